/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

// the loops over the lanes run in vectors: all that they call is inlined (cmake/Sources.cmake)
#include "hertz_contacts.h"

#include "mindlin.h"

#include <cmath>

using namespace Dust;

namespace {

constexpr int LANES = ContactBatch::BLOCK;

// a block of contacts from k on; those beyond the last one have the numbers of former ones
template <bool MOVE, bool SYNCHRONIZED, bool DAMPED>
DUST_IN_LANES void compute_block(HertzBatch &b, int first, double dt)
{
  MindlinBlock friction;
  friction.by_inverse = b.by_inverse;
  const double inside = b.inside(), flat = b.wall ? 1.0 : 0.0;    // numbers: a choice would be made lane by lane
  double overlap[LANES], normal[LANES];
  for (int l = 0, k = first; l < LANES; l++, k++) {
    const Vector velocity = b.velocity[k];
    const double radius_i = b.radius_i[k], radius_j = b.radius_j[k], radii = radius_i + radius_j;
    const double r = std::sqrt(b.rsq[k]);
    overlap[l] = radii - r;
    const Vector whole = (1.0 / r) * b.dx[k], n = SYNCHRONIZED ? half_step_normal(b, k) : whole;
    const double approach = dot(velocity, n);

    const double a = std::sqrt(overlap[l] * (radius_i * radius_j / radii + flat * radius_i));
    const double elastic = b.stiffness[k] * a * overlap[l];
    const double rate_if = b.damping[k] * std::sqrt(b.mass[k] * elastic / overlap[l]);
    const double rate = overlap[l] > 0.0 ? rate_if : 0.0;
    const double damper = -rate * approach;
    normal[l] = elastic + (damper < -elastic ? -elastic : damper);

    friction.n.set(l, n);
    friction.whole.set(l, whole);
    friction.slip.set(l, velocity - approach * n - cross(b.turning[k], n));
    friction.half[l] = b.half[k];
    friction.stiffness[l] = b.shear_stiffness[k] * a;
    friction.damping[l] = b.shear_damping[k] * rate;
    friction.limit[l] = std::fabs(normal[l]) * b.friction[k];
    friction.shear.set(l, b.shear[k]);
  }
  friction.compute<MOVE, SYNCHRONIZED, DAMPED>(dt);
  for (int l = 0, k = first; l < LANES; l++, k++) {
    const Vector n = friction.n[l], tangential = friction.force[l], torque = -1.0 * cross(n, tangential);
    b.shear.set(k, friction.shear[l]);
    b.force.set(k, normal[l] * n + tangential);
    b.torque_i.set(k, (b.radius_i[k] - inside * overlap[l]) * torque);
    b.torque_j.set(k, (b.radius_j[k] - inside * overlap[l]) * torque);
  }
}

template <bool MOVE, bool SYNCHRONIZED, bool DAMPED> DUST_IN_LANES void compute_all(HertzBatch &b, double dt)
{
  for (int k = 0; k < b.count; k += LANES) compute_block<MOVE, SYNCHRONIZED, DAMPED>(b, k, dt);
}

}    // namespace

DUST_LANES static void compute(HertzBatch &batch, double dt, bool move)
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

void Dust::compute_forces(HertzBatch &batch, double dt, bool move) { compute(batch, dt, move); }
