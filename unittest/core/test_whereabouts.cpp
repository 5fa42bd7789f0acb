// What was found of spheres far apart is kept until one of them may have come close.

#include "whereabouts.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace {

// 37 spheres: more than fill whole vectors of lanes
struct Spheres {
  std::vector<double> x = std::vector<double>(3 * 37, 1.0), radius = std::vector<double>(37, 0.5);
  int n() const { return int(radius.size()); }
};

bool leaves(const Spheres &now, double distance, const Spheres &then = {})
{
  Dust::Whereabouts where;
  where.note(then.x.data(), then.radius.data(), then.n());
  return where.left(now.x.data(), now.radius.data(), now.n(), distance);
}

}    // namespace

TEST(Whereabouts, NothingHasLeftThatStands)
{
  EXPECT_FALSE(leaves({}, 0.0));
  EXPECT_FALSE(leaves({}, 0.1));
  EXPECT_TRUE(Dust::Whereabouts().left(Spheres().x.data(), Spheres().radius.data(), 1, 0.1)) << "never noted";
}

TEST(Whereabouts, EachSphereInEachDirection)
{
  for (int k = 0; k < 3 * 37; k++)
    for (const double way : {0.3, -0.3}) {
      Spheres moved;
      moved.x[k] += way;
      EXPECT_FALSE(leaves(moved, 0.31)) << k;
      EXPECT_TRUE(leaves(moved, 0.29)) << k;
    }
  Spheres across;    // 3-4-12: 13
  across.x[54] += 0.03, across.x[55] -= 0.04, across.x[56] += 0.12;
  EXPECT_FALSE(leaves(across, 0.131));
  EXPECT_TRUE(leaves(across, 0.129));
}

// a sphere that grows comes closer by as much, and once more for what reaches out of it; one that shrinks does not
TEST(Whereabouts, Growth)
{
  Spheres grown, shrunk;
  grown.radius[36] += 0.1;
  shrunk.radius[36] -= 0.1;
  EXPECT_FALSE(leaves(grown, 0.21));
  EXPECT_TRUE(leaves(grown, 0.19));
  EXPECT_FALSE(leaves(shrunk, 0.0));
  grown.x[108] += 0.1;
  EXPECT_FALSE(leaves(grown, 0.31));
  EXPECT_TRUE(leaves(grown, 0.29));
}

TEST(Whereabouts, OthersAndNoNumbers)
{
  Spheres more, lost;
  more.x.resize(3 * 38, 1.0);
  more.radius.resize(38, 0.5);
  EXPECT_TRUE(leaves(more, 1.0));
  lost.x[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(leaves(lost, 1.0));
}
