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

#include "carrier_data.h"
#include "carrier_motion.h"
#include "core/collision_pool.h"
#include "core/pack.h"
#include "deck_checks.h"
#include "detach_settings.h"
#include "detach_totals.h"
#include "detachment_rows.h"
#include "dust_coat.h"
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
  void setup_post_neighbor() override { post_neighbor(); }
  void initial_integrate(int) override;
  void post_neighbor() override;
  void post_force(int) override;
  void end_of_step() override;
  void post_run() override;

  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;

  // for those who draw carrier i: its texture, and what is left of it
  const DustCoat &coat_of(int i) const { return coats[carriers.coat[i]]; }
  const CarrierData &all_carriers() const { return carriers; }

  void grow_arrays(int) override;
  void copy_arrays(int, int, int) override;
  void set_arrays(int) override;
  int pack_exchange(int i, double *buf) override { return pack_with_size(i, false, buf); }
  int unpack_exchange(int, double *) override;
  int pack_forward_comm(int, int *, double *, int, int *) override;
  void unpack_forward_comm(int, int, double *) override;

  void write_restart(FILE *) override;
  void restart(char *) override;
  int pack_restart(int i, double *buf) override { return pack_with_size(i, true, buf); }
  void unpack_restart(int, int) override;
  int size_restart(int i) override { return packed_size(i) + 1; }
  int maxsize_restart() override;

 private:
  DetachSettings settings;
  DeckChecks checks;
  DeckChecks::Course course_of(int) const;    // the collision of a carrier

  DustCoats coats;
  CarrierData carriers;
  const Dust::GrainTable &table_of(int i) const { return coats.table(carriers.coat[i]); }
  static constexpr int NO_CARRIER = CarrierData::NO_CARRIER, NOT_WEIGHED = CarrierData::NOT_WEIGHED,
                       FREE_FLIGHT = CarrierData::FREE_FLIGHT, AT_REST = CarrierData::AT_REST;
  double steps;      // since the fix is there
  bool newcomers;    // atoms were added that may be carriers
  bool is_newcomer(int) const;
  void adopt();
  void adopt(int);
  void weigh();

  // collisions under way on this rank
  Dust::CollisionPool collisions;
  Dust::Motion motion_of(int) const;
  struct Busy {    // those of a block of atoms that something may happen to in this step
    static constexpr int BLOCK = 64, GOES = 3;
    int atoms[BLOCK], count = 0;
  };
  void find_busy(int block, Busy &);
  void fetch_motion(const Busy &) const;
  void fetch(const Busy &, Dust::Collision::Fetch) const;
  void attend(const Busy &);
  void collide(int, const Dust::Motion &);
  void begin_collision(int, const Dust::Motion &);
  void finish_collision(int, int);
  void leave_contact(int);
  void spin_off(int);

  // inertia from motion: who is in contact is seen with the forces, how carriers move at the end of the step
  CarrierMotion motions;
  std::vector<char> touched;    // in this step
  void note_contacts();
  void follow(int);

  DetachTotals mine;    // of this rank
  double attached_grains() const;
  template <typename Question> double sum_under_way(Question) const;

  // grains that meet: followed together after a collision
  void begin_following(int, const double *);
  void follow_grains();
  void stop_following(int);
  double followed_carriers() const;
  void pack_following(int, Dust::Packer &) const;
  void unpack_following(int, Dust::Unpacker &);

  // detachments
  DetachmentRows rows;
  struct Carried {
    double x[3], v[3];
  };
  Carried now(int) const;
  struct Loss {
    double grains, weight, mass, momentum[3];
  };
  void add(Loss &, int i, int bit, Dust::Mode, double sign, const double *velocity);
  void book(int, const Loss &);
  DustShedding::Grain as_it_left(int, const Carried &, const Dust::Detachment &, double before, double height) const;
  void record(int);
  void record_together(int);
  double lifted(int) const;
  void add_row(int, const DustShedding::Grain &, Dust::Mode, double before);
  void close_step();
  void close_window();
  void show_rows();

  // mass and grains that leave
  DustShedding shedding;
  void tell_ghosts();

  int exchange_room;    // for a collision and waiting grains in what a carrier takes along when it changes ranks
  void make_exchange_room(int);
  void share_exchange_room();
  int fixed_size() const;
  int packed_size(int) const;
  enum { NEWCOMER = -1, NO_DATA = 0, CARRIER = 1 };    // what an atom takes along
  void pack(int, bool, Dust::Packer &) const;
  int pack_with_size(int, bool, double *) const;
  void unpack(int, const double *);
};

}    // namespace LAMMPS_NS

#endif
#endif
