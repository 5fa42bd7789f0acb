/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

// the loops over the contacts run in vectors: all that they call is inlined (cmake/Sources.cmake)
#include "grain_contacts.h"

#include "hamaker.h"
#include "jkr.h"
#include "mindlin.h"
#include "overlap_rate.h"
#include "rolling.h"

#include <cmath>
#include <cstdint>
#include <limits>

using namespace Dust;

namespace {

constexpr int LANES = ContactBatch::BLOCK;
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
DUST_IN_LANES double overlap_rate(GrainBatch &b, int k, double closing, double dt, double decay, double sign)
{
  OverlapRate now = {sign * b.overlap[k], sign * b.coasting[k], sign * b.rate[k]};
  const double overlap = b.now[k];
  const bool fresh = b.neck[k] == 0.0, neck = b.radius[k] > 0.0;
  if (!MOVE) return fresh ? -closing : now.rate;
  const double mean_then = (overlap - now.overlap) / dt;
  const double mean = fresh ? -closing : mean_then, others = fresh ? 0.0 : mean_then - now.coasting;
  now.step_on(overlap, mean, others, decay * dt);
  b.overlap[k] = neck ? sign * now.overlap : 0.0;
  b.coasting[k] = neck ? sign * now.coasting : 0.0;
  b.rate[k] = neck ? sign * now.rate : 0.0;
  return now.rate;
}

// which way contacts point, how their surfaces move, and the normal force; nothing is remembered of before the neck
template <bool MOVE, bool SYNCHRONIZED>
DUST_IN_LANES void push_apart(GrainBatch &b, int first, double dt, MindlinBlock &friction, double *normal)
{
  for (int l = 0, k = first; l < LANES; l++, k++) {
    const Vector velocity = b.velocity[k], whole = (1.0 / b.distance[k]) * b.dx[k], sheared = b.shear[k];
    const Vector n = SYNCHRONIZED ? half_step_normal(b, k) : whole;
    const double closing = dot(velocity, n);
    const double before = b.neck[k], x = b.radius[k], a = x * b.equilibrium_radius[k], eta = b.damping[k];
    const bool neck = x > 0.0;
    const double rate =
        overlap_rate<MOVE>(b, k, closing, dt, eta * x * b.equilibrium_radius[k], std::copysign(1.0, before));

    const double held = b.pull_off_force[k] * jkr_force(x), attraction = b.attraction[k];
    const double elastic = neck ? held : attraction, damping = eta * b.mass[k] * a;
    normal[l] = elastic + -damping * (neck ? -rate : closing);
    const double limit = std::fabs(elastic + 2.0 * b.pull_off_force[k]) * b.friction[k];

    friction.n.set(l, n);
    friction.whole.set(l, whole);
    friction.slip.set(l, velocity - closing * n - cross(b.turning[k], n));
    friction.half[l] = b.half[k];
    friction.stiffness[l] = b.shear_stiffness[k] * a;
    friction.damping[l] = b.shear_damping[k] * damping;
    friction.limit[l] = neck ? limit : 0.0;
    friction.shear.set(l, only_if(MOVE ? neck & (before != 0.0) : true, sheared));
  }
}

// resistance to rolling, and all torques; friction and rolling at their limits are told
template <bool MOVE>
DUST_IN_LANES void turn(GrainBatch &b, int first, double dt, const MindlinBlock &friction, const double *normal)
{
  const double inside = b.inside();
  for (int l = 0, k = first; l < LANES; l++, k++) {
    const Vector n = friction.n[l], tangential = friction.force[l], rolled = b.rolling[k];
    const double before = b.neck[k], x = b.radius[k], R = b.effective_radius[k], sign = std::copysign(1.0, before);
    const bool neck = x > 0.0, had = before != 0.0;
    Vector xi = sign * only_if(MOVE ? neck & had : true, rolled);
    double events = 0.0;
    if (MOVE) {
      const Rolling moved = roll_on(xi, friction.whole[l], R * cross(b.spin[k], n), dt, R * b.theta_crit[k]);
      xi = moved.displacement;
      b.rolling.set(k, only_if(neck, sign * xi));
      b.neck[k] = std::copysign(x, before);
      const double limit = friction.limit[l], square = (1.0 - 1.0e-12) * limit * limit;
      const double least = limit > 0.0 ? square : std::numeric_limits<double>::infinity();
      const double slides = dot(tangential, tangential) > least ? double(GrainBatch::SLIDE) : 0.0;
      const double rolls = moved.gave_way ? double(GrainBatch::ROLL) : 0.0, both = slides + rolls;
      events = (neck ? both : 0.0) + (neck != had ? double(GrainBatch::NECK) : 0.0);
    }
    b.events[k] = events;

    const double a0 = b.equilibrium_radius[k], overlap = b.now[k];
    const double stiffness = rolling_stiffness(b.pull_off_force[k], x * a0 / a0) / R;
    const Vector roll = R * cross(n, only_if(neck, -stiffness * xi)), torque = -1.0 * cross(n, tangential);
    b.shear.set(k, friction.shear[l]);
    b.force.set(k, normal[l] * n + tangential);
    b.torque_i.set(k, (b.radius_i[k] - inside * overlap) * torque + roll);
    b.torque_j.set(k, (b.radius_j[k] - inside * overlap) * torque - roll);
  }
}

template <bool MOVE, bool SYNCHRONIZED, bool DAMPED> DUST_IN_LANES void compute_all(GrainBatch &b, double dt)
{
  MindlinBlock friction;
  friction.by_inverse = b.by_inverse;
  double normal[LANES];
  for (int k = 0; k < b.count; k += LANES) {
    push_apart<MOVE, SYNCHRONIZED>(b, k, dt, friction, normal);
    friction.compute<MOVE, SYNCHRONIZED, DAMPED>(dt);
    turn<MOVE>(b, k, dt, friction, normal);
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

void GrainBatch::meet(const Spheres &spheres)
{
  ContactBatch::meet(spheres);
  const double *__restrict omega = spheres.omega;
  GrainBatch &__restrict b = *this;
  for (int k = 0, n = count; k < n; k++) b.spin.set(k, at(omega, b.i[k]) - at(omega, b.j[k]));
  recall();
}

void GrainBatch::meet(const Spheres &spheres, const Planes &planes)
{
  ContactBatch::meet(spheres, planes);
  for (int k = 0; k < count; k++) spin.set(k, at(spheres.omega, i[k]));
  recall();
}

void GrainBatch::recall()
{
  GrainBatch &__restrict b = *this;
  for (int k = 0, n = count; k < n; k++) {
    const double *from = b.kept[k];
    b.neck[k] = from[0];
    b.rolling.set(k, at(from + 1));
    b.overlap[k] = from[4];
    b.coasting[k] = from[5];
    b.rate[k] = from[6];
  }
}

void GrainBatch::keep() const
{
  ContactBatch::keep();
  for (int k = 0; k < count; k++) {
    double *to = kept[k];
    to[0] = neck[k];
    put(to + 1, rolling[k]);
    to[4] = overlap[k];
    to[5] = coasting[k];
    to[6] = rate[k];
  }
}

void Dust::compute_forces(GrainBatch &batch, double dt, bool move)
{
  find(batch);
  find_the_rest(batch);
  compute(batch, dt, move);
}
