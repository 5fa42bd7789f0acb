/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_VECTOR_H
#define DUST_CORE_VECTOR_H

namespace Dust {

/*! A vector by value, for loops over many grains that the compiler is to turn into vector instructions */
struct Vector {
  double x, y, z;
};

__attribute__((always_inline)) inline Vector operator+(const Vector &a, const Vector &b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
__attribute__((always_inline)) inline Vector operator-(const Vector &a, const Vector &b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
__attribute__((always_inline)) inline Vector operator*(double c, const Vector &a) { return {c * a.x, c * a.y, c * a.z}; }
__attribute__((always_inline)) inline double dot(const Vector &a, const Vector &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
__attribute__((always_inline)) inline Vector cross(const Vector &a, const Vector &b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}    // namespace Dust

#endif
