/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_ROOM_H
#define LMP_DUST_ROOM_H

#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {

/* Where spheres can be put: inside the fixed borders of the box, before the walls that act on all atoms, over no atom,
   and over none of their own that comes before. All ranks give the same list and get the same answer, whichever rank an
   atom belongs to and whatever periodic image of it is near. */

class DustRoom : protected Pointers {
 public:
  struct Sphere {
    double x[3], from[3], radius;    // from: where it has flown from
    tagint carrier;                  // may touch it: grains leave from there
  };
  DustRoom(class LAMMPS *, std::vector<Sphere>);

  // 1 or 0 for each
  std::vector<int> find() const;

 private:
  std::vector<Sphere> spheres;
  std::vector<int> along;    // sorted along the longest side of the box
  int axis;
  double largest;    // radius

  template <typename Visit> void each_near(const double *x, double reach, Visit visit) const;
  double distance2(const double *, const double *) const;
  void clear_of_atoms(std::vector<int> &room) const;
  void clear_of_each_other(std::vector<int> &room) const;
};

}    // namespace LAMMPS_NS

#endif
