// Grains that the bound spares must stay whatever they do.

#include "motion_bound.h"

#include "normal_motion.h"
#include "surface_motion.h"
#include "surface_reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace Dust;

TEST(MotionBound, IsThatOfItsHeader)
{
  // V, W, the angle by which n turns and what F_n/m stays below, from their integrals; 2 % more for the steps
  std::mt19937 random(10);
  std::uniform_real_distribution<double> u(0.2, 1.0);
  for (int i = 0; i < 200; i++) {
    ImpulseRecord record;
    const int spans = 2 + i % 20;
    const double dt = 1.0e-7 * u(random), theta = u(random), peak = 3.0 * HOLD * u(random);
    const Vec spin0 = 3.0e3 * u(random) * random_direction(random);
    Vec spin = spin0, before, all;
    double spun = 0.0, changes = 0.0, fastest = size(spin0);
    std::vector<Vec> forces;
    for (int k = 0; k < spans; k++) {
      const Vec a = peak * u(random) * random_direction(random), next = 3.0e3 * u(random) * random_direction(random);
      record.add(&a.x, &next.x, dt);
      spun += size(next - spin);
      changes += size(a - before);
      fastest = std::max(fastest, size(next));
      spin = next;
      before = a;
      all = all + a;
      forces.push_back(a);
    }
    changes += size(before);
    const Vec axis = 1.0 / size(all) * all;
    double along = 0.0, aside = 0.0;
    for (const Vec &a : forces) {
      along += dt * std::fabs(dot(a, axis));
      aside += dt * size(a - dot(a, axis) * axis);
    }
    const double time = spans * dt, hold = HOLD * u(random), rd = RD * u(random), shell = RP + rd, more = 1.02;
    const auto own = [&](double r_12_of_r_d) {
      const double s = 2.0 * hold * r_12_of_r_d * (1.0 + std::sqrt(1.0 + peak / hold)),
                   l = std::sqrt(shell * shell + 0.4 * rd * rd);
      return std::sqrt(2.5) * theta * s * time + l * spun + 0.5 * shell * fastest * fastest * time;
    };
    const MotionBound bound(record, &spin0.x, peak, theta, RP);

    // a grain: the impulses along the axis count with what is tangential of them, as far as n turns
    const Vec n = random_direction(random);
    const auto [angle, centrifugal] = bound.of(&n.x, hold, shell);
    const double v = along + aside + own(RP / shell), turns = more * (v / shell + fastest) * time;
    EXPECT_NEAR(angle, turns, 1.0e-9 * turns);
    const double across = std::sqrt(1.0 - dot(n, axis) * dot(n, axis)) + turns;
    const double w = along * std::min(1.0, across) + aside + own(RP / shell) + shell * fastest;
    EXPECT_NEAR(centrifugal, more * w * w / shell, 1.0e-9 * centrifugal);

    // any grain
    const double v_any = along + aside + own(1.0), turns_any = more * (v_any / RP + fastest) * time,
                 w_any = v_any + shell * fastest, centrifugal_any = more * w_any * w_any / RP;
    const double outward = peak * (1.0 + turns_any) + centrifugal_any;
    EXPECT_TRUE(bound.any_may_leave(0.999 * outward, hold, shell));
    EXPECT_FALSE(bound.any_may_leave(1.001 * outward, hold, shell));
    const double rings = std::max(outward / 0.3, (changes + turns_any * peak + 4.0 * centrifugal_any) / 0.95);
    EXPECT_TRUE(bound.any_may_ring_off(0.999 * rings, hold, shell));
    EXPECT_FALSE(bound.any_may_ring_off(1.001 * rings, hold, shell));
  }
}

TEST(MotionBound, HoldsForWhatMovesMostAndSparesWhatDoesNot)
{
  // half a sine for 3 us along z, at the equator and at the pole
  const auto bound = [](double speed) {
    ImpulseRecord record;
    const double time = 3.0e-6, peak = 0.5 * M_PI * speed / time;
    for (int k = 0; k < 300; k++) {
      const double a[3] = {0.0, 0.0, peak * std::sin(M_PI * (k + 0.5) / 300)};
      record.add(a, NO_SPIN, time / 300);
    }
    return MotionBound(record, NO_SPIN, peak, 0.15, RP);
  };
  const double equator[3] = {1.0, 0.0, 0.0}, pole[3] = {0.0, 0.0, 1.0}, needed = std::sqrt(HOLD * (RP + RD));
  EXPECT_GT(bound(1.001 * needed).of(equator, HOLD, RP + RD).centrifugal, HOLD);    // frictionless
  EXPECT_LT(bound(1.5 * needed).of(pole, HOLD, RP + RD).centrifugal, 0.2 * HOLD);
  EXPECT_LT(bound(0.5 * needed).of(equator, HOLD, RP + RD).centrifugal, 0.5 * HOLD);
  EXPECT_GT(bound(0.5 * needed).of(equator, HOLD, RP + RD).angle, 0.5 * needed * 3.0e-6 / (RP + RD));
  EXPECT_TRUE(bound(0.5 * needed).any_may_leave(HOLD, HOLD, SHELL));
  EXPECT_FALSE(bound(0.01 * needed).any_may_leave(HOLD, HOLD, SHELL));
}

