// Eqs. 4 to 6: against a closed form, and what is left of a grain's velocity.

#include "tangential_estimate.h"

#include "collision_reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace Dust;

TEST(TangentialEstimate, FrictionlessRingOfTheClosedForm)
{
  // v_t0 = |Dv| sin(polar angle) above v_crit: the ring between asin(v_crit/|Dv|) and the equator
  Criteria criteria;
  criteria.tangential = Criteria::FRICTIONLESS;
  const History h = straight_impact(8.0, 0.2733);
  const double v_crit = std::sqrt(HOLD * (RP + RD)), dv = size(h.before + -1.0 * h.after);
  EXPECT_NEAR(v_crit, 10.05, 0.005);    // sqrt(c |r_pd|)
  const double bare = 0.5 * (1.0 - std::cos(0.33));
  const double expected = 0.5 * std::sqrt(1.0 - std::pow(v_crit / dv, 2)) / (1.0 - bare);
  double found = 0.0;
  for (int seed = 1; seed <= 20; seed++) {
    const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), seed);
    found += by_collision(texture, GrainTable(texture, CALCITE, criteria), h).north / 4500.0 / 20.0;
  }
  EXPECT_NEAR(found, expected, 0.003);
}

TEST(TangentialEstimate, RearGrainsFlyOffWithWhatFrictionLeaves)
{
  const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  Criteria criteria;
  criteria.tangential = Criteria::ESTIMATE;
  const GrainTable table(texture, CALCITE, criteria);
  const History h = straight_impact(9.0, 0.2733);
  std::vector<uint64_t> attached = table.all_attached();
  Workspace work;
  std::vector<Detachment> &detached = work.detached;
  Collision collision;
  const double spin[3] = {0.0, 0.0, 0.0};
  collision.begin(Quaternion(), spin);
  for (const Vec &a : h.a) collision.step(table, {{a.x, a.y, a.z}, {}, {}}, h.dt, attached, work);
  detached.clear();
  ASSERT_TRUE(collision.end(table, spin, attached.data(), work));
  const double needed = std::sqrt(HOLD * (RP + RD)), dv = size(h.before + -1.0 * h.after);
  double peak = 0.0;
  for (const Vec &a : h.a) peak = std::max(peak, a.z);
  for (const Detachment &d : detached) {
    const Grain &g = texture.grains[table.grain(d.bit)];
    const Vec v = {d.velocity[0], d.velocity[1], d.velocity[2]}, n = {g.n[0], g.n[1], g.n[2]};
    EXPECT_NEAR(dot(v, n), 0.0, 1.0e-12);    // along the surface,
    EXPECT_LT(v.z, 0.0);                     // towards the point of impact,
    EXPECT_GT(size(v), needed);              // faster than what adhesion can hold,
    // and as slow as E_fr of doc/fix_dust_detach.rst leaves it, with F_n/m = -a n_z
    const double s0 = dv * std::sqrt(1.0 - n.z * n.z), longest = 0.5 * s0 * h.a.size() * h.dt;
    const double E = 0.5 * CALCITE.friction * (2.0 * HOLD + peak * n.z) * longest;
    EXPECT_NEAR(size(v), std::sqrt(s0 * s0 - 2.0 * E), 1.0e-9);
  }
}
