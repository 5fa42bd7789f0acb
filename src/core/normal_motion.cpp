/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

// compiled as surface_motion.cpp
#include "normal_motion.h"

#include "geometry.h"
#include "jkr.h"

#include <algorithm>
#include <cmath>

using namespace Dust;

namespace {

constexpr double STIFFNESS = 1.8 / ROOT_6;    // k0 delta_c/F_c: 12/(20/3 6^(1/3)), the slope of the branch at y = 1
constexpr double STEP = 0.3;                  // times the frequency: a period in 21 steps
constexpr double MAX_STEPS = 1.0e4;           // at once: beyond any load that a material stands

double overlap_of(double y) { return ROOT_6 * (2.0 * y * y * y - 4.0 / 3.0) * y; }
double slope_of(double y) { return 1.0 / (ROOT_6 * (8.0 * y * y * y - 4.0 / 3.0)); }

// y of a grain that does not move under a load
double quiet_y(double load) { return std::cbrt(0.5 * (1.0 + std::sqrt(std::max(0.0, 1.0 - load)))); }

}    // namespace

NormalMotion::NormalMotion(double zeta) : damping(zeta * std::sqrt(STIFFNESS)) { clear(); }

/* ---------------------------------------------------------------------- */

void NormalMotion::clear()
{
  count = 0;
  for (int i = 0; i < LANES; i++) {
    here[i] = G[i] = U[i] = rate[i] = 0.0;
    gap[i] = y[i] = 1.0;
    D[i] = overlap_of(1.0);
    slope[i] = slope_of(1.0);
  }
}

/* ---------------------------------------------------------------------- */

void NormalMotion::add(double hold, double breaking_gap, double load)
{
  const int i = count++;
  here[i] = 1.0;
  gap[i] = breaking_gap;
  rate[i] = std::sqrt(hold / breaking_gap);
  G[i] = load;
  y[i] = quiet_y(load);
  D[i] = overlap_of(y[i]);
  slope[i] = slope_of(y[i]);
}

/* ---------------------------------------------------------------------- */

void NormalMotion::advance(const double *load, double dt)
{
  // dF/dD = 4 (6 y^5 - 3 y^2) dy/dD is below 3 y^2/6^(1/3) + 1/2 on the branch up to where the load is -G
  double max_rate2 = 0.0;
  for (int i = 0; i < count; i++) {
    const double max_y = std::max({y[i], quiet_y(load[i]), quiet_y(G[i])});
    max_rate2 = std::max(max_rate2, here[i] * rate[i] * rate[i] * (3.0 / ROOT_6 * max_y * max_y + 0.5));
  }
  // in this order also of what is not a number
  advance(load, dt, 1 + static_cast<int>(std::min(MAX_STEPS, dt * std::sqrt(max_rate2) / STEP)));
}

/* ---------------------------------------------------------------------- */

void NormalMotion::advance(const double *load, double dt, int steps)
{
  // the branch ends where slope has no bound: y stays this far from there
  constexpr double MIN_Y = 1.02 * 0.5503212;    // 6^(-1/3)
  double grow[LANES], h[LANES];
  for (int i = 0; i < LANES; i++) {
    grow[i] = i < count ? (load[i] - G[i]) / steps : 0.0;
    h[i] = rate[i] * dt / steps;
  }
  for (int k = 0; k < steps; k++)
    for (int i = 0; i < LANES; i++) {
      const double step = h[i] * here[i], y2 = y[i] * y[i], y3 = y2 * y[i];
      const double drag = damping * y2 * step, force = G[i] + 4.0 * y3 * (y3 - 1.0);
      const double u = ((1.0 - drag) * U[i] - step * force) / (1.0 + drag), d = D[i] + step * u;
      // y goes on as it did, and one step of Newton's method
      const double along = y[i] + step * u * slope[i], guess = along > MIN_Y ? along : MIN_Y,
                   g3 = guess * guess * guess;
      const double guess_slope = 1.0 / (ROOT_6 * (8.0 * g3 - 4.0 / 3.0));
      const double more = (d - ROOT_6 * (2.0 * g3 - 4.0 / 3.0) * guess) * guess_slope,
                   next = guess + (more < 0.1 ? more : 0.1);
      y[i] = next > MIN_Y ? next : MIN_Y;
      slope[i] = guess_slope;
      U[i] = u;
      D[i] = d;
      G[i] += grow[i];
      here[i] = d < -1.0 ? 0.0 : here[i];
    }
}

/* ---------------------------------------------------------------------- */

double NormalMotion::longest_period() const
{
  double max_time = 0.0;
  for (int i = 0; i < count; i++) max_time = std::max(max_time, here[i] / std::max(rate[i], 1e-300));
  return 2.0 * PI / std::sqrt(STIFFNESS) * max_time;
}

/* ----------------------------------------------------------------------
   grains side by side whose loads come to 1/2 at slopes one step apart, within a tenth and then a hundredth of it
------------------------------------------------------------------------- */

double Dust::overshoot(double zeta)
{
  constexpr int LANES = NormalMotion::LANES, PIECES = 100;
  constexpr double LOAD = 0.5, MAX_SLOPE = 32.0, RISE = 60.0;    // time in which a load comes, units as in the header
  double low = 0.0, high = MAX_SLOPE;
  while (high - low > 1.0e-3 * high) {
    const double step = (high - low) / LANES;
    NormalMotion motion(zeta);
    double load[LANES], slope[LANES];
    for (int i = 0; i < LANES; i++) {
      slope[i] = low + (i + 1) * step;
      motion.add(1.0, 1.0, load[i] = LOAD - 0.75 * RISE * slope[i]);
    }
    // from rest, and evenly from half of the time on, so that it does not ring before
    for (int k = 1; k <= PIECES; k++) {
      const double t = static_cast<double>(k) / PIECES, part = t < 0.5 ? t * t : t - 0.25;
      for (int i = 0; i < LANES; i++) load[i] = LOAD + (part - 0.75) * RISE * slope[i];
      motion.advance(load, RISE / PIECES);
    }
    motion.advance(RISE);
    int stay = 0;
    while (stay < LANES && motion.attached(stay)) stay++;
    if (stay == LANES) return 0.0;
    high = low + (stay + 1) * step;
    low += stay * step;
  }
  return (1.0 - LOAD) / high;
}
