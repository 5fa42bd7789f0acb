// The impulse law: against closed forms and against friction that is summed over the collision.

#include "tangential_impulse.h"

#include "collision_reference.h"
#include "normal_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <utility>

using namespace Dust;

namespace {

Criteria with(Criteria::Tangential law)
{
  Criteria criteria;
  criteria.tangential = law;
  return criteria;
}

Material without_pivots()
{
  Material m = CALCITE;
  m.rolling = 0.0;
  return m;
}

// velocities v_t at the end of the collision of the grains that leave tangentially, by grain: when it leaves before, it
// has as much of it as half a sine has come to
std::map<int, Vec> velocities(const GrainTable &table, const History &h)
{
  std::vector<uint64_t> attached = table.all_attached();
  Workspace work;
  Collision collision;
  collision.begin(Quaternion(), NO_SPIN);
  for (const Vec &a : h.a) collision.step(table, {{a.x, a.y, a.z}, {}, {}}, h.dt, attached, work);
  collision.end(table, NO_SPIN, attached.data(), work);
  std::map<int, Vec> found;
  for (const Detachment &d : work.detached)
    if (d.mode == TANGENTIAL) {
      const double tau = M_PI * (1.0 - d.before_end / (h.a.size() * h.dt)), share = 0.5 * (1.0 - std::cos(tau));
      found[table.grain(d.bit)] = 1.0 / share * Vec{d.velocity[0], d.velocity[1], d.velocity[2]};
    }
  return found;
}

// well on the north a grain is not lifted on its way
constexpr double NORTH = 0.1;

Vec direction(const Grain &g) { return {g.n[0], g.n[1], g.n[2]}; }

}    // namespace

TEST(TangentialImpulse, RingOfTheClosedForm)
{
  // along z, with t the polar angle: v_t = |Dv| sin t less the smaller of 2/7 of it and mu_f (2 c Dt + |Dv| cos t), if
  // pivots take nothing
  const double v_crit = std::sqrt(HOLD * SHELL), bare = 0.5 * (1.0 - std::cos(0.33));
  for (double damping : {1.112, 0.2733, 0.0766}) {
    const History h = straight_impact(9.0, damping);
    const double dv = size(h.before + -1.0 * h.after), time = h.a.size() * h.dt;
    const auto leaves = [&](double t) {
      const double slip = dv * std::sin(t), taken = 0.3 * (2.0 * HOLD * time + dv * std::cos(t));
      return slip - std::min(2.0 / 7.0 * slip, taken) > v_crit;
    };
    double inside = 0.5 * M_PI, outside = 0.0;    // it grows with t up to the equator
    ASSERT_TRUE(leaves(inside));
    for (int i = 0; i < 60; i++) (leaves(0.5 * (inside + outside)) ? inside : outside) = 0.5 * (inside + outside);
    const double expected = 0.5 * std::cos(inside) / (1.0 - bare);
    double found = 0.0;
    for (int seed = 1; seed <= 20; seed++) {
      const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), seed);
      const GrainTable table(texture, without_pivots(), with(Criteria::IMPULSE));
      found += by_collision(texture, table, h).north / 4500.0 / 20.0;
    }
    EXPECT_NEAR(found, expected, 0.003) << damping;
  }
}

TEST(TangentialImpulse, EveryGrainLeavesThatNothingHolds)
{
  const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  Material m = CALCITE;
  m.gamma *= 1.0e-8;
  const GrainTable table(texture, m, with(Criteria::IMPULSE));
  EXPECT_EQ(by_collision(texture, table, straight_impact(4.0, 0.2733)).left.size(), 4500u);
}

TEST(TangentialImpulse, FrictionTakesAtMostWhatMakesAGrainRoll)
{
  const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  const History h = straight_impact(12.0, 0.0766);
  const std::map<int, Vec> free = velocities(GrainTable(texture, CALCITE, with(Criteria::FRICTIONLESS)), h);
  Material m = without_pivots();
  m.friction = 1.0e12;
  const std::map<int, Vec> rough = velocities(GrainTable(texture, m, with(Criteria::IMPULSE)), h);
  int north = 0;
  for (const auto &[grain, v] : rough) {
    if (direction(texture.grains[grain]).z <= NORTH) continue;
    ASSERT_EQ(free.count(grain), 1u);
    EXPECT_NEAR(size(v), 5.0 / 7.0 * size(free.at(grain)), 1.0e-12);
    north++;
  }
  EXPECT_GT(north, 1000);
  EXPECT_LT(rough.size(), free.size());
  m.friction = 0.0;
  const std::map<int, Vec> smooth = velocities(GrainTable(texture, m, with(Criteria::IMPULSE)), h);
  for (const auto &[grain, v] : free)
    if (direction(texture.grains[grain]).z > NORTH) {
      EXPECT_NEAR(size(smooth.at(grain)), size(v), 1.0e-12);
    }
}

