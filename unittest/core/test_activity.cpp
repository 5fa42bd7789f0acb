// When a collision is lively and when it rests, by whole numbers of steps.

#include "activity.h"

#include <gtest/gtest.h>

using Dust::Activity;

namespace {

void steps(Activity &activity, int count, bool lively)
{
  for (int k = 0; k < count; k++) {
    activity.count_step();
    if (lively) activity.mark_lively();
    EXPECT_EQ(activity.is_lively(), lively);
  }
}

}    // namespace

TEST(Activity, RestsAfterThreeTimesItsBurst)
{
  Activity activity;
  EXPECT_FALSE(activity.has_begun());
  steps(activity, 10, true);
  EXPECT_TRUE(activity.has_begun());
  steps(activity, 30, false);
  EXPECT_FALSE(activity.at_rest(false));
  steps(activity, 1, false);
  EXPECT_TRUE(activity.at_rest(false));
}

TEST(Activity, APauseLongerThanTheBurstBeginsAnother)
{
  Activity joined;
  steps(joined, 10, true);
  steps(joined, 10, false);
  steps(joined, 1, true);    // still the first burst: 21 steps
  steps(joined, 63, false);
  EXPECT_FALSE(joined.at_rest(false));
  steps(joined, 1, false);
  EXPECT_TRUE(joined.at_rest(false));

  Activity apart;
  steps(apart, 10, true);
  steps(apart, 11, false);
  steps(apart, 1, true);
  steps(apart, 3, false);
  EXPECT_FALSE(apart.at_rest(false));
  steps(apart, 1, false);
  EXPECT_TRUE(apart.at_rest(false));
}
