/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_CONTACT_BATCH_H
#define DUST_CORE_CONTACT_BATCH_H

#include "geometry.h"
#include "lanes.h"

#include <cmath>

namespace Dust {

/*! Vectors of many contacts, component by component */
template <int N> struct Vectors {
  double x[N], y[N], z[N];
  void set(int k, const Vector &v) { x[k] = v.x, y[k] = v.y, z[k] = v.z; }
  Vector operator[](int k) const { return {x[k], y[k], z[k]}; }
};

inline Vector at(const double *v, int i = 0) { return {v[3 * i], v[3 * i + 1], v[3 * i + 2]}; }

inline void put(double *to, const Vector &v)
{
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

/*! Spheres, of which contacts tell the places: three coordinates each, one radius and mass */
struct Spheres {
  const double *x, *v, *omega, *radius, *mass;
};

/*! Two planes across an axis, of which a sphere meets the nearer one, and the velocity of both */
struct Planes {
  int axis;
  double low, high;    // coordinates
  Vector velocity;
  double distance(double x) const { return x - low < high - x ? x - low : -(high - x); }
};

/*! Contacts of two spheres that are computed together, out of place: what all laws need of them, and what they return.
 *  SI or any other consistent units; i and j are the spheres, the normal points from j to i. */
struct ContactBatch {
  static constexpr int COUNT = 64, BLOCK = 32;    // blocks of lanes that skip together what none of them needs
  // a line of the cache more: one contact's numbers would all fall into the same places of the cache
  static constexpr int SIZE = COUNT + 8;

  int count = 0;
  // of each contact, before it is met: its spheres, and where its tangential displacement is kept
  int i[SIZE], j[SIZE];
  double *kept_shear[SIZE];

  bool synchronized = false;    // some of the contacts have half > 0
  bool shear_damped = false;    // some have a shear_damping
  bool by_inverse = false;      // as MindlinBlock's
  bool wall = false;            // j are flat walls: radius_j is 0 and means none, and the force acts at radius_i

  /*! Of the overlap, by which the force acts inside of the radius */
  double inside() const { return wall ? 0.0 : 0.5; }

  // geometry and motion
  Vectors<SIZE> dx;    // x_i - x_j
  double rsq[SIZE];    // its square
  double radius_i[SIZE], radius_j[SIZE];
  Vectors<SIZE> velocity;    // v_i - v_j
  Vectors<SIZE> turning;     // R_i omega_i + R_j omega_j
  double mass[SIZE];         // effective
  double half[SIZE];         // half a time step where the normal is the half step's, else 0

  // coefficients of the laws
  double damping[SIZE];            // of the normal motion, in the units of the law
  double shear_stiffness[SIZE];    // Mindlin's, over the contact radius
  double shear_damping[SIZE];      // over that of the normal motion
  double friction[SIZE];

  Vectors<SIZE> shear;    // tangential displacement of the last step, changed

  // of i; the force on j is the opposite one
  Vectors<SIZE> force, torque_i, torque_j;

  /*! How the spheres of all contacts meet, and their displacements of the last step */
  void meet(const Spheres &);
  /*! The same with walls */
  void meet(const Spheres &, const Planes &);
  /*! Keeps the new ones */
  void keep() const
  {
    for (int k = 0; k < count; k++) put(kept_shear[k], shear[k]);
  }
};

/*! Normal in the middle of the step, or at its end where half is 0 */
DUST_IN_LANES Vector half_step_normal(const ContactBatch &b, int k)
{
  const Vector middle = b.dx[k] - b.half[k] * b.velocity[k];
  return (1.0 / std::sqrt(dot(middle, middle))) * middle;
}

DUST_IN_LANES Vector choose(bool first, const Vector &a, const Vector &b)
{
  return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}

DUST_IN_LANES Vector only_if(bool there, const Vector &a)
{
  return {there ? a.x : 0.0, there ? a.y : 0.0, there ? a.z : 0.0};
}

}    // namespace Dust

#endif