TEST(TangentialImpulse, FrictionIsTheMomentumSummedOverTheCollision)
{
  // mu_f (2 F_c - F_n) in each step of a Hertzian pulse, against the slip as it is then, and on the spin of a sphere
  const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  for (double friction : {0.1, 0.3, 0.6})
    for (double damping : {0.01, 0.2733}) {
      const History h = straight_impact(11.0, damping);
      Material m = without_pivots();
      m.friction = friction;
      int slid = 0, rolled = 0;
      for (const auto &[grain, v] : velocities(GrainTable(texture, m, with(Criteria::IMPULSE)), h)) {
        const Vec n = direction(texture.grains[grain]);
        if (n.z <= NORTH) continue;
        double w = 0.0, rolling = 0.0;    // along the meridian
        for (const Vec &a : h.a) {
          const double push = -std::sqrt(1.0 - n.z * n.z) * a.z, slip = w + push * h.dt - rolling;
          const double limit = friction * (2.0 * HOLD + dot(a, n)) * h.dt;
          const double taken = std::copysign(std::min(limit, 2.0 / 7.0 * std::fabs(slip)), slip);
          w += push * h.dt - taken;
          rolling += 2.5 * taken;
        }
        (std::fabs(w - rolling) > 1.0e-9 ? slid : rolled)++;
        // at first, while a is small, a grain rolls and needs less than its friction: and is the faster at the end
        EXPECT_GT(std::fabs(w), size(v) - 1.0e-9);
        EXPECT_LT(std::fabs(w), 1.006 * size(v));
      }
      EXPECT_GT(slid + rolled, 800);
      if (friction == 0.3) {
        EXPECT_GT(slid, 100);
      }
      if (friction == 0.6) {
        EXPECT_GT(rolled, 100);
      }
    }
}

TEST(TangentialImpulse, TurningEverythingChangesNothing)
{
  std::mt19937 random(5);
  Texture texture = place_monolayer(RP, 40.0e-6, 0.15, BareCap(), 2);
  for (Grain &g : texture.grains) g.radius = RD;
  const GrainTable table(texture, CALCITE, with(Criteria::IMPULSE));
  int left = 0;
  for (int i = 0; i < 500; i++) {
    const History h = random_history(random, i % 2);
    const auto turn = [](const Vec &v) { return Vec{-v.y, v.z, -v.x}; };    // a rotation without round-off
    Texture texture1 = texture;
    for (Grain &g : texture1.grains) {
      const Vec n = turn(direction(g));
      g.n[0] = n.x, g.n[1] = n.y, g.n[2] = n.z;
    }
    History h1 = h;
    for (std::vector<Vec> *vectors : {&h1.a, &h1.alpha})
      for (Vec &v : *vectors) v = turn(v);
    for (Vec *v : {&h1.before, &h1.after, &h1.axis, &h1.spin}) *v = turn(*v);
    Outcome found = by_collision(texture, table, h);
    for (auto &[grain, place] : found.where) place = {turn(place.direction), turn(place.velocity), place.before_end};
    expect_same(by_collision(texture1, GrainTable(texture1, CALCITE, with(Criteria::IMPULSE)), h1), found);
    left += found.left.size();
  }
  EXPECT_GT(left, 10000);
}

