/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(wall/gran/region,FixWallGranRegionNear);
// clang-format on
#else

#ifndef LMP_FIX_WALL_GRAN_REGION_NEAR_H
#define LMP_FIX_WALL_GRAN_REGION_NEAR_H

#include "core/geometry.h"
#include "fix_wall_gran_region.h"

#include <vector>

namespace LAMMPS_NS {

/* ----------------------------------------------------------------------
   LAMMPS' fix wall/gran/region under its own name, with the same bits: it looks only at atoms that may touch the wall
------------------------------------------------------------------------- */

class FixWallGranRegionNear : public FixWallGranRegion {
 public:
  FixWallGranRegionNear(class LAMMPS *, int, char **);
  void init() override;
  void post_force(int) override;
  double memory_usage() override;

 private:
  // of each atom: where it was, as the region sees it, when its distance was looked at, its radius then, whether it was
  // near, and the square of how far it has come since
  std::vector<double> places[3], radii, moved2;
  std::vector<char> near;
  std::vector<int> groups;    // of the atoms that may touch the wall, 0 of all others
  bool skips;                 // whether atoms may be skipped
  double margin;              // up to which they are near
  void look_at(int, const Dust::Vector &);
  bool may_touch(const Dust::Vector &, double) const;
  void find_near();
};

}    // namespace LAMMPS_NS

#endif
#endif
