/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "fix_wall_gran_region_near.h"

#include "atoms_shown.h"
#include "core/lanes.h"
#include "gran_sub_mod_dust_normal.h"

#include "atom.h"
#include "granular_model.h"
#include "neighbor.h"
#include "region.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

using namespace LAMMPS_NS;
using Dust::Vector;

namespace {

// whose contacts are those of the surface's nearest points: no open faces, no parts of other regions
constexpr const char *SHAPES[] = {"block", "cylinder", "sphere", "plane"};

// whether LAMMPS tells how a region has moved; 4Feb2025 does not
template <class Moving> auto see(Moving *region, Vector &x, int)
    -> decltype(region->inverse_transform(x.x, x.y, x.z), true)
{
  region->inverse_transform(x.x, x.y, x.z);
  return true;
}

template <class Moving> bool see(Moving *, Vector &, long) { return false; }

// how a region sees the box: as it was before it moved and turned
class Frame {
 public:
  explicit Frame(Region *region) : origin(seen(region, {0.0, 0.0, 0.0}))
  {
    axes[0] = seen(region, {1.0, 0.0, 0.0}) - origin;
    axes[1] = seen(region, {0.0, 1.0, 0.0}) - origin;
    axes[2] = seen(region, {0.0, 0.0, 1.0}) - origin;
  }
  DUST_IN_LANES Vector of(const double *x) const { return origin + x[0] * axes[0] + x[1] * axes[1] + x[2] * axes[2]; }

 private:
  Vector origin, axes[3];
  static Vector seen(Region *region, Vector x)
  {
    if (region->dynamic) see(region, x, 0);
    return x;
  }
};

// Stands for a region that has moved already, where LAMMPS would move it once more: a variable may give something else
// the second time, above all one that asks for groups while atoms are hidden. Has no other use than that of
// fix wall/gran/region.
class Moved : public Region {
 public:
  Moved(LAMMPS *_lmp, Region *&_place) : Region(_lmp, 2, NAMES), place(_place), region(_place)
  {
    dynamic = region->dynamic;
    contact = region->contact;
    place = this;
  }
  ~Moved() { place = region; }
  Moved(const Moved &) = delete;
  Moved &operator=(const Moved &) = delete;

  // virtual in LAMMPS since 4Jul2026: before, regions that move are left to LAMMPS
  void prematch() {}
  int match(double x, double y, double z) { return region->match(x, y, z); }
  int surface(double x, double y, double z, double reach) { return region->surface(x, y, z, reach); }
  void set_velocity() { region->set_velocity(); }
  void velocity_contact(double *of_wall, double *x, int k) { region->velocity_contact(of_wall, x, k); }

  int inside(double x, double y, double z) { return region->inside(x, y, z); }
  int surface_interior(double *x, double reach) { return region->surface_interior(x, reach); }
  int surface_exterior(double *x, double reach) { return region->surface_exterior(x, reach); }

 private:
  static inline char name[] = "moved";
  static inline char *NAMES[] = {name, name};
  Region *&place, *const region;
};

}    // namespace

// squares of how far atoms have come from places, as a region sees both
DUST_LANES static void find_moved(const double *x, int n, const Frame &seen, const double *const *places,
                                  double *moved2)
{
  const Frame frame = seen;
  const double *a = places[0], *b = places[1], *c = places[2];
  for (int i = 0; i < n; i++) {
    const Vector moved = frame.of(x + 3 * i) - Vector{a[i], b[i], c[i]};
    moved2[i] = dot(moved, moved);
  }
}

/* ---------------------------------------------------------------------- */

FixWallGranRegionNear::FixWallGranRegionNear(LAMMPS *_lmp, int narg, char **arg) :
    FixWallGranRegion(_lmp, narg, arg), skips(false), margin(0.0)
{
}

/* ---------------------------------------------------------------------- */

void FixWallGranRegionNear::init()
{
  FixWallGranRegion::init();
  const bool adhesive = dynamic_cast<const Granular_NS::GranSubModNormalJKRVdW *>(model->normal_model);
  const bool simple = std::any_of(std::begin(SHAPES), std::end(SHAPES),
                                  [this](const char *shape) { return std::string(shape) == region->style; });
  Vector origin = {0.0, 0.0, 0.0};
  const bool still = !region->dynamic || see(region, origin, 0);
  skips =
      simple && still && !region->openflag && !region->varshape && !heat_flag && (adhesive || !model->beyond_contact);
  near.clear();
}

