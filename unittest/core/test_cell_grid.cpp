// Points in cells of space: none near a place is missed.

#include "cell_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

using namespace Dust;

TEST(CellGrid, FindsAllThatAreNear)
{
  std::mt19937 random(4);
  std::uniform_real_distribution<double> anywhere(-1.2, 1.2);    // also outside of the cube of +-1
  CellGrid cells;
  for (const double size : {0.05, 0.3, 5.0, 1.0e-6}) {    // also one cell, and smaller than any memory holds
    cells.clear(1.0, size);
    std::vector<std::array<double, 3>> points(500);
    for (int id = 0; id < 500; id++) {
      for (double &x : points[id]) x = anywhere(random);
      cells.insert(id, points[id].data());
    }
    for (int k = 0; k < 100; k++) {
      const double place[3] = {anywhere(random), anywhere(random), anywhere(random)}, reach = 0.1;
      std::vector<int> found;
      cells.each_near(place, reach, [&](int id) { found.push_back(id); });
      std::sort(found.begin(), found.end());
      EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());    // none twice
      for (int id = 0; id < 500; id++) {
        bool near = true;
        for (int d = 0; d < 3; d++) near = near && std::fabs(points[id][d] - place[d]) <= reach;
        EXPECT_TRUE(!near || std::binary_search(found.begin(), found.end(), id));
      }
    }
  }
}

TEST(CellGrid, IsEmptyAgain)
{
  CellGrid cells;
  const double place[3] = {0.1, 0.2, 0.3};
  for (int round = 0; round < 3; round++) {
    cells.clear(1.0, round == 1 ? 0.5 : 0.1);
    int found = 0;
    cells.each_near(place, 2.0, [&](int) { found++; });
    EXPECT_EQ(found, 0);
    cells.insert(7, place);
    cells.each_near(place, 0.01, [&](int id) { found += id; });
    EXPECT_EQ(found, 7);
  }
}
