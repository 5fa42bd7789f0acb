// Points on a sphere and their neighbours, against comparing all of them.

#include "shell_grid.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include <sys/resource.h>

using namespace Dust;

namespace {

using Point = std::array<double, 3>;

// uniform on the sphere, each tenth close to a pole
std::vector<Point> points(int n, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Point> all;
  for (int k = 0; k < n; k++) {
    double z = uniform(random);
    if (k % 10 == 0) z = std::copysign(1.0 - 1.0e-6 * std::fabs(z), z);
    const double phi = M_PI * uniform(random), s = std::sqrt(1.0 - z * z);
    all.push_back({s * std::cos(phi), s * std::sin(phi), z});
  }
  all.push_back({0.0, 0.0, 1.0});
  all.push_back({0.0, 0.0, -1.0});
  return all;
}

}    // namespace

TEST(ShellGrid, FindsAllNeighbours)
{
  const std::vector<Point> all = points(2000, 1), centres = points(200, 2);
  for (const double reach : {1.0e-7, 0.01, 0.1, 0.5, 1.5, 3.0}) {
    ShellGrid grid(reach, all.size());
    for (size_t k = 0; k < all.size(); k++) grid.insert(static_cast<int>(k), all[k].data());
    for (const double angle : {reach, 0.3 * reach})
      for (const Point &centre : centres) {
        std::set<int> visited;
        EXPECT_FALSE(grid.any_near(centre.data(), angle, [&](int id, double distance2) {
          EXPECT_EQ(distance2, chord2(centre.data(), all[id].data()));
          EXPECT_TRUE(visited.insert(id).second) << "twice";
          return false;
        }));
        const double chord = 2.0 * std::sin(0.5 * angle);
        for (size_t k = 0; k < all.size(); k++)
          if (chord2(all[k].data(), centre.data()) < chord * chord) {
            EXPECT_TRUE(visited.count(static_cast<int>(k)))
                << "reach " << reach << " angle " << angle << " point " << k;
          }
      }
  }
}

TEST(ShellGrid, LooksAtFewOthers)
{
  const std::vector<Point> all = points(20000, 3);
  ShellGrid grid(0.01, all.size());
  for (size_t k = 0; k < all.size(); k++) grid.insert(static_cast<int>(k), all[k].data());
  double visited = 0.0, near = 0.0;
  for (const Point &centre : points(1000, 4))
    grid.any_near(centre.data(), 0.01, [&](int id, double) {
      visited++;
      near += chord2(all[id].data(), centre.data()) < 0.01 * 0.01;
      return false;
    });
  EXPECT_GT(near, 100.0);    // most of them at the poles
  EXPECT_LT(visited, 10.0 * near);
}

TEST(ShellGrid, StopsAtTheFirstYes)
{
  ShellGrid grid(0.5, 2);
  const Point a = {0.0, 0.0, 1.0};
  grid.insert(7, a.data());
  grid.insert(8, a.data());
  int visits = 0;
  EXPECT_TRUE(grid.any_near(a.data(), 0.5, [&](int id, double) {
    visits++;
    return id == 7 || id == 8;
  }));
  EXPECT_EQ(visits, 1);
}

// the same for a reach of 1e-9 rad as for one that fits: there were 800 MB of bins
TEST(ShellGrid, MemoryGoesWithTheNumberOfPoints)
{
  const auto most_memory = []() {
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;    // kB
  };
  const long before = most_memory();
  ShellGrid grid(1.0e-9, 10);
  const Point a = {0.6, 0.0, 0.8}, b = {0.6, 5.0e-10, 0.8};
  grid.insert(0, a.data());
  EXPECT_TRUE(grid.any_near(b.data(), 1.0e-9, [](int, double) { return true; }));
  ShellGrid many(1.0e-9, 100000);
  EXPECT_LT(most_memory() - before, 20000);
}
