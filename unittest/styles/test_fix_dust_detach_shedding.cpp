// fix dust/detach with mass yes and emit: mass, momentum and grains that leave, whatever happens around them.

#include "deck.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <utility>

using namespace LAMMPS_NS;

namespace {

using Vec = std::array<double, 3>;

constexpr double RADIUS = 0.75e-3, BARE = 4.0 / 3.0 * M_PI * RADIUS * RADIUS * RADIUS * 7700.0;

// a cubic box without walls, periodic unless said
void space(Deck &deck, double half, const std::string &boundary = "p p p")
{
  deck("units si\natom_style sphere\nboundary " + boundary + "\nnewton off\ncomm_modify vel yes\nregion box block" +
       line(" -%g %g", half, half) + line(" -%g %g", half, half) + line(" -%g %g", half, half) +
       "\ncreate_box 2 box\ntimestep 1e-9\nneighbor 3e-4 bin\npair_style granular\npair_coeff * * " + contact(0.7));
}

void spin(Deck &deck, int id, double x, double y, double z)
{
  deck("set atom " + std::to_string(id) + line(" omega %.17g %.17g %.17g", x, y, z));
}

// small neighbour bins and no contact forces of grains
void grains_that_touch_nothing(Deck &deck)
{
  const std::string soft =
      "hertz/material 1e-9 0.5 0.3 tangential linear_nohistory 0.0 0.0 damping coeff_restitution/limited\n";
  deck("neighbor 4e-5 multi\ncomm_modify mode multi vel yes\nneigh_modify one 20000 page 400000\npair_coeff 1 2 " +
       soft + "pair_coeff 2 2 " + soft);
}

// two carriers 0.15 um apart that collide off-centre, at 16 m/s
void two_that_collide(Deck &deck)
{
  deck.carrier(0, 0.4e-3, 0.6346e-3, 0, 0, -9.0);
  deck.carrier(0, -0.4e-3, -0.6346e-3, 1, 0, 7.0);
  spin(deck, 1, 3000, 0, 1000);
  deck("group carriers id 1 2");
}

struct Atom {
  int type;
  double mass, radius;
  Vec x, v, spin;
};

// all of them, by ID
std::map<tagint, Atom> atoms(const Deck &deck)
{
  std::map<tagint, Atom> all;
  const tagint *tag = deck.tags();
  const int *type = static_cast<int *>(lammps_extract_atom(deck.lmp, "type"));
  const double *mass = static_cast<double *>(lammps_extract_atom(deck.lmp, "rmass"));
  const double *radius = static_cast<double *>(lammps_extract_atom(deck.lmp, "radius"));
  const auto vector = [&](const char *name, int i) {
    const double *p = static_cast<double **>(lammps_extract_atom(deck.lmp, name))[i];
    return Vec{p[0], p[1], p[2]};
  };
  const int n = lammps_extract_setting(deck.lmp, "nlocal");
  for (int i = 0; i < n; i++)
    all[tag[i]] = {type[i], mass[i], radius[i], vector("x", i), vector("v", i), vector("omega", i)};
  EXPECT_EQ(all.size(), static_cast<size_t>(n)) << "IDs exist twice";
  return all;
}

struct Books {
  double mass = 0.0;
  Vec momentum = {0.0, 0.0, 0.0};
  int grains = 0;    // that are atoms
};

Books books(const Deck &deck)
{
  Books sum;
  for (const auto &[id, a] : atoms(deck)) {
    sum.mass += a.mass;
    for (int d = 0; d < 3; d++) sum.momentum[d] += a.mass * a.v[d];
    sum.grains += a.type == 2;
  }
  return sum;
}

void expect_same(const Books &a, const Books &b, double speed)
{
  EXPECT_NEAR(a.mass, b.mass, 1e-12 * b.mass);    // of thousands of differences
  for (int d = 0; d < 3; d++) EXPECT_NEAR(a.momentum[d], b.momentum[d], 1e-12 * b.mass * speed);
}

double total(const Deck &deck, int element) { return deck.global(element + 1); }

double detached(const Deck &deck)
{
  double sum = 0.0;
  for (int mode : {DetachVector::NORMAL, DetachVector::TANGENTIAL, DetachVector::SLIDING, DetachVector::ROLLING})
    sum += total(deck, mode);
  return sum;
}

}    // namespace

