// Grains that ring in their contacts, against closed forms and a reference in tiny steps.

#include "normal_motion.h"

#include "hamaker.h"
#include "jkr.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace Dust;

namespace {

constexpr double RP = 0.75e-3, RD = 10.0e-6, MASS = 4.0 / 3.0 * M_PI * RD * RD * RD * 2700.0;
const double GAMMA = surface_energy(std::sqrt(10.1e-20 * 21.2e-20), 0.4e-9),
             MODULUS = combined_modulus(75.0e9, 0.3, 210.0e9, 0.3);
const double R12 = effective_radius(RP, RD), FC = pull_off_force(GAMMA, R12), HOLD = FC / MASS;
const double A0 = equilibrium_contact_radius(GAMMA, R12, MODULUS), D0 = equilibrium_overlap(A0, R12),
             DC = breaking_gap(A0, R12);
const double FREQUENCY = std::sqrt(1.2 * MODULUS * A0 / MASS);    // of small swings

// work along the branch to its end, in F_c delta_c, from y = sqrt(a/a0)
double work_from(double y)
{
  const auto w = [](double x) {
    return 4.0 * ROOT_6 * (0.8 * std::pow(x, 10) - 4.0 / 3.0 * std::pow(x, 7) + std::pow(x, 4) / 3.0);
  };
  return w(std::pow(6.0, -1.0 / 3.0)) - w(y);
}

void ring_out(NormalMotion &motion) { motion.advance(3.0 * motion.longest_period()); }

// one reference grain; a load comes evenly
struct Alone {
  NormalMotion motion;
  explicit Alone(double damping, double load = 0.0) : motion(damping) { motion.add(HOLD, DC, load); }
  void advance(double load, double time, int steps = 1)
  {
    for (int k = 0; k < steps; k++) motion.advance(&load, time / steps);
  }
  // at once
  void set(double load) { motion.advance(&load, 0.0); }
  // in no time
  void kick(double speed)
  {
    const double time = 1.0e-4 / FREQUENCY;
    set(-speed / (HOLD * time));
    advance(-speed / (HOLD * time), time);
    set(0.0);
  }
};

}    // namespace

TEST(NormalMotion, SmallSwingsAreThoseOfAnOscillator)
{
  EXPECT_NEAR(FREQUENCY, 2.41e7, 0.01e7);
  for (double zeta : {0.0, 0.06, 0.2, 0.7}) {
    Alone grain(zeta);
    const double speed = 1.0e-5, damped = FREQUENCY * std::sqrt(1.0 - zeta * zeta), amplitude = speed / damped;
    EXPECT_NEAR(grain.motion.overlap(0), D0, 1e-9 * D0);
    grain.kick(speed);
    for (int k = 1; k <= 60; k++) {
      grain.advance(0.0, 0.1 / FREQUENCY, 20);
      const double t = 0.1 * k / FREQUENCY, swing = amplitude * std::exp(-zeta * FREQUENCY * t) * std::sin(damped * t);
      EXPECT_NEAR(grain.motion.overlap(0) - D0, swing, 0.005 * amplitude) << "zeta " << zeta << " step " << k;
    }
  }
}

TEST(NormalMotion, LeavesWithTheEnergyOfItsBranchAndNotWithLess)
{
  const double needed = std::sqrt(2.0 * 1.5426 * FC * DC / MASS);
  EXPECT_NEAR(work_from(1.0), 1.5426, 5e-5);
  EXPECT_NEAR(needed, 9.65e-3, 0.01e-3);
  for (double share : {0.99, 1.01})
    for (double way : {-1.0, 1.0}) {    // let go, or pushed in first
      Alone grain(0.0);
      grain.kick(way * share * needed);
      ring_out(grain.motion);
      EXPECT_EQ(grain.motion.attached(0), share < 1.0) << share << " " << way;
    }
  Alone damped(1.0);
  damped.kick(-1.5 * needed);
  ring_out(damped.motion);
  EXPECT_TRUE(damped.motion.attached(0));
  EXPECT_NEAR(damped.motion.overlap(0), D0, 0.001 * D0);
}

TEST(NormalMotion, SqueezedSlowlyItStaysAndLetGoAtOnceItLeaves)
{
  // from the load where the work along the branch is that to its end
  double y = 1.0;
  for (double step = 0.5; step > 1e-12; step /= 2.0)
    if (work_from(y + step) > 0.0) y += step;
  const double load = 4.0 * (std::pow(y, 3) - std::pow(y, 6));
  EXPECT_NEAR(work_from(y), 0.0, 1e-9);
  EXPECT_LT(load, -1.0);
  for (double share : {0.98, 1.02}) {
    Alone grain(0.0, share * load);
    EXPECT_NEAR(grain.motion.overlap(0), DC * ROOT_6 * (2.0 * std::pow(y, 4) - 4.0 / 3.0 * y), 0.03 * DC);
    grain.advance(share * load, 1.0e-6);
    EXPECT_TRUE(grain.motion.attached(0));
    grain.set(0.0);
    ring_out(grain.motion);
    EXPECT_EQ(grain.motion.attached(0), share < 1.0);
  }
  // in 1000 periods: along the branch at rest, also where it is pulled; it swings by the rate of the load over the
  // frequency
  Alone grain(0.0);
  for (double to : {-50.0, 0.0, 0.9}) {
    grain.advance(to, 6000.0 / FREQUENCY);
    const double x = std::pow(0.5 * (1.0 + std::sqrt(1.0 - to)), 2.0 / 3.0);
    EXPECT_NEAR(grain.motion.overlap(0), DC * ROOT_6 * (2.0 * x * x - 4.0 / 3.0 * std::sqrt(x)), 0.05 * DC);
  }
  EXPECT_TRUE(grain.motion.attached(0));
  grain.advance(1.1, 30.0 / FREQUENCY);
  EXPECT_FALSE(grain.motion.attached(0));
}

