/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_MINDLIN_H
#define DUST_CORE_MINDLIN_H

#include "contact_batch.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace Dust {

/*! Friction of Mindlin and Coulomb of a block of contacts, in the operations of LAMMPS' `tangential mindlin` (Luding,
 *  Granular Matter 10, 235 (2008), Eq. 17 for the turning of the displacement). What none of them needs is left out. */
struct MindlinBlock {
  static constexpr int LANES = ContactBatch::BLOCK;

  Vectors<LANES> n, whole;    // normals of the velocities and of the whole step
  Vectors<LANES> slip;        // relative velocity of the surfaces
  double half[LANES];         // above 0 for contacts whose two normals differ
  double stiffness[LANES];    // of the displacement, force/length
  double damping[LANES];      // of the velocity, force time/length
  double limit[LANES];        // largest force
  Vectors<LANES> shear;       // tangential displacement, changed
  Vectors<LANES> force;       // returned
  bool by_inverse = false;    // LAMMPS 4Feb2025 multiplies by the inverse of a force where 4Jul2026 divides by it

  /*! \tparam MOVE         whether the displacement grows with the slip
   *  \tparam SYNCHRONIZED whether any half is above 0
   *  \tparam DAMPED       whether any damping is not 0 */
  template <bool MOVE, bool SYNCHRONIZED, bool DAMPED> DUST_IN_LANES void compute(double dt)
  {
    for (int l = 0; l < LANES; l++) damper.set(l, slip[l]);
    if (MOVE) {
      if (lean()) turn(shear, n);
      for (int l = 0; l < LANES; l++) shear.set(l, shear[l] + dt * slip[l]);
      if (SYNCHRONIZED && lean_at_last()) {
        turn(shear, whole);
        // times 0, only its signs count
        DAMPED ? turn(damper, whole) : flatten(damper, whole);
      }
    }
    if (push()) cut();
  }

 private:
  static constexpr double NEGLIGIBLE = 1.0e-10;

  Vectors<LANES> damper;               // velocity that is damped, then its force
  double turns[LANES], size[LANES];    // 1 for those that turn; force before it is cut

  // whether any displacement leans out of its plane
  DUST_IN_LANES bool lean()
  {
    std::int64_t any = 0;
    for (int l = 0; l < LANES; l++) {
      turns[l] = std::fabs(dot(shear[l], n[l])) * stiffness[l] > NEGLIGIBLE * limit[l] ? 1.0 : 0.0;
      any += turns[l] > 0.0;
    }
    return any != 0;
  }

  DUST_IN_LANES bool lean_at_last()
  {
    std::int64_t any = 0;
    for (int l = 0; l < LANES; l++) {
      const double least = half[l] > 0.0 ? NEGLIGIBLE * limit[l] : std::numeric_limits<double>::infinity();
      turns[l] = std::fabs(dot(shear[l], whole[l])) * stiffness[l] > least ? 1.0 : 0.0;
      any += turns[l] > 0.0;
    }
    return any != 0;
  }

  // into the plane with this normal, as long as before
  DUST_IN_LANES void turn(Vectors<LANES> &v, const Vectors<LANES> &normal) const
  {
    for (int l = 0; l < LANES; l++) {
      const Vector before = v[l], in_plane = before - dot(before, normal[l]) * normal[l];
      const double length = std::sqrt(dot(before, before)), left = std::sqrt(dot(in_plane, in_plane));
      const double longer = length / left;
      v.set(l, choose(turns[l] > 0.0, (left > 0.0 ? longer : 0.0) * in_plane, before));
    }
  }

  DUST_IN_LANES void flatten(Vectors<LANES> &v, const Vectors<LANES> &normal) const
  {
    for (int l = 0; l < LANES; l++) {
      const Vector before = v[l];
      v.set(l, choose(turns[l] > 0.0, before - dot(before, normal[l]) * normal[l], before));
    }
  }

  // whether any force is beyond its limit
  DUST_IN_LANES bool push()
  {
    std::int64_t any = 0;
    for (int l = 0; l < LANES; l++) {
      const Vector damped = -damping[l] * damper[l], pushes = -stiffness[l] * shear[l] + damped;
      damper.set(l, damped);
      force.set(l, pushes);
      size[l] = std::sqrt(dot(pushes, pushes));
      any += size[l] > limit[l];
    }
    return any != 0;
  }

  // what slides keeps the displacement that belongs to its force
  DUST_IN_LANES void cut()
  {
    for (int l = 0; l < LANES; l++) {
      const Vector before = shear[l], pushes = force[l];
      const bool slides = size[l] > limit[l], sheared = dot(before, before) != 0.0;
      const double by_force = limit[l] / size[l], times_inverse = limit[l] * (1.0 / size[l]);
      const Vector at_limit = only_if(sheared, (by_inverse ? times_inverse : by_force) * pushes);
      const Vector kept = choose(sheared, (-1.0 / stiffness[l]) * (at_limit - damper[l]), before);
      shear.set(l, choose(slides, kept, before));
      force.set(l, choose(slides, at_limit, pushes));
    }
  }
};

}    // namespace Dust

#endif
