// Collisions by the rules of doc/fix_dust_detach.rst, "What a collision is" and "Criteria", for each grain at each step

#ifndef DUST_TEST_COLLISION_REFERENCE_H
#define DUST_TEST_COLLISION_REFERENCE_H

#include "collision.h"
#include "reference_case.h"
#include "vec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>

using namespace Dust;

// by an angle |v| about v (Rodrigues)
inline Vec turned(const Vec &x, const Vec &v)
{
  const double angle = size(v);
  if (angle == 0.0) return x;
  const Vec u = (1.0 / angle) * v;
  return std::cos(angle) * x + std::sin(angle) * cross(u, x) + (1.0 - std::cos(angle)) * dot(u, x) * u;
}

// a collision: what the contacts do in each step, the velocity before and after
struct History {
  std::vector<Vec> a, alpha;    // alpha may be empty: no rotation
  Vec before, after;
  double dt;
  Vec axis = {0.0, 0.0, 0.0};    // the carrier stands turned about it at first, by its length
  Vec spin = {0.0, 0.0, 0.0};    // before
};

struct Outcome {
  struct Place {    // in space; so long before the end of the collision
    Vec direction, velocity;
    double before_end;
  };
  std::map<int, std::pair<int, int>> left;    // grain: step, mode
  std::map<int, Place> where;
  int north = 0, sliding = 0, rolling = 0;
  int steps = 0;    // until the end
};