TEST(MotionBound, NeverSparesAGrainThatIsThrownOff)
{
  std::mt19937 random(9);
  int thrown = 0, spared = 0, collisions = 0;
  for (int i = 0; i < 2500; i++) {
    History h = random_history(random, i % 5 == 0 ? 0.0 : 4.0e3);
    if (h.a.size() < 32) continue;    // Collision takes smaller steps
    const double weaker = std::exp(-3.0 * std::uniform_real_distribution<double>()(random));
    for (Vec &a : h.a) a = weaker * a;
    collisions++;
    ImpulseRecord record;
    double peak = 0.0;
    for (size_t k = 0; k < h.a.size(); k++) {
      record.add(&h.a[k].x, &h.spin[k].x, h.dt);
      peak = std::max(peak, size(h.a[k]));
    }
    const double rolling = i % 3 == 0 ? 3.0 : 0.15;
    const MotionBound bound(record, &h.spin0.x, peak, rolling, RP);
    SurfaceMotion motion(i % 7 == 0 ? 0.0 : 0.3, rolling);
    std::vector<bool> stays;
    while (!motion.full()) {
      const Vec n = random_direction(random);
      const double radius = RD * (1.0 + 0.1 * (motion.grains() % 5)), hold = HOLD * RD * RD / (radius * radius);
      motion.add(&n.x, hold, radius, RP, &h.spin0.x);
      const auto [angle, centrifugal] = bound.of(&n.x, hold, RP + radius);
      bool holds = centrifugal <= hold;    // after the end
      for (const Vec &a : h.a) holds &= angle * size(a) - dot(a, n) + centrifugal <= hold;
      stays.push_back(holds);
      if (!bound.any_may_leave(hold, hold, RP + radius)) {
        EXPECT_TRUE(holds);
      }
    }
    for (const ImpulseRecord::Span &span : record.spans()) {
      const double t = span.duration, *j = span.impulse, a[3] = {j[0] / t, j[1] / t, j[2] / t};
      const double spin[3] = {span.angle[0] / t, span.angle[1] / t, span.angle[2] / t};
      motion.advance(a, spin, t);
    }
    motion.release();
    for (int k = 0; k < motion.grains(); k++) {
      thrown += !motion.attached(k);
      spared += stays[k];
      if (stays[k]) {
        EXPECT_TRUE(motion.attached(k)) << "collision " << i << " grain " << k;
      }
    }
  }
  EXPECT_GT(collisions, 2000);
  EXPECT_GT(thrown, 2000);
  EXPECT_GT(spared, 10000);
}

TEST(MotionBound, NeverSparesAGrainThatRingsOff)
{
  // an undamped contact under loads that swing at its frequency; spared where they change by 0.95 F_c, thrown off by
  // far more
  const double gap = 2.267e-10, mass = 4.0 / 3.0 * M_PI * RD * RD * RD * 2700.0, n[3] = {0.0, 0.0, 1.0};
  const double period =
      2.0 * M_PI /
      std::sqrt(1.2 * CALCITE.modulus *
                equilibrium_contact_radius(CALCITE.gamma, effective_radius(RP, RD), CALCITE.modulus) / mass);
  int spared = 0, thrown = 0;
  for (int swings = 1; swings <= ImpulseRecord::MAX_SPANS / 2; swings++)
    for (double strength = 0.0; strength < 0.5; strength += 0.01) {
      ImpulseRecord record;
      NormalMotion ringing(0.0);
      SurfaceMotion motion(0.3, 0.15);
      motion.add(n, HOLD, RD, RP, NO_SPIN);
      ringing.add(HOLD, gap, 0.0);
      for (int k = 0; k < 2 * swings; k++) {
        const double a[3] = {0.0, 0.0, (k % 2 ? 1.0 : -1.0) * strength * HOLD};
        record.add(a, NO_SPIN, 0.5 * period);
        const double load = motion.outward_force(0, a) / HOLD;
        EXPECT_NEAR(load, -a[2] / HOLD, 1e-12);
        ringing.advance(&load, 0.0);
        ringing.advance(&load, 0.5 * period);
      }
      ringing.advance(3.0 * ringing.longest_period());
      const bool may = MotionBound(record, NO_SPIN, strength * HOLD, 0.15, RP).any_may_ring_off(HOLD, HOLD, SHELL);
      spared += !may;
      thrown += !ringing.attached(0);
      if (!may) {
        EXPECT_TRUE(ringing.attached(0)) << swings << " swings of " << strength;
      }
    }
  EXPECT_GT(spared, 50);
  EXPECT_GT(thrown, 200);
}
