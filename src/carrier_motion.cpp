/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "carrier_motion.h"

#include "atom.h"
#include "domain.h"
#include "fix.h"
#include "modify.h"
#include "update.h"

#include <algorithm>

using namespace LAMMPS_NS;

static constexpr int NOTED = 6;    // numbers in the middle of a step: velocity, spin

/* ---------------------------------------------------------------------- */

void CarrierMotion::look()
{
  gravities.clear();
  carried = kicked = 0;
  for (Fix *fix : modify->get_fix_list()) {
    if (utils::strmatch(fix->style, "^move")) carried |= fix->groupbit;
    if (utils::strmatch(fix->style, "^nve")) kicked |= fix->groupbit;
    if (!utils::strmatch(fix->style, "^gravity")) continue;
    int dim = 0;
    const auto *acceleration = static_cast<const double *>(fix->extract("gvec", dim));
    if (acceleration) gravities.push_back({fix->groupbit, acceleration});
  }
}

/* ---------------------------------------------------------------------- */

void CarrierMotion::remember(int i, double *before) const
{
  std::copy_n(atom->x[i], 3, before);
  std::copy_n(atom->v[i], 3, before + 3);
  if (atom->omega_flag) std::copy_n(atom->omega[i], 3, before + 6);
}

/* ---------------------------------------------------------------------- */

void CarrierMotion::note_middle()
{
  middle.resize(NOTED * atom->nlocal);
  for (int i = 0; i < atom->nlocal; i++) {
    std::copy_n(atom->v[i], 3, &middle[NOTED * i]);
    if (atom->omega_flag) std::copy_n(atom->omega[i], 3, &middle[NOTED * i + 3]);
  }
}

/* ---------------------------------------------------------------------- */

Dust::Motion CarrierMotion::of(int i, const double *before, bool rotation) const
{
  Dust::Motion motion = {};
  const double per_time = 1.0 / update->dt, *v = atom->v[i], *v_middle = &middle[NOTED * i];
  const bool is_carried = atom->mask[i] & carried, is_kicked = !is_carried && (atom->mask[i] & kicked);
  if (is_carried) {
    const double *x = atom->x[i];
    double from[3];    // across a periodic border, too
    domain->closest_image(x, before, from);
    for (int d = 0; d < 3; d++) motion.acceleration[d] = 2.0 * (v[d] - (x[d] - from[d]) * per_time) * per_time;
  } else if (is_kicked)
    for (int d = 0; d < 3; d++) motion.acceleration[d] = 2.0 * (v[d] - v_middle[d]) * per_time;
  else
    for (int d = 0; d < 3; d++) motion.acceleration[d] = (v[d] - before[3 + d]) * per_time;
  for (const Gravity &gravity : gravities)
    if (atom->mask[i] & gravity.groupbit)
      for (int d = 0; d < 3; d++) motion.acceleration[d] -= gravity.acceleration[d];

  if (!rotation) return motion;
  const double *w = atom->omega[i], *w_before = before + 6, *w_middle = v_middle + 3;
  for (int d = 0; d < 3; d++) {
    if (is_carried)
      motion.spin[d] = w[d];
    else if (is_kicked) {
      motion.angular_acceleration[d] = 2.0 * (w[d] - w_middle[d]) * per_time;
      motion.spin[d] = w_middle[d];
    } else {
      motion.angular_acceleration[d] = (w[d] - w_before[d]) * per_time;
      motion.spin[d] = 0.5 * (w[d] + w_before[d]);
    }
  }
  return motion;
}
