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
#include "detach_settings.h"

#include <array>
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

  double compute_scalar() override;
  double compute_vector(int) override;
  double memory_usage() override;

  void grow_arrays(int) override;
  void copy_arrays(int, int, int) override;
  void set_arrays(int) override;
  int pack_exchange(int, double *) override;
  int unpack_exchange(int, double *) override;

  void write_restart(FILE *) override;
  void restart(char *) override;
  int pack_restart(int, double *) override;
  void unpack_restart(int, int) override;
  int size_restart(int) override;
  int maxsize_restart() override;

 private:
  DetachSettings settings;
  void check_order() const;

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
  enum { ATTACHED, MASS, WINDOW_MASS, CONTACT_TIME, PEAK_ACCELERATION, NCOLUMNS };    // of array_atom
  bool newcomers;    // atoms were added that may be carriers
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

  // what this rank has counted since the start, or since it read a restart file; whole numbers but for weight, the
  // mass lost in mean grain masses, which is one for equal grains
  struct Totals {
    double initial, modes[Dust::NMODES], weight, collisions;
    double north, sliding, rolling;    // of the collisions that are over
    double no_room;                    // grains that were not emitted
  } mine;
  struct Sums {    // over all ranks
    Totals totals;
    double attached;
  };
  Sums sum_up() const;
  template <typename Question> double sum_under_way(Question) const;

  // detachments
  static constexpr int NROW = 11;
  using Row = std::array<double, NROW>;
  std::vector<Row> events, rows;    // of this window and of the last complete one
  std::vector<double *> row_pointers;
  void record(int);
  int open_windows;    // windows to be closed until all of window_mass and its column are 0 again
  void close_window();
  void show_rows();

  // detached grains whose mass is still in their carrier's: they leave it at the end of the window
  enum { CARRIER, GRAIN, LOSS_MASS, LOSS_RADIUS, LOSS_STEP, LOSS_X, LOSS_V = LOSS_X + 3, LOSS_SPIN = LOSS_V + 3 };
  static constexpr int NLOSS = LOSS_SPIN + 3;
  using Loss = std::array<double, NLOSS>;
  std::vector<Loss> losses;
  void shed();
  std::vector<Loss> all_losses() const;
  void place_of(const Loss &, double *) const;
  void find_room(const std::vector<Loss> &, const std::vector<int> &, std::vector<char> &) const;
  void share_room(const std::vector<Loss> &, std::vector<char> &) const;

  // contacts of the deck that are softer than `stiffen` says
  double too_soft;    // factor of the inertia, or 1
  bool warned;
  void look_for_soft_contacts();

  int exchange_room;    // for a collision in what a carrier takes along when it changes ranks
  void make_exchange_room(const Dust::Collision &);
  void share_exchange_room();
  int fixed_size() const;
  bool oriented() const;
  int orientation_size() const;
  int packed_size(int) const;
  int pack(int, double *) const;
  void unpack(int, const double *);
};

}    // namespace LAMMPS_NS

#endif
#endif
