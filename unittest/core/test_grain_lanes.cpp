// Grains that slide, roll, swing and fly, against closed forms.

#include "grain_lanes.h"

#include "jkr.h"
#include "meeting_case.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

using namespace Dust;

namespace {

constexpr double STEP = 10.0e-9;

// grains of 20 um, all awake, and an instance to move them
struct Case {
  GrainTable table;
  GrainLanes lanes;

  explicit Case(Material m = meeting(), size_t grains = 1, double zeta = 1.0) :
      table(on_circle(angles(grains), std::vector<double>(grains, RD)), m, meeting_criteria()), lanes(table, zeta)
  {
    for (size_t bit = 0; bit < grains; bit++) lanes.set_awake(static_cast<int>(bit), true);
  }
  static std::vector<double> angles(size_t grains)
  {
    std::vector<double> all;
    for (size_t k = 0; k < grains; k++) all.push_back(0.1 * static_cast<double>(k));
    return all;
  }
  void change(int bit, const std::function<void(GrainLanes::Grain &)> &how)
  {
    GrainLanes::Grain grain = lanes.get(bit);
    how(grain);
    lanes.put(bit, grain);
  }
  void run(int steps, const Motion &motion = {}, double h = STEP, bool settle = false)
  {
    for (int k = 0; k < steps; k++) lanes.advance({motion, h}, settle);
  }
};

double length(const double *v) { return std::sqrt(dot(v, v)); }

}    // namespace

TEST(GrainLanes, RestsWhereItHolds)
{
  Case one;
  const GrainLanes::Grain before = one.lanes.get(0);
  EXPECT_NEAR(before.gap, -0.2747e-9, 1e-13);    // delta_0, physics.md
  one.run(1000);
  const GrainLanes::Grain after = one.lanes.get(0);
  EXPECT_NEAR(after.gap, before.gap, 1e-6 * std::fabs(before.gap));
  EXPECT_LT(length(after.v), 1e-12);
}

// rolling without slip, so that friction takes nothing: it flies off from w^2/|r| = c on, which is 10.0539 m/s. The
// damped contact follows the load without ringing from zeta = 0.7 on, whatever the step (physics.md, section 2)
TEST(GrainLanes, LeavesItsCurveFromTheSpeedThatAdhesionCanHold)
{
  const auto leaves = [](double speed, double zeta, double h) {
    Material m = meeting();
    m.rolling = 0.0;
    Case one(m, 1, zeta);
    one.change(0, [&](GrainLanes::Grain &g) {
      g.v[0] = speed;
      g.spin[1] = speed / RD;    // Omega x n = v/R_d
      g.psi[0] = g.psi[1] = g.psi[2] = 0.0;
    });
    one.run(static_cast<int>(20.0e-6 / h), {}, h);
    return !one.lanes.held(0);
  };
  const double critical = std::sqrt(HOLD * SHELL);
  EXPECT_NEAR(critical, 10.0539, 1e-4);
  for (const double zeta : {0.7, 1.0, 2.0})
    for (const double h : {2.0e-9, 10.0e-9, 20.0e-9}) {
      EXPECT_FALSE(leaves(0.998 * critical, zeta, h)) << zeta << " " << h;
      EXPECT_TRUE(leaves(1.002 * critical, zeta, h)) << zeta << " " << h;
    }
}

// the neck holds up to -F_c, pulled slowly
TEST(GrainLanes, HoldsUpToThePullOffForce)
{
  for (const double load : {0.99, 1.01}) {
    Case one;
    Motion motion = {};
    const int slow = 2000;
    for (int k = 0; k < 2 * slow; k++) {
      motion.acceleration[2] = -load * HOLD * std::min(1.0, static_cast<double>(k) / slow);
      one.run(1, motion);
    }
    EXPECT_EQ(one.lanes.held(0), load < 1.0) << load;
  }
}

// a pivot that gives way all the time: 5/7 of 4 c (R_12/R_d) theta_crit against the motion, at (a/a0)^(3/2) = 1
TEST(GrainLanes, RollingResistanceStopsIt)
{
  Case one;
  const double speed = 1.0;    // slow: the load changes by 1 % of F_c
  one.change(0, [&](GrainLanes::Grain &g) {
    g.v[0] = speed;
    g.spin[1] = speed / RD;
    g.psi[0] = CALCITE.rolling;
  });
  const double r12 = effective_radius(RP, RD), slowing = 5.0 / 7.0 * 4.0 * HOLD * r12 / RD * CALCITE.rolling;
  const int steps = 500;
  one.run(steps);
  double v[3];
  one.lanes.velocity(0, v);
  EXPECT_NEAR(speed - length(v), slowing * steps * STEP, 0.01 * slowing * steps * STEP);
}

// it slides: friction mu 2 c against the motion, until v has lost 2/7 and rolls
TEST(GrainLanes, SlidesUntilItRolls)
{
  Material m = meeting();
  m.rolling = 0.0;
  Case one(m);
  const double speed = 1.4;
  one.change(0, [&](GrainLanes::Grain &g) { g.v[1] = speed; });
  const int steps = 200;
  one.run(steps);
  double v[3];
  one.lanes.velocity(0, v);
  const double limit = 2.0 * HOLD * CALCITE.friction;    // the load is 2 % of F_c at most, of 2 F_c
  EXPECT_NEAR(speed - length(v), limit * steps * STEP, 0.02 * limit * steps * STEP);
  one.run(4000);
  one.lanes.velocity(0, v);
  EXPECT_NEAR(length(v), 5.0 / 7.0 * speed, 0.001 * speed);
}

