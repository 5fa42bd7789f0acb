/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_ROLLING_H
#define DUST_CORE_ROLLING_H

#include "geometry.h"

#include <cmath>

namespace Dust {

/*! Moves the rolling displacement xi of an adhesive contact on: Dominik & Tielens, Philos. Mag. A 72, 783 (1995).
 *
 * xi is a vector in the tangential plane. It turns with the contact, keeping its length, grows with the rolling
 * velocity and is held at xi_crit, where the pivot gives way.
 * \param xi        rolling displacement of the last step, changed
 * \param n         unit normal now
 * \param velocity  rolling velocity, in the tangential plane
 * \param limit     xi_crit = R_12 theta_crit
 * \return          whether the pivot gave way */
inline bool roll_on(double *xi, const double *n, const double *velocity, double dt, double limit)
{
  const double along = dot(xi, n), size2 = dot(xi, xi), left = size2 - along * along;
  const double turned = left > 0.0 ? std::sqrt(size2 / left) : 0.0;
  for (int d = 0; d < 3; d++) xi[d] = turned * (xi[d] - along * n[d]) + dt * velocity[d];
  const double size = std::sqrt(dot(xi, xi));
  if (!(size > limit)) return false;
  for (int d = 0; d < 3; d++) xi[d] *= limit / size;
  return true;
}

/*! Rolling stiffness k of the moment M = k xi of resistance, 4 F_c (a/a0)^(3/2)
 *  \param x  a/a0 */
inline double rolling_stiffness(double pull_off_force, double x) { return 4.0 * pull_off_force * x * std::sqrt(x); }

}    // namespace Dust

#endif
