/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "motion_bound.h"

#include "geometry.h"

#include <algorithm>
#include <cmath>

using namespace Dust;

MotionBound::MotionBound(const ImpulseRecord &record, double peak, double rolling, double carrier_radius) :
    peak(peak), rolling(rolling), carrier_radius(carrier_radius)
{
  for (const ImpulseRecord::Span &span : record.spans()) {
    time += span.duration;
    for (int d = 0; d < 3; d++) axis[d] += span.impulse[d];
  }
  const double size = std::sqrt(dot(axis, axis));
  for (double &x : axis) x = size > 0.0 ? x / size : 0.0;
  for (const ImpulseRecord::Span &span : record.spans()) {
    const double *j = span.impulse, part = dot(j, axis);
    const double rest[3] = {j[0] - part * axis[0], j[1] - part * axis[1], j[2] - part * axis[2]};
    along += std::fabs(part);
    aside += std::sqrt(dot(rest, rest));
  }
}

/* ---------------------------------------------------------------------- */

// sqrt(5/2) theta_crit s_max t
double MotionBound::spring(double hold, double shell) const
{
  const double s = 2.0 * hold * carrier_radius / shell * (1.0 + std::sqrt(1.0 + peak / hold));
  return std::sqrt(2.5) * rolling * s * time;
}

/* ---------------------------------------------------------------------- */

MotionBound::Bound MotionBound::of(const double *n, double hold, double shell) const
{
  const double held = spring(hold, shell), turn = MARGIN * (along + aside + held) * time / shell;
  const double u = dot(n, axis), across = std::sqrt(std::max(0.0, 1.0 - u * u)) + turn;    // of the axis in the tangential plane
  const double w = along * std::min(1.0, across) + aside + held;
  return {turn, MARGIN * w * w / shell};
}

/* ---------------------------------------------------------------------- */

bool MotionBound::any_may_leave(double least_hold, double largest_hold) const
{
  const double w = along + aside + spring(largest_hold, carrier_radius);
  return peak * (1.0 + MARGIN * w * time / carrier_radius) + MARGIN * w * w / carrier_radius > least_hold;
}
