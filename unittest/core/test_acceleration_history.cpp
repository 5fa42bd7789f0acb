/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "core/acceleration_history.h"

#include "gtest/gtest.h"

#include <algorithm>
#include <cmath>
#include <random>

using namespace Dust;

namespace {

// jumps from step to step, so that what the spheres of its tree allow for is used up
std::vector<Motion> random_motions(std::mt19937 &random, int count, double turning)
{
  std::normal_distribution<double> normal;
  std::vector<Motion> motions(count);
  for (Motion &m : motions)
    for (int d = 0; d < 3; d++) {
      m.acceleration[d] = normal(random);
      m.angular_acceleration[d] = turning * normal(random);
      m.spin[d] = std::sqrt(turning) * normal(random);
    }
  return motions;
}

}    // namespace

TEST(AccelerationHistory, AnswersAsALookAtEachMotionDoes)
{
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  constexpr double SHELL = 0.7;
  for (int count : {1, 7, 8, 9, 64, 100, 700})
    for (double turning : {0.01, 1.0, 10.0}) {
      AccelerationHistory history;
      const std::vector<Motion> motions = random_motions(random, count, turning);
      for (const Motion &m : motions) history.add(m, dot(m.acceleration, m.acceleration), true);
      ASSERT_EQ(history.kept().size(), motions.size());
      size_t hint = 0;
      for (int k = 0; k < 200; k++) {
        double n[3] = {normal(random), normal(random), normal(random)};
        const double size = std::sqrt(dot(n, n));
        for (double &x : n) x /= size;
        double push = -INFINITY, lift = -INFINITY, force = 0.0;
        for (const Motion &m : motions) {
          double g[3];
          m.inertia(n, SHELL, g);
          push = std::max(push, -m.lift(n, SHELL));
          lift = std::max(lift, m.lift(n, SHELL));
          force = std::max(force, std::sqrt(dot(g, g)));
        }
        EXPECT_EQ(history.max_push(n, SHELL, hint), push);
        // at limits just below and above the largest
        for (double part : {0.999, 1.001}) {
          const auto lifts = [&](const Motion &m) {
            return m.lift(n, SHELL) - (lift > 0.0 ? part : 1.0 / part) * lift;
          };
          const auto pulls = [&](const Motion &m) {
            double g[3];
            m.inertia(n, SHELL, g);
            return std::sqrt(dot(g, g)) - part * force;
          };
          EXPECT_EQ(history.any(lifts, 1.0, SHELL), part < 1.0);
          EXPECT_EQ(history.any(pulls, 1.0, SHELL), part < 1.0);
        }
      }
    }
}
