// Where a carrier was and how fast, before the end of its collision.

#include "retrospect.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace Dust;

TEST(Retrospect, AConstantForce)
{
  // v = v1 - a s, x = x1 - s v1 + a s^2/2
  ImpulseRecord record;
  const double a[3] = {2.0, 0.0, -6.0}, spin[3] = {0.0, 0.0, 0.0};
  for (int k = 0; k < 10; k++) record.add(a, spin, 0.1);
  const Retrospect past(record);
  for (double s : {0.0, 0.05, 0.1, 0.55, 0.99, 1.0, 1.5}) {
    double u[3], r[3];
    past.at(s, u, r);
    const double t = std::min(s, 1.0);
    for (int d = 0; d < 3; d++) {
      EXPECT_NEAR(u[d], -a[d] * t, 1e-14);
      EXPECT_NEAR(r[d], 0.5 * a[d] * t * t, 1e-14);
    }
  }
}

TEST(Retrospect, EachStepOfACourseThatTurns)
{
  // a carrier moved by steps of constant acceleration, and what it says of any moment
  for (int steps : {1, 7, 64, 65, 1000}) {
    const double dt = 1.0 / steps, spin[3] = {0.0, 0.0, 0.0};
    const auto force = [](double t, double *a) {
      a[0] = std::sin(7.0 * t);
      a[1] = 3.0 * t * t;
      a[2] = -4.0 * t * (1.0 - t);
    };
    ImpulseRecord record;
    std::vector<double> x = {1.0, 2.0, 3.0}, v = {-1.0, 0.5, 0.2};
    std::vector<std::vector<double>> places = {x}, speeds = {v};
    for (int k = 0; k < steps; k++) {
      double a[3];
      force((k + 0.5) * dt, a);
      record.add(a, spin, dt);
      for (int d = 0; d < 3; d++) {
        x[d] += dt * (v[d] + 0.5 * dt * a[d]);
        v[d] += dt * a[d];
      }
      places.push_back(x);
      speeds.push_back(v);
    }
    const Retrospect past(record);
    // a record of spans is of second order in their length; of its own steps it is exact
    const double tolerance = steps <= ImpulseRecord::MAX_SPANS ? 1e-13 : 2e-3;
    for (int k = 0; k <= steps; k++) {
      double u[3], r[3];
      const double s = (steps - k) * dt;
      past.at(s, u, r);
      for (int d = 0; d < 3; d++) {
        EXPECT_NEAR(v[d] + u[d], speeds[k][d], tolerance) << steps << " " << k;
        EXPECT_NEAR(x[d] - s * v[d] + r[d], places[k][d], tolerance) << steps << " " << k;
      }
    }
  }
}