// mass yes: what the carriers weigh and what has come off is the mass at first, in every step; a grain takes its
// momentum with it, with the velocity of its row
TEST(FixDustDetachShedding, MassAndMomentumLeaveInTheStepOfTheGrain)
{
  for (const char *tangential : {"estimate", "integrate"}) {
    Deck deck;
    space(deck, 0.01);
    two_that_collide(deck);
    deck(std::string("fix move all nve/sphere\nfix dust all dust/detach ") + REFERENCE_DUST +
         " mass yes orientation random 4 every 1 tangential " + tangential);
    deck("run 0");
    Books expected = books(deck);
    EXPECT_NEAR(expected.mass, 2.0 * BARE + total(deck, DetachVector::INITIAL_MASS), 1e-14 * BARE);
    int steps_with_losses = 0;
    for (int k = 0; k < 3000; k++) {
      deck("run 1 pre no post no");
      const auto rows = deck.events();
      for (const auto &row : rows) {
        const double m = M_PI / 6.0 * std::pow(row[DetachRow::DIAMETER], 3) * 2700.0;
        expected.mass -= m;
        for (int d = 0; d < 3; d++) expected.momentum[d] -= m * row[DetachRow::VX + d];
      }
      steps_with_losses += !rows.empty();
      if (!rows.empty()) expect_same(books(deck), expected, 9.0);
    }
    expect_same(books(deck), expected, 9.0);
    EXPECT_GT(steps_with_losses, 50);
    EXPECT_GT(total(deck, DetachVector::TANGENTIAL), 100.0);
  }
}

// a carrier that has lost some goes on as one of that mass: so nothing depends on the output window. What is not in the
// restitution of 0.7 is the grains that leave where the carrier turns: they have given their momentum to the wall
// before.
TEST(FixDustDetachShedding, TheOutputWindowDoesNotMatter)
{
  const auto rebound = [](const std::string &options) {
    Deck deck;
    deck("units si\natom_style sphere\nboundary f f f\nnewton off\ncomm_modify vel yes\n"
         "region box block -0.5e-3 0.5e-3 -0.5e-3 0.5e-3 -0.1e-3 0.9e-3\ncreate_box 1 box\n"
         "create_atoms 1 single 0 0 50.05e-6\nset group all diameter 100e-6 density 1540\nvelocity all set 0 0 -10\n"
         "timestep 1e-10\npair_style none\nfix move all nve/sphere\n"
         "fix wall all wall/gran granular hertz/material 24e9 0.7 0.3 tangential mindlin NULL 0 0.05 damping "
         "coeff_restitution/limited zplane 0 NULL\n"
         "fix dust all dust/detach texture monolayer 5e-6 coverage 0.45 seed 1 bare 0.33 tangential estimate density "
         "1340 surface "
         "0.005 elastic 2e9 0.3 24e9 0.3 friction 0.3 " +
         options + "\nrun 8000 post no");
    return deck.atom("v", 1)[2] / 10.0;
  };
  const double reference = rebound("mass yes every 1");
  EXPECT_NEAR(reference, 0.7405, 5e-5);
  for (const char *every : {"100", "1000", "100000"})
    EXPECT_EQ(rebound(std::string("mass yes every ") + every), reference) << every;
  EXPECT_NEAR(rebound("mass no"), 0.7, 1e-4);
}

