/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "jkr.h"

#include <algorithm>

/* ----------------------------------------------------------------------
   y = sqrt(x) solves y^4 - (2/3) y = D with D = d/(2 6^(1/3)). It is the larger root of y^2 - m y + s, where z = m^2
   solves z^3 + 4 D z = 4/9; Cardano's cube roots u, v of z = u + v have the product -4 D/3.
------------------------------------------------------------------------- */

double Dust::jkr_contact_radius(double d)
{
  const double D = std::max(d, -1.0) / (2.0 * Dust::ROOT_6);
  const double p = 4.0 / 3.0 * D;
  const double u = std::cbrt(2.0 / 9.0 + std::sqrt(std::max(0.0, 4.0 / 81.0 + p * p * p)));
  const double v = -p / u;
  // u + v, without cancellation where v < 0
  const double z = D > 0.0 ? 4.0 / 9.0 / (u * u + p + v * v) : u + v;
  const double m = std::sqrt(z);
  const double y = 0.5 * (m + std::sqrt(std::max(0.0, 4.0 / 3.0 / m - z)));
  // the slope vanishes at the end of the branch, where the root is good enough as it stands
  const double slope = 4.0 * y * y * y - 2.0 / 3.0;
  const double step = slope > 1.0e-4 ? (y * (y * y * y - 2.0 / 3.0) - D) / slope : 0.0;
  return (y - step) * (y - step);
}

/* ----------------------------------------------------------------------
   convex on the branch: a step from below lands above the root, from there on y falls towards it
------------------------------------------------------------------------- */

double Dust::jkr_contact_radius(double d, double guess)
{
  const double D = d / (2.0 * Dust::ROOT_6);
  double y = std::sqrt(std::fabs(guess));
  for (int k = 0; k < JKR_STEPS; k++) {
    const JKRStep newton = jkr_newton(y, D);
    if (!(newton.slope > JKR_FLAT)) break;
    y -= newton.step;
    if (std::fabs(newton.step) < JKR_SETTLED * y) return y * y;
  }
  return jkr_contact_radius(d);
}
