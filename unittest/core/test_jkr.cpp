// The full branch of the adhesive contact: check points, inverse and work, by hand from the equations of jkr.h.

#include "jkr.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

const double ROOT = std::cbrt(6.0);

double overlap(double x) { return ROOT * (2.0 * x * x - 4.0 / 3.0 * std::sqrt(x)); }

// integral of F/F_c over delta/delta_c between two contact radii, in x, as the branch is vertical in delta at its end
double work(double from, double to)
{
  const int n = 20000;
  const double h = (to - from) / n;
  double sum = 0.0;
  for (int i = 0; i < n; i++) {
    const double x = from + (i + 0.5) * h;
    sum += Dust::jkr_force(x) * ROOT * (4.0 * x - 2.0 / 3.0 / std::sqrt(x)) * h;
  }
  return sum;
}

}    // namespace

TEST(Jkr, CheckPoints)
{
  EXPECT_NEAR(Dust::jkr_contact_radius(0.0), std::pow(2.0 / 3.0, 2.0 / 3.0), 1e-10);
  EXPECT_NEAR(Dust::jkr_force(Dust::jkr_contact_radius(0.0)), -8.0 / 9.0, 1e-10);
  const double pull_off = std::pow(4.0, -1.0 / 3.0);
  EXPECT_NEAR(Dust::jkr_force(pull_off), -1.0, 1e-10);
  EXPECT_NEAR(overlap(pull_off), -0.4807, 0.5e-4);    // as printed
  EXPECT_NEAR(Dust::jkr_contact_radius(overlap(pull_off)), pull_off, 1e-10);
  const double end = std::pow(6.0, -2.0 / 3.0);
  EXPECT_NEAR(overlap(end), -1.0, 1e-10);
  EXPECT_NEAR(Dust::jkr_force(end), -5.0 / 9.0, 1e-10);
  EXPECT_NEAR(Dust::jkr_force(Dust::jkr_contact_radius(-1.0)), -5.0 / 9.0, 1e-7);    // x has half the digits there
  EXPECT_NEAR(Dust::jkr_force(1.0), 0.0, 1e-10);
}

TEST(Jkr, ReferenceGrain)
{
  const double r12 = 9.8684e-6, a0 = 90.18e-9;
  EXPECT_NEAR(Dust::equilibrium_overlap(a0, r12), 0.2747e-9, 0.5e-13);
  EXPECT_NEAR(Dust::breaking_gap(a0, r12), 0.2267e-9, 1e-13);    // printed with its last digit cut
  // both follow from the branch: x = 1
  EXPECT_NEAR(Dust::equilibrium_overlap(a0, r12) / Dust::breaking_gap(a0, r12), overlap(1.0), 1e-14);
}

// from whatever guess: below, at and above the answer, off the branch, without a meaning
TEST(Jkr, InverseFromAGuess)
{
  for (double t = -40.0; t < 12.0; t += 0.01) {
    const double d = std::exp(t) - 1.0;
    const double x = Dust::jkr_contact_radius(d);
    for (const double guess : {x, -x, 0.99 * x, 1.01 * x, 0.1 * x, 10.0 * x, 0.0, 1.0, 1e300, std::nan("")}) {
      const double found = Dust::jkr_contact_radius(d, guess);
      ASSERT_LE(std::fabs(overlap(found) - d), 1e-14 * std::max(1.0, d)) << "d = " << d << ", guess " << guess;
      // sqrt(2 residual / curvature) at the end of the branch, where the slope vanishes
      ASSERT_NEAR(found, x, d >= -0.99 ? 1e-12 * std::max(1.0, x) : 1e-7) << "d = " << d << ", guess " << guess;
    }
  }
}

TEST(Jkr, InverseOverTheWholeBranch)
{
  // round-off of delta/delta_c itself is what is left where it is large
  for (double t = -40.0; t < 12.0; t += 0.001) {
    const double d = std::exp(t) - 1.0;
    const double x = Dust::jkr_contact_radius(d);
    ASSERT_LE(std::fabs(overlap(x) - d), 1e-14 * std::max(1.0, d)) << "d = " << d;
    ASSERT_GE(x, std::pow(6.0, -2.0 / 3.0) * (1.0 - 1e-15));
  }
  for (double x = 0.338; x < 30.0; x *= 1.0003)
    if (overlap(x) >= -0.99) {
      ASSERT_NEAR(Dust::jkr_contact_radius(overlap(x)), x, 1e-12 * std::max(1.0, x)) << "x = " << x;
    }
  EXPECT_EQ(Dust::jkr_contact_radius(-1.5), Dust::jkr_contact_radius(-1.0));    // the neck has broken
}

TEST(Jkr, ContactRadiusGrowsWithTheOverlap)
{
  double last = 0.0;
  for (double d = -1.0; d < 50.0; d += 0.001) {
    const double x = Dust::jkr_contact_radius(d);
    ASSERT_GE(x, last);
    last = x;
  }
}

TEST(Jkr, WorkOfAdhesionAlongTheBranch)
{
  const double end = std::pow(6.0, -2.0 / 3.0);
  EXPECT_NEAR(-work(end, Dust::jkr_contact_radius(0.0)), 0.9355, 0.0005);
  EXPECT_NEAR(-work(end, 1.0), 1.5426, 0.0005);
}
