/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

// compiled with square roots that set no errno (cmake/Sources.cmake): the loop over the lanes runs in vectors only then
#include "surface_motion.h"

#include "geometry.h"

#include <algorithm>
#include <cmath>

using namespace Dust;

namespace {

// of the carrier: its acceleration, its spin at the start and how much that changes
struct CarrierStep {
  double dt, inv_dt;
  Vector a, omega, change;
};

// one grain: its time step and half of it, which are 0 if it has left, as `here` is; then as in SurfaceMotion
struct Lane {
  double h, half, here, holds;
  double friction, hold, inv_hold, stiffness;
  double shell, inv_shell, radius, inv_radius;
};

// its unknowns, named as in surface_motion.h
struct State {
  Vector n, v, p, psi;
};

// half of dn and dpsi, and all vectors into the tangential plane there
inline void to_middle(State &s, const Lane &g, const CarrierStep &step, double rolling2)
{
  const double over = g.half * g.inv_shell, roll = g.half * g.inv_radius;
  Vector n = s.n + over * s.v + g.half * cross(step.omega, s.n);
  n = (1.5 - 0.5 * dot(n, n)) * n;    // times 1/|n|, nearly 1
  const Vector psi = s.psi + roll * s.p;
  s.n = n;
  s.v = s.v - dot(s.v, n) * n;
  s.p = s.p - dot(s.p, n) * n;
  s.psi = psi - dot(psi, n) * n;
  const double psi2 = dot(s.psi, s.psi);
  s.psi = (psi2 > rolling2 ? std::sqrt(rolling2 / psi2) : 1.0) * s.psi;    // the pivot gives way
}

// the friction that ends the slip: u + dt (t + 7/2 f + 5/2 s psi) - R_p change of omega x n = 0; or its limit
inline Vector friction_on(const State &s, const Lane &g, const CarrierStep &step, const Vector &turned, const Vector &t,
                          double stiffness, double gn)
{
  const double limit = g.friction * std::fabs(2.0 * g.hold - gn), surface = g.shell - g.radius;
  const Vector f = -2.0 / 7.0 * (step.inv_dt * (s.v - s.p - surface * turned) + t + 2.5 * stiffness * s.psi);
  const double f2 = dot(f, f);
  return (f2 > limit * limit ? limit / std::sqrt(f2) : 1.0) * f;
}

// the forces in the middle, all of dv and dp, and the other half of dn and dpsi; 0 if it leaves, with the velocity it
// has in the middle
inline double to_end(State &s, const Lane &g, const CarrierStep &step)
{
  // what the carrier's turning brings: omega x n before and after, and with it w
  const Vector n = s.n, before = g.here * cross(step.omega, n), after = before + g.here * cross(step.change, n);
  const Vector w = s.v + g.shell * before;
  const double on = dot(step.omega + 0.5 * step.change, n), an = dot(step.a, n);
  const Vector t = an * n - step.a - on * cross(n, w);
  const double gn = dot(w, w) * g.inv_shell - an;    // F_n/m, but for the kick below
  const double stiffness = g.stiffness * (1.0 + std::sqrt(std::max(0.0, 1.0 - gn * g.inv_hold)));
  const Vector f = friction_on(s, g, step, after - before, t, stiffness, gn);

  const Vector middle = w + g.half * (t + f);
  const double lift = dot(middle, middle) * g.inv_shell - an, stays = lift > g.hold ? g.holds * g.here : g.here;
  const double rest = stays * 0.5 * step.dt;
  s.v = middle + rest * (t + f) - (stays * g.shell) * after;
  s.p = s.p + (g.radius * before - 2.5 * g.h * (f + stiffness * s.psi) - (stays * g.radius) * after);
  s.n = n + (rest * g.inv_shell) * s.v + rest * after;
  s.psi = s.psi + (rest * g.inv_radius) * s.p;
  return stays;
}

}    // namespace

