// Whole collisions against a reference that visits every grain at every step, and against closed forms.

#include "collision.h"

#include "adhesion_spread.h"

#include "collision_reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

using namespace Dust;

TEST(Collision, SameGrainsAsBruteForceInTenThousandRandomCollisions)
{
  std::mt19937 random(1);
  const Texture texture = place_monolayer(RP, 40.0e-6, 0.15, BareCap(), 2);    // 211 grains: four patches, one not full
  Material m = CALCITE;
  m.gamma *=
      std::pow(40.0e-6 / RD, 2) * effective_radius(RP, RD) / effective_radius(RP, 40.0e-6) * 4.0;    // hold as HOLD
  int left = 0, normal = 0, rear = 0, at_rest = 0;
  for (int i = 0; i < 10000; i++) {
    Criteria criteria;
    criteria.count = i % 3 > 0;
    criteria.ibrahim = i % 4 == 3;
    criteria.tangential = i % 7 < 3 ? Criteria::IMPULSE : Criteria::ESTIMATE;
    if (i % 7 == 5) criteria.tangential = Criteria::FRICTIONLESS;
    if (i % 7 == 6) criteria.tangential = Criteria::OFF;
    m.friction = i % 5 == 4 ? 0.0 : 0.3;
    const GrainTable table(texture, m, criteria);
    const History h = random_history(random, i % 3);
    const Outcome expected = by_brute_force(texture, m, criteria, h);
    const Outcome found = by_collision(texture, table, h);
    expect_same(found, expected);
    expect_same(by_collision(texture, table, h, 17), expected);
    if (::testing::Test::HasFailure()) FAIL() << "collision " << i;
    left += expected.left.size();
    at_rest += expected.steps < static_cast<int>(h.a.size());
    for (const auto &[grain, how] : expected.left) {
      normal += how.second == NORMAL;
      rear += how.second == TANGENTIAL;
    }
  }
  EXPECT_GT(normal, 50000);    // the test tests something
  EXPECT_GT(rear, 5000);
  EXPECT_LT(left, 10000 * 200);
  EXPECT_GT(at_rest, 100);
}

TEST(Collision, SameGrainsAsBruteForceForGrainsOfAllSizes)
{
  std::mt19937 random(2);
  Texture texture = place_monolayer(RP, 40.0e-6, 0.15, BareCap(), 2);
  for (Grain &g : texture.grains) g.radius *= 0.2 + 0.8 * std::uniform_real_distribution<double>()(random);
  Material m = CALCITE;
  m.gamma *= 16.0;
  Criteria criteria;
  criteria.count = true;
  const GrainTable table(texture, m, criteria);
  double mass = 0.0, expected_mass = 0.0;
  for (int bit = 0; bit < table.grains(); bit++) mass += table.weight(bit) * table.mean_mass();
  for (const Grain &g : texture.grains) expected_mass += 4.0 / 3.0 * M_PI * std::pow(g.radius, 3) * m.density;
  EXPECT_NEAR(mass, expected_mass, 1.0e-12 * expected_mass);
  for (int i = 0; i < 500; i++) {
    const History h = random_history(random, i % 2);
    expect_same(by_collision(texture, table, h), by_brute_force(texture, m, criteria, h));
    if (::testing::Test::HasFailure()) FAIL() << "collision " << i;
  }
}

TEST(Collision, SameGrainsAsBruteForceWithASpreadOfAdhesion)
{
  std::mt19937 random(3);
  Texture texture = place_monolayer(RP, 40.0e-6, 0.15, BareCap(), 2);
  spread_adhesion(texture, 2.5, 2);
  Material m = CALCITE;
  m.gamma *= 64.0;
  int left = 0;
  for (int i = 0; i < 600; i++) {
    Criteria criteria;
    criteria.count = true;
    criteria.ibrahim = i % 4 == 3;
    criteria.tangential = std::vector{Criteria::IMPULSE, Criteria::ESTIMATE, Criteria::FRICTIONLESS}[i % 3];
    const GrainTable table(texture, m, criteria);
    const History h = random_history(random, i % 2);
    const Outcome expected = by_brute_force(texture, m, criteria, h);
    expect_same(by_collision(texture, table, h), expected);
    left += expected.left.size();
    if (::testing::Test::HasFailure()) FAIL() << "collision " << i;
  }
  EXPECT_GT(left, 600 * 20);
  EXPECT_LT(left, 600 * 180);
}

TEST(Collision, ReferenceImpactsSameAsBruteForce)
{
  const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  for (double speed : {0.3, 3.0, 8.0})
    for (bool ibrahim : {false, true}) {
      Criteria criteria;
      criteria.count = true;
      criteria.ibrahim = ibrahim;
      const History h = straight_impact(speed, 0.2733);
      expect_same(by_collision(texture, GrainTable(texture, CALCITE, criteria), h),
                  by_brute_force(texture, CALCITE, criteria, h));
    }
}

TEST(Collision, NormalModeOfAStraightImpactIsTheCapOfTheClosedForm)
{
  // 1/2 (1 - c/a_max) of the sphere less the bare cap; a texture of 4500 scatters by about 0.5 %, 20 of them by 0.1 %
  const History h = straight_impact(2.0, 0.2733);
  double peak = 0.0;
  for (const Vec &a : h.a) peak = std::max(peak, a.z);
  const double bare = 0.5 * (1.0 - std::cos(0.33));
  const double expected = (0.5 * (1.0 - HOLD / peak) - bare) / (1.0 - bare);
  Criteria alone;
  alone.tangential = Criteria::OFF;
  double found = 0.0;
  for (int seed = 1; seed <= 20; seed++) {
    const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), seed);
    found += by_collision(texture, GrainTable(texture, CALCITE, alone), h).left.size() / 4500.0 / 20.0;
  }
  EXPECT_NEAR(found, expected, 0.003);
}

TEST(Collision, NothingLeavesBelowThePullOffForce)
{
  const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  const GrainTable table(texture, CALCITE, Criteria());
  History h;
  h.dt = 1.0e-9;
  h.a.assign(100, {0.0, 0.0, 0.9999 * HOLD});
  h.before = {0.0, 0.0, -0.01};
  h.after = {0.0, 0.0, 0.003};
  EXPECT_TRUE(by_collision(texture, table, h).left.empty());
  h.a.assign(100, {0.0, 0.0, 1.5 * HOLD});
  EXPECT_FALSE(by_collision(texture, table, h).left.empty());
}
