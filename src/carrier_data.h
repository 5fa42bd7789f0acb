/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_CARRIER_DATA_H
#define LMP_DUST_CARRIER_DATA_H

#include "pointers.h"

#include "core/entrainment.h"
#include "core/pack.h"
#include "core/quaternion.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace LAMMPS_NS {

// what a fix dust/detach keeps of each atom: arrays that LAMMPS has grow, and travel with the atom

class CarrierData : protected Pointers {
 public:
  // NOT_WEIGHED: in free flight, the mass of its grains not in its own yet. Other states: number of the collision
  enum { NO_CARRIER = -4, NOT_WEIGHED = -3, FREE_FLIGHT = -2, AT_REST = -1 };
  int *state;
  int *coat;                                      // number of its texture
  double *radius;                                 // when it became a carrier; 0 for other atoms
  std::vector<std::vector<uint64_t>> attached;    // of carriers, a bit a grain of the texture; of atoms so far
  Dust::Quaternion *orientation;    // if it is not the same for all for ever: TURN_EVERY steps ago at most, with
  double **angle;                   // rotation: about which the carrier has turned since
  double *window_mass;              // lost in the window that is not complete yet
  double **before;                  // for inertia from motion: at the end of the last step
  double *began;                    // step in which the present contact did
  double **columns;                 // of the per-atom array
  // grains that meet: of carriers whose grains are followed after a collision
  std::vector<std::unique_ptr<Dust::Entrainment>> together;

  // rotation: carriers turn; orientations: they do, or do not start all alike; motion: numbers of before[i];
  // meet: grains meet each other
  CarrierData(class LAMMPS *, bool rotation, bool orientations, int motion, bool meet);
  ~CarrierData() override;
  CarrierData(const CarrierData &) = delete;
  CarrierData &operator=(const CarrierData &) = delete;

  void grow(int nmax);
  void copy(int i, int j);
  void clear(int i);    // no carrier

  void add_turn(int first, int last);    // of a step, for the atoms from first to before last
  static constexpr int TURN_EVERY = 16;
  void turn();
  Dust::Quaternion standing(int i) const;    // now
  void show_standing();                      // in the columns

  void close_window();    // its mass becomes a column
  double attached_grains(int groupbit) const;
  std::vector<bool> colliding(size_t collisions) const;    // by number of the collision, whether a carrier has it

  // of a carrier; the number of its collision does not travel, 0 stands for it
  int size(int words) const;    // at most, with so many words of attached bits
  // tells which are used
  int layout() const { return 100 * meet_used + motion_size + (angle_used ? 7 : orientation_used ? 4 : 0); }
  void pack(int i, Dust::Packer &) const;
  void unpack(int i, Dust::Unpacker &);

  double memory_usage() const;

 private:
  bool angle_used, orientation_used, meet_used;
  int motion_size;
  void make_room_for(int);
};

}    // namespace LAMMPS_NS

#endif