// the velocity of a row is the carrier's at the end of the step, not that of its half; also for a grain that is thrown
// off at the very start of a run, where LAMMPS has no half step
TEST(FixDustDetachShedding, RowsHaveTheVelocityAtTheEndOfTheStep)
{
  for (const char *mass : {"no", "yes"}) {
    Deck deck;
    deck.box();
    deck.carrier(0.0, 0.0, 0.7501e-3, 1.0, 0.0, -8.0);
    deck.wall_and_motion();
    deck("fix dust all dust/detach " + REFERENCE_DUST + " rotation no tangential off mass " + mass + "\nrun 1");
    int seen = 0;
    for (int k = 0; k < 2000 && seen < 20; k++) {
      deck("run 1 pre no post no");
      const auto rows = deck.events();
      seen += !rows.empty();
      // the force moves the carrier by 10 mm/s in a step, its grains move with it
      for (const auto &row : rows)
        for (int d = 0; d < 3; d++) EXPECT_NEAR(row[DetachRow::VX + d], deck.atom("v", 1)[d], 1e-9) << "mass " << mass;
    }
    EXPECT_EQ(seen, 20);
  }
  Deck deck;
  deck.box();
  deck.carrier(0.0, 0.0, 0.745e-3, 1.0, 0.0, -3.0);    // 5 um in the wall: 7e6 m/s2
  deck.wall_and_motion();
  deck("fix dust all dust/detach " + REFERENCE_DUST + " rotation no tangential off\nrun 0");
  deck("run 1 post no");
  int at_start = 0;
  for (const auto &row : deck.events()) {
    if (row[DetachRow::STEP] != 0.0) continue;
    at_start++;
    EXPECT_EQ(row[DetachRow::VZ], -3.0);
  }
  EXPECT_GT(at_start, 100);
}

// emit: mass and momentum of all atoms are the same before and after every run, nothing waits between runs, and a grain
// that has found no room is in its carrier again
TEST(FixDustDetachShedding, EmittedGrainsKeepMassAndMomentum)
{
  for (const char *boundary : {"p p p", "f f f", "s s s"}) {
    Deck deck;
    space(deck, 0.002, boundary);
    two_that_collide(deck);
    if (boundary[0] == 's')    // others at which the box ends
      for (double side : {-1.9e-3, 1.9e-3}) deck.carrier(side, side, side, 0, 0, 0);
    grains_that_touch_nothing(deck);
    deck("fix move all nve/sphere\nfix dust carriers dust/detach texture monolayer 20e-6 coverage 0.03 seed 1 emit 2 "
         "orientation random 4 every 100\nrun 0");
    const Books first = books(deck);
    for (int k = 0; k < 40; k++) {
      deck(k % 3 ? "run 120 post no" : "run 120 post no every 40 NULL");
      const Books now = books(deck);
      expect_same(now, first, 9.0);
      ASSERT_EQ(now.grains, detached(deck) - total(deck, DetachVector::NO_ROOM));
    }
    EXPECT_GT(detached(deck), 300.0);
    EXPECT_GT(total(deck, DetachVector::NO_ROOM), 0.0);
    EXPECT_LT(total(deck, DetachVector::NO_ROOM), 0.05 * detached(deck));    // those where the carriers touch
    // what is missing in the carriers is what flies
    double carriers = 0.0, grains = 0.0;
    for (const auto &[id, a] : atoms(deck)) (a.type == 1 ? carriers : grains) += a.mass;
    const double each = total(deck, DetachVector::INITIAL_MASS) / total(deck, DetachVector::INITIAL_GRAINS);
    EXPECT_NEAR(grains, each * (detached(deck) - total(deck, DetachVector::NO_ROOM)), 1e-12 * grains);
    EXPECT_NEAR(carriers, (boundary[0] == 's' ? 4.0 : 2.0) * BARE + total(deck, DetachVector::INITIAL_MASS) - grains,
                1e-13 * carriers);
  }
}

namespace {

// an impact at 8 m/s with large grains that touch nothing, above or on a wall for carriers only
void impact_with_grains(Deck &deck, const std::string &options = "", const std::string &modify = "")
{
  deck(modify +
       "\nunits si\natom_style sphere\nboundary f f f\nnewton off\ncomm_modify vel yes\n"
       "region box block -8e-3 8e-3 -8e-3 8e-3 -4e-3 9e-3\ncreate_box 2 box\ntimestep 1e-9\n"
       "pair_style granular\npair_coeff * * " +
       contact(0.7));
  deck.carrier(0.0, 0.0, 0.7501e-3, 0.0, 0.0, -8.0);
  grains_that_touch_nothing(deck);
  deck("group carriers type 1\nfix move all nve/sphere\nfix wall carriers wall/gran granular " + contact(0.7) +
       " zplane 0 NULL\nfix dust carriers dust/detach texture monolayer 40e-6 coverage 0.1 seed 1 emit 2 every "
       "1000000 " +
       options);
}

// where free flight has brought each grain since it left, by its place and velocity then
std::vector<Vec> free_flight(const std::vector<std::vector<double>> &rows, double now)
{
  std::vector<Vec> places;
  for (const auto &row : rows) {
    Vec x;
    for (int d = 0; d < 3; d++)
      x[d] = row[DetachRow::X + d] + (now - 1e-9 * row[DetachRow::STEP]) * row[DetachRow::VX + d];
    places.push_back(x);
  }
  std::sort(places.begin(), places.end());
  return places;
}

// where the grains are, or have been or will be at a time
std::vector<Vec> places_of_grains(const Deck &deck, double time)
{
  const double flight = time - lammps_get_thermo(deck.lmp, "time");
  std::vector<Vec> places;
  for (const auto &[id, a] : atoms(deck))
    if (a.type == 2) places.push_back({a.x[0] + flight * a.v[0], a.x[1] + flight * a.v[1], a.x[2] + flight * a.v[2]});
  std::sort(places.begin(), places.end());
  return places;
}

}    // namespace

