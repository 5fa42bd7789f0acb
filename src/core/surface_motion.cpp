/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

// compiled with square roots that set no errno (cmake/Sources.cmake): the loop over the lanes runs in vectors only then
#include "surface_motion.h"

#include "geometry.h"

#include <algorithm>
#include <cmath>

using namespace Dust;

SurfaceMotion::SurfaceMotion(double mu_f, double theta_crit) : friction(mu_f), rolling2(theta_crit * theta_crit)
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

void SurfaceMotion::advance(const double *a, const double *spin, double dt)
{
  const double inv_dt = 1.0 / dt, ax = a[0], ay = a[1], az = a[2];
  const double ox = omega[0], oy = omega[1], oz = omega[2];
  const double dx = spin[0] - ox, dy = spin[1] - oy, dz = spin[2] - oz;
  for (int i = 0; i < LANES; i++) {
    const double at = here[i], h = dt * at, half = 0.5 * h, c = hold[i];
    double vx = v[0][i], vy = v[1][i], vz = v[2][i];
    double px = p[0][i], py = p[1][i], pz = p[2][i];

    // to the middle of the step, and all vectors into the tangential plane there
    const double over = half * inv_shell[i], roll = half * inv_radius[i];
    const double n0x = n[0][i], n0y = n[1][i], n0z = n[2][i];
    double nx = n0x + over * vx + half * (oy * n0z - oz * n0y);
    double ny = n0y + over * vy + half * (oz * n0x - ox * n0z);
    double nz = n0z + over * vz + half * (ox * n0y - oy * n0x);
    const double inv_size = 1.5 - 0.5 * (nx * nx + ny * ny + nz * nz);    // 1/|n|, nearly 1
    nx *= inv_size, ny *= inv_size, nz *= inv_size;
    double qx = psi[0][i] + roll * px, qy = psi[1][i] + roll * py, qz = psi[2][i] + roll * pz;
    const double vn = vx * nx + vy * ny + vz * nz, pn = px * nx + py * ny + pz * nz, qn = qx * nx + qy * ny + qz * nz;
    vx -= vn * nx, vy -= vn * ny, vz -= vn * nz;
    px -= pn * nx, py -= pn * ny, pz -= pn * nz;
    qx -= qn * nx, qy -= qn * ny, qz -= qn * nz;
    const double q2 = qx * qx + qy * qy + qz * qz;
    const double held = q2 > rolling2 ? std::sqrt(rolling2 / q2) : 1.0;    // the pivot gives way
    qx *= held, qy *= held, qz *= held;

    // what the carrier's turning brings: omega x n before and after, and with it w
    const double bx = at * (oy * nz - oz * ny), by = at * (oz * nx - ox * nz), bz = at * (ox * ny - oy * nx);
    const double cx = bx + at * (dy * nz - dz * ny), cy = by + at * (dz * nx - dx * nz),
                 cz = bz + at * (dx * ny - dy * nx);
    const double wx = vx + shell[i] * bx, wy = vy + shell[i] * by, wz = vz + shell[i] * bz;
    const double on = (ox + 0.5 * dx) * nx + (oy + 0.5 * dy) * ny + (oz + 0.5 * dz) * nz;

    const double an = ax * nx + ay * ny + az * nz;
    const double tx = an * nx - ax - on * (ny * wz - nz * wy);
    const double ty = an * ny - ay - on * (nz * wx - nx * wz);
    const double tz = an * nz - az - on * (nx * wy - ny * wx);
    const double gn = (wx * wx + wy * wy + wz * wz) * inv_shell[i] - an;    // F_n/m, but for the kick below
    const double s = stiffness[i] * (1.0 + std::sqrt(std::max(0.0, 1.0 - gn * inv_hold[i])));
    const double limit = friction * std::fabs(2.0 * c - gn);

    // the friction that ends the slip: u + dt (t + 7/2 f + 5/2 s psi) - R_p change of omega x n = 0
    const double surface = shell[i] - radius[i];
    double fx = -2.0 / 7.0 * (inv_dt * (vx - px - surface * (cx - bx)) + tx + 2.5 * s * qx);
    double fy = -2.0 / 7.0 * (inv_dt * (vy - py - surface * (cy - by)) + ty + 2.5 * s * qy);
    double fz = -2.0 / 7.0 * (inv_dt * (vz - pz - surface * (cz - bz)) + tz + 2.5 * s * qz);
    const double f2 = fx * fx + fy * fy + fz * fz;
    const double part = f2 > limit * limit ? limit / std::sqrt(f2) : 1.0;
    fx *= part, fy *= part, fz *= part;

    // in the middle: does it leave, with the velocity it has there?
    const double mx = wx + half * (tx + fx), my = wy + half * (ty + fy), mz = wz + half * (tz + fz);
    const double lift = (mx * mx + my * my + mz * mz) * inv_shell[i] - an;
    const double stays = lift > c ? 0.0 : at;
    const double rest = stays * 0.5 * dt, carrier = stays * shell[i], spun = stays * radius[i], r = radius[i];
    vx = mx + rest * (tx + fx) - carrier * cx, vy = my + rest * (ty + fy) - carrier * cy,
    vz = mz + rest * (tz + fz) - carrier * cz;
    px += r * bx - 2.5 * h * (fx + s * qx) - spun * cx;
    py += r * by - 2.5 * h * (fy + s * qy) - spun * cy;
    pz += r * bz - 2.5 * h * (fz + s * qz) - spun * cz;

    here[i] = stays;
    const double move = rest * inv_shell[i], roll_on = rest * inv_radius[i];
    n[0][i] = nx + move * vx + rest * cx, n[1][i] = ny + move * vy + rest * cy, n[2][i] = nz + move * vz + rest * cz;
    v[0][i] = vx, v[1][i] = vy, v[2][i] = vz;
    p[0][i] = px, p[1][i] = py, p[2][i] = pz;
    psi[0][i] = qx + roll_on * px, psi[1][i] = qy + roll_on * py, psi[2][i] = qz + roll_on * pz;
  }
  for (int d = 0; d < 3; d++) omega[d] = spin[d];
}

/* ---------------------------------------------------------------------- */

void SurfaceMotion::release()
{
  for (int i = 0; i < count; i++) {
    double w[3], rolling_w[3];
    for (int d = 0; d < 3; d++) {
      w[d] = velocity(i, d);
      rolling_w[d] = rolling_velocity(i, d);
    }
    if (!(dot(w, w) * inv_shell[i] > hold[i])) continue;
    here[i] = 0.0;
    for (int d = 0; d < 3; d++) {
      v[d][i] = w[d];
      p[d][i] = rolling_w[d];
    }
  }
}
