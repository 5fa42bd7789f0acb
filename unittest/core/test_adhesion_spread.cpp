// Pull-off forces that differ from grain to grain: their distribution, what stays as it was, and what a load releases.

#include "adhesion_spread.h"

#include "collision.h"
#include "reference_case.h"
#include "texture_placement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace Dust;

namespace {

Texture spread_texture(double sigma_a, int seed = 1)
{
  Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), seed);
  spread_adhesion(texture, sigma_a, seed);
  return texture;
}

// of the log-normal with median 1
double share_below(double x, double sigma_a)
{
  return 0.5 * std::erfc(-std::log(x) / (std::sqrt(2.0) * std::log(sigma_a)));
}

}    // namespace

TEST(AdhesionSpread, FactorsAreLogNormalWithMedianOne)
{
  // 20 textures of 4500: largest distance of their distribution function from the log-normal's (Kolmogorov), at 1 %
  for (double sigma_a : {1.2, 2.0, 4.0}) {
    std::vector<double> factors;
    for (int seed = 1; seed <= 20; seed++)
      for (const Grain &grain : spread_texture(sigma_a, seed).grains) factors.push_back(grain.adhesion);
    std::sort(factors.begin(), factors.end());
    const double n = factors.size();
    double distance = 0.0;
    for (size_t k = 0; k < factors.size(); k++)
      distance = std::max(distance, std::fabs((k + 0.5) / n - share_below(factors[k], sigma_a)));
    EXPECT_LT(distance, 1.63 / std::sqrt(n)) << sigma_a;
  }
}

TEST(AdhesionSpread, LeavesAllElseOfTheTextureAsItIs)
{
  const Texture plain = place_monolayer(RP, RD, 0.2, BareCap(), 1), spread = spread_texture(2.0);
  ASSERT_EQ(plain.grains.size(), spread.grains.size());
  for (size_t k = 0; k < plain.grains.size(); k++) {
    for (int d = 0; d < 3; d++) ASSERT_EQ(plain.grains[k].n[d], spread.grains[k].n[d]);
    ASSERT_EQ(plain.grains[k].radius, spread.grains[k].radius);
    ASSERT_EQ(plain.grains[k].adhesion, 1.0);
  }
  for (const Grain &grain : spread_texture(1.0).grains) ASSERT_EQ(grain.adhesion, 1.0);
  // one seed, one draw; another seed, another one; the deviates serve every sigma_a
  const Texture again = spread_texture(2.0), wider = spread_texture(4.0), other = spread_texture(2.0, 2);
  int same = 0;
  for (size_t k = 0; k < spread.grains.size(); k++) {
    ASSERT_EQ(again.grains[k].adhesion, spread.grains[k].adhesion);
    ASSERT_NEAR(std::log(wider.grains[k].adhesion), 2.0 * std::log(spread.grains[k].adhesion), 1.0e-12);
    same += other.grains[k].adhesion == spread.grains[k].adhesion;
  }
  EXPECT_EQ(same, 0);
}

TEST(AdhesionSpread, DoesNotFollowTheSizes)
{
  // neither the seed's other stream nor the order of the grains, from large to small: no correlation with the radius
  Texture texture = place_monolayer(RP, SizeDistribution{SizeDistribution::LOGNORMAL, 15.0e-6, 1.5}, 0.2, BareCap(), 1);
  spread_adhesion(texture, 2.0, 1);
  double xy = 0.0, x2 = 0.0, y2 = 0.0, mean = 0.0;
  for (const Grain &grain : texture.grains) mean += std::log(grain.radius) / texture.grains.size();
  for (const Grain &grain : texture.grains) {
    const double x = std::log(grain.radius) - mean, y = std::log(grain.adhesion);
    xy += x * y;
    x2 += x * x;
    y2 += y * y;
  }
  EXPECT_LT(std::fabs(xy) / std::sqrt(x2 * y2), 3.0 / std::sqrt(texture.grains.size()));
}

TEST(AdhesionSpread, GoesIntoPullOffForceAndContactRadius)
{
  Texture texture = spread_texture(2.0);
  texture.grains[0].adhesion = 1.0;
  const GrainTable table(texture, CALCITE, Criteria());
  Texture plain = texture;
  for (Grain &grain : plain.grains) grain.adhesion = 1.0;
  const GrainTable without(plain, CALCITE, Criteria());
  for (int bit = 0; bit < table.grains(); bit++) {
    const double factor = texture.grains[table.grain(bit)].adhesion;
    ASSERT_EQ(table.grain(bit), without.grain(bit));
    ASSERT_NEAR(table.site(bit).hold, factor * HOLD, 1.0e-12 * factor * HOLD);
    ASSERT_NEAR(table.site(bit).lever, std::cbrt(factor) * without.site(bit).lever, 1.0e-12);
    ASSERT_EQ(without.site(bit).hold, HOLD);
    if (table.grain(bit) == 0) {
      ASSERT_EQ(table.site(bit).hold, HOLD);
      ASSERT_EQ(table.site(bit).lever, without.site(bit).lever);
    }
  }
}

TEST(AdhesionSpread, ALoadReleasesWhatTheLogNormalSays)
{
  // a load that grows step by step, along the axis of a cap of grains, as in a centrifuge: each grain leaves when g.n
  // exceeds its own F_c/m_d. Expected is the mean of the distribution function over the grains' directions, with the
  // scatter of as many independent grains
  BareCap bare = {2.6, {0.0, 0.0, 1.0}};
  for (double sigma_a : {1.2, 2.0, 4.0}) {
    Texture texture = place_monolayer(RP, RD, 0.02, bare, 3);
    spread_adhesion(texture, sigma_a, 3);
    Criteria criteria;
    criteria.tangential = Criteria::OFF;
    const GrainTable table(texture, CALCITE, criteria);
    std::vector<uint64_t> attached = table.all_attached();
    Workspace work;
    Collision collision;
    collision.begin(Quaternion(), NO_SPIN);
    double left = 0.0;
    for (double load : {0.3, 0.5, 0.8, 1.0, 1.25, 2.0, 3.0}) {
      const Motion motion = {{0.0, 0.0, load * HOLD}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
      collision.step(table, motion, 1.0e-9, attached, work);
      left += work.detached.size();
      for (const Detachment &d : work.detached) EXPECT_EQ(d.mode, NORMAL);
      work.detached.clear();
      double expected = 0.0, variance = 0.0;
      for (const Grain &grain : texture.grains) {
        const double p = grain.n[2] < 0.0 ? share_below(-load * grain.n[2], sigma_a) : 0.0;
        expected += p;
        variance += p * (1.0 - p);
      }
      EXPECT_NEAR(left, expected, 3.0 * std::sqrt(variance) + 1.0e-9) << "spread " << sigma_a << ", load " << load;
    }
    EXPECT_GT(left, 0.7 * texture.grains.size());
    collision.release(work);
  }
}

TEST(AdhesionSpread, RefusesWhatIsNone)
{
  Texture texture = place_monolayer(RP, RD, 0.01, BareCap(), 1);
  for (double sigma_a : {0.999, 100.1, -2.0, double(NAN), double(INFINITY)}) {
    try {
      spread_adhesion(texture, sigma_a, 1);
      ADD_FAILURE() << sigma_a;
    } catch (const TextureError &error) {
      EXPECT_NE(std::string(error.what()).find("is not from 1 to 100"), std::string::npos) << error.what();
    }
  }
}