// grains are made where free flight from the place and the step of their rows has brought them, whenever that is:
// during the run or at its end, with the time step of then or not
TEST(FixDustDetachShedding, AGrainIsMadeWhereItHasFlown)
{
  Deck deck;
  impact_with_grains(deck);
  deck("reset_timestep 990000\nrun 10000 post no");    // the window has just ended
  const auto rows = deck.events();
  ASSERT_GT(rows.size(), 300u);
  const auto expected = free_flight(rows, 1e-9 * 1e6);
  const auto found = places_of_grains(deck, lammps_get_thermo(deck.lmp, "time"));
  ASSERT_EQ(found.size(), expected.size());
  // 80 um on average; rows have the step of 1 ns next to the moment in which a grain left
  for (size_t k = 0; k < found.size(); k++)
    for (int d = 0; d < 3; d++) EXPECT_NEAR(found[k][d], expected[k][d], 0.5e-9 * 15.0);
  // with the velocity of the row
  std::vector<Vec> velocities, speeds;
  for (const auto &row : rows) velocities.push_back({row[DetachRow::VX], row[DetachRow::VY], row[DetachRow::VZ]});
  for (const auto &[id, a] : atoms(deck))
    if (a.type == 2) speeds.push_back(a.v);
  std::sort(velocities.begin(), velocities.end());
  std::sort(speeds.begin(), speeds.end());
  EXPECT_EQ(speeds, velocities);
}

// no rebuild of neighbour lists is needed for the time that a grain waits: made at once or late, it is in the same
// place, unless it meets another one there
TEST(FixDustDetachShedding, TheMomentAtWhichAGrainIsMadeDoesNotMatter)
{
  const auto run = [](const std::string &commands) {
    Deck deck;
    impact_with_grains(deck);
    deck(commands);
    return std::make_pair(places_of_grains(deck, 6e-6), total(deck, DetachVector::NO_ROOM));
  };
  const auto often = run("neigh_modify every 1 delay 0 check no\nrun 6000 post no");
  EXPECT_GT(often.first.size(), 500u);
  EXPECT_EQ(often.second, 0.0);
  for (const char *commands :
       {"neigh_modify every 100000 delay 0 check no\nrun 6000 post no", "run 6000 post no",
        "neigh_modify every 700 delay 0 check no\nrun 4000 post no\nrun 2000 pre no post no",
        // from 8 nm a step at 8 m/s to 8 nm at those of the rebound, while the grains wait
        "neigh_modify every 4500 delay 0 check no\nfix longer all dt/reset 4000 NULL NULL 8e-9\nrun 5000 post no"}) {
    const auto [places, no_room] = run(commands);
    EXPECT_LT(no_room, 40.0);
    ASSERT_EQ(places.size() + no_room, often.first.size());
    for (const Vec &x : places)
      EXPECT_TRUE(std::any_of(often.first.begin(), often.first.end(), [&](const Vec &y) {
        return std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]) < 1e-13;
      })) << commands;
  }
}

