// Grains that slide and roll over their carrier, against a reference that follows each alone in tiny steps, and against
// closed forms.

#include "surface_motion.h"

#include "surface_reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

using namespace Dust;

namespace {

// one grain on a wall, nearly: a carrier so large that its surface is flat. Normal z, pushed along x
struct OnAPlane {
  static constexpr double CARRIER = 1.0e3;
  SurfaceMotion motion;
  OnAPlane(double friction, double rolling) : motion(friction, rolling)
  {
    const double n[3] = {0.0, 0.0, 1.0};
    motion.add(n, HOLD, RD, CARRIER, NO_SPIN);
  }
  // the inertia force pushes with `push`
  void advance(double push, double time, int steps)
  {
    const double a[3] = {-push, 0.0, 0.0};
    for (int k = 0; k < steps; k++) motion.advance(a, NO_SPIN, time / steps);
  }
  double w() const { return motion.velocity(0, 0); }
  double p() const { return motion.rolling_velocity(0, 0); }
  double psi() const { return motion.rolling_angle(0, 0); }
  double energy() const { return 0.5 * w() * w() + 0.2 * p() * p() + 0.5 * RD * STIFFNESS * psi() * psi(); }
  static constexpr double STIFFNESS_IN_HOLD = 4.0;    // s = k/m without load
  static inline const double STIFFNESS = STIFFNESS_IN_HOLD * HOLD;
};

}    // namespace

TEST(SurfaceMotion, SameGrainsAsAReferenceOnACarrierThatTurns)
{
  std::mt19937 random(4);
  int left = 0, stay = 0, close = 0;
  for (int i = 0; i < 150; i++) {
    Material m = CALCITE;
    m.friction = i % 5 == 4 ? 0.0 : i % 5 == 3 ? 5.0 : 0.1 + 0.1 * (i % 4);
    m.rolling = i % 4 == 2 ? 0.0 : i % 2 == 1 ? 3.0 : 0.15;
    const History h = random_history(random, 0.5 * std::sqrt(HOLD / SHELL));
    SurfaceMotion motion(m.friction, m.rolling);
    std::vector<double> loads;
    while (!motion.full()) {
      const Vec n = random_direction(random);
      const Grain grain = {{n.x, n.y, n.z}, RD * (0.5 + 0.03 * motion.grains())};
      const double hold =
          HOLD * effective_radius(RP, grain.radius) / effective_radius(RP, RD) * std::pow(RD / grain.radius, 3);
      motion.add(grain.n, hold, grain.radius, RP, &h.spin0.x);
      loads.push_back(largest_load(grain, RP, m, h));
    }
    for (size_t k = 0; k < h.a.size(); k++) {
      const Vec spin = h.spin_after(k);
      motion.advance(&h.a[k].x, &spin.x, h.dt);
    }
    motion.release();
    for (int k = 0; k < motion.grains(); k++) {
      (motion.attached(k) ? stay : left)++;
      if (std::fabs(loads[k] - 1.0) < 0.005)
        close++;
      else
        EXPECT_EQ(motion.attached(k), loads[k] < 1.0) << "collision " << i << " grain " << k << " load " << loads[k];
    }
  }
  EXPECT_GT(left, 1000);
  EXPECT_GT(stay, 1000);
  EXPECT_LT(close, 60);
}

TEST(SurfaceMotion, WithoutFrictionAGrainKeepsItsVelocity)
{
  OnAPlane grain(0.0, 0.15);
  grain.advance(1.0e6, 3.0e-6, 50);
  EXPECT_NEAR(grain.w(), 3.0, 1e-9);
  EXPECT_EQ(grain.p(), 0.0);
}

TEST(SurfaceMotion, RollingWithoutResistanceGivesFiveSevenths)
{
  OnAPlane grain(10.0, 0.0);
  grain.advance(1.0e6, 3.0e-6, 50);
  EXPECT_NEAR(grain.w(), 5.0 / 7.0 * 3.0, 1e-9);
  EXPECT_NEAR(grain.p(), grain.w(), 1e-9);
}

TEST(SurfaceMotion, SlidingIsBrakedByTheLimitOfFriction)
{
  // pushed faster than it can roll: no slip would need 2/7 of the push
  OnAPlane grain(0.3, 0.0);
  const double push = 20.0 * HOLD, brake = 0.3 * 2.0 * HOLD, time = 1.0e-6;
  ASSERT_GT(2.0 / 7.0 * push, brake);
  grain.advance(push, time, 50);
  EXPECT_NEAR(grain.w(), (push - brake) * time, 1e-8);
  EXPECT_NEAR(grain.p(), 2.5 * brake * time, 1e-8);
  // then left alone until it rolls: w + (2/5) p does not change
  const double kept = grain.w() + 0.4 * grain.p();
  grain.advance(0.0, 40.0e-6, 4000);
  EXPECT_NEAR(grain.w(), kept / 1.4, 1e-8);
  EXPECT_NEAR(grain.p(), grain.w(), 1e-8);
}

