// Placement from the free area: as by tries anywhere, and at a cost a grain that does not go with their number.

#include "sequential_placement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

using namespace Dust;

namespace {

constexpr double LOWEST = -0.95, NEVER = std::numeric_limits<double>::infinity(), AT_ONCE = -1.0;

std::vector<double> equal_grains(size_t number, double coverage)
{
  return std::vector<double>(number, 2.0 * std::sqrt(coverage / double(number)));
}

// lognormal by number, with the coverage of the mean square
std::vector<double> many_sizes(size_t number, double coverage, double spread)
{
  std::mt19937_64 random(7);
  std::vector<double> radii(number);
  double sum = 0.0;
  for (double &radius : radii) {
    radius = std::exp(std::log(spread) * std::clamp(normal_deviate(random), -2.0, 2.0));
    sum += radius * radius;
  }
  for (double &radius : radii) radius *= 2.0 * std::sqrt(coverage / sum);
  std::sort(radii.begin(), radii.end(), std::greater<double>());
  return radii;
}

SequentialPlacement placed(const std::vector<double> &radii, std::mt19937_64 &random, double patience)
{
  SequentialPlacement placement(LOWEST, 1.0, radii, random, patience);
  for (const double radius : radii)
    if (!placement.place(radius)) break;
  return placement;
}

// of each grain, to the nearest other one: distance of the centres less the radii, in the sum of these; sorted
std::vector<double> gaps(const std::vector<Grain> &grains)
{
  std::vector<double> all;
  for (const Grain &a : grains) {
    double least = NEVER;
    for (const Grain &b : grains) {
      if (&a == &b) continue;
      double d2 = 0.0;
      for (int k = 0; k < 3; k++) d2 += std::pow((1.0 + a.radius) * a.n[k] - (1.0 + b.radius) * b.n[k], 2);
      least = std::min(least, std::sqrt(d2) / (a.radius + b.radius) - 1.0);
    }
    all.push_back(least);
  }
  return all;
}

// largest difference of two cumulated distributions (Kolmogorov and Smirnov)
double distance(std::vector<double> a, std::vector<double> b)
{
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  double largest = 0.0;
  for (size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    a[i] < b[j] ? i++ : j++;
    largest = std::max(largest, std::fabs(double(i) / double(a.size()) - double(j) / double(b.size())));
  }
  return largest;
}

}    // namespace

TEST(SequentialPlacement, FreeAreaKeepsGapsAndNumber)
{
  for (const auto &radii : {equal_grains(1000, 0.5), many_sizes(1000, 0.6, 1.6)}) {
    std::mt19937_64 random(1);
    const SequentialPlacement placement = placed(radii, random, AT_ONCE);
    ASSERT_EQ(placement.grains.size(), radii.size());
    const std::vector<double> all = gaps(placement.grains);
    EXPECT_GE(*std::min_element(all.begin(), all.end()), 0.999 * SequentialPlacement::MIN_GAP);
    for (size_t k = 0; k < radii.size(); k++) {
      EXPECT_EQ(placement.grains[k].radius, radii[k]);
      EXPECT_GE(placement.grains[k].n[2], LOWEST);
    }
  }
}

TEST(SequentialPlacement, FreeAreaHasTheDistributionOfTriesAnywhere)
{
  // Kolmogorov and Smirnov's distance of two samples of n is above 1.95 sqrt(2/n) once in a thousand; n counts pairs of
  // neighbours, not grains, as most gaps are the nearest of both
  constexpr int SEEDS = 40;
  for (const auto &radii : {equal_grains(400, 0.48), many_sizes(400, 0.5, 1.5)}) {
    std::vector<double> near[2], height[2];
    for (int seed = 1; seed <= SEEDS; seed++)
      for (const int way : {0, 1}) {
        std::mt19937_64 random(seed + 1000 * way);
        const SequentialPlacement placement = placed(radii, random, way == 0 ? NEVER : AT_ONCE);
        const std::vector<double> all = gaps(placement.grains);
        near[way].insert(near[way].end(), all.begin(), all.end());
        for (const Grain &grain : placement.grains) height[way].push_back(grain.n[2]);
      }
    ASSERT_EQ(near[0].size(), SEEDS * radii.size());
    EXPECT_LT(distance(near[0], near[1]), 1.95 * std::sqrt(2.0 / (0.5 * double(near[0].size()))));
    EXPECT_LT(distance(height[0], height[1]), 1.95 * std::sqrt(2.0 / double(height[0].size())));
  }
}

TEST(SequentialPlacement, FreeAreaJamsWhereTriesAnywhereDo)
{
  // 0.547 of the shell of their centres for discs; chance leaves 0.4/sqrt(number) of it, the rim and curvature 0.01
  const std::vector<double> radii = equal_grains(2000, 0.6);
  const double shell = 0.5 * (1.0 - LOWEST) * std::pow((1.0 + radii[0]) / (1.0 + SequentialPlacement::MIN_GAP), 2);
  std::mt19937_64 random(1);
  const SequentialPlacement placement = placed(radii, random, AT_ONCE);
  EXPECT_NEAR(double(placement.grains.size()) / 2000.0 * 0.6 / shell, 0.547, 0.015);
}

TEST(SequentialPlacement, CostGoesWithTheNumberOfGrains)
{
  const auto cost = [](const std::vector<double> &radii, double patience) {
    std::mt19937_64 random(1);
    const SequentialPlacement placement = placed(radii, random, patience);
    return double(placement.cost()) / double(placement.grains.size());
  };
  for (const double coverage : {0.05, 0.2, 0.5}) {
    const double few = cost(equal_grains(3000, coverage), NEVER), many = cost(equal_grains(30000, coverage), NEVER);
    // 1.1, 1.7 and 31 to 53: of dense ones, many meet 2000 misses in a row sooner, and more is divided into cells
    EXPECT_LT(many, (coverage < 0.5 ? 1.1 : 2.0) * few);
  }
  // a layer of many sizes, until it is full: 230, 140 and 160; with cells made anew for each 630, 1160 and more
  for (const size_t number : {1000, 3000, 10000}) EXPECT_LT(cost(many_sizes(number, 0.95, 1.3), AT_ONCE), 300.0);
}
