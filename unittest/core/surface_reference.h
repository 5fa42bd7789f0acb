// Grains that slide and roll, each followed alone in tiny steps by the equations of doc/fix_dust_detach.rst,
// "Criteria", tangential integrate

#ifndef DUST_TEST_SURFACE_REFERENCE_H
#define DUST_TEST_SURFACE_REFERENCE_H

#include "motion.h"
#include "reference_case.h"
#include "vec.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace Dust;

inline Vec along_surface(const Vec &v, const Vec &n) { return v - dot(v, n) * n; }

// a collision: contact acceleration and spin of each step
struct History {
  std::vector<Vec> a, spin;
  Vec spin0;    // before
  double dt;
  bool smooth;    // what lifts a grain does not jump between steps
  // at the end of a step
  Vec a_after(size_t k) const { return 0.5 * (a[k] + a[std::min(k + 1, a.size() - 1)]); }
  Vec spin_after(size_t k) const { return 0.5 * (spin[k] + spin[std::min(k + 1, spin.size() - 1)]); }
};

// largest F_n/F_c of a grain that is followed in forces, spin and displacement, in small steps: it leaves where this
// comes to 1, and is followed on all the same, so that the answer tells by how much
inline double largest_load(const Grain &grain, double carrier_radius, const Material &m, const History &h)
{
  const double mass = 4.0 / 3.0 * M_PI * std::pow(grain.radius, 3) * m.density,
               inertia = 0.4 * mass * grain.radius * grain.radius;
  const double r12 = effective_radius(carrier_radius, grain.radius), shell = carrier_radius + grain.radius;
  const double fc = pull_off_force(m.gamma, r12), pivot = r12 * m.rolling;
  Vec n = {grain.n[0], grain.n[1], grain.n[2]}, omega = h.spin0, w = shell * cross(omega, n), xi;
  const int substeps = 1 + static_cast<int>(4000 / h.a.size());
  const double dt = h.dt / substeps;
  double most = 0.0;
  for (size_t k = 0; k <= h.a.size(); k++) {
    const bool over = k == h.a.size();
    for (int s = 0; s < (over ? 1 : substeps); s++) {
      const double part = (s + 1.0) / substeps;
      const Vec a = over ? Vec() : h.a[k], before = k == 0 || over ? a : h.a_after(k - 1);
      const Vec felt = h.smooth && !over ? before + part * (h.a_after(k) - before) : a;
      const double fn = mass * (dot(w, w) / shell - dot(felt, n));
      most = std::max(most, fn / fc);
      if (over) return most;
      const double stiffness = 2.0 * fc * (1.0 + std::sqrt(std::max(0.0, 1.0 - fn / fc))),
                   limit = m.friction * std::fabs(2.0 * fc - fn);
      const Vec from = k == 0 ? h.spin0 : h.spin_after(k - 1), carrier = from + part * (h.spin_after(k) - from);
      const Vec slip = w - grain.radius * cross(omega, n) - carrier_radius * cross(carrier, n),
                push = -mass * along_surface(a, n), resist = -stiffness * cross(n, xi);
      // without friction the slip of the next step would be this; friction changes it by (1/m + R^2/I) f dt
      const Vec next = slip + dt / mass * push - dt * grain.radius / inertia * cross(resist, n);
      Vec f = -1.0 / (dt * (1.0 / mass + grain.radius * grain.radius / inertia)) * next;
      if (size(f) > limit) f = limit / size(f) * f;
      w = w + dt / mass * (push + f);
      omega = omega + dt / inertia * (resist - grain.radius * cross(n, f));
      n = n + dt / shell * w;
      n = 1.0 / size(n) * n;
      w = along_surface(w, n);
      xi = along_surface(xi + dt * r12 * cross(omega - carrier, n), n);
      if (size(xi) > pivot) xi = pivot / size(xi) * xi;
    }
  }
  return most;
}

inline Vec random_direction(std::mt19937 &random)
{
  std::uniform_real_distribution<double> u(0.0, 1.0);
  const double z = 2.0 * u(random) - 1.0, phi = 2.0 * M_PI * u(random), s = std::sqrt(1.0 - z * z);
  return {s * std::cos(phi), s * std::sin(phi), z};
}

// one to three pulses, each in a direction of its own; with spins of about `spin`, what each changes the spin by, and
// pulses that begin and end smoothly within the collision
inline History random_history(std::mt19937 &random, double spin = 0.0)
{
  const auto u = [&]() { return std::uniform_real_distribution<double>(0.0, 1.0)(random); };
  History h;
  h.smooth = spin > 0.0;
  const int steps = (spin > 0.0 ? 400 : 3) + static_cast<int>(800 * u() * u());
  h.a.assign(steps, Vec());
  if (spin > 0.0) h.spin0 = spin * random_direction(random);
  h.spin.assign(steps, h.spin0);
  const int pulses = 1 + static_cast<int>(2.5 * u());
  for (int p = 0; p < pulses; p++) {
    const double strength = HOLD * std::exp(3.5 * u()), part = u(), length = 0.2 + u();
    const double middle = steps * (spin > 0.0 ? std::clamp(part, 0.25, 0.75) : part);
    const double width = spin > 0.0 ? std::min({steps * length, middle, steps - middle}) : steps * length;
    const Vec direction = random_direction(random), turn = spin > 0.0 ? spin * random_direction(random) : Vec();
    for (int k = 0; k < steps; k++) {
      const double x = std::clamp((k + 0.5 - middle) / width, -1.0, 1.0);
      if (std::fabs(x) < 1.0) h.a[k] = h.a[k] + strength * std::pow(1.0 - x * x, spin > 0.0 ? 2 : 1) * direction;
      h.spin[k] = h.spin[k] + (0.5 + 0.75 * x - 0.25 * x * x * x) * turn;
    }
  }
  h.dt = (1.0 + 6.0 * u()) * 1.0e-6 / steps;
  return h;
}

#endif
