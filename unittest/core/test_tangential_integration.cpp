// The law that follows each grain, in whole collisions, against a reference that follows each alone in tiny steps.

#include "tangential_integration.h"

#include "collision.h"
#include "surface_reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>

using namespace Dust;

namespace {

// a step as Collision takes it, with the spin half a step earlier
Motion motion_of(const History &h, size_t k)
{
  const Vec &a = h.a[k], alpha = 1.0 / h.dt * (h.spin[k] - (k ? h.spin[k - 1] : h.spin0)),
            spin = h.spin[k] - 0.5 * h.dt * alpha;
  return {{a.x, a.y, a.z}, {alpha.x, alpha.y, alpha.z}, {spin.x, spin.y, spin.z}};
}

// mode by grain, by Collision; handed over to another one every `handover` steps
std::map<int, Mode> by_collision(const GrainTable &table, const History &h, int handover = 0)
{
  std::map<int, Mode> left;
  std::vector<uint64_t> attached = table.all_attached();
  Workspace work;
  Collision collision;
  const Motion earlier = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}, {7.0, 8.0, 9.0}};    // a collision before this one
  collision.begin(Quaternion(), earlier.spin);
  collision.step(table, earlier, 1.0, attached, work);
  collision.begin(Quaternion(), &h.spin0.x);
  for (size_t k = 0; k <= h.a.size(); k++) {
    if (k < h.a.size())
      collision.step(table, motion_of(h, k), h.dt, attached, work);
    else
      collision.end(table, &h.spin.back().x, attached.data(), work);
    for (const Detachment &d : work.detached) left[table.grain(d.bit)] = d.mode;
    work.detached.clear();
    if (handover && k % handover == 0) {
      std::vector<double> buf(collision.packed_size());
      EXPECT_GE(collision.max_packed_size(table), collision.packed_size());
      Packer packer(buf.data());
      collision.pack(packer);
      Collision other;
      std::vector<uint64_t> all = table.all_attached();
      other.begin(Quaternion(), earlier.spin);    // one that has been used
      other.step(table, earlier, 1.0, all, work);
      work.detached.clear();
      Unpacker unpacker(buf.data());
      other.unpack(unpacker);
      collision = std::move(other);
    }
  }
  return left;
}

Criteria integrate()
{
  Criteria criteria;
  criteria.tangential = Criteria::INTEGRATE;
  return criteria;
}

struct Comparison {
  int tangential = 0, close = 0, stay = 0;
};

// random collisions of a texture against the reference; grains whose load comes as close as `tolerance` to 1 may do
// either
Comparison compare(const Texture &texture, Material m, int collisions, double tolerance, double spin = 0.0)
{
  std::mt19937 random(3);
  Comparison found;
  for (int i = 0; i < collisions; i++) {
    m.friction = i % 5 == 4 ? 0.0 : i % 5 == 3 ? 5.0 : 0.1 + 0.1 * (i % 4);
    m.rolling = i % 4 == 2 ? 0.0 : i % 2 == 1 ? 3.0 : 0.15;
    const GrainTable table(texture, m, integrate());
    const History h = random_history(random, spin);
    const std::map<int, Mode> left = by_collision(table, h);
    EXPECT_EQ(by_collision(table, h, 17), left) << "collision " << i << " handed over";
    for (size_t k = 0; k < texture.grains.size(); k++) {
      const auto it = left.find(k);
      if (it != left.end() && it->second == NORMAL) continue;
      const bool leaves = it != left.end();
      const double load = largest_load(texture.grains[k], texture.carrier_radius, m, h);
      if (load > 1.0 + tolerance || load < 1.0 - tolerance) {
        EXPECT_EQ(leaves, load > 1.0) << "collision " << i << " grain " << k << " load " << load;
      } else
        found.close++;
      (leaves ? found.tangential : found.stay)++;
    }
    if (::testing::Test::HasFailure()) break;
  }
  return found;
}

}    // namespace

TEST(TangentialIntegration, SameGrainsAsAReferenceInTinySteps)
{
  Texture texture = place_monolayer(RP, 40.0e-6, 0.15, BareCap(), 2);
  for (Grain &g : texture.grains) g.radius = RD;
  const Comparison found = compare(texture, CALCITE, 60, 0.003);
  EXPECT_GT(found.tangential, 300);    // the test tests something
  EXPECT_GT(found.stay, 2000);
  EXPECT_LT(found.close, 30);
}

TEST(TangentialIntegration, SameGrainsAsAReferenceForGrainsOfAllSizes)
{
  std::mt19937 random(4);
  Texture texture = place_monolayer(RP, 40.0e-6, 0.15, BareCap(), 2);
  for (Grain &g : texture.grains) g.radius = RD * (0.3 + 2.2 * std::uniform_real_distribution<double>()(random));
  const Comparison found = compare(texture, CALCITE, 40, 0.003);
  EXPECT_GT(found.tangential, 100);
  EXPECT_GT(found.stay, 500);
}

