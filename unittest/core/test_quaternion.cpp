// Orientations: against rotations that are known, and the distribution of the random ones.

#include "geometry.h"
#include "quaternion.h"

#include <gtest/gtest.h>

#include <cmath>

using Dust::Quaternion;

namespace {

void expect_vector(const double *v, double x, double y, double z, double tolerance)
{
  EXPECT_NEAR(v[0], x, tolerance);
  EXPECT_NEAR(v[1], y, tolerance);
  EXPECT_NEAR(v[2], z, tolerance);
}

}    // namespace

TEST(Quaternion, AQuarterTurnAboutZBringsXToY)
{
  Quaternion q;
  const double spin[3] = {0.0, 0.0, 0.5 * Dust::PI}, x[3] = {1.0, 0.0, 0.0};
  q.turn_by(spin, 1.0);
  double v[3];
  q.to_space(x, v);
  expect_vector(v, 0.0, 1.0, 0.0, 1e-15);
  q.to_body(x, v);
  expect_vector(v, 0.0, -1.0, 0.0, 1e-15);
}

// spin about a fixed axis: a million small steps end where one large one does; the round-off of steps adds up as a
// random walk, 1e-16 sqrt(1e6)
TEST(Quaternion, SmallStepsAddUp)
{
  const double spin[3] = {300.0, -200.0, 500.0}, v[3] = {0.2, 0.5, -0.7};
  Quaternion many, one;
  for (int i = 0; i < 1000000; i++) many.turn_by(spin, 1.0e-8);
  one.turn_by(spin, 1.0e-2);
  double a[3], b[3];
  many.to_space(v, a);
  one.to_space(v, b);
  expect_vector(a, b[0], b[1], b[2], 1e-11);
  EXPECT_NEAR(Dust::dot(a, a), Dust::dot(v, v), 1e-14);
}

TEST(Quaternion, ProductTurnsByTheSecondFirst)
{
  Quaternion a, b;
  const double sa[3] = {0.3, 0.7, -1.0}, sb[3] = {-0.8, 0.1, 0.4}, v[3] = {1.0, 2.0, 3.0};
  a.turn_by(sa, 1.0);
  b.turn_by(sb, 1.0);
  double w[3], both[3];
  b.to_space(v, w);
  a.to_space(w, w);
  (a * b).to_space(v, both);
  expect_vector(both, w[0], w[1], w[2], 1e-14);
  (a.inverse() * a).to_space(v, both);
  expect_vector(both, v[0], v[1], v[2], 1e-14);
}

// a turned axis is uniform on the sphere and the angle of turn has the density (1 - cos)/pi, so that cos(angle/2)^2 =
// w^2 has the mean 1/4; standard errors at 20,000: 0.004 for a component, 0.002 for w^2. Four of them.
TEST(Quaternion, RandomOrientationsAreEquallyLikely)
{
  const int n = 20000;
  double mean[3] = {}, square[3] = {}, w2 = 0.0;
  for (int i = 0; i < n; i++) {
    const Quaternion q = Dust::random_orientation(7, i + 1);
    const double x[3] = {1.0, 0.0, 0.0};
    double v[3];
    q.to_space(x, v);
    ASSERT_NEAR(Dust::dot(v, v), 1.0, 1e-14);
    for (int d = 0; d < 3; d++) {
      mean[d] += v[d] / n;
      square[d] += v[d] * v[d] / n;
    }
    w2 += q.q[0] * q.q[0] / n;
  }
  expect_vector(mean, 0.0, 0.0, 0.0, 0.016);
  expect_vector(square, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 0.009);
  EXPECT_NEAR(w2, 0.25, 0.008);
}

TEST(Quaternion, RandomOrientationDependsOnBothNumbersAlone)
{
  const Quaternion a = Dust::random_orientation(3, 5), same = Dust::random_orientation(3, 5);
  for (int i = 0; i < 4; i++) EXPECT_EQ(a.q[i], same.q[i]);
  EXPECT_NE(a.q[0], Dust::random_orientation(5, 3).q[0]);
  EXPECT_NE(a.q[0], Dust::random_orientation(3, 6).q[0]);
}
