// Eq. 2 on grains that move with their carrier: in forces as the documentation has it, and bounds of whole patches.

#include "sticking_criteria.h"

#include "patch_bits.h"
#include "reference_case.h"
#include "vec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

using namespace Dust;

namespace {

Motion random_motion(std::mt19937 &random, double size, bool rotates)
{
  std::normal_distribution<double> normal;
  Motion m = {};
  for (int d = 0; d < 3; d++) {
    m.acceleration[d] = size * normal(random);
    if (!rotates) continue;
    m.angular_acceleration[d] = size / SHELL * normal(random);
    m.spin[d] = 0.5 * std::sqrt(size / SHELL) * normal(random);
  }
  return m;
}

struct Forces {
  double n, t;
};
Forces forces_on(const Grain &grain, double mass, const Motion &m)
{
  const Vec n = {grain.n[0], grain.n[1], grain.n[2]}, r = (RP + grain.radius) * n;
  const Vec a = {m.acceleration[0], m.acceleration[1], m.acceleration[2]};
  const Vec alpha = {m.angular_acceleration[0], m.angular_acceleration[1], m.angular_acceleration[2]};
  const Vec omega = {m.spin[0], m.spin[1], m.spin[2]};
  const Vec f = -mass * (a + cross(alpha, r) + cross(omega, cross(omega, r)));
  return {dot(f, n), size(f - dot(f, n) * n)};
}

Texture grains_of_all_sizes()
{
  std::mt19937 random(2);
  Texture texture = place_monolayer(RP, 40.0e-6, 0.15, BareCap(), 2);
  for (Grain &g : texture.grains) g.radius *= 0.1 + 0.4 * std::uniform_real_distribution<double>()(random);
  return texture;
}

}    // namespace

TEST(StickingCriteria, AsTheyStandInForces)
{
  std::mt19937 random(3);
  const Texture texture = grains_of_all_sizes();
  const GrainTable table(texture, CALCITE, Criteria());
  std::map<Mode, int> met;
  for (int i = 0; i < 200; i++) {
    const Motion motion = random_motion(random, HOLD * std::exp(2.0 * (i % 5) - 6.0), i % 2);
    std::map<int, Mode> expected, found;
    for (int bit = 0; bit < table.grains(); bit++) {
      const Grain &g = texture.grains[table.grain(bit)];
      const double mass = 4.0 / 3.0 * M_PI * std::pow(g.radius, 3) * CALCITE.density;
      const double r12 = effective_radius(RP, g.radius), fc = pull_off_force(CALCITE.gamma, r12),
                   a0 = equilibrium_contact_radius(CALCITE.gamma, r12, CALCITE.modulus);
      const Forces f = forces_on(g, mass, motion);
      const double slides = f.t - CALCITE.friction * std::fabs(2.0 * fc - f.n),
                   rolls = f.t - std::fabs(fc - f.n) * a0 / g.radius;
      EXPECT_NEAR(mass * excess(table, SLIDING, bit, motion), slides, 1.0e-9 * (f.t + fc));
      EXPECT_NEAR(mass * excess(table, ROLLING, bit, motion), rolls, 1.0e-9 * (f.t + fc));
      if (f.n > fc)
        expected[bit] = NORMAL;
      else if (slides > 0.0)
        expected[bit] = SLIDING;
      else if (rolls > 0.0)
        expected[bit] = ROLLING;
    }
    std::vector<Loss> losses;
    find_losses(table, motion, table.all_attached().data(), losses);
    for (const Loss &loss : losses) found[loss.bit] = loss.mode;
    EXPECT_EQ(found, expected);
    for (const auto &grain : expected) met[grain.second]++;
  }
  for (Mode mode : {NORMAL, SLIDING, ROLLING}) EXPECT_GT(met[mode], 500);
}

TEST(StickingCriteria, PatchesAreBoundedByTheirGrains)
{
  std::mt19937 random(4);
  const GrainTable table(grains_of_all_sizes(), CALCITE, Criteria());
  int told = 0;
  for (int i = 0; i < 400; i++) {
    const Motion motion = random_motion(random, HOLD * std::exp(2.0 * (i % 5) - 6.0), i % 2);
    for (Mode mode : {SLIDING, ROLLING})
      for (int word = 0; word < table.words(); word++) {
        const Range range = excess_in_patch(table, mode, word, motion);
        each_bit(table.all_attached()[word], [&](int k) {
          const double value = excess(table, mode, word * PATCH + k, motion);
          EXPECT_LE(range.min, value);
          EXPECT_GE(range.max, value);
        });
        told += range.min > 0.0 || range.max < 0.0;
      }
  }
  EXPECT_GT(told, 300);
}

TEST(StickingCriteria, PatchesOfGrainsAtManyDistancesAreBoundedToo)
{
  // grains as large as half their carrier, all of them nearly at one place: what rotation adds differs most among them
  Texture texture;
  texture.carrier_radius = RP;
  for (int k = 0; k < 60; k++) texture.grains.push_back({{0.0, 0.0, 1.0}, RP * (0.01 + 0.008 * k)});
  const GrainTable table(texture, CALCITE, Criteria());
  std::mt19937 random(6);
  for (int i = 0; i < 2000; i++) {
    Motion motion = random_motion(random, table.min_hold(), true);
    for (double &x : motion.acceleration) x *= 0.01 * (i % 3);
    for (Mode mode : {SLIDING, ROLLING}) {
      const Range range = excess_in_patch(table, mode, 0, motion);
      for (int bit = 0; bit < table.grains(); bit++) {
        EXPECT_LE(range.min, excess(table, mode, bit, motion));
        EXPECT_GE(range.max, excess(table, mode, bit, motion));
      }
    }
  }
}

TEST(StickingCriteria, NoSmallerForceMeetsThem)
{
  // along the worst direction: g_n/g = slope/sqrt(1 + slope^2)
  const GrainTable table(grains_of_all_sizes(), CALCITE, Criteria());
  for (Mode mode : {SLIDING, ROLLING}) {
    double worst = -1.0e300;
    for (int bit = 0; bit < table.grains(); bit++) {
      const GrainTable::Site &site = table.site(bit);
      const double slope = limit_of(mode, CALCITE.friction, site.lever).slope, part = 1.0 / std::hypot(1.0, slope);
      const double g = table.min_force_to(mode);
      worst = std::max(worst, excess(table, mode, bit, Load{g * slope * part, g * part}) / site.hold);
    }
    EXPECT_NEAR(worst, 0.0, 1.0e-12);
  }
}
