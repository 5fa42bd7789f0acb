/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "quaternion.h"

#include "geometry.h"

#include <cmath>

using namespace Dust;

Quaternion Quaternion::operator*(const Quaternion &first) const
{
  const double *p = q, *r = first.q;
  return {{p[0] * r[0] - p[1] * r[1] - p[2] * r[2] - p[3] * r[3], p[0] * r[1] + p[1] * r[0] + p[2] * r[3] - p[3] * r[2],
           p[0] * r[2] - p[1] * r[3] + p[2] * r[0] + p[3] * r[1],
           p[0] * r[3] + p[1] * r[2] - p[2] * r[1] + p[3] * r[0]}};
}

/* ---------------------------------------------------------------------- */

void Quaternion::large_angle(double a2, double &c, double &s)
{
  const double a = std::sqrt(a2);
  c = std::cos(a);
  s = std::sin(a) / a;
}

/* ---------------------------------------------------------------------- */

namespace {

// the next of a series of numbers that look random (Steele, Lea & Flood, OOPSLA 2014: SplitMix64)
uint64_t mix(uint64_t z)
{
  z += 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

}    // namespace

Quaternion Dust::random_orientation(uint64_t seed, uint64_t number)
{
  uint64_t state = mix(mix(seed) ^ number);
  double u[3];    // in [0, 1)
  for (double &x : u) {
    state = mix(state);
    x = double(state >> 11) * 0x1p-53;
  }
  const double a = std::sqrt(1.0 - u[0]), b = std::sqrt(u[0]);
  return {{a * std::sin(2.0 * PI * u[1]), a * std::cos(2.0 * PI * u[1]), b * std::sin(2.0 * PI * u[2]),
           b * std::cos(2.0 * PI * u[2])}};
}
