/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_HERTZ_H
#define DUST_CORE_HERTZ_H

#include <cmath>

/* Elastic impact of two spheres, or of one on a wall: F = 4/3 E* sqrt(R) delta^(3/2), K. L. Johnson, Contact Mechanics
   (1985), section 11.4. */

namespace Dust {

/*! Largest overlap: m u^2/2 = 8/15 E* sqrt(R) delta^(5/2)
 *  \param modulus  E*
 *  \param radius   effective radius R; on a wall that of the sphere
 *  \param mass     effective mass m
 *  \param speed    u, with which the surfaces meet */
inline double hertz_overlap(double modulus, double radius, double mass, double speed)
{
  return std::pow(15.0 / 16.0 * mass * speed * speed / (modulus * std::sqrt(radius)), 0.4);
}

/*! Largest force */
inline double hertz_peak_force(double modulus, double radius, double mass, double speed)
{
  const double overlap = hertz_overlap(modulus, radius, mass, speed);
  return 4.0 / 3.0 * modulus * std::sqrt(radius * overlap) * overlap;
}

}    // namespace Dust

#endif