// whatever happens between two runs finds all grains as atoms
TEST(FixDustDetachShedding, CommandsBetweenRunsFindAllGrainsAsAtoms)
{
  Deck deck;
  impact_with_grains(deck);
  deck("run 5500 post no");
  const auto before = atoms(deck);
  EXPECT_GT(before.size(), 300u);
  deck("displace_atoms all move 1e-3 0 1e-3 units box\nvelocity all set 0 0 0\ntimestep 5e-9\nrun 0 post no");
  const auto after = atoms(deck);
  ASSERT_EQ(after.size(), before.size());
  for (const auto &[id, a] : after) {
    EXPECT_EQ(a.mass, before.at(id).mass);
    EXPECT_EQ(a.v, (Vec{0.0, 0.0, 0.0}));
    EXPECT_NEAR(a.x[0], before.at(id).x[0] + 1e-3, 1e-15);
    EXPECT_NEAR(a.x[2], before.at(id).x[2] + 1e-3, 1e-15);
  }
}

// a carrier that has shed something keeps its lower mass when others are deleted or IDs change
TEST(FixDustDetachShedding, MassesStayWithTheirCarriersWhenIDsChange)
{
  for (const char *emit : {"mass yes", "emit 2"}) {
    Deck deck;
    space(deck, 0.01, "p p f");
    deck.carrier(-8e-3, 0, 5e-3, 0, 0, 0);
    deck.carrier(-4e-3, 0, 5e-3, 0, 0, 0);
    deck.carrier(0, 0, 0.7501e-3, 0, 0, -8);
    deck.carrier(4e-3, 0, 5e-3, 0, 0, 0);
    deck("group carriers type 1");
    grains_that_touch_nothing(deck);
    deck(std::string("fix move all nve/sphere\nfix wall carriers wall/gran granular ") + contact(0.7) +
         " zplane 0 NULL\nfix dust carriers dust/detach " +
         "texture monolayer 40e-6 coverage 0.1 seed 1 every 100000 " + emit + "\nrun 6000 post no");
    const double lost = total(deck, DetachVector::DETACHED_MASS), each = total(deck, DetachVector::INITIAL_MASS) / 4.0;
    EXPECT_GT(lost, 0.5 * each);
    const auto carriers = [&] {
      std::map<int, std::pair<double, double>> all;    // mass and velocity, by place
      for (const auto &[id, a] : atoms(deck))
        if (a.type == 1) all[static_cast<int>(std::lround(a.x[0] / 1e-3))] = {a.mass, a.v[2]};
      return all;
    };
    auto expected = carriers();
    ASSERT_EQ(expected.size(), 4u);
    EXPECT_NEAR(expected[0].first, BARE + each - lost, 1e-13 * BARE);
    deck("group gone id 1\ndelete_atoms group gone\nrun 0 post no");    // compresses the IDs
    expected.erase(-8);
    EXPECT_EQ(carriers(), expected);
    deck("reset_atoms id\nrun 1 post no");
    EXPECT_EQ(carriers(), expected);
  }
}

namespace {

// LAMMPS computes damping forces with other velocities where a run starts: so two runs are the same to nanometres and
// um/s
void expect_same_atoms(const std::map<tagint, Atom> &a, const std::map<tagint, Atom> &b, double period = 1.0)
{
  ASSERT_EQ(a.size(), b.size());
  for (const auto &[id, one] : a) {
    ASSERT_EQ(b.count(id), 1u) << id;
    const Atom &other = b.at(id);
    EXPECT_EQ(one.type, other.type) << id;
    EXPECT_EQ(one.radius, other.radius) << id;
    EXPECT_NEAR(one.mass, other.mass, 1e-14 * other.mass) << id;
    for (int d = 0; d < 3; d++) {
      EXPECT_NEAR(std::remainder(one.x[d] - other.x[d], period), 0.0, 1e-10) << id;
      EXPECT_NEAR(one.v[d], other.v[d], 2e-6) << id;
    }
  }
}

}    // namespace

