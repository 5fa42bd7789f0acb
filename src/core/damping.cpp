/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "damping.h"

#include "geometry.h"

#include <cmath>

namespace {

// x such that decay(x) = target, for a decay that grows with x between lo and hi
template <typename Decay> double invert(Decay decay, double target, double lo, double hi)
{
  while (true) {
    const double x = 0.5 * (lo + hi);
    if (x == lo || x == hi) return x;    // no double left between them
    (decay(x) < target ? lo : hi) = x;
  }
}

}    // namespace

double Dust::damping_ratio(double e)
{
  const double target = -std::log(e);
  if (target < 2.0)
    return std::sin(invert([](double t) { return std::tan(t) * (Dust::PI - 2.0 * t); }, target, 0.0, 0.5 * Dust::PI));
  if (target == 2.0) return 1.0;
  return std::cosh(invert([](double h) { return 2.0 * h / std::tanh(h); }, target, 0.0, target));
}

double Dust::hertz_damping(double e) { return std::sqrt(5.0) * damping_ratio(e); }

double Dust::hooke_damping(double e) { return 2.0 * damping_ratio(e); }