/* ----------------------------------------------------------------------
   an atom off the region is near: LAMMPS looks at it again when it comes back. LAMMPS knows no contact on the axis of a
   cylinder: look beside the place, too.
------------------------------------------------------------------------- */

void FixWallGranRegionNear::look_at(int i, const Vector &place)
{
  constexpr double BESIDE = 1.0e-3;
  const double *x = atom->x[i], radius = atom->radius[i], off = BESIDE * margin;
  const double reach = radius + model->pulloff_distance(radius, 0.0) + margin + 2.0 * off;
  near[i] = !region->match(x[0], x[1], x[2]) || region->surface(x[0], x[1], x[2], reach) > 0 ||
            region->surface(x[0] + off, x[1] + off, x[2] + off, reach) > 0;
  radii[i] = radius;
  places[0][i] = place.x;
  places[1][i] = place.y;
  places[2][i] = place.z;
}

/* ----------------------------------------------------------------------
   whether LAMMPS, which takes sines and cosines for each atom that it sees, may find a contact here, or none off the
   region. The place differs by round-off from where LAMMPS finds the atom.
------------------------------------------------------------------------- */

bool FixWallGranRegionNear::may_touch(const Vector &place, double radius) const
{
  constexpr double BESIDE = 1.0e-6;
  const double off = BESIDE * radius, reach = radius + model->pulloff_distance(radius, 0.0) + 4.0 * off;
  double x[3] = {place.x + off, place.y + off, place.z + off};
  if (region->inside(x[0], x[1], x[2]) != region->interior) return true;
  return (region->interior ? region->surface_interior(x, reach) : region->surface_exterior(x, reach)) > 0;
}

/* ----------------------------------------------------------------------
   Between two looks an atom moves by less than the margin, as the region sees it. When LAMMPS sees an atom without
   contact, it forgets those that the atom had.
------------------------------------------------------------------------- */

void FixWallGranRegionNear::find_near()
{
  if (region->dynamic_check()) region->prematch();
  const int nlocal = atom->nlocal, *mask = atom->mask;
  const double *const *x = atom->x, *radius = atom->radius;
  const bool anew = neighbor->ago == 0 || static_cast<int>(near.size()) != nlocal;
  if (anew) margin = 0.5 * neighbor->skin;    // holds as long as what was found with it
  const double margin2 = margin * margin;
  const Frame frame(region);
  for (std::vector<double> *each : {&places[0], &places[1], &places[2], &radii, &moved2}) each->resize(nlocal);
  near.resize(nlocal);
  groups.assign(nlocal, 0);
  const double *const looked_at[3] = {places[0].data(), places[1].data(), places[2].data()};
  if (!anew && nlocal > 0) find_moved(x[0], nlocal, frame, looked_at, moved2.data());
  for (int i = 0; i < nlocal; i++) {
    if (!(mask[i] & groupbit)) continue;
    const bool looks_now = anew || !(moved2[i] < margin2) || radius[i] != radii[i];
    if (!looks_now && !near[i]) continue;
    const Vector place = frame.of(x[i]);
    if (looks_now) look_at(i, place);
    if (may_touch(place, radius[i]))
      groups[i] = mask[i];
    else if (use_history)
      ncontact[i] = 0;
  }
}

/* ---------------------------------------------------------------------- */

void FixWallGranRegionNear::post_force(int vflag)
{
  if (!skips) {
    FixWallGranRegion::post_force(vflag);
    return;
  }
  find_near();
  std::optional<Moved> moved;
  if (region->dynamic) moved.emplace(lmp, region);
  const AtomsShown shown(atom, groups);
  FixWallGranRegion::post_force(vflag);
}

/* ---------------------------------------------------------------------- */

double FixWallGranRegionNear::memory_usage()
{
  return FixWallGranRegion::memory_usage() + double(near.size()) * (5 * sizeof(double) + sizeof(char) + sizeof(int));
}