TEST(TangentialImpulse, ACarrierThatSpinsEvenlyInAStraightImpactCarriesItsGrainsAlong)
{
  // about the normal of the wall: the slip has no part of it, and the grains keep their share of the rotation
  const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  const GrainTable table(texture, CALCITE, with(Criteria::IMPULSE));
  const History h = straight_impact(9.0, 0.2733);
  const std::map<int, Vec> without = velocities(table, h);
  const double spin[3] = {0.0, 0.0, 3000.0};
  std::vector<uint64_t> attached = table.all_attached();
  Workspace work;
  Collision collision;
  collision.begin(Quaternion(), spin);
  for (const Vec &a : h.a) collision.step(table, {{a.x, a.y, a.z}, {}, {0.0, 0.0, 3000.0}}, h.dt, attached, work);
  work.detached.clear();
  ASSERT_TRUE(collision.end(table, spin, attached.data(), work));
  int both = 0;
  for (const Detachment &d : work.detached) {
    const Vec n0 = direction(texture.grains[table.grain(d.bit)]), along = SHELL * cross({0.0, 0.0, 3000.0}, n0);
    const Vec v = {d.velocity[0], d.velocity[1], d.velocity[2]}, n = {d.direction[0], d.direction[1], d.direction[2]};
    EXPECT_NEAR(size(n), 1.0, 1.0e-12);
    EXPECT_NEAR(dot(v, n), 0.0, 1.0e-12);
    EXPECT_LT(v.z, 0.0);
    const auto still = without.find(table.grain(d.bit));
    if (n0.z <= NORTH || still == without.end()) continue;
    EXPECT_NEAR(dot(v, v), dot(along, along) + dot(still->second, still->second), 1.0e-9 * dot(v, v));
    // moved by all of what it was carried along with and by half of what it has slid
    const double moved = 0.5 * (dot(v, v) + dot(along, along)) * h.a.size() * h.dt / SHELL;
    EXPECT_NEAR(dot(n - n0, v), moved, 0.05 * moved);
    both++;
  }
  EXPECT_GT(both, 500);
}

TEST(TangentialImpulse, PivotsTakeTheMomentumOfTheirMoment)
{
  // a grain that rolls from first to last, against the moment of each step
  const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  const History h = straight_impact(12.0, 0.2733);
  Material m = CALCITE;
  m.friction = 10.0;
  const std::map<int, Vec> free = velocities(GrainTable(texture, without_pivots(), with(Criteria::FRICTIONLESS)), h);
  const std::map<int, Vec> found = velocities(GrainTable(texture, m, with(Criteria::IMPULSE)), h);
  int north = 0;
  for (const auto &[grain, v] : found) {
    const double z = texture.grains[grain].n[2];
    if (z <= NORTH) continue;
    double lost = 0.0;
    for (const Vec &a : h.a) {
      // M = 4 F_c (a/a0)^(3/2) xi at xi = R_12 theta_crit, with the (a/a0)^(3/2) of the load
      const double x3 = 0.5 * (1.0 + std::sqrt(1.0 + a.z * z / HOLD)), xi = effective_radius(RP, RD) * 0.15;
      lost += 5.0 / 7.0 * 4.0 * HOLD * x3 * xi / RD * h.dt;
    }
    const double rolling = 5.0 / 7.0 * size(free.at(grain));
    EXPECT_NEAR(rolling - size(v), lost, 0.05 * lost);
    EXPECT_GT(lost, 0.015 * rolling);
    north++;
  }
  EXPECT_GT(north, 800);
}

TEST(TangentialImpulse, GrainsThatComeToTheSideOfTheContactLeaveEarly)
{
  // straight and too slow for v_crit: against grains that slide along the meridian in the steps of the pulse itself.
  // The polar angle from which they leave differs as half a sine does from the pulse: by the angle of a fifth of them.
  const double v_crit = std::sqrt(HOLD * SHELL);
  for (const auto &[speed, damping] : {std::pair(5.0, 0.2733), std::pair(5.9, 0.2733), std::pair(6.0, 0.571)}) {
    const History h = straight_impact(speed, damping);
    EXPECT_LT(size(h.before + -1.0 * h.after) - 0.3 * 2.0 * HOLD * h.a.size() * h.dt, v_crit);
    const auto leaves = [&](double z, bool moves) {
      double t = std::acos(z), w = 0.0, rolling = 0.0;    // polar angle, velocity along the meridian
      for (const Vec &a : h.a) {
        const double fn = w * w / SHELL - a.z * std::cos(t), push = a.z * std::sin(t) * h.dt;
        if (fn > HOLD) return true;
        if (!moves) continue;
        const double taken = std::min(0.3 * (2.0 * HOLD - fn) * h.dt, 2.0 / 7.0 * (w + push - rolling));
        w += push - taken;
        rolling += 2.5 * taken;
        t += w * h.dt / SHELL;
      }
      return false;
    };
    const auto limit = [&](bool moves) {    // of z, from which grains stay
      double stays = 0.3, goes = -0.3;
      for (int i = 0; i < 40; i++) {
        const double z = 0.5 * (stays + goes);
        (leaves(z, moves) ? goes : stays) = z;
      }
      return stays;
    };
    const double with_motion = limit(true), without = limit(false);
    EXPECT_GT(with_motion, without + 0.01);
    const double expected = 0.5 * (with_motion - without) / (0.5 + 0.5 * std::cos(0.33));
    double found = 0.0;
    for (int seed = 1; seed <= 20; seed++) {
      const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), seed);
      found += velocities(GrainTable(texture, without_pivots(), with(Criteria::IMPULSE)), h).size() / 4500.0 / 20.0;
    }
    EXPECT_NEAR(found, expected, 0.2 * expected) << speed << " m/s";
  }
}