// a restart file written in the middle of a run, while grains wait for the end of the collision
TEST(FixDustDetachShedding, RestartWhileGrainsWait)
{
  const std::string often = "neigh_modify every 1000 delay 0 check no\nrestart 500 dust_waiting.*.restart\n";
  Deck whole;
  impact_with_grains(whole, "tangential estimate");
  whole(often + "run 5000 post no");
  const auto expected = atoms(whole);
  EXPECT_GT(expected.size(), 300u);

  const auto again = [&](const std::string &between) {
    Deck rest;
    rest("read_restart dust_waiting.1500.restart\ncomm_modify vel yes\ntimestep 1e-9\npair_style granular\npair_coeff "
         "* * " +
         contact(0.7));
    grains_that_touch_nothing(rest);
    rest(
        "fix move all nve/sphere\nfix wall carriers wall/gran granular " + contact(0.7) +
        " zplane 0 NULL\nfix dust carriers dust/detach texture monolayer 40e-6 coverage 0.1 seed 1 tangential estimate "
        "emit 2 every 1000000");
    EXPECT_EQ(atoms(rest).size(), 1u);    // all of them wait
    EXPECT_GT(detached(rest), 100.0);
    rest(between + often + "run 5000 upto post no");
    return atoms(rest);
  };
  expect_same_atoms(again(""), expected);
  expect_same_atoms(again("write_restart dust_waiting.1500.restart\n"), expected);    // once more

  // moved between reading and running (after a command that makes LAMMPS forget what it has read): grains move along.
  // The carrier is taken off the wall and stops touching it: its grains fly on from where they were, moved by the same.
  const auto up = again("balance 1.0 shift x 1 1.0\ndisplace_atoms all move 0 0 3e-3 units box\n");
  const auto still = again("fix_modify wall virial no\nunfix wall\n");
  std::vector<double> heights[2];
  for (const auto &[id, a] : up)
    if (a.type == 2) heights[0].push_back(a.x[2]);
  for (const auto &[id, a] : still)
    if (a.type == 2) heights[1].push_back(a.x[2]);
  ASSERT_EQ(heights[0].size(), heights[1].size());
  for (auto &list : heights) std::sort(list.begin(), list.end());
  for (size_t k = 0; k < heights[0].size(); k++) EXPECT_NEAR(heights[0][k], heights[1][k] + 3e-3, 1e-12);

  // without emit they have nowhere to go
  Deck none;
  none("read_restart dust_waiting.1500.restart\ncomm_modify vel yes");
  const std::string error = none.attempt(
      "fix dust carriers dust/detach texture monolayer 40e-6 coverage 0.1 seed 1 tangential estimate mass yes");
  EXPECT_NE(error.find("emit"), std::string::npos) << error;
  for (int step = 500; step <= 5000; step += 500)
    std::remove(("dust_waiting." + std::to_string(step) + ".restart").c_str());
}

// a carrier that goes in the middle of a run takes along what waits on it; the totals stay
TEST(FixDustDetachShedding, ACarrierThatGoesTakesItsWaitingGrainsAlong)
{
  Deck deck;
  space(deck, 0.01, "p p f");
  deck.carrier(0, 0, 0.7501e-3, 0, 0, -8);
  deck.carrier(4e-3, 0, 0.7501e-3, 0, 0, -8);
  deck("group carriers type 1\nregion left block -1e-3 1e-3 INF INF INF INF");
  grains_that_touch_nothing(deck);
  deck("fix move all nve/sphere\nfix wall carriers wall/gran granular " + contact(0.7) +
       " zplane 0 NULL\nfix dust carriers dust/detach texture monolayer 40e-6 coverage 0.1 seed 1 every 1 emit 2\n"
       "fix gone carriers evaporate 1500 1 left 49892\nneigh_modify every 100000 delay 0 check no");
  // in the middle of the collision, where all that has left waits
  deck("run 6000 post no");
  const double each = total(deck, DetachVector::INITIAL_GRAINS) / 2.0, lost = detached(deck);
  int carriers = 0;
  double kept = 0.0;
  for (const auto &[id, a] : atoms(deck)) {
    if (a.type != 1) continue;
    carriers++;
    kept = deck.columns(static_cast<int>(id))[DetachAtom::ATTACHED];
  }
  EXPECT_EQ(carriers, 1);
  EXPECT_EQ(total(deck, DetachVector::ATTACHED_GRAINS), kept);
  const double gone = lost - (each - kept);    // had left the other one
  EXPECT_GT(gone, 100.0);
  EXPECT_EQ(books(deck).grains + total(deck, DetachVector::NO_ROOM), lost - gone);
}