TEST(NormalMotion, SameAsAReferenceInTinySteps)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  int left = 0, stay = 0, close = 0;
  int apart = 0;    // decided otherwise by its own steps than by finer ones
  for (int i = 0; i < 24; i++) {
    const double zeta = i % 4 == 0 ? 0.0 : i % 4 == 1 ? 1.0 : 0.2 * u(random);
    NormalMotion motion(zeta), fine(zeta);
    double hold[NormalMotion::LANES], gap[NormalMotion::LANES], k0[NormalMotion::LANES];
    for (int k = 0; k < NormalMotion::LANES; k++) {
      const double r = RD * (0.5 + u(random)), r12 = effective_radius(RP, r),
                   a0 = equilibrium_contact_radius(GAMMA, r12, MODULUS);
      const double mass = MASS * std::pow(r / RD, 3);
      hold[k] = pull_off_force(GAMMA, r12) / mass;
      gap[k] = breaking_gap(a0, r12);
      k0[k] = 1.2 * MODULUS * a0 / mass;
      motion.add(hold[k], gap[k], 0.0);
      fine.add(hold[k], gap[k], 0.0);
    }
    // a squeeze that ends in a pull, at 20 times
    const double squeeze = 60.0 * u(random), pull = 0.9 * u(random), time = (0.3 + 3.0 * u(random)) * 1.0e-6;
    std::vector<double> loads;
    for (int k = 1; k <= 20; k++) loads.push_back(pull * k / 20 - squeeze * std::sin(M_PI * k / 20));
    double before = 0.0;
    for (double load : loads) {
      const std::vector<double> all(NormalMotion::LANES, load);
      motion.advance(all.data(), time / 20);
      for (int k = 1; k <= 200; k++) {
        const std::vector<double> some(NormalMotion::LANES, before + (load - before) * k / 200);
        fine.advance(some.data(), time / 4000);
      }
      before = load;
    }
    ring_out(motion);
    ring_out(fine);
    for (int k = 0; k < NormalMotion::LANES; k++) {
      // the outermost it comes to, in overlaps of delta_c
      double d = equilibrium_overlap(1.0, 1.0) / breaking_gap(1.0, 1.0), v = 0.0, x = 1.0, last = 0.0, outermost = d;
      const int steps = 2000;
      for (int s = 0; s < 21 && outermost > -1.0; s++) {
        const double to = s < 20 ? loads[s] : last, span = s < 20 ? time / 20 : 20.0 / std::sqrt(k0[k]);
        const double h = span / steps;
        for (int j = 0; j < steps && outermost > -1.0; j++) {
          x = jkr_contact_radius(d, x);
          v += h * (-(last + (to - last) * (j + 0.5) / steps) - jkr_force(x)) * hold[k] / gap[k];
          v /= 1.0 + 2.0 * zeta * std::sqrt(k0[k]) * x * h;
          d += h * v;
          outermost = std::min(outermost, d);
        }
        last = to;
      }
      (motion.attached(k) ? stay : left)++;
      if (outermost > -1.001 && outermost < -0.95)
        close++;    // as little energy as that
      else
        EXPECT_EQ(fine.attached(k), outermost > -1.0) << "course " << i << " grain " << k << " comes to " << outermost;
      apart += motion.attached(k) != fine.attached(k);
    }
  }
  EXPECT_GT(left, 150);
  EXPECT_GT(stay, 150);
  EXPECT_LT(close, 60);
  EXPECT_LT(apart, 10);    // of 768
}

TEST(NormalMotion, OvershootTellsWhichGrowingLoadsBreakTheContact)
{
  const double unit = std::sqrt(DC / HOLD);
  double before = 0.6;
  for (double zeta : {0.0, 0.06, 0.2, 0.3, 0.5}) {
    const double c = overshoot(zeta);
    EXPECT_LT(c, 0.9 * before);
    before = c;
    // at the load that it is found at, and elsewhere by the straight line
    struct Case {
      double load, margin;
    };
    for (const Case &at : {Case{0.5, 0.01}, Case{0.2, 0.08}, Case{0.8, 0.13}}) {
      if (zeta > 0.2 && at.load != 0.5) continue;
      for (double share : {1.0 - at.margin, 1.0 + at.margin}) {
        const double slope = share * (1.0 - at.load) / c / unit, time = 50.0 * unit;
        Alone grain(zeta, at.load - 1.5 * slope * time);
        for (int k = 1; k <= 100; k++)    // from rest to the slope
          grain.advance(at.load - slope * time * (1.5 - 0.5 * k * k / 1e4), 0.01 * time);
        grain.advance(at.load, time);
        ring_out(grain.motion);
        EXPECT_EQ(grain.motion.attached(0), share < 1.0) << "zeta " << zeta << " load " << at.load << " " << share;
      }
    }
  }
  // damped well enough, the contact follows its load
  EXPECT_EQ(overshoot(0.7), 0.0);
  EXPECT_EQ(overshoot(1.0), 0.0);
}

TEST(NormalMotion, WhatIsNotANumberTakesNoEndlessSteps)
{
  for (double wrong : {double(NAN), double(INFINITY), -double(INFINITY), -1.0e300, -1.0e30}) {
    Alone grain(0.2);
    grain.advance(wrong, 1.0e-6);
    grain.set(0.0);
    ring_out(grain.motion);
    EXPECT_EQ(grain.motion.grains(), 1);
  }
}
