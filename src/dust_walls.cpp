/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "dust_walls.h"

#include "domain.h"
#include "fix_wall_gran.h"
#include "modify.h"
#include "region.h"
#include "update.h"

#include <cmath>

using namespace LAMMPS_NS;

namespace {

constexpr int DIMENSIONS = 3;    // planes have the wall style of their axis

// a class for the wall's members, which have no other way out
class Wall : public FixWallGran {
 public:
  static int style(const FixWallGran *wall) { return wall->*(&Wall::wallstyle); }
  static const char *region(const FixWallGran *wall) { return wall->*(&Wall::idregion); }
  // by how much an oscillating plane is displaced along its axis
  static double shift(const FixWallGran *wall, bigint step)
  {
    if (!(wall->*(&Wall::wiggle)) || wall->*(&Wall::axis) != style(wall)) return 0.0;
    const double time = double(step - wall->*(&Wall::time_origin)) * (wall->*(&Wall::dt));
    return wall->*(&Wall::amplitude) * (1.0 - std::cos(wall->*(&Wall::omega) * time));
  }
  static double low(const FixWallGran *wall) { return wall->*(&Wall::lo); }
  static double high(const FixWallGran *wall) { return wall->*(&Wall::hi); }
};

}    // namespace

/* ---------------------------------------------------------------------- */

DustWalls::DustWalls(LAMMPS *_lmp) : Pointers(_lmp)
{
  for (const Fix *fix : modify->get_fix_list()) {
    const auto *wall = dynamic_cast<const FixWallGran *>(fix);
    if (!wall || wall->igroup != 0) continue;
    const int style = Wall::style(wall);
    if (style >= 0 && style < DIMENSIONS) {
      const double shift = Wall::shift(wall, update->ntimestep);
      planes.push_back({style, Wall::low(wall) + shift, Wall::high(wall) + shift});
    } else if (Region *region = Wall::region(wall) ? domain->get_region_by_id(Wall::region(wall)) : nullptr) {
      region->prematch();
      regions.push_back(region);
    }
  }
}

/* ----------------------------------------------------------------------
   a region's wall acts on what is in the region: what was outside of it before it may be there now
------------------------------------------------------------------------- */

bool DustWalls::stop(const double *from, const double *x, double radius) const
{
  for (const Plane &plane : planes)
    if (x[plane.axis] < plane.low + radius || x[plane.axis] > plane.high - radius) return true;
  for (Region *region : regions) {
    const bool was_in = region->match(from[0], from[1], from[2]), is_in = region->match(x[0], x[1], x[2]);
    if (is_in ? region->surface(x[0], x[1], x[2], radius) > 0 : was_in) return true;
  }
  return false;
}