// a run that goes on without a new set-up, and one in pieces: contacts with their history over a periodic border
TEST(FixDustDetachShedding, RunsInPieces)
{
  const auto run = [](const std::string &commands) {
    Deck deck;
    space(deck, 0.002);
    // a third and a fourth carrier rub over the border of the box, from which ghosts come
    two_that_collide(deck);
    deck.carrier(1.9e-3, 1.9e-3, 1.9e-3, 0, 3.0, 0);
    deck.carrier(-0.6005e-3, 1.9e-3, 1.9e-3, 0, 0, 0);
    grains_that_touch_nothing(deck);
    deck("group carriers id 3 4\nfix move all nve/sphere\n"
         "fix dust carriers dust/detach texture monolayer 40e-6 coverage 0.06 seed 1 emit 2 orientation random 4\n" +
         commands);
    EXPECT_GT(books(deck).grains, 100);
    return atoms(deck);
  };
  const auto expected = run("run 2000 post no\nrun 3000 post no");
  expect_same_atoms(run("run 2000 post no\nrun 3000 pre no post no"), expected, 0.004);
  expect_same_atoms(run("run 5000 post no every 2000 NULL"),
                    run("run 2000 post no\nrun 2000 post no\nrun 1000 post no"), 0.004);
}

// two carriers that meet: grains between them find no room, and what is made overlaps nothing. Nothing depends on where
// the box has its borders, nor on whether each carrier has a fix of its own.
TEST(FixDustDetachShedding, RoomDoesNotDependOnBordersNorFixes)
{
  const auto run = [](double shift, bool two_fixes) {
    Deck deck;
    space(deck, 0.003);
    deck.carrier(0, 0, -0.75e-3, 0, 0, 4.0);
    deck.carrier(0, 0, 0.7501e-3, 0, 0, -4.0);
    grains_that_touch_nothing(deck);
    deck("group carriers id 1 2\ngroup first id 1\ngroup second id 2\ndisplace_atoms all move 0 0 " +
         std::to_string(shift) + " units box\nfix move all nve/sphere");
    const std::string coat =
        " dust/detach texture monolayer 40e-6 coverage 0.3 seed 1 orientation random 3 every 1000 emit 2 tangential "
        "estimate";
    if (two_fixes)
      deck("fix dust first" + coat + "\nfix other second" + coat);
    else
      deck("fix dust carriers" + coat);
    deck("variable no equal f_dust[14]" + std::string(two_fixes ? "+f_other[14]" : ""));
    deck("run 6000 post no");
    std::vector<double> found = {*static_cast<double *>(lammps_extract_variable(deck.lmp, "no", nullptr))};
    const auto all = atoms(deck);
    found.push_back(static_cast<double>(all.size()));
    for (const auto &[id, a] : all) {
      found.push_back(a.mass);
      if (a.type != 2) continue;
      for (const auto &[other, b] : all) {
        if (other >= id) break;
        double d2 = 0.0;
        for (int d = 0; d < 3; d++) d2 += std::pow(std::remainder(a.x[d] - b.x[d], 0.006), 2);
        EXPECT_GT(std::sqrt(d2), (1.0 - 1e-6) * (a.radius + b.radius)) << id << " and " << other;
      }
    }
    return found;
  };
  const auto expected = run(0.0, false);
  EXPECT_EQ(expected[0], 84.0);
  for (double shift : {1e-3, 2.99e-3, 3e-3, 3.01e-3}) EXPECT_EQ(run(shift, false), expected) << shift;
  EXPECT_EQ(run(0.0, true), expected);
  EXPECT_EQ(run(2.9e-3, true), expected);
}

