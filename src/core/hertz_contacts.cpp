/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

// the loop over the contacts runs in vectors: all that it calls is inlined (cmake/Sources.cmake)
#include "hertz_contacts.h"

#include <algorithm>
#include <cmath>

using namespace Dust;

namespace {

// the law's own numbers, in the order of LAMMPS' operations
template <bool MOVE, bool SYNCHRONIZED, bool DAMPED> DUST_IN_LANES void compute_all(HertzBatch &b, double dt)
{
  for (int k = 0; k < b.count; k++) {
    const Vector velocity = b.velocity[k];
    const double radius_i = b.radius_i[k], radius_j = b.radius_j[k], radii = radius_i + radius_j;
    const double r = std::sqrt(b.rsq[k]);
    const double overlap = radii - r;
    const Vector whole = (1.0 / r) * b.dx[k];
    const Vector n = SYNCHRONIZED ? half_step_normal(b, k) : whole;
    const double approach = dot(velocity, n);
    const Vector slip = velocity - approach * n - cross(b.turning[k], n);

    const double a = std::sqrt(overlap * (radius_i * radius_j / radii));
    const double elastic = b.stiffness[k] * a * overlap;
    const double rate_if = b.damping[k] * std::sqrt(b.mass[k] * elastic / overlap);
    const double rate = overlap > 0.0 ? rate_if : 0.0;
    const double damper = -rate * approach;
    const double normal = elastic + (damper < -elastic ? -elastic : damper);

    const Shear shear = mindlin<MOVE, SYNCHRONIZED, DAMPED>(b.shear[k], n, whole, SYNCHRONIZED && b.half[k] > 0.0, slip, dt,
                                                    b.shear_stiffness[k] * a, b.shear_damping[k] * rate,
                                                    std::fabs(normal) * b.friction[k]);
    b.shear.set(k, shear.displacement);
    b.force.set(k, normal * n + shear.force);
    const Vector torque = -1.0 * cross(n, shear.force);
    b.torque_i.set(k, (radius_i - 0.5 * overlap) * torque);
    b.torque_j.set(k, (radius_j - 0.5 * overlap) * torque);
  }
}

}    // namespace

DUST_LANES void Dust::compute_forces(HertzBatch &batch, double dt, bool move)
{
  if (!move)
    compute_all<false, true, true>(batch, dt);
  else if (!batch.synchronized)
    compute_all<true, false, false>(batch, dt);
  else if (!batch.shear_damped)
    compute_all<true, true, false>(batch, dt);
  else
    compute_all<true, true, true>(batch, dt);
}
