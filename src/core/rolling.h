/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_ROLLING_H
#define DUST_CORE_ROLLING_H

#include "geometry.h"

#include <cmath>

namespace Dust {

/*! Rolling displacement xi of an adhesive contact after a step, and whether its pivot gave way */
struct Rolling {
  Vector displacement;
  bool gave_way;
};

/*! Moves the rolling displacement on: Dominik & Tielens, Philos. Mag. A 72, 783 (1995).
 *
 * xi is a vector in the tangential plane. It turns with the contact, keeping its length, grows with the rolling
 * velocity and is held at xi_crit, where the pivot gives way.
 * \param xi        rolling displacement of the last step
 * \param n         unit normal now
 * \param velocity  rolling velocity, in the tangential plane
 * \param limit     xi_crit = R_12 theta_crit */
inline Rolling roll_on(const Vector &xi, const Vector &n, const Vector &velocity, double dt, double limit)
{
  const double along = dot(xi, n), size2 = dot(xi, xi), left = size2 - along * along;
  const double turned = left > 0.0 ? std::sqrt(size2 / left) : 0.0;
  const Vector moved = turned * (xi - along * n) + dt * velocity;
  const double size = std::sqrt(dot(moved, moved));
  const bool gives_way = size > limit;
  const double shortened = limit / size;
  const Vector held = shortened * moved;
  return {{gives_way ? held.x : moved.x, gives_way ? held.y : moved.y, gives_way ? held.z : moved.z}, gives_way};
}

/*! Rolling stiffness k of the moment M = k xi of resistance, 4 F_c (a/a0)^(3/2)
 *  \param x  a/a0 */
inline double rolling_stiffness(double pull_off_force, double x) { return 4.0 * pull_off_force * x * std::sqrt(x); }

}    // namespace Dust

#endif
