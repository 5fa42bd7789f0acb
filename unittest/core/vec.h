// Vectors of the references, whose formulas stand as on paper

#ifndef DUST_TEST_VEC_H
#define DUST_TEST_VEC_H

#include <cmath>

struct Vec {
  double x = 0.0, y = 0.0, z = 0.0;
};
inline Vec operator*(double s, const Vec &v) { return {s * v.x, s * v.y, s * v.z}; }
inline Vec operator+(const Vec &a, const Vec &b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(const Vec &a, const Vec &b) { return a + -1.0 * b; }
inline double dot(const Vec &a, const Vec &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(const Vec &a, const Vec &b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double size(const Vec &v) { return std::sqrt(dot(v, v)); }

#endif
