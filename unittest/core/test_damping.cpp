// The damping coefficient must realise its coefficient of restitution in a contact that never pulls.

#include "damping.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

// restitution of x'' = -max(0, x^p + c x^((p-1)/2) x'), integrated independently (fourth-order Runge-Kutta)
double realised(double c, double p)
{
  const auto a = [&](double x, double v) {
    if (x <= 0.0) return 0.0;
    return -std::max(0.0, std::pow(x, p) + c * std::pow(x, 0.5 * (p - 1.0)) * v);
  };
  double x = 0.0, v = 1.0;
  const double h = 1.0e-4;
  for (int i = 0; i < 1000000; i++) {
    const double v1 = v, a1 = a(x, v);
    const double v2 = v + 0.5 * h * a1, a2 = a(x + 0.5 * h * v1, v2);
    const double v3 = v + 0.5 * h * a2, a3 = a(x + 0.5 * h * v2, v3);
    const double v4 = v + h * a3, a4 = a(x + h * v3, v4);
    x += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
    v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    if (v < 0.0 && a(x, v) == 0.0) return -v;
  }
  return NAN;
}

}    // namespace

TEST(Damping, CoefficientsOfTheDocumentation)
{
  // doc/gran_damping_coeff_restitution_limited.rst prints them with three or four digits
  EXPECT_NEAR(Dust::hertz_damping(0.9), 0.0766, 0.00005);
  EXPECT_NEAR(Dust::hertz_damping(0.7), 0.2733, 0.00005);
  EXPECT_NEAR(Dust::hertz_damping(0.5), 0.571, 0.0005);
  EXPECT_NEAR(Dust::hertz_damping(0.3), 1.112, 0.0005);
  EXPECT_NEAR(Dust::hertz_damping(0.1), 2.780, 0.0005);
}

TEST(Damping, RealisesTheRestitutionOfAHertzianContact)
{
  for (double e : {0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99})
    EXPECT_NEAR(realised(Dust::hertz_damping(e), 1.5), e, 1.0e-4 * e) << "e = " << e;    // the step's error
}

TEST(Damping, RealisesTheRestitutionOfAHookeanContact)
{
  for (double e : {0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99})
    EXPECT_NEAR(realised(Dust::hooke_damping(e), 1.0), e, 1.0e-4 * e) << "e = " << e;
}

TEST(Damping, LimitsAndTheSeamBetweenTheTwoForms)
{
  EXPECT_EQ(Dust::damping_ratio(1.0), 0.0);
  const double seam = std::exp(-2.0);    // critical damping
  EXPECT_NEAR(Dust::damping_ratio(seam), 1.0, 1.0e-7);
  EXPECT_NEAR(Dust::damping_ratio(seam * (1.0 - 1.0e-9)), 1.0, 1.0e-7);
  EXPECT_NEAR(Dust::damping_ratio(seam * (1.0 + 1.0e-9)), 1.0, 1.0e-7);
  for (double e = 0.01; e < 0.995; e += 0.01) EXPECT_GT(Dust::damping_ratio(e), Dust::damping_ratio(e + 0.005));
}
