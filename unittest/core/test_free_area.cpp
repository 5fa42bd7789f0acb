// Cells of a sphere that may have room: they hold all that is free, go where nothing is, and wait for smaller grains.

#include "free_area.h"

#include "random_numbers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace Dust;

namespace {

constexpr double LOWEST = -0.5, ANGLE = 0.1;

}    // namespace

TEST(FreeArea, DrawsEvenlyFromWhatIsFree)
{
  // free are 0.2 < z < 0.6 and azimuths below 1; cells that no part of it is in have room for no grain
  const auto largest_in = [](const ShellCell &c) { return c.z1 > 0.2 && c.z0 < 0.6 && c.phi0 < 1.0 ? 1.0 : 0.0; };
  FreeArea area(LOWEST);
  area.begin(1.0, 1.0, ANGLE, largest_in);
  std::mt19937_64 random(1);
  int counts[4] = {}, placed = 0, missed = 0;
  while (placed < 4000) {
    ASSERT_FALSE(area.full());
    const ShellCell c = area.draw(uniform(random));
    const double z = c.z0 + uniform(random) * (c.z1 - c.z0), phi = c.phi0 + uniform(random) * (c.phi1 - c.phi0);
    if (z < 0.2 || z > 0.6 || phi > 1.0) {
      area.quarter(1.0, 1.0, largest_in);
      missed++;
      continue;
    }
    counts[(z > 0.4) + 2 * (phi > 0.5)]++;
    placed++;
  }
  double chi2 = 0.0;    // 3 degrees of freedom: above 16.3 once in a thousand
  for (const int count : counts) chi2 += std::pow(count - 1000.0, 2) / 1000.0;
  EXPECT_LT(chi2, 16.3);
  EXPECT_LT(missed, 200);    // each takes away a part of what was drawn in vain
}

TEST(FreeArea, IsFullWhereNothingIsFree)
{
  FreeArea area(LOWEST);
  EXPECT_TRUE(area.full());
  area.begin(1.0, 1.0, ANGLE, [](const ShellCell &c) { return c.phi1 - c.phi0 > 1.0 ? 1.0 : 0.0; });
  EXPECT_TRUE(area.full());

  // a point is in four cells at most, and in ever smaller ones: below 1e-9 of the sphere they are given up
  FreeArea point(LOWEST);
  const auto largest_in = [](const ShellCell &c) {
    return c.z0 <= 0.3 && c.z1 >= 0.3 && c.phi0 <= 2.0 && c.phi1 >= 2.0;
  };
  point.begin(1.0, 1.0, ANGLE, largest_in);
  std::mt19937_64 random(1);
  int misses = 0;
  for (; !point.full(); misses++) {
    point.draw(uniform(random));
    point.quarter(1.0, 1.0, largest_in);
    ASSERT_LT(misses, 200);
  }
  EXPECT_GT(misses, 20);
}

TEST(FreeArea, CellsWaitForSmallerGrains)
{
  // room for radius 1 on one half, for 0.5 on the other
  const auto largest_in = [](const ShellCell &c) { return c.phi0 < PI ? 1.0 : 0.5; };
  FreeArea area(LOWEST);
  area.begin(1.0, 0.1, ANGLE, largest_in);
  std::mt19937_64 random(1);
  for (const double size : {1.0, 0.6, 0.5, 0.3}) {
    area.wake(size);
    int beyond = 0;
    for (int k = 0; k < 2000; k++) beyond += area.draw(uniform(random)).phi0 >= PI;
    if (size > 0.5)
      EXPECT_EQ(beyond, 0);
    else
      EXPECT_NEAR(beyond, 1000, 110);    // five deviations
  }
  FreeArea coarse(LOWEST);    // of which the smallest grain is larger than what finds room
  coarse.begin(1.0, 0.7, ANGLE, largest_in);
  coarse.wake(0.7);
  for (int k = 0; k < 200; k++) EXPECT_LT(coarse.draw(uniform(random)).phi0, PI);
}
