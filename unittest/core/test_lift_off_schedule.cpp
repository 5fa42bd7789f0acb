// The calendar of looks must find each grain in the step in which it lifts off, as a look at all grains does.

#include "lift_off_schedule.h"

#include "reference_case.h"
#include "vec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

using namespace Dust;

namespace {

// g grows from nothing to `peak` c and falls again, evenly or by a part `wave` up and down; about an axis that turns by
// `swing` rad, with a spin that comes and goes
Motion course(double t, double peak, double swing, double spin, double wave)
{
  const double even = peak * HOLD * std::sin(M_PI * t), size = even * (1.0 - wave * std::pow(std::sin(40.0 * t), 2));
  const double angle = swing * t, w = spin * std::sin(2.0 * M_PI * t);
  return {{size * std::sin(angle), 0.0, size * std::cos(angle)}, {}, {0.6 * w, 0.8 * w, 0.0}};
}

}    // namespace

TEST(LiftOffSchedule, FindsEachGrainInTheStepInWhichItLiftsOff)
{
  Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  LiftOffSchedule schedule;    // one for all: what a course has left in it must not show in the next
  int found = 0;
  for (int i = 0; i < 120; i++) {
    if (i == 60)
      for (Grain &g : texture.grains) g.radius *= 0.4 + 0.6 * u(random);
    const GrainTable table(texture, CALCITE, Criteria());
    std::vector<uint64_t> attached = table.all_attached();
    const int steps = 2 + static_cast<int>(2000 * u(random) * u(random));
    const double peak = std::exp(4.0 * u(random)), swing = i % 3 ? 3.0 * u(random) : 0.0,
                 spin = i % 2 ? 0.0 : 0.7 * std::sqrt(HOLD / SHELL), wave = i % 5 ? 0.0 : 0.3;
    schedule.clear();
    for (int k = 0; k <= steps; k++) {
      const Motion motion = course(double(k) / steps, peak, swing, spin, wave);
      std::set<int> expected, looked;
      for (int bit = 0; bit < table.grains(); bit++)
        if (attached[bit / 64] >> (bit % 64) & 1 &&
            motion.lift(table.site(bit).n, table.site(bit).shell) > table.site(bit).hold)
          expected.insert(bit);
      std::vector<Loss> losses;
      schedule.look(table, motion, attached.data(), losses);
      for (const Loss &loss : losses) {
        EXPECT_EQ(loss.mode, NORMAL);
        EXPECT_TRUE(looked.insert(loss.bit).second) << "found twice";
        attached[loss.bit / 64] &= ~(uint64_t(1) << (loss.bit % 64));
      }
      ASSERT_EQ(looked, expected) << "course " << i << " step " << k << " of " << steps;
      found += expected.size();
    }
  }
  EXPECT_GT(found, 60000);
}

TEST(LiftOffSchedule, WhatIsNotANumberIsNoIndex)
{
  const GrainTable table(place_monolayer(RP, RD, 0.2, BareCap(), 1), CALCITE, Criteria());
  for (double wrong : {double(NAN), double(INFINITY), 1.0e200}) {
    LiftOffSchedule schedule;
    std::vector<Loss> losses;
    schedule.clear();
    for (double size : {0.5, 0.6, 0.7, wrong, wrong, 0.7, 0.8}) {
      const Motion motion = {{0.0, 0.0, size < 1.0 ? size * HOLD : size}, {}, {}};
      schedule.look(table, motion, table.all_attached().data(), losses);
    }
    EXPECT_LE(losses.size(), 7u * table.grains());
  }
}
