/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(wall/gran,FixWallGranNear);
// clang-format on
#else

#ifndef LMP_FIX_WALL_GRAN_NEAR_H
#define LMP_FIX_WALL_GRAN_NEAR_H

#include "fix_wall_gran.h"

#include <vector>

namespace LAMMPS_NS {

/* ----------------------------------------------------------------------
   LAMMPS' fix wall/gran under its own name, with the same bits: it looks only at atoms that may touch the wall
------------------------------------------------------------------------- */

class FixWallGranNear : public FixWallGran {
 public:
  FixWallGranNear(class LAMMPS *, int, char **);
  void init() override;
  void post_force(int) override;
  double memory_usage() override;

 private:
  std::vector<int> groups;    // of the atoms near the wall, 0 of all others
  std::vector<char> close;    // now
  bool skips;                 // whether atoms may be skipped
  double largest_radius, largest_gap;
  double reach(double);
  void find_near();
};

}    // namespace LAMMPS_NS

#endif
#endif
