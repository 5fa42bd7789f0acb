/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_JKR_H
#define DUST_CORE_JKR_H

#include "geometry.h"

#include <cmath>

/* Constants of the adhesive contact of Johnson, Kendall and Roberts, Proc. R. Soc. Lond. A 324, 301 (1971), with
   gamma in the convention of Chokshi et al., Astrophys. J. 407, 806 (1993): work of adhesion w = 2 gamma. */

namespace Dust {

/*! Effective radius R_12 of two spheres */
inline double effective_radius(double r1, double r2) { return r1 * r2 / (r1 + r2); }

/*! Combined modulus E* of two materials with Young's moduli and Poisson's ratios */
inline double combined_modulus(double e1, double nu1, double e2, double nu2)
{
  return 1.0 / ((1.0 - nu1 * nu1) / e1 + (1.0 - nu2 * nu2) / e2);
}

/*! Pull-off force F_c = 3 pi gamma R_12 */
inline double pull_off_force(double gamma, double r12) { return 3.0 * PI * gamma * r12; }

/*! Contact radius without load, a0 = (9 pi gamma R_12^2/E*)^(1/3) */
inline double equilibrium_contact_radius(double gamma, double r12, double modulus)
{
  return std::cbrt(9.0 * PI * gamma * r12 * r12 / modulus);
}

/*! 6^(1/3), in the lengths of the branch */
constexpr double ROOT_6 = 1.8171205928321397;

/*! Overlap without load, delta_0 = a0^2/(3 R_12) */
inline double equilibrium_overlap(double a0, double r12) { return a0 * a0 / (3.0 * r12); }

/*! Gap to which the neck stretches before it breaks, delta_c = a0^2/(2 6^(1/3) R_12) */
inline double breaking_gap(double a0, double r12) { return a0 * a0 / (2.0 * ROOT_6 * r12); }

/*! Work of a neck along the branch from the overlap 0 to its end, in F_c delta_c */
constexpr double NECK_WORK = 0.9355;

/*! Contact radius a/a0 on the stable branch from the overlap: the largest x with
 *  delta/delta_c = 6^(1/3) (2 x^2 - (4/3) sqrt(x)).
 *
 * A quartic in sqrt(x), solved by its resolvent cubic in a form without cancellation, and one Newton step.
 * \param d  delta/delta_c, at least -1; the branch ends there and lower values are taken for -1
 * \return   x, from 6^(-2/3) on */
double jkr_contact_radius(double d);

/*! A step of Newton's method for y = sqrt(a/a0), where y^4 - (2/3) y = depth.
 *  \param depth  delta/(2 6^(1/3) delta_c) */
struct JKRStep {
  double slope, step;
};
inline JKRStep jkr_newton(double y, double depth)
{
  const double y3 = y * y * y;
  const double slope = 4.0 * y3 - 2.0 / 3.0;
  return {slope, (y * (y3 - 2.0 / 3.0) - depth) / slope};
}
constexpr int JKR_STEPS = 4;              //!< of which the last ones are seldom needed
constexpr double JKR_FLAT = 0.05;         //!< a slope near the end of the branch or beyond it
constexpr double JKR_SETTLED = 1.0e-9;    //!< a step over y; what is left is quadratic in it

/*! The same by Newton's method from a guess near the answer, such as x of a step before; in closed form if that fails.
 *  \param guess  any value; its sign does not matter */
double jkr_contact_radius(double d, double guess);

/*! Force F/F_c = 4 (x^3 - x^(3/2)) on the branch at x = a/a0; negative pulls */
inline double jkr_force(double x)
{
  const double y3 = x * std::sqrt(x);
  return 4.0 * y3 * (y3 - 1.0);
}

}    // namespace Dust

#endif
