/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

// compiled with square roots that set no errno (cmake/Sources.cmake): the loop over the lanes runs in vectors only then
#include "surface_motion.h"

#include <algorithm>
#include <cmath>

using namespace Dust;

SurfaceMotion::SurfaceMotion(double friction, double rolling) : friction(friction), rolling2(rolling * rolling)
{
  clear();
}

/* ----------------------------------------------------------------------
   lanes without a grain hold one that nothing moves, away from where a division fails
------------------------------------------------------------------------- */

void SurfaceMotion::clear()
{
  count = 0;
  for (int i = 0; i < LANES; i++) {
    here[i] = 0.0;
    hold[i] = per_hold[i] = per_shell[i] = per_radius[i] = stiffness[i] = 1.0;
    for (int d = 0; d < 3; d++) {
      n[d][i] = d == 2;
      w[d][i] = p[d][i] = psi[d][i] = 0.0;
    }
  }
}

/* ---------------------------------------------------------------------- */

void SurfaceMotion::add(const double *direction, double hold_of, double grain_radius, double carrier_radius)
{
  const int i = count++;
  const double shell = carrier_radius + grain_radius;
  here[i] = 1.0;
  hold[i] = hold_of;
  per_hold[i] = 1.0 / hold_of;
  per_shell[i] = 1.0 / shell;
  per_radius[i] = 1.0 / grain_radius;
  stiffness[i] = 2.0 * hold_of * carrier_radius / shell;
  for (int d = 0; d < 3; d++) n[d][i] = direction[d];
}

/* ---------------------------------------------------------------------- */

void SurfaceMotion::advance(const double *a, double dt)
{
  const double per_dt = 1.0 / dt, ax = a[0], ay = a[1], az = a[2];
  for (int i = 0; i < LANES; i++) {
    const double h = dt * here[i], half = 0.5 * h, c = hold[i];
    double wx = w[0][i], wy = w[1][i], wz = w[2][i];
    double px = p[0][i], py = p[1][i], pz = p[2][i];

    // to the middle of the step, and all vectors into the tangential plane there
    const double turn = half * per_shell[i], roll = half * per_radius[i];
    double nx = n[0][i] + turn * wx, ny = n[1][i] + turn * wy, nz = n[2][i] + turn * wz;
    const double per_size = 1.5 - 0.5 * (nx * nx + ny * ny + nz * nz);    // 1/|n|, nearly 1
    nx *= per_size, ny *= per_size, nz *= per_size;
    double qx = psi[0][i] + roll * px, qy = psi[1][i] + roll * py, qz = psi[2][i] + roll * pz;
    const double wn = wx * nx + wy * ny + wz * nz, pn = px * nx + py * ny + pz * nz, qn = qx * nx + qy * ny + qz * nz;
    wx -= wn * nx, wy -= wn * ny, wz -= wn * nz;
    px -= pn * nx, py -= pn * ny, pz -= pn * nz;
    qx -= qn * nx, qy -= qn * ny, qz -= qn * nz;
    const double q2 = qx * qx + qy * qy + qz * qz;
    const double held = q2 > rolling2 ? std::sqrt(rolling2 / q2) : 1.0;    // the pivot gives way
    qx *= held, qy *= held, qz *= held;

    const double an = ax * nx + ay * ny + az * nz;
    const double tx = an * nx - ax, ty = an * ny - ay, tz = an * nz - az;
    const double gn = (wx * wx + wy * wy + wz * wz) * per_shell[i] - an;    // F_n/m, but for the kick below
    const double s = stiffness[i] * (1.0 + std::sqrt(std::max(0.0, 1.0 - gn * per_hold[i])));
    const double limit = friction * std::fabs(2.0 * c - gn);

    // the friction that ends the slip: u + dt (t + 7/2 f + 5/2 s psi) = 0
    double fx = -2.0 / 7.0 * (per_dt * (wx - px) + tx + 2.5 * s * qx);
    double fy = -2.0 / 7.0 * (per_dt * (wy - py) + ty + 2.5 * s * qy);
    double fz = -2.0 / 7.0 * (per_dt * (wz - pz) + tz + 2.5 * s * qz);
    const double f2 = fx * fx + fy * fy + fz * fz;
    const double part = f2 > limit * limit ? limit / std::sqrt(f2) : 1.0;
    fx *= part, fy *= part, fz *= part;

    // in the middle: does it leave, with the velocity it has there?
    const double mx = wx + half * (tx + fx), my = wy + half * (ty + fy), mz = wz + half * (tz + fz);
    const double lift = (mx * mx + my * my + mz * mz) * per_shell[i] - an;
    const double stays = lift > c ? 0.0 : here[i];
    const double rest = stays * 0.5 * dt;
    wx = mx + rest * (tx + fx), wy = my + rest * (ty + fy), wz = mz + rest * (tz + fz);
    px -= 2.5 * h * (fx + s * qx), py -= 2.5 * h * (fy + s * qy), pz -= 2.5 * h * (fz + s * qz);

    here[i] = stays;
    const double on = rest * per_shell[i], roll_on = rest * per_radius[i];
    n[0][i] = nx + on * wx, n[1][i] = ny + on * wy, n[2][i] = nz + on * wz;
    w[0][i] = wx, w[1][i] = wy, w[2][i] = wz;
    p[0][i] = px, p[1][i] = py, p[2][i] = pz;
    psi[0][i] = qx + roll_on * px, psi[1][i] = qy + roll_on * py, psi[2][i] = qz + roll_on * pz;
  }
}

/* ---------------------------------------------------------------------- */

void SurfaceMotion::release()
{
  for (int i = 0; i < count; i++) {
    const double w2 = w[0][i] * w[0][i] + w[1][i] * w[1][i] + w[2][i] * w[2][i];
    if (w2 * per_shell[i] > hold[i]) here[i] = 0.0;
  }
}