TEST(SurfaceMotion, LoadOnTheContactRaisesTheLimit)
{
  // pressed on with g_n = -3 c: the limit is mu (2 c + 3 c)
  OnAPlane grain(0.3, 0.0);
  const double a[3] = {-40.0 * HOLD, 0.0, 3.0 * HOLD}, time = 1.0e-6;
  for (int k = 0; k < 50; k++) grain.motion.advance(a, NO_SPIN, time / 50);
  EXPECT_NEAR(grain.w(), (40.0 - 0.3 * 5.0) * HOLD * time, 1e-6);
}

TEST(SurfaceMotion, AGrainBelowTheLimitsRocksAboutItsPlace)
{
  // no slip: w' = (5/7) (push - s psi), psi' = w/R_d, an oscillator
  OnAPlane grain(0.3, 0.15);
  const double push = 0.2 * HOLD, period = 2.0 * M_PI * std::sqrt(7.0 * RD / (5.0 * OnAPlane::STIFFNESS));
  EXPECT_NEAR(period, 32.3e-6, 0.1e-6);
  grain.advance(push, 0.5 * period, 200);
  EXPECT_NEAR(grain.psi(), 2.0 * push / OnAPlane::STIFFNESS, 1e-4 * 0.1);
  EXPECT_GT(grain.psi(), 0.09);
  EXPECT_NEAR(grain.w(), 0.0, 1e-3);
  grain.advance(push, 0.5 * period, 200);
  EXPECT_NEAR(grain.psi(), 0.0, 1e-4 * 0.1);
  EXPECT_NEAR(grain.w(), 0.0, 1e-3);
  EXPECT_TRUE(grain.motion.attached(0));
  // nothing moves it at all: it stays as it is
  OnAPlane still(0.3, 0.15);
  still.advance(0.0, period, 200);
  EXPECT_EQ(still.w(), 0.0);
  EXPECT_EQ(still.psi(), 0.0);
}

TEST(SurfaceMotion, LoadOnTheContactStiffensItsRolling)
{
  // s = 2 c (1 + sqrt(1 - g_n/c)): 8 c where it is pressed on with g_n = -8 c, 3 c where it is pulled with 3/4 c
  for (const auto &[gn, stiffness] : {std::pair<double, double>{-8.0, 8.0}, {0.75, 3.0}}) {
    OnAPlane grain(1.0, 0.15);
    const double push = 0.1 * HOLD, s = stiffness * HOLD, half = M_PI * std::sqrt(7.0 * RD / (5.0 * s));
    const double a[3] = {-push, 0.0, -gn * HOLD};
    for (int k = 0; k < 400; k++) grain.motion.advance(a, NO_SPIN, half / 400);
    EXPECT_NEAR(grain.psi(), 2.0 * push / s, 1e-4 * push / s);
    EXPECT_NEAR(grain.w(), 0.0, 1e-3);
  }
}

TEST(SurfaceMotion, RollingResistanceIsHeldAtThePivotsAngle)
{
  // far beyond it: w' = (5/7) (push - s theta_crit)
  OnAPlane grain(5.0, 0.02);
  grain.advance(2.0 * HOLD, 10.0e-6, 200);
  EXPECT_GE(grain.psi(), 0.02);
  EXPECT_LE(grain.psi(), 0.02 + 0.5 * 5.0e-8 * grain.p() / RD + 1e-12);    // held in the middle of each step
  const double before = grain.w();
  grain.advance(2.0 * HOLD, 1.0e-6, 20);
  EXPECT_NEAR(grain.w() - before, 5.0 / 7.0 * (2.0 - 4.0 * 0.02) * HOLD * 1.0e-6, 1e-6);
}

TEST(SurfaceMotion, EnergyIsKeptInRollingAndNeverMadeBySliding)
{
  OnAPlane grain(1.0, 10.0);
  grain.advance(1.0 * HOLD, 3.0e-6, 100);
  const double start = grain.energy();
  EXPECT_GT(start, 0.01);
  for (int k = 0; k < 50; k++) {
    grain.advance(0.0, 1.0e-6, 20);
    EXPECT_NEAR(grain.energy(), start, 0.005 * start);    // psi is half a step ahead of nothing: second order
  }
  OnAPlane slides(0.02, 0.15);
  slides.advance(10.0 * HOLD, 2.0e-6, 100);
  double last = slides.energy();
  const double first = last;
  for (int k = 0; k < 50; k++) {
    slides.advance(0.0, 1.0e-6, 20);
    EXPECT_LE(slides.energy(), last * (1.0 + 1e-3));
    last = slides.energy();
  }
  EXPECT_LT(last, 0.9 * first);
}

