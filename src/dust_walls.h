/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_WALLS_H
#define LMP_DUST_WALLS_H

#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {

// planes and regions of fix wall/gran that act on all atoms, and so on grains that have become atoms

class DustWalls : protected Pointers {
 public:
  explicit DustWalls(class LAMMPS *);    // as the walls stand now

  // whether a sphere that was at `from` has flown against a wall on its way to x, or through it
  bool stop(const double *from, const double *x, double radius) const;

 private:
  struct Plane {
    int axis;
    double low, high;    // allowed between
  };
  std::vector<Plane> planes;
  std::vector<class Region *> regions;
};

}    // namespace LAMMPS_NS

#endif
