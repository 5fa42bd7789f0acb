// Collisions keep number and address while they are taken, and leave what they no longer need to others.

#include "collision_pool.h"

#include "collision_reference.h"

#include <gtest/gtest.h>

#include <set>

using namespace Dust;

TEST(CollisionPool, NumbersAndAddressesStayAndAreUsedAgain)
{
  CollisionPool pool;
  EXPECT_FALSE(pool.any_taken());
  std::vector<const Collision *> addresses;
  for (int k = 0; k < 1000; k++) {
    ASSERT_EQ(pool.take(), k);
    addresses.push_back(&pool[k]);
  }
  for (int k = 0; k < 1000; k++) EXPECT_EQ(&pool[k], addresses[k]);
  EXPECT_TRUE(pool.any_taken());
  pool.give_back(3);
  pool.give_back(700);
  EXPECT_EQ(std::set<int>({pool.take(), pool.take()}), std::set<int>({3, 700}));
  EXPECT_EQ(pool.take(), 1000);
  for (int k = 0; k <= 1000; k++) pool.give_back(k);
  EXPECT_FALSE(pool.any_taken());
  EXPECT_EQ(pool.capacity(), 1001u);
}

TEST(CollisionPool, KeepsOnlyThoseThatStillHaveAHolder)
{
  CollisionPool pool;
  for (int k = 0; k < 5; k++) pool.take();
  pool.give_back(1);
  pool.keep_only({true, false, false, true, false});
  EXPECT_TRUE(pool.any_taken());
  EXPECT_EQ(std::set<int>({pool.take(), pool.take(), pool.take()}), std::set<int>({1, 2, 4}));
  EXPECT_EQ(pool.take(), 5);
}

TEST(CollisionPool, StrongPartsGoToTheNextCollision)
{
  const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  const GrainTable table(texture, CALCITE, Criteria());
  const Motion hard = {{0.0, 0.0, 0.9 * HOLD}, {}, {}};    // grains could slide, none lifts off
  CollisionPool pool;
  for (int k = 0; k < 3; k++) {
    std::vector<uint64_t> attached = table.all_attached();
    const int number = pool.take();
    pool[number].begin(Quaternion(), NO_SPIN);
    EXPECT_TRUE(pool[number].weak());
    pool[number].step(table, hard, 1.0e-9, attached, pool.work);
    EXPECT_FALSE(pool[number].weak());
    EXPECT_GT(pool.memory_usage(), sizeof(Collision));
    EXPECT_TRUE(pool.work.spare.empty());
    pool.give_back(number);
    EXPECT_EQ(pool.work.spare.size(), 1u);
  }
}
