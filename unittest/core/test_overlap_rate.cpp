// Rate of the overlap as a damping force needs it, in velocity Verlet, against closed forms.

#include "overlap_rate.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

// x'' = load - omega^2 x - decay x' by velocity Verlet from x = 0, x' = speed; x at the end
double verlet(double omega, double decay, double load, double speed, double end, int steps)
{
  const double dt = end / steps;
  Dust::OverlapRate rate = {};
  double x = 0.0, v = speed, a = load - decay * v;
  for (int k = 0; k < steps; k++) {
    v += 0.5 * dt * a;
    x += dt * v;
    if (k == 0)
      rate.begin(x, v, decay, dt);
    else
      rate.advance(x, decay, dt);
    a = load - omega * omega * x - decay * rate.rate;
    v += 0.5 * dt * a;
  }
  return x;
}

}    // namespace

TEST(OverlapRate, SecondOrderInTheTimeStep)
{
  // damped oscillation about load/omega^2
  const double omega = 1.0, load = 0.3, speed = 1.0, end = 5.0;
  for (double zeta : {0.1, 0.5, 2.0}) {
    const double decay = 2.0 * zeta * omega, rest = load / (omega * omega);
    double exact;
    if (zeta < 1.0) {
      const double w = omega * std::sqrt(1.0 - zeta * zeta);
      exact = rest + std::exp(-zeta * omega * end) *
                         (-rest * std::cos(w * end) + (speed - zeta * omega * rest) / w * std::sin(w * end));
    } else {
      const double root = omega * std::sqrt(zeta * zeta - 1.0), slow = -zeta * omega + root,
                   fast = -zeta * omega - root;
      const double b = (speed + slow * rest) / (fast - slow);
      exact = rest + (-rest - b) * std::exp(slow * end) + b * std::exp(fast * end);
    }
    double before = 0.0;
    for (int steps : {200, 400, 800}) {
      const double error = std::fabs(verlet(omega, decay, load, speed, end, steps) - exact);
      EXPECT_LT(error, 1e-3);
      if (before > 0.0) {
        EXPECT_NEAR(before / error, 4.0, 0.4) << zeta << " " << steps;
      }
      before = error;
    }
  }
}

TEST(OverlapRate, StableHoweverStrongTheDamping)
{
  for (double decay : {1.0, 10.0, 1e3, 1e6}) {    // per step of 1
    Dust::OverlapRate rate = {};
    double x = 0.0, v = 1.0, fastest = 0.0;
    rate.begin(x, v, decay, 1.0);
    for (int k = 0; k < 100; k++) {
      v -= decay * rate.rate;
      x += v;
      rate.advance(x, decay, 1.0);
      fastest = std::fabs(v);
      ASSERT_LT(fastest, 1.0) << decay << " " << k;
    }
    if (decay < 100.0) {
      EXPECT_LT(fastest, 1e-10) << decay;
    }
  }
}

TEST(OverlapRate, NoneWhereTheOverlapStays)
{
  Dust::OverlapRate rate = {};
  rate.begin(1e-9, 0.0, 5e7, 1e-9);
  for (int k = 0; k < 3; k++) {
    rate.advance(1e-9, 5e7, 1e-9);
    EXPECT_EQ(rate.rate, 0.0);
  }
}
