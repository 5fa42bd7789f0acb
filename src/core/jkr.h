/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_JKR_H
#define DUST_CORE_JKR_H

#include <cmath>

/* Constants of the adhesive contact of Johnson, Kendall and Roberts, Proc. R. Soc. Lond. A 324, 301 (1971), with
   gamma in the convention of Chokshi et al., Astrophys. J. 407, 806 (1993): work of adhesion w = 2 gamma. */

namespace Dust {

/*! Effective radius R_12 of two spheres */
inline double effective_radius(double r1, double r2)
{
  return r1 * r2 / (r1 + r2);
}

/*! Combined modulus E* of two materials with Young's moduli and Poisson's ratios */
inline double combined_modulus(double e1, double nu1, double e2, double nu2)
{
  return 1.0 / ((1.0 - nu1 * nu1) / e1 + (1.0 - nu2 * nu2) / e2);
}

/*! Pull-off force F_c = 3 pi gamma R_12 */
inline double pull_off_force(double gamma, double r12)
{
  constexpr double PI = 3.14159265358979323846;
  return 3.0 * PI * gamma * r12;
}

/*! Contact radius without load, a0 = (9 pi gamma R_12^2/E*)^(1/3) */
inline double equilibrium_contact_radius(double gamma, double r12, double modulus)
{
  constexpr double PI = 3.14159265358979323846;
  return std::cbrt(9.0 * PI * gamma * r12 * r12 / modulus);
}

}    // namespace Dust

#endif
