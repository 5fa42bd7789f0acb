/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "fix_wall_gran_near.h"

#include "atoms_shown.h"
#include "gran_sub_mod_dust_normal.h"

#include "atom.h"
#include "granular_model.h"
#include "neighbor.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

static constexpr int DIMENSIONS = 3;        // planes have the wall style of their axis
static constexpr double SLACK = 1.0e-12;    // LAMMPS compares squares

/* ---------------------------------------------------------------------- */

FixWallGranNear::FixWallGranNear(LAMMPS *_lmp, int narg, char **arg) :
    FixWallGran(_lmp, narg, arg), skips(false), largest_radius(-1.0), largest_gap(0.0)
{
}

/* ----------------------------------------------------------------------
   planes at rest whose contacts end at the radius, or where the law says
------------------------------------------------------------------------- */

void FixWallGranNear::init()
{
  FixWallGran::init();
  const bool adhesive = dynamic_cast<const Granular_NS::GranSubModNormalJKRVdW *>(model->normal_model);
  skips = wallstyle >= 0 && wallstyle < DIMENSIONS && !wiggle && !heat_flag && (adhesive || !model->beyond_contact);
  largest_radius = -1.0;
  close.clear();
}

/* ----------------------------------------------------------------------
   adhesion reaches the farther the larger an atom is: as far as that of the largest one will do
------------------------------------------------------------------------- */

double FixWallGranNear::reach(double radius)
{
  if (radius > largest_radius) {
    largest_radius = radius;
    largest_gap = model->beyond_contact ? model->pulloff_distance(radius, 0.0) : 0.0;
  }
  return (radius + largest_gap) * (1.0 + SLACK);
}

/* ----------------------------------------------------------------------
   An atom that was close is shown once more: LAMMPS then clears its history. After atoms have changed places all are.
------------------------------------------------------------------------- */

void FixWallGranNear::find_near()
{
  const int nlocal = atom->nlocal;
  const bool anew = neighbor->ago == 0 || static_cast<int>(close.size()) != nlocal;
  if (anew) close.assign(nlocal, 1);
  groups.resize(nlocal);
  const int *mask = atom->mask;
  const double *const *x = atom->x, *radius = atom->radius;
  for (int i = 0; i < nlocal; i++) {
    groups[i] = 0;
    if (!(mask[i] & groupbit)) continue;
    const double distance = std::min(std::fabs(x[i][wallstyle] - lo), std::fabs(hi - x[i][wallstyle]));
    const char now = distance < reach(radius[i]);
    if (now || close[i]) groups[i] = mask[i];
    close[i] = now;
  }
}

/* ---------------------------------------------------------------------- */

void FixWallGranNear::post_force(int vflag)
{
  if (!skips) {
    FixWallGran::post_force(vflag);
    return;
  }
  find_near();
  const AtomsShown shown(atom, groups);
  FixWallGran::post_force(vflag);
}

/* ---------------------------------------------------------------------- */

double FixWallGranNear::memory_usage()
{
  return FixWallGran::memory_usage() + double(groups.size() * sizeof(int) + close.size());
}
