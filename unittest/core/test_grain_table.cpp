// What the table says of the grains of a texture.

#include "grain_table.h"

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