// the equations as they stand in the documentation, in forces, for each grain at each step, in space
inline Outcome by_brute_force(const Texture &texture, const Material &m, const Criteria &criteria, const History &h)
{
  Outcome out;
  double reach = 0.0, least = 1.0e300, rolling = 1.0e300;
  for (const Grain &g : texture.grains) {
    const double mass = 4.0 / 3.0 * M_PI * g.radius * g.radius * g.radius * m.density;
    reach = std::max(reach, texture.carrier_radius + g.radius);
    const double r12 = effective_radius(texture.carrier_radius, g.radius),
                 hold = g.adhesion * pull_off_force(m.gamma, r12) / mass;
    const double lever = equilibrium_contact_radius(g.adhesion * m.gamma, r12, m.modulus) / g.radius;
    least = std::min(least, hold);
    rolling = std::min(rolling, hold * lever / std::hypot(1.0, lever));
  }
  const double slide = least * 2.0 * m.friction / std::hypot(1.0, m.friction);
  const double sliding =
      criteria.ibrahim ? std::min({least, slide, rolling}) : std::min(least, std::max(0.1 * least, slide));

  // spin of each step, and where the collision ends: at its last step or at rest
  std::vector<Vec> spin(h.a.size());
  Vec now = h.spin;
  size_t first = 0, lively = 0;    // of the burst, and the last of it
  size_t counts = 0;               // the last step that is lively or in which |a| has fallen by an eighth since one
  double peak = 0.0, low = 0.0;
  bool rests = false, weak = true;
  for (size_t k = 0; k < h.a.size() && !rests; k++) {
    const Vec alpha = h.alpha.empty() ? Vec{0.0, 0.0, 0.0} : h.alpha[k];
    spin[k] = now + 0.5 * h.dt * alpha;
    now = now + h.dt * alpha;
    const bool moves = size(h.a[k]) + reach * (size(alpha) + dot(spin[k], spin[k])) > sliding;
    weak = weak && !moves;
    if (moves || k == 0 || size(h.a[k]) > peak) {
      if (k > lively && k - lively - 1 > lively + 1 - first) first = k;
      lively = k;
    }
    peak = std::max(peak, size(h.a[k]));
    if (lively == k || size(h.a[k]) < 0.875 * low) {
      low = size(h.a[k]);
      counts = k;
    }
    out.steps = k + 1;
    double own_time = 0.0;    // in steps
    for (size_t j = first; j <= k; j++) own_time += size(h.a[j]) / peak;
    rests = k - counts > 0.75 * own_time && (weak || k - counts > 3 * (lively + 1 - first));
    rests = rests || (weak && k + 1 - first > 4.0 * own_time);
  }
  // as long as inertia has not been able to make a grain slide, the collision is weak: of that time the largest
  // acceleration stands for all, and the angles of its steps are summed
  int strong = 0, largest_of_weak = 0;
  for (; strong < out.steps; strong++) {
    const Vec alpha = h.alpha.empty() ? Vec{0.0, 0.0, 0.0} : h.alpha[strong];
    if (size(h.a[strong]) + reach * (size(alpha) + dot(spin[strong], spin[strong])) > sliding) break;
    if (size(h.a[strong]) > size(h.a[largest_of_weak])) largest_of_weak = strong;
  }
  const size_t last = rests ? lively : h.a.size() - 1;
  Vec dv = {0.0, 0.0, 0.0}, spin1 = rests ? spin[lively] : now, so_far = {0.0, 0.0, 0.0};
  for (int k = 0; k < out.steps; k++) {
    if (k <= static_cast<int>(last)) dv = dv - h.dt * h.a[k];
    so_far = so_far + h.dt * h.a[k];
  }
  const double contact_time = (last + 1) * h.dt;

  for (size_t i = 0; i < texture.grains.size(); i++) {
    const Grain &g = texture.grains[i];
    const Vec n0 = turned({g.n[0], g.n[1], g.n[2]}, h.axis);
    const double mass = 4.0 / 3.0 * M_PI * g.radius * g.radius * g.radius * m.density;
    const double r12 = effective_radius(texture.carrier_radius, g.radius), r_pd = texture.carrier_radius + g.radius;
    const double fc = g.adhesion * pull_off_force(m.gamma, r12);
    const double a0 = std::cbrt(g.adhesion) * equilibrium_contact_radius(m.gamma, r12, m.modulus);
    bool attached = true, slid = false, rolled = false;
    double largest = 0.0;
    Vec n = n0, mid = h.spin, angle = {0.0, 0.0, 0.0};    // mid: spin of the middle of the step before
    for (int k = 0; attached && k < out.steps; k++) {
      const Vec alpha = h.alpha.empty() ? Vec{0.0, 0.0, 0.0} : h.alpha[k];
      if (k > 0 && k <= strong) {
        angle = angle + h.dt * mid;
        n = turned(n0, angle);
      } else if (k > 0)
        n = turned(n, h.dt * mid);
      mid = mid + h.dt * alpha;
      if (k < strong && k != largest_of_weak) continue;
      const Vec r = r_pd * n, f = -mass * (h.a[k] + cross(alpha, r) + cross(spin[k], cross(spin[k], r)));
      const double fn = dot(f, n), ft = size(f - fn * n);
      const bool slides = ft > m.friction * std::fabs(2.0 * fc - fn), rolls = ft * g.radius > std::fabs(fc - fn) * a0;
      slid |= slides;
      rolled |= rolls;
      largest = std::max(largest, std::fabs(2.0 * fc - fn));
      int mode = NMODES;
      if (fn > fc)
        mode = NORMAL;
      else if (criteria.ibrahim && slides)
        mode = SLIDING;
      else if (criteria.ibrahim && rolls)
        mode = ROLLING;
      if (mode != NMODES) {
        out.left[i] = {k, mode};
        out.where[i] = {n, cross(spin[k], r), 0.0};
        attached = false;
      }
    }
    const bool impulse = criteria.tangential == Criteria::IMPULSE;
    if (attached && !(rests && weak) && (impulse || dot(n0, dv) < 0.0) && criteria.tangential != Criteria::OFF) {
      const Vec r = r_pd * n0, all = dv + cross(h.spin, r), vt0 = all - dot(all, n0) * n0;
      const Vec surface = cross(spin1, r), s0 = vt0 - surface;
      const double friction = criteria.tangential == Criteria::ESTIMATE ? 0.5 * m.friction * largest : 0.0;
      const double work = friction * 0.5 * size(s0) * contact_time;
      const double s = std::sqrt(std::max(0.0, dot(s0, s0) - 2.0 * work / mass));
      Vec vt = (size(s0) > 0.0 ? s / size(s0) : 0.0) * s0 + surface;
      if (impulse) {
        // friction's momentum, at most what makes a solid sphere roll that spins and slides at first
        const Vec slip = vt0 - cross(g.radius * h.spin + texture.carrier_radius * spin1, n0);
        const double pulled = mass * dot(dv, n0), held = fc * contact_time;
        const double pushed = m.friction * (2.0 * held - pulled);
        const double inertia = 0.4 * mass * g.radius * g.radius, lever = g.radius * g.radius / inertia;
        const double to_roll = size(slip) / (1.0 / mass + lever);
        // while it rolls, the moment of its pivots and the force of friction on it in a ratio that keeps it rolling
        const double pivots =
            2.0 * (held + std::sqrt(held * std::max(0.0, held - pulled))) * r12 * m.rolling / g.radius;
        const double on = std::min(pivots, mass * size(slip)) * lever / (1.0 / mass + lever);
        const double taken = std::max(0.0, std::min(pushed, to_roll + on)) / mass;
        vt = size(slip) > 0.0 ? vt0 - taken / size(slip) * slip : vt0;
        // half a sine in twelve parts; it has no grain to lift in the first of them that stays where it is
        const Vec w0 = cross(h.spin, r);
        const double most = mass * std::min(0.5 * M_PI * size(dv) / contact_time, peak);
        for (int k = 3; k <= 12 && attached && size(dv) > 0.0; k++) {
          const double tau = k * M_PI / 12.0, omega = M_PI / contact_time;
          const Vec w = w0 + std::pow(std::sin(0.5 * tau), 2) * (vt - w0);
          const Vec moved = tau / omega * w0 + 0.5 / omega * (tau - std::sin(tau)) * (vt - w0);
          const Vec n_now = n0 + 1.0 / r_pd * moved, lift = most * std::sin(tau) / size(dv) * dv;
          if (dot(lift, n_now) + mass * dot(w, w) / r_pd <= fc) continue;
          out.left[i] = {out.steps, TANGENTIAL};
          // on the sphere, with its speed
          const Vec there = 1.0 / size(n_now) * n_now, along = w - dot(w, there) * there;
          out.where[i] = {there, (size(along) > 0.0 ? size(w) / size(along) : 0.0) * along,
                          contact_time * (1.0 - k / 12.0)};
          attached = false;
        }
      }
      if (attached && mass * dot(vt, vt) / r_pd > fc) {
        out.left[i] = {out.steps, TANGENTIAL};
        out.where[i] = {n0, vt, 0.0};
        attached = false;
      }
    }
    out.sliding += criteria.count && slid;
    out.rolling += criteria.count && rolled;
    out.north += !attached && dot(n0, so_far) > 0.0;
  }
  return out;
}