TEST(TangentialIntegration, SameGrainsOnACarrierThatTurns)
{
  // the spans of the record are longer than steps of time
  Texture texture = place_monolayer(RP, 40.0e-6, 0.15, BareCap(), 2);
  for (Grain &g : texture.grains) g.radius = RD;
  const Comparison found = compare(texture, CALCITE, 40, 0.1, 0.5 * std::sqrt(HOLD / SHELL));
  EXPECT_GT(found.tangential, 80);    // more lift off while they stick
  EXPECT_GT(found.stay, 1000);
}

TEST(TangentialIntegration, GrainsOfACollisionThatRingLeaveMore)
{
  // straight, as fast as it takes: squeezed on the north and let go
  Texture texture = place_monolayer(RP, 2.0 * RD, 0.2, BareCap(), 1);
  History h;
  h.dt = 3.0e-6 / 600;
  h.smooth = false;
  for (int k = 0; k < 600; k++) h.a.push_back({0.0, 0.0, 50.0 * HOLD * std::sin(M_PI * (k + 0.5) / 600)});
  h.spin.assign(600, Vec());
  std::map<double, std::map<int, Mode>> left;
  for (double zeta : {-1.0, 1.0, 3.0, 0.06}) {
    Material m = CALCITE;
    m.damping = zeta;
    const GrainTable table(texture, m, integrate());
    left[zeta] = by_collision(table, h);
    EXPECT_EQ(by_collision(table, h, 17), left[zeta]);
  }
  EXPECT_GT(left[0.06].size(), left[-1.0].size() + 100);
  for (const auto &grain : left[-1.0]) EXPECT_EQ(left[0.06].count(grain.first), 1u);
  // a contact that opens against its damping takes time, in which friction slows the grain: some that are drawn out by
  // more than F_c stay
  for (double zeta : {1.0, 3.0}) {
    EXPECT_LT(left[zeta].size(), left[-1.0].size());
    EXPECT_GT(left[zeta].size(), left[-1.0].size() - 60);
    for (const auto &grain : left[zeta]) EXPECT_EQ(left[-1.0].count(grain.first), 1u);
  }
}

TEST(TangentialIntegration, ADampedContactOpensInTheEndIfNothingSlowsTheGrain)
{
  // without friction and pivots: all but those whose load is as close to F_c as 1 in 300
  const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  History h;
  h.dt = 3.0e-6 / 600;
  h.smooth = false;
  for (int k = 0; k < 600; k++) h.a.push_back({0.0, 0.0, 50.0 * HOLD * std::sin(M_PI * (k + 0.5) / 600)});
  h.spin.assign(600, Vec());
  Material m = CALCITE;
  m.friction = m.rolling = 0.0;
  const std::map<int, Mode> at_once = by_collision(GrainTable(texture, m, integrate()), h);
  for (double zeta : {0.7, 1.0, 2.0}) {
    m.damping = zeta;
    const std::map<int, Mode> left = by_collision(GrainTable(texture, m, integrate()), h);
    for (size_t k = 0; k < texture.grains.size(); k++) {
      const double load = largest_load(texture.grains[k], RP, m, h);
      if (std::fabs(load - 1.0) < 1.0 / 300.0) continue;
      EXPECT_EQ(left.count(k), at_once.count(k)) << zeta << " load " << load;
    }
  }
}

TEST(TangentialIntegration, AloneNeedsTheImpulses)
{
  std::mt19937 random(7);
  const History h = random_history(random);
  const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  std::map<int, int> sizes;
  for (auto tangential :
       {Criteria::OFF, Criteria::FRICTIONLESS, Criteria::ESTIMATE, Criteria::IMPULSE, Criteria::INTEGRATE}) {
    Criteria criteria;
    criteria.tangential = tangential;
    const GrainTable table(texture, CALCITE, criteria);
    std::vector<uint64_t> attached = table.all_attached();
    Workspace work;
    Collision collision;
    collision.begin(Quaternion(), NO_SPIN);
    for (size_t k = 0; k < h.a.size(); k++) collision.step(table, motion_of(h, k), h.dt, attached, work);
    sizes[tangential] = collision.packed_size();
  }
  EXPECT_EQ(sizes[Criteria::OFF], sizes[Criteria::ESTIMATE]);
  EXPECT_EQ(sizes[Criteria::FRICTIONLESS], sizes[Criteria::ESTIMATE]);
  EXPECT_EQ(sizes[Criteria::IMPULSE], sizes[Criteria::ESTIMATE]);
  EXPECT_GT(sizes[Criteria::INTEGRATE], sizes[Criteria::ESTIMATE] + 7 * ImpulseRecord::MAX_SPANS / 2);
}