TEST(FixDustDetachShedding, WhatStandsInTheWayOfEmittedGrainsIsNamed)
{
  const auto names = [](const std::string &error, const std::string &word) {
    EXPECT_NE(error.find(word), std::string::npos) << error;
  };
  const std::string dust = "fix dust carriers dust/detach " + REFERENCE_DUST + " emit 2\n";
  const std::string start =
                        "units si\nnewton off\natom_style sphere\nregion box block -8e-3 8e-3 -8e-3 8e-3 -4e-3 9e-3\n"
                        "create_box 2 box\ntimestep 1e-9\ncreate_atoms 1 single 0 0 0\nset group all diameter 1.5e-3 "
                        "density 7700\ngroup carriers type 1\n",
                    pair = "comm_modify vel yes\npair_style granular\npair_coeff * * " + contact(0.7) + "\n";
  {
    Deck deck;
    names(deck.attempt("atom_modify id no\n" + start + pair + dust), "atom_modify id yes");
  }
  {
    Deck deck;
    deck(start + pair + "fix move all nve/sphere\n" + dust + "run 1 post no\nchange_box all triclinic");
    names(deck.attempt("run 1"), "orthogonal");
  }
  {
    Deck deck;
    deck(start + "comm_modify vel yes\npair_style zero 1e-3\npair_coeff * *\nfix move all nve/sphere\n" + dust + pair);
    names(deck.attempt("run 1"), "pair_style");
  }
}

// fix pour and fix deposit with id next count on from where they began, and would give IDs of emitted grains again
TEST(FixDustDetachShedding, IDsExistOnce)
{
  const auto run = [](const std::string &id) {
    Deck deck;
    space(deck, 0.004, "p p f");
    const std::string soft =
        "hertz/material 210e6 0.7 0.3 tangential mindlin NULL 0 0.05 damping coeff_restitution/limited";
    deck("neighbor 40e-6 multi\ncomm_modify mode multi vel yes\nneigh_modify one 20000 page 400000\npair_coeff * * " +
         soft +
         "\ntimestep 1e-7\nthermo_modify lost ignore\ngroup carriers type 1\nfix move all nve/sphere\nfix wall all "
         "wall/gran granular " +
         soft +
         " zplane -5e-4 NULL\nregion source block -3e-3 3e-3 -3e-3 3e-3 0 3e-3\n"
         "fix dust carriers dust/detach texture monolayer 100e-6 coverage 0.1 seed 1 orientation random 1 every 100 "
         "emit 2 "
         "stiffen 1000\nfix down all gravity 9.81 vector 0 0 -1\nfix rain carriers pour 6 1 71 region source diam one "
         "1.5e-3 dens 7700 7700 vol 0.05 50 vel 0 0 0 0 -8 id " +
         id);
    const std::string error = deck.attempt("run 6000 post no");
    if (error.empty()) {
      EXPECT_GT(atoms(deck).size(), 100u);    // looks for IDs that exist twice
    }
    return error;
  };
  EXPECT_EQ(run("max"), "");
  const std::string error = run("next");
  EXPECT_NE(error.find("id max"), std::string::npos) << error;
}

// grains fly on while their carrier's collision lasts: those that come to a wall meanwhile would be in it or behind it
// as atoms, and be lost. The wall acts on them only if it is one for group all.
TEST(FixDustDetachShedding, GrainsThatComeToAWallFindNoRoom)
{
  const std::string walls[] = {"zplane 0 NULL", "region up"};
  for (const std::string &wall : walls)
    for (const char *group : {"all", "carriers"}) {
      Deck deck;
      space(deck, 4e-3, "f f f");
      grains_that_touch_nothing(deck);
      deck.carrier(0, 0, 0.7501e-3, 0, 0, -8.0);
      deck("group carriers id 1\nregion up block INF INF INF INF 0 INF\nfix move all nve/sphere\nfix wall " +
           std::string(group) + (wall[0] == 'r' ? " wall/gran/region" : " wall/gran") + " granular " + contact(0.7) +
           " " + wall + "\nfix dust carriers dust/detach texture monolayer 40e-6 coverage 0.2 seed 1 bare 0.33 emit 2");
      const double mass = books(deck).mass;
      deck("run 5000 post no");
      double lowest = 1.0;
      for (const auto &[id, a] : atoms(deck)) lowest = std::min(lowest, a.x[2] - (a.type == 2 ? a.radius : 0.0));
      const bool acts = std::string(group) == "all";
      EXPECT_EQ(total(deck, DetachVector::NO_ROOM) > 20.0, acts) << wall;
      EXPECT_EQ(lowest > -1e-9, acts) << wall;    // contacts of the few that have touched it since
      EXPECT_EQ(books(deck).grains + total(deck, DetachVector::NO_ROOM), detached(deck));
      EXPECT_GT(books(deck).mass, mass);
    }
}