TEST(SurfaceMotion, AGrainLeavesWhereItsMotionOutweighsAdhesion)
{
  // no friction, a slow kick along the surface: it leaves at |w|^2/|r_pd| = c
  const double n[3] = {0.0, 0.0, 1.0}, a[3] = {-1.0e6, 0.0, 0.0};
  SurfaceMotion motion(0.0, 0.15);
  motion.add(n, HOLD, RD, RP, NO_SPIN);
  for (int k = 0; k < 4000 && motion.attached(0); k++) motion.advance(a, NO_SPIN, 5.0e-9);
  ASSERT_FALSE(motion.attached(0));
  double w[3], at[3];
  for (int d = 0; d < 3; d++) {
    w[d] = motion.velocity(0, d);
    at[d] = motion.direction(0, d);
  }
  const double w2 = w[0] * w[0] + w[1] * w[1] + w[2] * w[2], lift = w2 / (RP + RD) - a[0] * at[0];
  EXPECT_NEAR(lift, HOLD, 0.01 * HOLD);
  const double before = w[0];
  motion.advance(a, NO_SPIN, 5.0e-9);    // gone: not moved any more
  EXPECT_EQ(motion.velocity(0, 0), before);
}

TEST(SurfaceMotion, GrainsAfterTheContactAreAskedOnceMore)
{
  // pressed on until the end, with a velocity that adhesion alone cannot hold
  const double n[3] = {0.0, 0.0, 1.0};
  SurfaceMotion motion(0.0, 0.15);
  motion.add(n, HOLD, RD, RP, NO_SPIN);
  const double a[3] = {-11.0e6, 0.0, 20.0 * HOLD};
  for (int k = 0; k < 100; k++) motion.advance(a, NO_SPIN, 1.0e-8);
  EXPECT_TRUE(motion.attached(0));
  motion.release();
  EXPECT_FALSE(motion.attached(0));
}

TEST(SurfaceMotion, GrainsDoNotDependOnTheirNeighbours)
{
  std::mt19937 random(5);
  const History h = random_history(random, 5.0e3);
  const Texture texture = place_monolayer(RP, 40.0e-6, 0.15, BareCap(), 2);
  SurfaceMotion together(0.3, 0.15);
  for (int k = 0; k < SurfaceMotion::LANES; k++)
    together.add(texture.grains[k].n, HOLD * (1.0 + k), RD / (1.0 + k), RP, &h.spin0.x);
  EXPECT_TRUE(together.full());
  for (size_t k = 0; k < h.a.size(); k++) together.advance(&h.a[k].x, &h.spin[k].x, h.dt);
  for (int k = 0; k < SurfaceMotion::LANES; k++) {
    SurfaceMotion alone(0.3, 0.15);
    alone.add(texture.grains[k].n, HOLD * (1.0 + k), RD / (1.0 + k), RP, &h.spin0.x);
    for (size_t i = 0; i < h.a.size(); i++) alone.advance(&h.a[i].x, &h.spin[i].x, h.dt);
    EXPECT_EQ(alone.attached(0), together.attached(k));
    for (int d = 0; d < 3; d++) EXPECT_EQ(alone.velocity(0, d), together.velocity(k, d));
  }
}

TEST(SurfaceMotion, AGrainAtTheEquatorTurnsWithItsCarrier)
{
  const double n[3] = {1.0, 0.0, 0.0}, still[3] = {0.0, 0.0, 0.0}, spin[3] = {0.0, 0.0, 0.95 * std::sqrt(HOLD / SHELL)};
  SurfaceMotion motion(0.3, 0.15);
  motion.add(n, HOLD, RD, RP, spin);
  const double angle = 10.0;    // rad
  for (int k = 0; k < 10000; k++) motion.advance(still, spin, angle / spin[2] / 10000);
  EXPECT_TRUE(motion.attached(0));
  EXPECT_NEAR(motion.direction(0, 0), std::cos(angle), 1e-5);    // tan(angle/20000) for angle/20000, twice a step
  EXPECT_NEAR(motion.direction(0, 1), std::sin(angle), 1e-5);
  EXPECT_EQ(motion.direction(0, 2), 0.0);
  const double speed = spin[2] * SHELL;
  EXPECT_NEAR(motion.velocity(0, 0), -speed * motion.direction(0, 1), 1e-12 * speed);
  EXPECT_NEAR(motion.velocity(0, 1), speed * motion.direction(0, 0), 1e-12 * speed);
  EXPECT_NEAR(motion.rolling_velocity(0, 1), spin[2] * RD * motion.direction(0, 0), 1e-12 * speed);
  for (int d = 0; d < 3; d++) EXPECT_NEAR(motion.rolling_angle(0, d), 0.0, 1e-14);
}