inline Quaternion orientation(const History &h)
{
  Quaternion q;
  q.turn_by(&h.axis.x, 1.0);
  return q;
}

// the same by Collision; handed over to another one every `handover` steps
inline Outcome by_collision(const Texture &texture, const GrainTable &table, const History &h, int handover = 0)
{
  Outcome out;
  std::vector<uint64_t> attached = table.all_attached();
  static Workspace work;    // shared, as what one collision leaves behind must not show in the next
  std::vector<Detachment> &detached = work.detached;
  Collision collision;
  collision.begin(orientation(h), &h.spin.x);
  Vec spin = h.spin;    // of the middle of the step before
  bool over = false;
  for (size_t k = 0; !over; k++) {
    over = k == h.a.size() || collision.at_rest();
    if (over) {
      collision.end(table, &spin.x, attached.data(), work);
      out.steps = k;
    } else {
      const Vec alpha = h.alpha.empty() ? Vec{0.0, 0.0, 0.0} : h.alpha[k];
      const Motion motion = {{h.a[k].x, h.a[k].y, h.a[k].z}, {alpha.x, alpha.y, alpha.z}, {spin.x, spin.y, spin.z}};
      collision.step(table, motion, h.dt, attached, work);
      spin = spin + h.dt * alpha;
    }
    for (const Detachment &d : detached) {
      EXPECT_EQ(out.left.count(table.grain(d.bit)), 0u) << "a grain left twice";
      out.left[table.grain(d.bit)] = {static_cast<int>(k), d.mode};
      out.where[table.grain(d.bit)] = {{d.direction[0], d.direction[1], d.direction[2]},
                                       {d.velocity[0], d.velocity[1], d.velocity[2]},
                                       d.before_end};
    }
    detached.clear();
    if (handover && k % handover == 0) {
      std::vector<double> buf(collision.packed_size());
      EXPECT_GE(collision.max_packed_size(table), collision.packed_size());
      EXPECT_LE(collision.max_packed_size(table), collision.packed_size() + 16);
      Packer packer(buf.data());
      collision.pack(packer);
      Collision other;
      Unpacker unpacker(buf.data());
      other.unpack(unpacker);
      collision.release(work);
      collision = std::move(other);
    }
  }
  out.north = collision.lost_north(table, attached.data());
  out.sliding = collision.grains_that(SLIDING, table, attached.data());
  out.rolling = collision.grains_that(ROLLING, table, attached.data());
  collision.release(work);
  int still = 0;
  for (uint64_t word : attached) still += __builtin_popcountll(word);
  EXPECT_EQ(still + out.left.size(), texture.grains.size());
  return out;
}

