/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_GEOMETRY_H
#define DUST_CORE_GEOMETRY_H

#include "lanes.h"

namespace Dust {

constexpr double PI = 3.14159265358979323846;

/*! Scalar and vector product of two vectors of three */
inline double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline void cross(const double *a, const double *b, double *c)
{
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

/*! A vector of three that a compiler takes apart: for loops over many of a kind, which then run in vector lanes */
struct Vector {
  double x, y, z;
};
DUST_IN_LANES Vector operator+(const Vector &a, const Vector &b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
DUST_IN_LANES Vector operator-(const Vector &a, const Vector &b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
DUST_IN_LANES Vector operator*(double c, const Vector &a) { return {c * a.x, c * a.y, c * a.z}; }
DUST_IN_LANES double dot(const Vector &a, const Vector &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
DUST_IN_LANES Vector cross(const Vector &a, const Vector &b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}    // namespace Dust

#endif