TEST(SurfaceMotion, AwayFromTheEquatorItRocksAboutWhereTheCentrifugalForceHoldsIt)
{
  // without slip (7/5) v' = T - s psi, T = |r_pd| omega^2 sin cos: after half a period psi = 2 T/s
  const double spin[3] = {0.0, 0.0, 1.0e3}, n[3] = {std::sqrt(0.5), 0.0, std::sqrt(0.5)}, still[3] = {0.0, 0.0, 0.0};
  const double push = 0.5 * SHELL * spin[2] * spin[2], s = 4.0 * HOLD * RP / SHELL;
  SurfaceMotion motion(0.3, 0.15);
  motion.add(n, HOLD, RD, RP, spin);
  for (int k = 0; k < 400; k++) motion.advance(still, spin, M_PI * std::sqrt(7.0 * RD / (5.0 * s)) / 400);
  const Vec psi = {motion.rolling_angle(0, 0), motion.rolling_angle(0, 1), motion.rolling_angle(0, 2)};
  EXPECT_NEAR(size(psi), 2.0 * push / s, 0.005 * push / s);
  EXPECT_LT(psi.z, 0.0);    // to the equator
}

TEST(SurfaceMotion, WithoutFrictionAGrainLeavesTheTurningCarrierBehind)
{
  // on a great circle, with the velocity it had
  const double spin[3] = {0.0, 0.0, 5.0e3}, n[3] = {std::sqrt(0.5), 0.0, std::sqrt(0.5)}, still[3] = {0.0, 0.0, 0.0};
  SurfaceMotion motion(0.0, 0.0);
  motion.add(n, HOLD, RD, RP, spin);
  const double angle = 0.3;
  for (int k = 0; k < 1000; k++) motion.advance(still, spin, angle / (spin[2] * std::sqrt(0.5)) / 1000);
  EXPECT_NEAR(motion.direction(0, 0), std::sqrt(0.5) * std::cos(angle), 1e-4);
  EXPECT_NEAR(motion.direction(0, 1), std::sin(angle), 1e-4);
  EXPECT_NEAR(motion.direction(0, 2), std::sqrt(0.5) * std::cos(angle), 1e-4);
  const double speed = spin[2] * SHELL * std::sqrt(0.5);
  EXPECT_NEAR(motion.velocity(0, 1), speed * std::cos(angle), 2e-4 * speed);
}

TEST(SurfaceMotion, ACarrierSpunUpThrowsGrainsOffItsEquatorOnly)
{
  // slowly enough that they follow
  const double equator[3] = {0.0, 1.0, 0.0}, axis[3] = {0.0, 0.0, -1.0}, still[3] = {0.0, 0.0, 0.0};
  for (double share : {0.995, 1.005}) {
    SurfaceMotion motion(0.3, 0.15);
    motion.add(equator, HOLD, RD, RP, still);
    motion.add(axis, HOLD, RD, RP, still);
    const int steps = 40000;
    for (int k = 1; k <= steps; k++) {
      const double spin[3] = {0.0, 0.0, share * std::sqrt(HOLD / SHELL) * k / steps};
      motion.advance(still, spin, 1.0e-3 / steps);
    }
    motion.release();
    EXPECT_EQ(motion.attached(0), share < 1.0);
    EXPECT_TRUE(motion.attached(1));
    EXPECT_EQ(motion.velocity(1, 0), 0.0);
  }
}

TEST(SurfaceMotion, DoesNotDependOnTheAxes)
{
  std::mt19937 random(8);
  const auto turned = [](const Vec &v) {
    return Vec{0.36 * v.x + 0.48 * v.y - 0.8 * v.z, -0.8 * v.x + 0.6 * v.y, 0.48 * v.x + 0.64 * v.y + 0.6 * v.z};
  };
  for (int i = 0; i < 20; i++) {
    const History h = random_history(random, 5.0e3);
    SurfaceMotion one(0.3, 0.15), other(0.3, 0.15);
    while (!one.full()) {
      const Vec n = random_direction(random), m = turned(n), spin = turned(h.spin0);
      one.add(&n.x, HOLD, RD, RP, &h.spin0.x);
      other.add(&m.x, HOLD, RD, RP, &spin.x);
    }
    for (size_t k = 0; k < h.a.size(); k++) {
      const Vec a = turned(h.a[k]), spin = turned(h.spin[k]);
      one.advance(&h.a[k].x, &h.spin[k].x, h.dt);
      other.advance(&a.x, &spin.x, h.dt);
    }
    for (int k = 0; k < one.grains(); k++) {
      EXPECT_EQ(one.attached(k), other.attached(k));
      const Vec v = turned({one.velocity(k, 0), one.velocity(k, 1), one.velocity(k, 2)});
      EXPECT_NEAR(size(v - Vec{other.velocity(k, 0), other.velocity(k, 1), other.velocity(k, 2)}), 0.0, 1e-10);
    }
  }
}
