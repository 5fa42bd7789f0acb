// When a collision rests: never in an impact of its own, soon in a contact that lasts.

#include "activity.h"

#include "damping.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using Dust::Activity;

namespace {

// force per mass of a damped Hertz contact that never pulls, the largest overlap being about 1 and the contact time
// about 3, until it ends or for so many contact times; with a weight that presses, and with friction along the wall
std::vector<double> hertz_impact(double restitution, int steps, double weight, double friction)
{
  const double c = Dust::hertz_damping(restitution), dt = 3.0 / steps;
  std::vector<double> sizes;
  double x = 0.0, v = 1.0;
  for (int k = 0; k < 20 * steps; k++) {
    x += v * dt;
    const double elastic = x > 0.0 ? x * std::sqrt(x) : 0.0;
    const double a = std::max(0.0, elastic + c * std::sqrt(elastic / std::max(x, 1.0e-300)) * v);
    if (a == 0.0 && k > 0) break;
    sizes.push_back(a * std::hypot(1.0, friction * std::sin(6.0 * k / steps)));    // as a Mindlin spring swings
    v -= (a - weight) * dt;
  }
  return sizes;
}

// the step in which it rests, 0 if in none
int rests_at(const std::vector<double> &sizes, double moving, bool &weak)
{
  Activity activity;
  double peak = 0.0;
  weak = true;
  for (size_t k = 0; k < sizes.size(); k++) {
    weak = weak && sizes[k] <= moving;
    activity.add(sizes[k], sizes[k] > moving || sizes[k] > peak || k == 0);
    peak = std::max(peak, sizes[k]);
    if (activity.at_rest(weak)) return static_cast<int>(k) + 1;
  }
  return 0;
}

}    // namespace

TEST(Activity, AnIsolatedImpactEndsByRebound)
{
  // whatever its damping, resolution and friction; with a weight up to a hundredth of its peak; weak, or able to move
  // grains at its peak only, for most of it or all the time
  for (double restitution : {0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 0.9, 1.0})
    for (int steps : {15, 30, 50, 100, 1000, 10000})
      for (double friction : {0.0, 0.3, 0.7})
        for (double weight : {0.0, 0.01}) {
          const std::vector<double> sizes = hertz_impact(restitution, steps, weight, friction);
          ASSERT_LT(sizes.size(), 1.6 * steps);    // it is one
          const double peak = *std::max_element(sizes.begin(), sizes.end());
          for (double moving : {2.0, 1.0, 0.999, 0.99, 0.9, 0.5, 0.1, 1.0e-3}) {
            bool weak;
            EXPECT_EQ(rests_at(sizes, moving * peak, weak), 0)
                << restitution << " " << steps << " " << friction << " " << weight << " " << moving;
            EXPECT_EQ(weak, moving >= 1.0);
          }
        }
}

TEST(Activity, AContactThatLastsRestsSoon)
{
  // dropped so gently, or so heavy, that it stays on the wall
  for (double restitution : {0.1, 0.3, 0.7})
    for (double weight : {1.0, 3.0, 30.0}) {
      const std::vector<double> sizes = hertz_impact(restitution, 100, weight, 0.0);
      ASSERT_EQ(sizes.size(), 2000u);
      bool weak;
      const int step = rests_at(sizes, 1.0e300, weak);
      EXPECT_GT(step, 0);
      EXPECT_LT(step, 300) << restitution << " " << weight;    // three contact times
    }
}

TEST(Activity, WhatDoesNotFallRestsAfterFourTimesItsBurst)
{
  Activity activity;
  EXPECT_FALSE(activity.has_begun());
  for (int k = 1; k <= 10; k++) {
    activity.add(k, true);
    EXPECT_TRUE(activity.is_lively());
    EXPECT_FALSE(activity.at_rest(true));
  }
  EXPECT_TRUE(activity.has_begun());
  int steps = 0;
  for (; !activity.at_rest(true); steps++) activity.add(9.0, false);
  EXPECT_FALSE(activity.is_lively());
  // q > 0.75 (55 + 9 q)/10
  EXPECT_EQ(steps, 13);
  // and if it has moved grains, after three times the burst
  for (; !activity.at_rest(false); steps++) activity.add(9.0, false);
  EXPECT_EQ(steps, 31);
}

TEST(Activity, AWeakContactThatSwingsOnAndOnRestsAfterFourOfItsOwnTimes)
{
  // a peak of 10, then swings that fall by more than an eighth each time they come down, a bit lower than before
  std::vector<double> sizes = {5.0, 10.0, 5.0};
  for (int k = 0; k < 40; k++) sizes.insert(sizes.end(), {0.5 * std::pow(0.87, k), 2.0});
  bool weak;
  EXPECT_EQ(rests_at(sizes, 1.0e300, weak), 12);    // steps > 4 sum/10
}

TEST(Activity, FallsAreCountedFromTheLastOne)
{
  Activity activity;
  activity.add(8.0, true);
  activity.add(7.0, false);    // not by more than an eighth: q > 0.75 (8 + 7 + 7)/8 comes with the second
  EXPECT_FALSE(activity.at_rest(true));
  activity.add(6.9, false);    // from 8, although not from 7
  EXPECT_FALSE(activity.at_rest(true));
  activity.add(6.9, false);
  activity.add(6.9, false);
  EXPECT_FALSE(activity.at_rest(true));
  activity.add(6.9, false);
  EXPECT_FALSE(activity.at_rest(true));
  activity.add(0.0, false);
  EXPECT_FALSE(activity.at_rest(true));
}

TEST(Activity, APauseLongerThanTheBurstBeginsAnother)
{
  const auto steps = [](Activity &activity, int count, bool lively) {
    for (int k = 0; k < count; k++) activity.add(1.0, lively);
  };
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
