/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "motion_bound.h"

#include "geometry.h"

#include <algorithm>
#include <cmath>

using namespace Dust;

MotionBound::MotionBound(const ImpulseRecord &record, const double *spin, double peak, double rolling,
                         double carrier_radius) : peak(peak), rolling(rolling), carrier_radius(carrier_radius)
{
  double last[3] = {spin[0], spin[1], spin[2]}, before[3] = {0.0, 0.0, 0.0};
  fastest = std::sqrt(dot(last, last));
  for (const ImpulseRecord::Span &span : record.spans()) {
    time += span.duration;
    for (int d = 0; d < 3; d++) axis[d] += span.impulse[d];
    double change[3], jump[3];
    for (int d = 0; d < 3; d++) {
      const double mean = span.turn[d] / span.duration, force = span.impulse[d] / span.duration;
      change[d] = mean - last[d];
      last[d] = mean;
      jump[d] = force - before[d];
      before[d] = force;
    }
    fastest = std::max(fastest, std::sqrt(dot(last, last)));
    spun += std::sqrt(dot(change, change));
    changes += std::sqrt(dot(jump, jump));
  }
  changes += std::sqrt(dot(before, before));
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
  return std::sqrt(shell * shell + 0.4 * grain * grain) * spun + 0.5 * shell * fastest * fastest * time;
}

/* ---------------------------------------------------------------------- */

MotionBound::Bound MotionBound::of(const double *n, double hold, double shell) const
{
  const double own = spring(hold, shell) + spin(shell);
  const double turn = MARGIN * ((along + aside + own) / shell + fastest) * time;
  const double u = dot(n, axis),
               across = std::sqrt(std::max(0.0, 1.0 - u * u)) + turn;    // of the axis in the tangential plane
  const double w = along * std::min(1.0, across) + aside + own + shell * fastest;
  return {turn, MARGIN * w * w / shell};
}

/* ---------------------------------------------------------------------- */

MotionBound::Largest MotionBound::of_any(double largest_hold, double largest_shell) const
{
  const double v = along + aside + spring(largest_hold, carrier_radius) + spin(largest_shell);
  const double turn = MARGIN * (v / carrier_radius + fastest) * time, w = v + largest_shell * fastest;
  const double centrifugal = MARGIN * w * w / carrier_radius;
  return {peak * (1.0 + turn) + centrifugal, turn, centrifugal};
}

/* ---------------------------------------------------------------------- */

bool MotionBound::any_may_leave(double least_hold, double largest_hold, double largest_shell) const
{
  return of_any(largest_hold, largest_shell).outward > least_hold;
}

/* ---------------------------------------------------------------------- */

bool MotionBound::any_may_ring_off(double least_hold, double largest_hold, double largest_shell) const
{
  const auto [outward, turn, centrifugal] = of_any(largest_hold, largest_shell);
  // |w|^2 goes up to its largest and down again, at most twice over: friction takes what was gained
  return outward > 0.3 * least_hold || changes + turn * peak + 4.0 * centrifugal > 0.95 * least_hold;
}
