/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

// the loops over the contacts run in vectors: all that they call is inlined (cmake/Sources.cmake)
#include "grain_contacts.h"

#include "hamaker.h"
#include "jkr.h"
#include "overlap_rate.h"
#include "rolling.h"

#include <cmath>
#include <cstdint>
#include <limits>

using namespace Dust;

namespace {

constexpr double UNKNOWN = -1.0;    // a/a0 that Newton's method has not found

/* ----------------------------------------------------------------------
   A step of Newton's method, as jkr_contact_radius() makes it contact by contact: all lanes go on, and keep their first
   answer. Returns whether there is none yet.
------------------------------------------------------------------------- */

DUST_IN_LANES bool step_to_radius(GrainBatch &b, int k, double y, double depth, double x)
{
  const JKRStep newton = jkr_newton(y, depth);
  // beyond the end of the branch y is nothing any more
  y = newton.slope > JKR_FLAT ? y - newton.step : std::numeric_limits<double>::quiet_NaN();
  const double found = std::fabs(newton.step) < JKR_SETTLED * y ? y * y : UNKNOWN;
  x = x < 0.0 ? found : x;
  b.root[k] = y;
  b.radius[k] = x;
  return x < 0.0;
}

// a neck holds until the end of the branch, one forms at contact
DUST_IN_LANES bool find_necks(GrainBatch &b)
{
  std::int64_t open = 0;
  for (int k = 0; k < b.count; k++) {
    const double r = std::sqrt(b.rsq[k]), overlap = b.radius_i[k] + b.radius_j[k] - r;
    const double before = b.neck[k], gap = b.breaking_gap[k], depth = overlap / gap / (2.0 * ROOT_6);
    const double stretched = before != 0.0 ? UNKNOWN : 0.0;
    const double apart = overlap > -gap ? stretched : 0.0;
    b.distance[k] = r;
    b.now[k] = overlap;
    b.depth[k] = depth;
    open += step_to_radius(b, k, std::sqrt(std::fabs(before)), depth, overlap >= 0.0 ? UNKNOWN : apart);
  }
  return open;
}

DUST_IN_LANES bool find_radii(GrainBatch &b)
{
  std::int64_t open = 0;
  for (int k = 0; k < b.count; k++) open += step_to_radius(b, k, b.root[k], b.depth[k], b.radius[k]);
  return open;
}

// what few contacts need: the closed form, the force without a neck
void find_the_rest(GrainBatch &b)
{
  for (int k = 0; k < b.count; k++) {
    b.attraction[k] = 0.0;
    if (b.radius[k] < 0.0)
      b.radius[k] = jkr_contact_radius(b.now[k] / b.breaking_gap[k]);
    else if (b.radius[k] == 0.0 && b.now[k] > -b.range[k])
      b.attraction[k] = -hamaker_force(b.hamaker[k], b.z0[k], b.effective_radius[k], -b.now[k]);
  }
}

/* ----------------------------------------------------------------------
   moves the rate of the overlap on; returns it. What a contact keeps has the sign of its neck.
------------------------------------------------------------------------- */

template <bool MOVE>
DUST_IN_LANES double overlap_rate(GrainBatch &b, int k, double overlap, double approach, double dt, double decay,
                                  double sign, bool neck, bool fresh)
{
  OverlapRate now = {sign * b.overlap[k], sign * b.coasting[k], sign * b.rate[k]};
  if (!MOVE) return fresh ? -approach : now.rate;
  const double mean_then = (overlap - now.overlap) / dt;
  const double mean = fresh ? -approach : mean_then, others = fresh ? 0.0 : mean_then - now.coasting;
  now.step_on(overlap, mean, others, decay * dt);
  b.overlap[k] = neck ? sign * now.overlap : 0.0;
  b.coasting[k] = neck ? sign * now.coasting : 0.0;
  b.rate[k] = neck ? sign * now.rate : 0.0;
  return now.rate;
}

template <bool MOVE, bool SYNCHRONIZED, bool DAMPED> DUST_IN_LANES void compute_all(GrainBatch &b, double dt)
{
  for (int k = 0; k < b.count; k++) {
    const double R = b.effective_radius[k], overlap = b.now[k];
    const double a0 = b.equilibrium_radius[k], Fc = b.pull_off_force[k], eta = b.damping[k], friction = b.friction[k];
    const Vector velocity = b.velocity[k], whole = (1.0 / b.distance[k]) * b.dx[k];
    const Vector n = SYNCHRONIZED ? half_step_normal(b, k) : whole;
    const double closing = dot(velocity, n);
    const Vector slip = velocity - closing * n - cross(b.turning[k], n);

    const double before = b.neck[k], x = b.radius[k], a = x * a0;
    const bool neck = x > 0.0, fresh = before == 0.0;
    const double sign = std::copysign(1.0, before);
    const double parting = overlap_rate<MOVE>(b, k, overlap, closing, dt, eta * x * a0, sign, neck, fresh);
    const double approach = neck ? -parting : closing;

    const double held = Fc * jkr_force(x);
    const double attraction = b.attraction[k];
    const double elastic = neck ? held : attraction;
    const double damping = eta * b.mass[k] * a;
    const double normal = elastic + -damping * approach;
    const double limit = neck ? std::fabs(elastic + 2.0 * Fc) * friction : 0.0;

    // nothing is remembered of before the neck
    const bool keeps = MOVE ? neck & !fresh : true;
    const Vector sheared = b.shear[k], rolled = b.rolling[k];
    const Shear shear = mindlin<MOVE, SYNCHRONIZED, DAMPED>(
        only_if(keeps, sheared), n, whole, SYNCHRONIZED ? b.half[k] > 0.0 : false, slip, dt,
        b.shear_stiffness[k] * a, b.shear_damping[k] * damping, limit);
    b.shear.set(k, shear.displacement);
    const Vector force = normal * n + shear.force;
    b.force.set(k, force);

    Vector xi = sign * only_if(keeps, rolled);
    double events = 0.0;
    if (MOVE) {
      const Rolling moved = roll_on(xi, whole, R * cross(b.spin[k], n), dt, R * b.theta_crit[k]);
      xi = moved.displacement;
      b.rolling.set(k, only_if(neck, sign * xi));
      b.neck[k] = std::copysign(x, before);
      // friction at its limit, as dominik/tielens sees it: no limit, no sliding
      const double least = limit > 0.0 ? (1.0 - 1.0e-12) * limit * limit : std::numeric_limits<double>::infinity();
      const double slides = dot(shear.force, shear.force) > least ? double(GrainBatch::SLIDE) : 0.0;
      const double rolls = moved.gave_way ? double(GrainBatch::ROLL) : 0.0;
      const double forms = neck ? 1.0 : 0.0, had = fresh ? 0.0 : 1.0;
      events = (neck ? slides + rolls : 0.0) + (forms != had ? double(GrainBatch::NECK) : 0.0);
    }
    b.events[k] = events;

    const double stiffness = rolling_stiffness(Fc, a / a0) / R;
    const Vector roll = R * cross(n, only_if(neck, -stiffness * xi));
    const Vector torque = -1.0 * cross(n, shear.force);
    b.torque_i.set(k, (b.radius_i[k] - 0.5 * overlap) * torque + roll);
    b.torque_j.set(k, (b.radius_j[k] - 0.5 * overlap) * torque - roll);
  }
}

}    // namespace

DUST_LANES static void find(GrainBatch &batch)
{
  bool open = find_necks(batch);
  for (int n = 1; n < JKR_STEPS && open; n++) open = find_radii(batch);
}

DUST_LANES static void compute(GrainBatch &batch, double dt, bool move)
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

void Dust::compute_forces(GrainBatch &batch, double dt, bool move)
{
  find(batch);
  find_the_rest(batch);
  compute(batch, dt, move);
}
