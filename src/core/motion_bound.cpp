/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "motion_bound.h"

#include "geometry.h"

#include <algorithm>
#include <cmath>

using namespace Dust;

MotionBound::MotionBound(const ImpulseRecord &record, const double *spin, double a_max, double theta_crit, double rp) :
    peak(a_max), rolling(theta_crit), carrier_radius(rp)
{
  double last[3] = {spin[0], spin[1], spin[2]}, before[3] = {0.0, 0.0, 0.0};
  max_spin = std::sqrt(dot(last, last));
  for (const ImpulseRecord::Span &span : record.spans()) {
    time += span.duration;
    for (int d = 0; d < 3; d++) axis[d] += span.impulse[d];
    double change[3], jump[3];
    for (int d = 0; d < 3; d++) {
      const double mean = span.angle[d] / span.duration, force = span.impulse[d] / span.duration;
      change[d] = mean - last[d];
      last[d] = mean;
      jump[d] = force - before[d];
      before[d] = force;
    }
    max_spin = std::max(max_spin, std::sqrt(dot(last, last)));
    spin_changes += std::sqrt(dot(change, change));
    force_changes += std::sqrt(dot(jump, jump));
  }
  force_changes += std::sqrt(dot(before, before));
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

double MotionBound::spring(double hold, double shell) const
{
  const double s = 2.0 * hold * carrier_radius / shell * (1.0 + std::sqrt(1.0 + peak / hold));
  return std::sqrt(2.5) * rolling * s * time;
}

double MotionBound::spin(double shell) const
{
  const double grain = shell - carrier_radius;
  return std::sqrt(shell * shell + 0.4 * grain * grain) * spin_changes + 0.5 * shell * max_spin * max_spin * time;
}

/* ---------------------------------------------------------------------- */

MotionBound::Bound MotionBound::of(const double *n, double hold, double shell) const
{
  const double own = spring(hold, shell) + spin(shell);
  const double angle = MARGIN * ((along + aside + own) / shell + max_spin) * time;
  const double u = dot(n, axis),
               across = std::sqrt(std::max(0.0, 1.0 - u * u)) + angle;    // of the axis in the tangential plane
  const double w = along * std::min(1.0, across) + aside + own + shell * max_spin;
  return {angle, MARGIN * w * w / shell};
}

/* ---------------------------------------------------------------------- */

MotionBound::Max MotionBound::of_any(double max_hold, double max_shell) const
{
  const double v = along + aside + spring(max_hold, carrier_radius) + spin(max_shell);
  const double angle = MARGIN * (v / carrier_radius + max_spin) * time, w = v + max_shell * max_spin;
  const double centrifugal = MARGIN * w * w / carrier_radius;
  return {peak * (1.0 + angle) + centrifugal, angle, centrifugal};
}

/* ---------------------------------------------------------------------- */

bool MotionBound::any_may_leave(double min_hold, double max_hold, double max_shell) const
{
  return of_any(max_hold, max_shell).outward > min_hold;
}

/* ---------------------------------------------------------------------- */

bool MotionBound::any_may_ring_off(double min_hold, double max_hold, double max_shell) const
{
  const auto [outward, angle, centrifugal] = of_any(max_hold, max_shell);
  // |w|^2 goes up to its largest and down again, at most twice over: friction takes what was gained
  return outward > 0.3 * min_hold || force_changes + angle * peak + 4.0 * centrifugal > 0.95 * min_hold;
}
