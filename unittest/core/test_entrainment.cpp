// Grains of a carrier followed together: alone they do what they do alone, and how it is asked changes nothing.

#include "entrainment.h"

#include "meeting_case.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

using namespace Dust;

namespace {

constexpr double DT = 1.0e-9;

// a straight impact as half a sine of acceleration along z that changes the velocity by dv, on a whole texture
struct Impact {
  Collision collision;
  std::vector<uint64_t> attached;
  Workspace work;
  std::map<int, Mode> alone;    // by grain
  std::vector<Detachment> late;

  Impact(const GrainTable &table, double dv, double duration = 3.0e-6) : attached(table.all_attached())
  {
    collision.begin(Quaternion(), NO_SPIN);
    const int steps = static_cast<int>(duration / DT);
    for (int k = 0; k < steps; k++) {
      Motion motion = {};
      motion.acceleration[2] = 0.5 * M_PI * dv / duration * std::sin(M_PI * (k + 0.5) / steps);
      collision.step(table, motion, DT, attached, work);
    }
    note(table);
    collision.end(table, NO_SPIN, attached.data(), work);
    late = work.detached;
    note(table);
  }
  void note(const GrainTable &table)
  {
    for (const Detachment &d : work.detached) alone[table.grain(d.bit)] = d.mode;
    work.detached.clear();
  }
};

struct Followed {
  std::map<int, Mode> off;    // by grain
  std::vector<Entrainment::Departure> departures;
  int returns = 0;

  void take(const GrainTable &table, Entrainment &together)
  {
    for (const auto &change : together.changes) {
      if (change.released)
        off[table.grain(change.bit)] = change.mode;
      else
        returns += off.erase(table.grain(change.bit));
    }
    departures.insert(departures.end(), together.departures.begin(), together.departures.end());
    together.changes.clear();
    together.departures.clear();
  }
};

// until nothing moves, in calls of this time each; packed and unpacked now and then
Followed follow(const GrainTable &table, Impact &impact, double call = 1.0e-7, int handover = 0)
{
  auto together = std::make_unique<Entrainment>(table);
  impact.collision.hand_over(table, NO_SPIN, impact.late, impact.attached.data(), *together);
  EXPECT_EQ(impact.attached, table.all_attached());
  Followed found;
  found.take(table, *together);
  for (int k = 0; !together->over(); k++) {
    together->fly(call);
    found.take(table, *together);
    if (!handover || k % handover) continue;
    Packer counter;
    together->pack(counter);
    EXPECT_EQ(counter.size(), together->packed_size());
    EXPECT_GT(together->memory_usage(), 280.0 * table.grains());
    std::vector<double> buffer(counter.size());
    Packer packer(buffer.data());
    together->pack(packer);
    auto other = std::make_unique<Entrainment>(table);
    Unpacker unpacker(buffer.data());
    other->unpack(unpacker);
    EXPECT_EQ(unpacker.position(), buffer.data() + buffer.size());
    together = std::move(other);
  }
  together->stop();
  found.take(table, *together);
  return found;
}

GrainTable dense(double softening = 100.0)
{
  const SizeDistribution sizes = SizeDistribution{SizeDistribution::LOGNORMAL, 60.0e-6, 1.5};
  return {place_monolayer(RP, sizes, 0.25, BareCap{0.8, {0.0, 0.0, -1.0}}, 3), meeting(softening), meeting_criteria()};
}

}    // namespace

// far from each other, none is knocked off, and all leave that leave alone: but those on the very edge
TEST(Entrainment, AloneTheyDoAsAlone)
{
  const GrainTable table(place_monolayer(RP, RD, 0.01, BareCap{0.4, {0.0, 0.0, -1.0}}, 5), meeting(),
                         meeting_criteria());
  for (const double dv : {3.0, 8.0, 13.0, 20.0}) {
    Impact impact(table, dv);
    const Followed found = follow(table, impact);
    int other = 0;
    for (const auto &[grain, mode] : found.off) {
      EXPECT_NE(mode, KNOCKED);
      const auto it = impact.alone.find(grain);
      if (it == impact.alone.end() || it->second != mode) other++;
    }
    other += static_cast<int>(impact.alone.size()) - static_cast<int>(found.off.size());
    EXPECT_LE(std::abs(other), 2) << dv << ", of " << impact.alone.size();    // of 225
    if (dv > 10.0) {
      EXPECT_GT(found.off.size(), 100u);
    }
  }
}

