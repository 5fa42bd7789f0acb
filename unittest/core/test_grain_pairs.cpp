// Contacts of grains with each other: conservation laws, and what a softer contact must not change.

#include "grain_pairs.h"

#include "jkr.h"
#include "meeting_case.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

using namespace Dust;

namespace {

using Vec3 = std::array<double, 3>;

// grains that fly 100 um above the carrier, where nothing else acts on them
struct Cloud {
  GrainTable table;
  GrainLanes lanes;
  GrainPairs pairs;
  std::vector<char> present;

  Cloud(const std::vector<double> &angles, const std::vector<double> &radii, double zeta, const Material &m) :
      table(on_circle(angles, radii), m, meeting_criteria()), lanes(table, 1.0), pairs(table, zeta, m.softening),
      present(angles.size(), 1)
  {
  }
  int bit(int grain) const { return bit_of(table, grain); }
  void place(int grain, const Vec3 &x, const Vec3 &v, const Vec3 &spin = {0.0, 0.0, 0.0})
  {
    GrainLanes::Grain g = lanes.get(bit(grain));
    const double r = std::sqrt(dot(x.data(), x.data()));
    for (int d = 0; d < 3; d++) {
      g.n[d] = x[d] / r;
      g.v[d] = v[d];
      g.spin[d] = spin[d];
      g.psi[d] = 0.0;
    }
    g.gap = r - table.site(bit(grain)).shell;
    g.held = 0.0;
    g.awake = 1.0;
    lanes.put(bit(grain), g);
  }
  void run(int steps, double h)
  {
    for (int k = 0; k < steps; k++) {
      pairs.push(lanes, present, h);
      lanes.advance({{}, h}, false);
      pairs.moved(lanes.max_speed() * h);
    }
  }
  Vec3 velocity(int grain) const
  {
    Vec3 v;
    lanes.velocity(bit(grain), v.data());
    return v;
  }
  double mass(int grain) const { return table.weight(bit(grain)) * table.mean_mass(); }
  // momentum, and angular momentum about the carrier's centre, of all; positions are half a step ahead
  std::array<double, 6> momenta(double h) const
  {
    std::array<double, 6> sum = {};
    for (int b = 0; b < table.grains(); b++) {
      const double m = table.weight(b) * table.mean_mass(), radius = lanes.place(b)[3];
      double v[3], w[3], x[3], l[3];
      lanes.velocity(b, v);
      lanes.spin(b, w);
      for (int d = 0; d < 3; d++) x[d] = lanes.place(b)[d] - 0.5 * h * v[d];
      cross(x, v, l);
      for (int d = 0; d < 3; d++) {
        sum[d] += m * v[d];
        sum[3 + d] += m * (l[d] + 0.4 * radius * radius * w[d]);
      }
    }
    return sum;
  }
};

// two grains of 20 and 12 um hit each other head on with this speed: by how much of it they part
double restitution(double speed, double zeta, double softening, double h, double cohesion)
{
  Material m = meeting(softening);
  m.cohesion = cohesion;
  Cloud two({0.0, 0.5}, {10.0e-6, 6.0e-6}, zeta, m);
  const double z = RP + 200.0e-6;
  two.place(0, {-8.5e-6, 0.0, z}, {0.5 * speed, 0.0, 0.0});
  two.place(1, {8.5e-6, 0.0, z}, {-0.5 * speed, 0.0, 0.0});
  two.run(static_cast<int>(3.0e-6 / h), h);
  return (two.velocity(1)[0] - two.velocity(0)[0]) / speed;
}

}    // namespace

// no force but their own: momentum and angular momentum, to round-off
TEST(GrainPairs, KeepsMomentum)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const double h = 5.0e-9, z = RP + 200.0e-6;
  for (int round = 0; round < 20; round++) {
    const std::vector<double> radii = {10.0e-6, 6.0e-6, 12.0e-6, 4.0e-6};
    Cloud some({0.0, 0.2, 0.4, 0.6}, radii, 1.0, meeting());
    for (int g = 0; g < 4; g++)
      some.place(g, {15.0e-6 * (g % 2), 15.0e-6 * (g / 2), z},
                 {(g % 2 ? -3.0 : 3.0) + any(random), (g / 2 ? -3.0 : 3.0) + any(random), any(random)},
                 {1e5 * any(random), 1e5 * any(random), 1e5 * any(random)});
    const auto before = some.momenta(h);
    some.run(400, h);
    const auto after = some.momenta(h);
    const double scale = some.mass(2) * 3.0;
    for (int d = 0; d < 3; d++) EXPECT_NEAR(after[d], before[d], 1e-12 * scale) << round;
    for (int d = 3; d < 6; d++) EXPECT_NEAR(after[d], before[d], 1e-11 * scale * RP) << round;
  }
}

