// What the table says of the grains of a texture.

#include "grain_table.h"

#include "geometry.h"
#include "reference_case.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace Dust;

TEST(GrainTable, EqualGrainsWeighExactlyOne)
{
  const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  const GrainTable table(texture, CALCITE, Criteria());
  for (int bit = 0; bit < table.grains(); bit++) ASSERT_EQ(table.weight(bit), 1.0);
  EXPECT_NEAR(table.mean_mass(), 1.1310e-11, 0.5e-15);    // 4/3 pi R^3 rho
  EXPECT_NEAR(table.min_hold(), 1.330e5, 0.5e2);
  EXPECT_EQ(table.words(), 71);
}

TEST(GrainTable, WhatMightMoveIsAskedFromSquares)
{
  // false only if may_move() is; not by much more than the factor sqrt(3) too often; true of what is not a number
  const GrainTable table(place_monolayer(RP, RD, 0.2, BareCap(), 1), CALCITE, Criteria());
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const double mass = 1.36e-5, inertia = 0.4 * mass * RP * RP;
  int may = 0, not_even_might = 0;
  for (int i = 0; i < 20000; i++) {
    Motion m;
    double force2 = 0.0, torque2 = 0.0;
    const double size = 0.5 * table.moving_force() * std::exp(normal(random));
    for (int d = 0; d < 3; d++) {
      m.acceleration[d] = size * normal(random);
      m.angular_acceleration[d] = i % 2 * size / SHELL * normal(random);
      m.spin[d] = i % 3 * 0.3 * std::sqrt(size / SHELL) * normal(random);
      force2 += std::pow(mass * m.acceleration[d], 2);
      torque2 += std::pow(inertia * m.angular_acceleration[d], 2);
    }
    const bool might = table.might_move(force2, torque2, dot(m.spin, m.spin), mass);
    if (table.may_move(m)) {
      EXPECT_TRUE(might);
    }
    may += table.may_move(m);
    not_even_might += !might;
    for (double *x : {m.acceleration, m.angular_acceleration, m.spin}) {
      const double kept = x[1];
      EXPECT_TRUE(m.is_finite());
      for (double wrong : {double(NAN), double(INFINITY), -double(INFINITY)}) {
        x[1] = wrong;
        EXPECT_FALSE(m.is_finite());
      }
      x[1] = kept;
    }
  }
  EXPECT_GT(may, 5000);
  EXPECT_GT(not_even_might, 2000);
  EXPECT_TRUE(table.might_move(NAN, 0.0, 0.0, mass));
  EXPECT_TRUE(table.might_move(0.0, NAN, 0.0, mass));
  EXPECT_TRUE(table.might_move(0.0, 0.0, NAN, mass));
  EXPECT_FALSE(table.might_move(0.0, 0.0, 0.0, mass));
}