// a coarse grain, which adhesion brakes less, runs into a fine one on its way: the line of centres is inclined, and
// lifts it. Alone both stay
TEST(Entrainment, OneKnocksTheOtherOff)
{
  const GrainTable two(on_circle({0.8, 0.8 + 25.0e-6 / RP}, {14.0e-6, 5.0e-6}), meeting(), meeting_criteria());
  const GrainTable far(on_circle({0.8, 1.6}, {14.0e-6, 5.0e-6}), meeting(), meeting_criteria());
  Impact impact(two, 7.0), apart(far, 7.0);
  EXPECT_TRUE(impact.alone.empty());
  const Followed found = follow(two, impact);
  ASSERT_EQ(found.off.count(0), 1u);
  EXPECT_EQ(found.off.at(0), KNOCKED);
  EXPECT_TRUE(follow(far, apart).off.empty());
}

TEST(Entrainment, DenseLayersKnockOff)
{
  const GrainTable table = dense();
  Impact impact(table, 8.0);
  const Followed found = follow(table, impact);
  int knocked = 0;
  for (const auto &[grain, mode] : found.off) {
    knocked += mode == KNOCKED;
    EXPECT_EQ(mode == KNOCKED, impact.alone.count(grain) == 0);
  }
  EXPECT_GT(knocked, 10);
  EXPECT_EQ(found.departures.size(), found.off.size());    // each says how it left, in the end
}

// in calls of any length, and handed over in the middle: the same grains at the same moments
TEST(Entrainment, HowItIsAskedChangesNothing)
{
  const GrainTable table = dense();
  Impact first(table, 8.0), second(table, 8.0), third(table, 8.0);
  const Followed expected = follow(table, first), often = follow(table, second, 1.0e-9),
                 handed = follow(table, third, 1.0e-7, 7);
  for (const Followed *other : {&often, &handed}) {
    EXPECT_EQ(other->off, expected.off);
    EXPECT_EQ(other->returns, expected.returns);
    ASSERT_EQ(other->departures.size(), expected.departures.size());
  }
  for (size_t k = 0; k < expected.departures.size(); k++) {
    const auto &a = handed.departures[k], &b = expected.departures[k];
    EXPECT_EQ(a.left.bit, b.left.bit);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.flown, b.flown);
    for (int d = 0; d < 3; d++) EXPECT_EQ(a.velocity[d], b.velocity[d]);
  }
}

// what a departure says of its moment agrees with where the grain is in the end, if it has met nothing since
TEST(Entrainment, DeparturesFlyStraight)
{
  const GrainTable table(place_monolayer(RP, RD, 0.01, BareCap{0.4, {0.0, 0.0, -1.0}}, 5), meeting(),
                         meeting_criteria());
  Impact impact(table, 13.0);
  const Followed found = follow(table, impact);
  ASSERT_GT(found.departures.size(), 50u);
  for (const auto &departure : found.departures) {
    const Detachment &left = departure.left;
    const double distance = table.site(left.bit).shell + departure.height, time = left.before_end + departure.flown;
    for (int d = 0; d < 3; d++) {
      // the carrier has gone on since, by r and with u (retrospect.h)
      const double then = distance * left.direction[d] + left.carrier_place[d];
      const double velocity = left.velocity[d] + left.carrier_velocity[d];
      EXPECT_NEAR(departure.place[d], then + time * velocity, 0.2e-6);
      EXPECT_NEAR(departure.velocity[d], velocity, 0.02);
    }
  }
}

// softer and coarser by factors: shares of this small texture within a few grains
TEST(Entrainment, SofteningAndStepHardlyMatter)
{
  const auto share = [](double softening, double step) {
    const SizeDistribution sizes = SizeDistribution{SizeDistribution::LOGNORMAL, 40.0e-6, 1.5};
    Material m = meeting(softening);
    m.step = step;
    const GrainTable table(place_monolayer(RP, sizes, 0.2, BareCap{0.6, {0.0, 0.0, -1.0}}, 3), m, meeting_criteria());
    Impact impact(table, 9.0);
    double off = 0.0, all = 0.0;
    const Followed found = follow(table, impact);
    for (int bit = 0; bit < table.grains(); bit++) {
      all += table.weight(bit);
      if (found.off.count(table.grain(bit))) off += table.weight(bit);
    }
    return off / all;
  };
  const double usual = share(100.0, 10.0e-9);
  EXPECT_GT(usual, 0.6);
  for (const auto &[softening, step] :
       {std::pair(30.0, 10.0e-9), std::pair(300.0, 10.0e-9), std::pair(100.0, 5.0e-9), std::pair(100.0, 20.0e-9)})
    EXPECT_NEAR(share(softening, step), usual, 0.012) << softening << " " << step;
}