SurfaceMotion::SurfaceMotion(double mu_f, double theta_crit, bool _holds) :
    friction(mu_f), rolling2(theta_crit * theta_crit), holds(_holds)
{
  clear();
}

/* ----------------------------------------------------------------------
   lanes without a grain hold one that nothing moves, away from where a division fails
------------------------------------------------------------------------- */

void SurfaceMotion::clear()
{
  count = 0;
  for (double &x : omega) x = 0.0;
  for (int i = 0; i < LANES; i++) {
    here[i] = 0.0;
    hold[i] = inv_hold[i] = stiffness[i] = shell[i] = inv_shell[i] = radius[i] = inv_radius[i] = 1.0;
    for (int d = 0; d < 3; d++) {
      n[d][i] = d == 2;
      v[d][i] = p[d][i] = psi[d][i] = 0.0;
    }
  }
}

/* ---------------------------------------------------------------------- */

void SurfaceMotion::add(const double *direction, double hold_of, double grain_radius, double carrier_radius,
                        const double *spin)
{
  const int i = count++;
  here[i] = 1.0;
  hold[i] = hold_of;
  inv_hold[i] = 1.0 / hold_of;
  shell[i] = carrier_radius + grain_radius;
  inv_shell[i] = 1.0 / shell[i];
  radius[i] = grain_radius;
  inv_radius[i] = 1.0 / grain_radius;
  stiffness[i] = 2.0 * hold_of * carrier_radius * inv_shell[i];
  for (int d = 0; d < 3; d++) {
    n[d][i] = direction[d];
    omega[d] = spin[d];
  }
}

/* ---------------------------------------------------------------------- */

// the loop over the grains runs in vectors: all that it calls is inlined
void SurfaceMotion::advance(const double *a, const double *spin, double dt)
{
  const Vector o = {omega[0], omega[1], omega[2]};
  const CarrierStep step = {dt, 1.0 / dt, {a[0], a[1], a[2]}, o, Vector{spin[0], spin[1], spin[2]} - o};
  for (int i = 0; i < LANES; i++) {
    const Lane grain = {dt * here[i], 0.5 * (dt * here[i]), here[i],  holds,        friction,  hold[i],
                        inv_hold[i],  stiffness[i],         shell[i], inv_shell[i], radius[i], inv_radius[i]};
    State state = {{n[0][i], n[1][i], n[2][i]},
                   {v[0][i], v[1][i], v[2][i]},
                   {p[0][i], p[1][i], p[2][i]},
                   {psi[0][i], psi[1][i], psi[2][i]}};
    to_middle(state, grain, step, rolling2);
    here[i] = to_end(state, grain, step);
    n[0][i] = state.n.x, n[1][i] = state.n.y, n[2][i] = state.n.z;
    v[0][i] = state.v.x, v[1][i] = state.v.y, v[2][i] = state.v.z;
    p[0][i] = state.p.x, p[1][i] = state.p.y, p[2][i] = state.p.z;
    psi[0][i] = state.psi.x, psi[1][i] = state.psi.y, psi[2][i] = state.psi.z;
  }
  for (int d = 0; d < 3; d++) omega[d] = spin[d];
}

/* ---------------------------------------------------------------------- */

void SurfaceMotion::let_go(int grain)
{
  double w[3], rolling_w[3];
  for (int d = 0; d < 3; d++) {
    w[d] = velocity(grain, d);
    rolling_w[d] = rolling_velocity(grain, d);
  }
  here[grain] = 0.0;
  for (int d = 0; d < 3; d++) {
    v[d][grain] = w[d];
    p[d][grain] = rolling_w[d];
  }
}

/* ---------------------------------------------------------------------- */

void SurfaceMotion::release()
{
  constexpr double NONE[3] = {0.0, 0.0, 0.0};
  for (int i = 0; i < count; i++)
    if (attached(i) && outward_force(i, NONE) > hold[i]) let_go(i);
}
