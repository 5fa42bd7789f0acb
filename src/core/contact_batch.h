/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_CONTACT_BATCH_H
#define DUST_CORE_CONTACT_BATCH_H

#include "geometry.h"

#include <cmath>
#include <limits>

/*! Compiled for wide vector registers too, of which the machine's widest are taken at run time. All give the same bits:
 *  each lane does what one contact alone would do, and nothing is contracted (-ffp-contract=off). */
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(DUST_ONE_TARGET)
#define DUST_LANES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define DUST_LANES
#endif
/*! A part of such a function: compiled with it, for the same registers */
#define DUST_IN_LANES inline __attribute__((always_inline))

namespace Dust {

/*! Vectors of many contacts, component by component */
template <int N> struct Vectors {
  double x[N], y[N], z[N];
  void set(int k, const Vector &v) { x[k] = v.x, y[k] = v.y, z[k] = v.z; }
  Vector operator[](int k) const { return {x[k], y[k], z[k]}; }
};

/*! Contacts of two spheres that are computed together, out of place: what all laws need of them, and what they return.
 *  SI or any other consistent units; i and j are the spheres, the normal points from j to i. */
struct ContactBatch {
  static constexpr int COUNT = 128;
  // a line of the cache more: one contact's numbers would all fall into the same two places of the cache
  static constexpr int SIZE = COUNT + 8;

  int count = 0;
  bool synchronized = false;    // some of the contacts have half > 0
  bool shear_damped = false;    // some have a shear_damping

  // geometry and motion
  Vectors<SIZE> dx;                      // x_i - x_j
  double rsq[SIZE];                      // its square
  double radius_i[SIZE], radius_j[SIZE];
  Vectors<SIZE> velocity;                // v_i - v_j
  Vectors<SIZE> turning;                 // R_i omega_i + R_j omega_j
  double mass[SIZE];                     // effective
  double half[SIZE];                     // half a time step where the normal is the half step's, else 0

  // coefficients of the laws
  double damping[SIZE];                  // of the normal motion, in the units of the law
  double shear_stiffness[SIZE];          // Mindlin's, over the contact radius
  double shear_damping[SIZE];            // over that of the normal motion
  double friction[SIZE];

  Vectors<SIZE> shear;                   // tangential displacement of the last step, changed

  // of i; the force on j is the opposite one
  Vectors<SIZE> force, torque_i, torque_j;

  void clear()
  {
    count = 0;
    synchronized = shear_damped = false;
  }
};

/*! What the tangential law returns of one contact */
struct Shear {
  Vector displacement, force;
};

/*! Normal in the middle of the step, or at its end where half is 0 */
DUST_IN_LANES Vector half_step_normal(const ContactBatch &b, int k)
{
  const Vector middle = b.dx[k] - b.half[k] * b.velocity[k];
  return (1.0 / std::sqrt(dot(middle, middle))) * middle;
}

/*! v in the plane with the normal n, as long as before */
DUST_IN_LANES Vector turned_into_plane(const Vector &v, const Vector &n)
{
  const double length = std::sqrt(dot(v, v));
  const Vector in_plane = v - dot(v, n) * n;
  const double left = std::sqrt(dot(in_plane, in_plane));
  return (left > 0.0 ? length / left : 0.0) * in_plane;
}

DUST_IN_LANES Vector choose(bool first, const Vector &a, const Vector &b)
{
  return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}

DUST_IN_LANES Vector only_if(bool there, const Vector &a)
{
  return {there ? a.x : 0.0, there ? a.y : 0.0, there ? a.z : 0.0};
}

/*! Friction of Mindlin and Coulomb, in the operations of LAMMPS' `tangential mindlin` (Luding, Granular Matter 10, 235
 *  (2008), Eq. 17 for the turning of the displacement).
 *
 * \param shear         tangential displacement of the last step
 * \param n             normal of the velocities
 * \param whole         that of the whole step, if the contact is synchronized
 * \param slip          relative velocity of the surfaces
 * \param stiffness     of the displacement, force/length
 * \param damping       of the velocity, force time/length
 * \param limit         largest force
 * \tparam MOVE         whether the displacement grows with the slip
 * \tparam SYNCHRONIZED whether any contact is
 * \tparam DAMPED       whether any damping is not 0 */
template <bool MOVE, bool SYNCHRONIZED, bool DAMPED>
DUST_IN_LANES Shear mindlin(Vector shear, const Vector &n, const Vector &whole, bool synchronized, const Vector &slip,
                            double dt, double stiffness, double damping, double limit)
{
  constexpr double NEGLIGIBLE = 1.0e-10;
  bool turns = false;
  if (MOVE) {
    const bool first = std::fabs(dot(shear, n)) * stiffness > NEGLIGIBLE * limit;
    shear = choose(first, turned_into_plane(shear, n), shear);
    shear = shear + dt * slip;
    if (SYNCHRONIZED) {
      // no && here, which would be a branch
      const double least = synchronized ? NEGLIGIBLE * limit : std::numeric_limits<double>::infinity();
      turns = std::fabs(dot(shear, whole)) * stiffness > least;
      shear = choose(turns, turned_into_plane(shear, whole), shear);
    }
  }
  Vector damped = slip;
  // times 0, only its signs count
  if (SYNCHRONIZED && MOVE)
    damped = choose(turns, DAMPED ? turned_into_plane(slip, whole) : slip - dot(slip, whole) * whole, slip);
  const Vector damper = -damping * damped;
  const Vector force = -stiffness * shear + damper;

  const double size = std::sqrt(dot(force, force));
  const bool slides = size > limit, sheared = dot(shear, shear) != 0.0;
  const Vector cut = only_if(sheared, (limit / size) * force);
  return {choose(slides && sheared, (-1.0 / stiffness) * (cut - damper), shear), choose(slides, cut, force)};
}

}    // namespace Dust

#endif