// elastic spheres part as they came, whatever the softening and the step: the rule of the midpoint loses nothing on its
// own but where the contact begins and ends within a step
TEST(GrainPairs, ElasticGrainsBounce)
{
  for (const double softening : {30.0, 100.0, 300.0})
    for (const double h : {1.0e-9, 5.0e-9, 10.0e-9})
      EXPECT_NEAR(restitution(4.0, 0.0, softening, h, 1.0e-4), 1.0, 0.1 * h / 1.0e-9 * 0.1 + 0.02)
          << softening << " " << h;
}

// weakly damped, so that there is a restitution to keep
TEST(GrainPairs, SofteningKeepsTheRestitution)
{
  const double hard = restitution(4.0, 0.02, 1.0, 0.05e-9, 1.0e-4);
  EXPECT_GT(hard, 0.3);
  EXPECT_LT(hard, 0.9);
  for (const double softening : {10.0, 100.0, 300.0})
    EXPECT_NEAR(restitution(4.0, 0.02, softening, 1.0e-9, 1.0e-4), hard, 0.02) << softening;
}

TEST(GrainPairs, DampedGrainsStayTogether)
{
  Material m = meeting();
  Cloud two({0.0, 0.5}, {10.0e-6, 6.0e-6}, 1.0, m);
  const double z = RP + 200.0e-6;
  two.place(0, {-8.5e-6, 0.0, z}, {0.05, 0.0, 0.0});
  two.place(1, {8.5e-6, 0.0, z}, {-0.05, 0.0, 0.0});
  two.run(3000, 10.0e-9);
  ASSERT_EQ(two.pairs.necks().size(), 1u);
  const double parting = two.velocity(1)[0] - two.velocity(0)[0];
  EXPECT_NEAR(parting, 0.0, 1e-4);
  // they fly on together, with the momentum that they had
  const double both = two.mass(0) + two.mass(1);
  EXPECT_NEAR(two.velocity(0)[0], 0.05 * (two.mass(0) - two.mass(1)) / both, 1e-4);
}

// friction turns them, and gives no more than mu times the normal momentum
TEST(GrainPairs, FrictionIsCoulombs)
{
  Material m = meeting();
  m.cohesion = 1.0e-4;
  m.friction = 0.05;
  Cloud two({0.0, 0.5}, {10.0e-6, 10.0e-6}, 0.1, m);
  const double z = RP + 200.0e-6;
  two.place(0, {-10.5e-6, 0.0, z}, {3.0, 0.0, 0.0}, {0.0, 0.0, 1.0e6});
  two.place(1, {10.5e-6, 0.0, z}, {-3.0, 0.0, 0.0}, {0.0, 0.0, 1.0e6});
  const double before = two.velocity(0)[0];
  two.run(600, 2.0e-9);
  const Vec3 after = two.velocity(0);
  EXPECT_NEAR(std::fabs(after[1]), m.friction * std::fabs(after[0] - before), 0.02 * std::fabs(after[1]));
  EXPECT_GT(std::fabs(after[1]), 0.1);
}

// whom a search finds beyond those that touch, and when, changes no bit: a search in each step, or as seldom as can be
TEST(GrainPairs, WhenNeighboursAreSoughtChangesNoBit)
{
  const auto run = [](bool always) {
    std::vector<double> angles, radii;
    for (int k = 0; k < 40; k++) {
      angles.push_back(0.028 * k);
      radii.push_back(k % 3 ? 6.0e-6 : 10.0e-6);
    }
    Cloud many(angles, radii, 1.0, meeting());
    std::mt19937 random(8);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int b = 0; b < 40; b++) {
      GrainLanes::Grain g = many.lanes.get(b);
      for (double &x : g.v) x = 5.0 * any(random);
      g.awake = b % 4 ? 1.0 : 0.0;
      many.lanes.put(b, g);
    }
    for (int k = 0; k < 400; k++) {
      if (always) many.pairs.set_necks(many.pairs.necks());
      many.run(1, 10.0e-9);
    }
    std::vector<double> all;
    for (int b = 0; b < 40; b++) {
      const GrainLanes::Grain g = many.lanes.get(b);
      all.insert(all.end(), {g.n[0], g.n[1], g.n[2], g.gap, g.v[0], g.spin[1], g.held, g.awake});
    }
    all.push_back(static_cast<double>(many.pairs.necks().size()));
    return all;
  };
  EXPECT_EQ(run(true), run(false));
}