// an implicit step is stable, however stiff the contact: a load that comes at once does not throw off a damped grain
TEST(GrainLanes, AnyStepIsStable)
{
  Case one;
  Motion motion = {};
  motion.acceleration[2] = 50.0 * HOLD;    // pressed
  one.run(100, motion, 1.0e-7);
  const double pressed = one.lanes.get(0).y;
  // F = 50 F_c: (a/a0)^(3/2) = (1 + sqrt(51))/2
  EXPECT_NEAR(std::pow(pressed, 3), 0.5 * (1.0 + std::sqrt(51.0)), 1e-3);
  EXPECT_TRUE(one.lanes.held(0));
}

TEST(GrainLanes, FliesStraightInSpaceWhileTheCarrierTurns)
{
  Case one;
  const double spin[3] = {3000.0, -2000.0, 4000.0};
  one.change(0, [&](GrainLanes::Grain &g) {
    g.held = 0.0;
    g.gap = 5.0e-6;
    g.v[0] = 3.0;
    g.v[2] = 4.0;
  });
  const GrainLanes::Grain start = one.lanes.get(0);
  const double *from = one.lanes.place(0);
  double turning[3], x0[3], v0[3];
  cross(spin, from, turning);
  for (int d = 0; d < 3; d++) {
    x0[d] = from[d];
    v0[d] = start.v[d] + turning[d];
  }
  Quaternion now;
  Motion motion = {};
  const int steps = 2000;
  for (int k = 0; k < steps; k++) {
    std::copy_n(spin, 3, motion.spin);
    one.run(1, motion.in_body(now));
    now.turn_by(spin, STEP);
  }
  double x[3];
  now.to_space(one.lanes.place(0), x);
  // positions stand in the middle of steps, and a carrier turns with steps of its own: what is left is of second order
  for (int d = 0; d < 3; d++) EXPECT_NEAR(x[d], x0[d] + steps * STEP * v0[d], 2e-9) << d;
}

TEST(GrainLanes, LandsAndIsHeldAgain)
{
  Case one;
  one.change(0, [&](GrainLanes::Grain &g) {
    g.held = 0.0;
    g.gap = 1.0e-6;
    g.v[2] = -0.5;
  });
  one.run(190);
  EXPECT_FALSE(one.lanes.held(0));
  one.run(500);
  EXPECT_TRUE(one.lanes.held(0));
  EXPECT_NEAR(one.lanes.gap(0), -0.2747e-9, 1e-12);
}

TEST(GrainLanes, SettlesOnceItOnlyRocks)
{
  Case one;
  one.change(0, [&](GrainLanes::Grain &g) {
    g.v[0] = 1.0;
    g.spin[1] = 1.0 / RD;
  });
  int steps = 0;
  for (; one.lanes.any_awake() && steps < 100000; steps++) one.run(1, {}, STEP, true);
  // from 1 m/s at 5.7e4 m/s2
  EXPECT_NEAR(steps * STEP, 1.0 / 5.6e4, 0.3 / 5.6e4);
  double v[3];
  one.lanes.velocity(0, v);
  EXPECT_EQ(length(v), 0.0);
  const GrainLanes::Grain rest = one.lanes.get(0);
  one.run(10);
  EXPECT_EQ(one.lanes.get(0).psi[0], rest.psi[0]);    // asleep
}

TEST(GrainLanes, HowTheyAreSideBySideChangesNoBit)
{
  const int grains = 60;
  const auto run = [](bool compact) {
    Case many(meeting(), grains);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int bit = 0; bit < grains; bit++) {
      if (bit % 3) {
        many.lanes.set_awake(bit, false);
        continue;
      }
      many.change(bit, [&](GrainLanes::Grain &g) {
        for (int d = 0; d < 3; d++) {
          g.v[d] = 5.0 * any(random);
          g.spin[d] = 1.0e5 * any(random);
        }
      });
    }
    Motion motion = {{1.0e5, 0.0, -2.0e5}, {1.0e7, 0.0, 0.0}, {100.0, 200.0, 300.0}};
    for (int k = 0; k < 300; k++) {
      if (compact && k % 10 == 0) many.lanes.compact();
      const double f[3] = {1.0, 2.0, -1.0}, t[3] = {0.0, 1.0, 0.0};
      if (k == 100) many.lanes.push(1, f, 1.0e5, t, 1.0e9);    // wakes it up
      many.run(1, motion, STEP, true);
    }
    std::vector<double> all;
    for (int bit = 0; bit < grains; bit++) {
      const GrainLanes::Grain g = many.lanes.get(bit);
      all.insert(all.end(), {g.n[0], g.n[1], g.n[2], g.gap, g.v[0], g.v[1], g.v[2], g.spin[0], g.psi[0], g.y, g.held,
                             g.awake, many.lanes.place(bit)[0]});
    }
    return all;
  };
  const std::vector<double> together = run(true), apart = run(false);
  for (size_t k = 0; k < apart.size(); k++) ASSERT_EQ(together[k], apart[k]) << k / 13 << " " << k % 13;
}
