/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(dust/detach,FixDustDetach);
// clang-format on
#else

#ifndef LMP_FIX_DUST_DETACH_H
#define LMP_FIX_DUST_DETACH_H

#include "fix.h"

#include "core/collision_pool.h"
#include "core/pack.h"
#include "deck_checks.h"
#include "detach_settings.h"
#include "detach_totals.h"
#include "detachment_rows.h"
#include "dust_shedding.h"

#include <memory>
#include <vector>

namespace LAMMPS_NS {

class FixDustDetach : public Fix {
 public:
  FixDustDetach(class LAMMPS *, int, char **);
  ~FixDustDetach() override;
  int setmask() override;
  void init() override;
  void setup_pre_exchange() override;
  void pre_exchange() override;
  void setup(int) override;
  void setup_post_neighbor() override;
  void initial_integrate(int) override;
  void post_neighbor() override;
  void post_force(int) override;
  void post_run() override;

  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;

  void grow_arrays(int) override;
  void copy_arrays(int, int, int) override;
  void set_arrays(int) override;
  int pack_exchange(int, double *) override;
  int unpack_exchange(int, double *) override;
  int pack_forward_comm(int, int *, double *, int, int *) override;
  void unpack_forward_comm(int, int, double *) override;

  void write_restart(FILE *) override;
  void restart(char *) override;
  int pack_restart(int, double *) override;
  void unpack_restart(int, int) override;
  int size_restart(int) override;
  int maxsize_restart() override;

 private:
  DetachSettings settings;
  DeckChecks checks;
  DeckChecks::Course course_of(const Dust::Collision &) const;

  // texture, once the size of the carriers is known
  double carrier_radius;    // 0 until then
  Dust::Texture texture;
  std::unique_ptr<Dust::GrainTable> functions;
  double texture_checksum;
  void build();

  // per atom
  enum { NO_CARRIER = -3, FREE_FLIGHT = -2, AT_REST = -1 };    // other states: index of the collision
  int *state;
  uint64_t **attached;
  Dust::Quaternion *orientation;    // if it is not the same for all carriers for ever: TURN_EVERY steps ago at most,
  double **angle;                   // with rotation: about which the carrier has turned since
  double *window_mass;              // lost in the window that is not complete yet
  double steps;                     // since the fix is there
  double *began;                    // of them, when the present contact did
  bool newcomers;                   // atoms were added that may be carriers
  void adopt();
  void weigh();

  // collisions under way on this rank
  Dust::CollisionPool collisions;
  void drop_lost_collisions();
  Dust::Motion motion_of(int) const;
  static constexpr int TURN_EVERY = 16;
  void turn();
  void collide(int);
  void begin_collision(int, const Dust::Motion &);
  void finish_collision(int, int);
  void leave_contact(int);
  void spin_off(int);

  DetachTotals mine;    // of this rank
  double attached_grains() const;
  template <typename Question> double sum_under_way(Question) const;

  // detachments
  DetachmentRows rows;
  void record(int);
  void close_window();
  void show_rows();

  // mass and grains that leave
  DustShedding shedding;
  void tell_ghosts();

  int exchange_room;    // for a collision and waiting grains in what a carrier takes along when it changes ranks
  void make_exchange_room(int);
  void share_exchange_room();
  int fixed_size() const;
  bool oriented() const;
  int orientation_size() const;
  int packed_size(int) const;
  static constexpr int NEWCOMER = -1;    // in what an atom that is no carrier takes along
  void pack(int, bool, Dust::Packer &) const;
  void unpack(int, const double *);
};

}    // namespace LAMMPS_NS

#endif
#endif