TEST(TangentialImpulse, ContactsThatOvershootLetGoOfARingInClosedForm)
{
  // a that falls evenly to 0: v_t^2/|r_pd| + C sqrt(delta_c/c) |da/dt| cos t > c
  History h;
  constexpr int STEPS = 3000;
  h.dt = 1.0e-9;
  const double slope = 9.0e6 / (STEPS * h.dt);
  for (int k = 0; k < STEPS; k++) h.a.push_back({0.0, 0.0, slope * (STEPS - k - 0.5) * h.dt});
  const double r12 = effective_radius(RP, RD), time = STEPS * h.dt, dv = 0.5 * slope * time * time;
  const double gap = breaking_gap(equilibrium_contact_radius(CALCITE.gamma, r12, CALCITE.modulus), r12);
  std::map<double, double> share;
  for (double zeta : {-1.0, 0.06, 0.2, 0.7, 1.0}) {
    Material m = without_pivots();
    m.damping = zeta;
    const double rises = zeta < 0.0 ? 0.0 : overshoot(zeta) * std::sqrt(gap / HOLD) * slope;
    const auto leaves = [&](double t) {
      const double slip = dv * std::sin(t), taken = 0.3 * (2.0 * HOLD * time + dv * std::cos(t));
      return std::pow(slip - std::min(2.0 / 7.0 * slip, taken), 2) / SHELL + rises * std::cos(t) > HOLD;
    };
    double inside = 0.5 * M_PI, outside = 0.0;
    ASSERT_TRUE(leaves(inside));
    for (int i = 0; i < 60; i++) (leaves(0.5 * (inside + outside)) ? inside : outside) = 0.5 * (inside + outside);
    const double expected = 0.5 * std::cos(inside) / (0.5 + 0.5 * std::cos(0.33));
    for (int seed = 1; seed <= 20; seed++) {
      const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), seed);
      share[zeta] += by_collision(texture, GrainTable(texture, m, with(Criteria::IMPULSE)), h).north / 4500.0 / 20.0;
    }
    EXPECT_NEAR(share[zeta], expected, 0.003) << zeta;
  }
  EXPECT_EQ(share[0.7], share[-1.0]);
  EXPECT_EQ(share[1.0], share[-1.0]);
  EXPECT_GT(share[0.2], share[-1.0] + 0.02);
  EXPECT_GT(share[0.06], share[0.2] + 0.01);
}

TEST(TangentialImpulse, ContactsThatRingLetGoOfWhatFollowedOnesDo)
{
  const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  for (double speed : {8.0, 12.0})
    for (double zeta : {0.06, 0.2}) {
      const History h = straight_impact(speed, 0.2733);
      Material m = CALCITE;
      m.damping = zeta;
      const GrainTable table(texture, m, with(Criteria::IMPULSE)), followed(texture, m, with(Criteria::INTEGRATE));
      const Outcome found = by_collision(texture, table, h);
      expect_same(by_collision(texture, table, h, 17), found);
      EXPECT_NEAR(found.left.size(), by_collision(texture, followed, h).left.size(), 0.01 * 4500)
          << speed << " " << zeta;
    }
}

TEST(TangentialImpulse, ContactsThatRingLetGoWhereNoVelocityWouldDo)
{
  // slower than what adhesion holds on a curved path, but the load comes fast
  History h;
  constexpr int STEPS = 1260;
  h.dt = 1.0e-9;
  for (int k = 0; k < STEPS; k++) h.a.push_back({0.0, 0.0, 1.0e13 * (STEPS - k - 0.5) * h.dt});
  ASSERT_LT(0.5 * 1.0e13 * std::pow(STEPS * h.dt, 2), 0.8 * std::sqrt(HOLD * SHELL));
  const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  Material m = CALCITE;
  EXPECT_EQ(by_collision(texture, GrainTable(texture, m, with(Criteria::IMPULSE)), h).north, 0);
  m.damping = 0.06;
  EXPECT_GT(by_collision(texture, GrainTable(texture, m, with(Criteria::IMPULSE)), h).north, 300);
}