inline void expect_same(const Outcome &a, const Outcome &b)
{
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.left, b.left);
  EXPECT_EQ(a.north, b.north);
  EXPECT_EQ(a.sliding, b.sliding);
  EXPECT_EQ(a.rolling, b.rolling);
  if (a.left != b.left) return;
  for (const auto &[grain, at] : a.where) {
    const Outcome::Place &there = b.where.at(grain);
    EXPECT_NEAR(size(at.direction - there.direction), 0.0, 1.0e-9);
    // a root near 0 in Eq. 5
    EXPECT_NEAR(size(at.velocity - there.velocity), 0.0, 1.0e-7 * (1.0 + size(there.velocity)));
    EXPECT_NEAR(at.before_end, there.before_end, 1.0e-9 * (1.0e-6 + there.before_end));
  }
}

// a few pulses in random directions: straight, turning, with several peaks and with kinks; with or without rotation
inline History random_history(std::mt19937 &random, bool rotation)
{
  const auto u = [&]() { return std::uniform_real_distribution<double>(0.0, 1.0)(random); };
  const auto direction = [&]() {
    const double z = 2.0 * u() - 1.0, phi = 2.0 * M_PI * u(), s = std::sqrt(1.0 - z * z);
    return Vec{s * std::cos(phi), s * std::sin(phi), z};
  };
  History h;
  const int steps = 3 + static_cast<int>(400 * u() * u());
  h.dt = 4.0e-6 / steps * (0.2 + 2.0 * u());
  h.a.assign(steps, {0.0, 0.0, 0.0});
  if (rotation) {
    h.alpha.assign(steps, {0.0, 0.0, 0.0});
    h.axis = 3.0 * u() * direction();
    h.spin = 1.5e4 * u() * u() * direction();    // 1.5e4 rad/s throws off grains by itself
  }
  const int pulses = 1 + static_cast<int>(3.5 * u());
  for (int p = 0; p < pulses; p++) {
    const double strength = HOLD * std::exp(6.0 * u() - 2.0), middle = u() * steps, width = steps * (0.05 + u());
    const Vec d = direction();
    // torque: friction with a coefficient up to 1, 5/2 mu a/R
    const Vec lever = rotation ? 2.5 * u() / RP * cross(d, direction()) : Vec{0.0, 0.0, 0.0};
    for (int k = 0; k < steps; k++) {
      const double x = (k + 0.5 - middle) / width;
      if (std::fabs(x) >= 1.0) continue;
      h.a[k] = h.a[k] + strength * (1.0 - x * x) * d;
      if (rotation) h.alpha[k] = h.alpha[k] + strength * (1.0 - x * x) * lever;
    }
  }
  h.before = 10.0 * u() * direction();
  h.after = h.before;
  for (const Vec &a : h.a) h.after = h.after + h.dt * a;
  return h;
}

// a damped Hertzian impact along z in small steps
inline History straight_impact(double speed, double restitution_damping)
{
  const double mass = 4.0 / 3.0 * M_PI * RP * RP * RP * 7700.0, k = 4.0 / 3.0 * 1.154e11 * std::sqrt(RP);
  History h;
  h.dt = 1.0e-9;
  h.before = {0.0, 0.0, -speed};
  double overlap = 0.0, v = speed;
  while (true) {
    overlap += v * h.dt;
    const double elastic = k * overlap * std::sqrt(overlap);
    const double f = elastic + restitution_damping * std::sqrt(mass * elastic / overlap) * v;
    if (f <= 0.0) break;
    h.a.push_back({0.0, 0.0, f / mass});
    v -= f / mass * h.dt;
  }
  h.after = {0.0, 0.0, -v};
  return h;
}

#endif