namespace {

// turned axes: those of the first are these of the second
Vec turned_by(const Quaternion &q, const Vec &v)
{
  Vec w;
  q.to_space(&v.x, &w.x);
  return w;
}

std::map<int, Detachment> released(const GrainTable &table, const History &h, const Quaternion &axes)
{
  std::vector<uint64_t> attached = table.all_attached();
  Workspace work;
  Collision collision;
  const Vec spin0 = turned_by(axes, h.spin0), spin1 = turned_by(axes, h.spin.back());
  collision.begin(axes, &spin0.x);
  for (size_t k = 0; k < h.a.size(); k++) {
    Motion m = motion_of(h, k);
    axes.to_space(m.acceleration, m.acceleration);
    axes.to_space(m.angular_acceleration, m.angular_acceleration);
    axes.to_space(m.spin, m.spin);
    collision.step(table, m, h.dt, attached, work);
  }
  work.detached.clear();
  collision.end(table, &spin1.x, attached.data(), work);
  std::map<int, Detachment> left;
  for (const Detachment &d : work.detached) left[d.bit] = d;
  return left;
}

}    // namespace

TEST(TangentialIntegration, SaysInSpaceWhenAndWhereAGrainLeft)
{
  Texture texture = place_monolayer(RP, 40.0e-6, 0.15, BareCap(), 2);
  for (Grain &g : texture.grains) g.radius = RD;
  const GrainTable table(texture, CALCITE, integrate());
  Quaternion axes;
  const double angle[3] = {0.7, -1.9, 0.4};
  axes.turn_by(angle, 1.0);
  std::mt19937 random(12);
  int early = 0;
  for (int i = 0; i < 300; i++) {
    const History h = random_history(random, i % 2 ? 0.3 * std::sqrt(HOLD / SHELL) : 0.0);
    const auto one = released(table, h, Quaternion()), other = released(table, h, axes);
    ASSERT_EQ(one.size(), other.size());
    for (const auto &[bit, a] : one) {
      const Detachment &b = other.at(bit);
      EXPECT_NEAR(a.before_end, b.before_end, 1.0e-6 * h.dt);
      const auto expect_turned = [&](const double *x, const double *y, double tolerance) {
        const Vec expected = turned_by(axes, {x[0], x[1], x[2]}), found = {y[0], y[1], y[2]};
        EXPECT_NEAR(size(found - expected), 0.0, tolerance);
      };
      expect_turned(a.direction, b.direction, 1.0e-9);
      expect_turned(a.velocity, b.velocity, 1.0e-7);
      expect_turned(a.carrier_velocity, b.carrier_velocity, 1.0e-9);
      expect_turned(a.carrier_place, b.carrier_place, 1.0e-15);
      if (a.before_end == 0.0) continue;
      early++;
      // what the steps after it have added to the carrier's velocity, to the length of a span
      EXPECT_LE(a.before_end, h.dt * h.a.size());
      Vec u;
      double largest = 0.0;
      const double steps = a.before_end / h.dt;
      for (size_t k = 0; k < h.a.size(); k++) {
        u = u - std::clamp(steps - (h.a.size() - 1.0 - k), 0.0, 1.0) * h.dt * h.a[k];
        largest = std::max(largest, size(h.a[k]));
      }
      const double span = h.dt * std::max<double>(1.0, h.a.size() / 32.0);
      EXPECT_NEAR(size(u - Vec{a.carrier_velocity[0], a.carrier_velocity[1], a.carrier_velocity[2]}), 0.0,
                  0.25 * span * largest);
    }
  }
  EXPECT_GT(early, 100);
}

TEST(TangentialIntegration, AGrainThatLeavesOnTheWayHasThatMoment)
{
  // without friction, pushed along by a constant force: at the equator w = a t until |w|^2/|r_pd| = c
  Texture texture;
  texture.carrier_radius = RP;
  texture.grains = {{{1.0, 0.0, 0.0}, RD}};
  Material m = CALCITE;
  m.friction = 0.0;
  const GrainTable table(texture, m, integrate());
  History h;
  h.dt = 1.0e-9;
  h.a.assign(3000, {0.0, 0.0, 4.0e6});
  h.spin.assign(3000, Vec());
  const auto left = released(table, h, Quaternion());
  ASSERT_EQ(left.size(), 1u);
  const Detachment &d = left.begin()->second;
  // it slides by 13 um, and lifts off at w = 9.9 m/s as the carrier's acceleration helps by then
  const double time = 3.0e-6 - d.before_end, w = 4.0e6 * time, slid = 0.5 * w * time / SHELL;
  EXPECT_NEAR(w * w / SHELL + 4.0e6 * std::sin(slid), HOLD, 0.03 * HOLD);
  EXPECT_NEAR(d.velocity[2], -w * std::cos(slid), 0.02 * w);
  EXPECT_NEAR(d.direction[2], -std::sin(slid), 0.001);
  EXPECT_NEAR(d.carrier_velocity[2], -4.0e6 * d.before_end, 1.0e-9);
  EXPECT_NEAR(d.carrier_place[2], 2.0e6 * d.before_end * d.before_end, 1.0e-15);
}
