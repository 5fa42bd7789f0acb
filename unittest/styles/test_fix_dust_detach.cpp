// fix dust/detach in LAMMPS: what it counts, when, and that neither run structure nor company changes it.

#include "deck.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

namespace {

constexpr double START = 0.7501e-3;    // height of a carrier just above the wall

// what the criteria count, too: no number of the global vector may depend on how a run is made
void dust(Deck &deck, const std::string &options = "", const std::string &group = "all")
{
  deck("fix dust " + group + " dust/detach " + REFERENCE_DUST + " counts yes " + options);
}

// one reference impact; 8 m/s straight unless said
std::vector<double> impact(const std::string &options = "", double vx = 0.0, double vz = -8.0)
{
  Deck deck;
  deck.box();
  deck.carrier(0.0, 0.0, START, vx, 0.0, vz);
  deck.wall_and_motion();
  dust(deck, options);
  deck("run 4000 post no");
  EXPECT_EQ(deck.global(9), 1.0);
  return deck.vector();
}

}    // namespace

TEST(FixDustDetach, OutputsAgreeWithEachOther)
{
  for (const char *options :
       {"", "criteria ibrahim", "tangential frictionless", "tangential integrate", "tangential off"}) {
    const std::vector<double> v = impact(options);
    EXPECT_EQ(v[1], 4500.0);
    EXPECT_EQ(v[2], v[1] - v[3] - v[4] - v[12] - v[13]);
    EXPECT_EQ(v[5] + v[6], v[3] + v[4] + v[12] + v[13]);
    EXPECT_NEAR(v[8], 4500.0 * 1.1310e-11, 1e-4 * v[8]);
    EXPECT_DOUBLE_EQ(v[7] / v[8], v[0]);
    EXPECT_DOUBLE_EQ(v[0], 1.0 - v[2] / v[1]);
  }
  EXPECT_EQ(impact("tangential off")[4], 0.0);
  EXPECT_GT(impact("tangential frictionless")[4], impact()[4]);
  EXPECT_GT(impact()[4], 1000.0);
  // each grain's own motion; the resolved run of this impact loses 0.7171
  EXPECT_NEAR(impact("tangential integrate")[0], 0.7233, 0.001);
  EXPECT_EQ(impact("tangential integrate rolling 0.15"), impact("tangential integrate"));
  // if grains ring it meets resolved runs with the same damping ratio
  EXPECT_NEAR(impact("tangential integrate damping 0.06")[0], 0.7729, 0.004);
  EXPECT_NEAR(impact("tangential integrate damping 0.2")[0], 0.7489, 0.004);
  // at 8 m/s the last grains that leave slide, at 12 m/s they roll
  EXPECT_GT(impact("tangential integrate rolling 0", 0.0, -12.0)[4], impact("tangential integrate", 0.0, -12.0)[4]);
  EXPECT_EQ(impact("rolling 0.5"), impact());
  EXPECT_EQ(impact()[12] + impact()[13], 0.0);
  EXPECT_GT(impact("criteria ibrahim")[12] + impact("criteria ibrahim")[13],
            3000.0);    // the rest lifts off in the first steps
  // what is counted does not depend on the criteria that detach; at 8 m/s all but grains at the poles slide and roll
  EXPECT_GT(impact()[10], 4000.0);
  EXPECT_GE(impact()[11], impact()[10]);
}

TEST(FixDustDetach, CountsNothingUnlessAskedAndLosesTheSameGrains)
{
  for (const std::string criteria : {" criteria liftoff", " criteria ibrahim"})
    for (const char *counts : {"", " counts no"}) {
      Deck deck;
      deck.box();
      deck.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
      deck.wall_and_motion();
      deck("fix dust all dust/detach " + REFERENCE_DUST + criteria + counts);
      deck("run 4000 post no");
      std::vector<double> counted = impact(criteria);
      EXPECT_GT(counted[10], 0.0);
      counted[10] = counted[11] = -1.0;
      EXPECT_EQ(deck.vector(), counted) << criteria << counts;
    }
}

TEST(FixDustDetach, ContactTimeAndPeakAcceleration)
{
  // Hertz without damping: contact time 2.9432 overlap/speed, peak force k overlap^1.5, with overlap = (5 m v^2/(4
  // k))^0.4
  const double v = 3.0, R = 0.75e-3, m = 4.0 / 3.0 * M_PI * R * R * R * 7700.0;
  const double k = 4.0 / 3.0 * 210e9 / (2.0 * (1.0 - 0.09)) * std::sqrt(R),
               overlap = std::pow(1.25 * m * v * v / k, 0.4);
  Deck deck;
  deck.box();
  deck.carrier(0.0, 0.0, START, 0.0, 0.0, -v);
  deck.wall_and_motion(1.0);
  dust(deck);
  deck("run 6000 post no");
  EXPECT_NEAR(deck.columns(1)[3], 2.9432 * overlap / v, 2e-9);    // a step at each end
  EXPECT_NEAR(deck.columns(1)[4], k * std::pow(overlap, 1.5) / m, 1e-3 * deck.columns(1)[4]);
  EXPECT_EQ(deck.columns(1)[0], deck.global(2));
  EXPECT_NEAR(deck.columns(1)[1], deck.global(7), 1e-12 * deck.global(7));    // summed grain by grain
}

TEST(FixDustDetach, SetupCountsNoStep)
{
  const std::vector<double> once = impact();
  Deck deck;
  deck.box();
  deck.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
  deck.wall_and_motion();
  dust(deck);
  for (int steps : {0, 1, 0, 700, 0, 0, 300, 1, 1, 997, 1000, 0, 1000})
    deck("run " + std::to_string(steps) + " post no");
  EXPECT_EQ(deck.vector(), once);

  // looking at it changes nothing either
  Deck watched;
  watched.box();
  watched.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
  watched.wall_and_motion();
  dust(watched);
  watched("thermo 10\nthermo_style custom step f_dust f_dust[5] f_dust[6] f_dust[10] f_dust[11]\nrun 4000 post no");
  EXPECT_EQ(watched.vector(), once);
}

TEST(FixDustDetach, AHundredCarriersAreAsAHundredSingleOnes)
{
  const auto carrier = [](Deck &deck, int k) {
    const int row = k / 10;
    deck.carrier(-0.009 + 0.002 * (k % 10), -0.009 + 0.002 * row, START + 1e-8 * k, 0.1 * (k % 7), 0.05 * (k % 3),
                 -0.2 * (k + 1));
  };
  Deck many;
  many.box();
  for (int k = 0; k < 100; k++) carrier(many, k);
  many.wall_and_motion();
  dust(many);
  many("run 12000 post no");
  EXPECT_EQ(many.global(9), 100.0);
  double attached = 0.0;
  for (int k = 0; k < 100; k++) {
    Deck one;
    one.box();
    carrier(one, k);
    one.wall_and_motion();
    dust(one);
    one("run 12000 post no");
    EXPECT_EQ(one.columns(1), many.columns(k + 1)) << "carrier " << k + 1;
    attached += one.global(2);
  }
  EXPECT_EQ(many.global(2), attached);
}

TEST(FixDustDetach, RestartInTheMiddleOfACollisionIsExact)
{
  for (const auto &[at, options] : {std::make_pair(500, "every 2000"),
                                    {1000, "every 2000"},
                                    {1500, "every 2000"},
                                    {2500, "every 2000"},
                                    {1500, "every 2000 tangential integrate"}}) {
    Deck whole;
    whole.box();
    whole.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
    whole.carrier(0.004, 0.0, START, 9.0, 0.0, -12.0);
    whole.wall_and_motion();
    dust(whole, options);
    const std::string file = "dust_restart_" + std::to_string(at);
    whole("run " + std::to_string(at) + " post no\nwrite_restart " + file);

    Deck rest;
    // a restored pair style granular does not know its cutoff (LAMMPS): it is given again
    rest("read_restart " + file +
         "\ncomm_modify vel yes\ntimestep 1e-9\nneighbor 3e-4 bin\npair_style granular\npair_coeff * * " +
         contact(0.7));
    rest.wall_and_motion();
    dust(rest, options);
    EXPECT_EQ(rest.vector(), whole.vector()) << "at once";
    EXPECT_EQ(rest.events(), whole.events()) << "at once";
    for (const char *next : {"run 2000 upto post no", "run 4000 upto post no", "run 6000 upto post no"}) {
      if (at > 2000 && next[4] == '2') continue;
      whole(next);
      rest(next);
      EXPECT_EQ(rest.events(), whole.events()) << "restarted at " << at << ", " << next;
    }
    EXPECT_EQ(rest.vector(), whole.vector()) << "restarted at " << at;
    for (int id : {1, 2}) {
      EXPECT_EQ(rest.columns(id), whole.columns(id));
      for (int d = 0; d < 3; d++) EXPECT_EQ(rest.atom("v", id)[d], whole.atom("v", id)[d]);
    }
    std::remove(file.c_str());
  }
}

TEST(FixDustDetach, StepsNumberedAnewInTheMiddleOfACollisionChangeNothing)
{
  const auto run = [](const std::string &between) {
    Deck deck;
    deck.box();
    deck.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
    deck.wall_and_motion();
    dust(deck);
    deck("run 1500 post no\n" + between + "\nrun 4000 post no");
    return deck.columns(1);
  };
  const std::vector<double> columns = run("");
  EXPECT_GT(columns[3], 1.0e-6);    // the contact lies in both runs
  EXPECT_EQ(run("reset_timestep 0"), columns);
  EXPECT_EQ(run("reset_timestep 1000000"), columns);
}

TEST(FixDustDetach, ARestartWithAnotherTextureRotationOrMassIsRefused)
{
  Deck deck;
  deck.box();
  deck.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
  deck.wall_and_motion();
  dust(deck);
  deck("run 10 post no\nwrite_restart dust_restart_other");
  const std::string same = REFERENCE_DUST;
  const std::pair<std::string, std::string> others[] = {{"texture monolayer 20e-6 coverage 0.2 seed 2", "texture"},
                                                        {"texture monolayer 20e-6 coverage 0.1 seed 1", "texture"},
                                                        {same + " rotation no", "rotation"},
                                                        {same + " mass yes", "mass"},
                                                        {same, ""}};
  for (const auto &[options, word] : others) {
    Deck rest;
    rest("read_restart dust_restart_other\ncomm_modify vel yes");
    const std::string error = rest.attempt("fix dust all dust/detach " + options);
    EXPECT_EQ(error.empty(), word.empty()) << error;
    EXPECT_NE(error.find(word), std::string::npos) << error;
    EXPECT_EQ(error.find("restart") == std::string::npos, word.empty()) << error;
  }
  std::remove("dust_restart_other");
}

TEST(FixDustDetach, EachUnitStyleGivesTheSameGrains)
{
  const std::vector<double> si = impact("tangential integrate");    // needs most of all
  // the same impact in other units: what one SI unit of each is in these
  struct Units {
    const char *style;
    double length, mass, time;
  };
  const Units all[] = {{"cgs", 1e2, 1e3, 1.0},
                       {"micro", 1e6, 1e15, 1e6},
                       {"nano", 1e9, 1e21, 1e9},
                       {"lj", 3.0, 7.0, 11.0}};
  for (const Units &u : all) {
    Deck deck;
    char text[4096];
    const double L = u.length, radius = 0.75e-3 * L, speed = 8.0 * L / u.time;
    const double density = u.mass / (L * L * L), pressure = u.mass / (L * u.time * u.time),
                 energy = pressure * L * L * L;
    std::snprintf(
        text, sizeof(text),
        "units %s\natom_style sphere\nboundary p p f\nnewton off\ncomm_modify vel yes\n"
        "region box block %.15g %.15g %.15g %.15g %.15g %.15g\ncreate_box 1 box\ntimestep %.15g\nneighbor %.15g bin\n"
        "create_atoms 1 single 0 0 %.15g\nset atom 1 diameter %.15g density %.15g\nvelocity all set 0 0 %.15g\n"
        "pair_style zero %.15g\npair_coeff * *\nfix move all nve/sphere\n",
        u.style, -0.01 * L, 0.01 * L, -0.01 * L, 0.01 * L, -0.002 * L, 0.01 * L, 1e-9 * u.time, 3e-4 * L, START * L,
        2.0 * radius, 7700.0 * density, -speed, 2.0 * radius);
    deck(text);
    std::snprintf(
        text, sizeof(text),
        "fix wall all wall/gran granular hertz/material %.15g 0.7 0.3 tangential mindlin NULL 0.0 0.05 damping "
        "coeff_restitution/limited zplane 0.0 NULL\n"
        "fix dust all dust/detach texture monolayer %.15g coverage 0.2 seed 1 density %.15g hamaker %.15g %.15g "
        "elastic %.15g 0.3 %.15g 0.3 friction 0.3 tangential integrate counts yes\nrun 4000 post no",
        210e9 * pressure, 20e-6 * L, 2700.0 * density, std::sqrt(10.1e-20 * 21.2e-20) * energy, 0.4e-9 * L,
        75e9 * pressure, 210e9 * pressure);
    deck(text);
    const std::vector<double> v = deck.vector();
    for (int n : {1, 9}) EXPECT_EQ(v[n], si[n]) << u.style;
    // conversions round: a grain or two at a threshold may fall on the other side
    for (int n : {2, 3, 4, 5, 6, 10, 11}) EXPECT_NEAR(v[n], si[n], 2.0) << u.style << " " << n;
    EXPECT_NEAR(v[8], si[8] * u.mass, 1e-9 * v[8]) << u.style;
  }
}

TEST(FixDustDetach, UnitsThatDoNotFitTogetherAreRefused)
{
  for (const char *style : {"real", "metal", "electron"}) {
    Deck deck;
    deck(std::string("units ") + style + "\natom_style sphere\nregion box block -9 9 -9 9 -9 9\ncreate_box 1 box");
    EXPECT_NE(deck.attempt("fix dust all dust/detach " + REFERENCE_DUST).find(std::string("units ") + style),
              std::string::npos);
  }
  Deck deck;
  deck("units cgs\natom_style sphere\nregion box block -9 9 -9 9 -9 9\ncreate_box 1 box");
  EXPECT_NE(deck.attempt("fix dust all dust/detach " + REFERENCE_DUST).find("density"),
            std::string::npos);    // no default
}

TEST(FixDustDetach, RegionWallsAndPlaneWalls)
{
  const std::vector<double> plane = impact();
  Deck deck;
  deck.box();
  deck.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
  deck("region above block INF INF INF INF 0.0 INF side in\nfix move all nve/sphere\n"
       "fix wall all wall/gran/region granular " +
       contact(0.7) + " region above");
  dust(deck);
  deck("run 4000 post no");
  const std::vector<double> region = deck.vector();
  for (int n = 0; n <= 13; n++) EXPECT_NEAR(region[n], plane[n], 1e-12 * plane[n]) << n;
}

TEST(FixDustDetach, BodyForcesDoNotCount)
{
  // gravity far stronger than the pull-off force per grain mass moves the carriers, but no grain off them
  Deck deck;
  deck.box();
  deck.carrier(0.0, 0.0, 5e-3, 0.0, 0.0, 0.0);
  deck.wall_and_motion();
  dust(deck);
  deck("fix down all gravity 1e6 vector 0 0 -1\nrun 1000 post no");
  EXPECT_EQ(deck.global(0), 0.0);
  EXPECT_LT(deck.atom("v", 1)[2], -0.9);
}

TEST(FixDustDetach, OrderOfFixesIsChecked)
{
  const auto error = [](const std::string &fixes) {
    Deck deck;
    deck.box();
    deck.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
    const std::string at_once = deck.attempt(fixes);
    return at_once.empty() ? deck.attempt("run 0") : at_once;
  };
  const std::string move = "fix move all nve/sphere\n", dust = "fix dust all dust/detach " + REFERENCE_DUST + "\n";
  const std::string wall = "fix floor all wall/gran granular " + contact(0.7) + " zplane 0.0 NULL\n";
  const std::string gravity = "fix down all gravity 9.81 vector 0 0 -1\n", drag = "fix air all viscous 1e-9\n";
  EXPECT_EQ(error(move + wall + dust), "");
  EXPECT_EQ(error(move + wall + dust + gravity + drag), "");
  EXPECT_EQ(error(dust + move), "");
  EXPECT_NE(error(move + dust + wall).find("floor"), std::string::npos);
  EXPECT_NE(error(move + wall + gravity + dust).find("down"), std::string::npos);
  EXPECT_NE(error(move + wall + drag + dust).find("air"), std::string::npos);
  EXPECT_NE(error("region above block INF INF INF INF 0.0 INF\n" + move + dust +
                  "fix funnel all wall/gran/region granular " + contact(0.7) + " region above\n")
                .find("funnel"),
            std::string::npos);
  // two textures in one run: neither is in the other's way
  EXPECT_EQ(error(move + wall + dust + "fix other all dust/detach texture monolayer 30e-6 coverage 0.1 seed 4\n"), "");
}

TEST(FixDustDetach, ARepeatedImpactActsOnWhatIsLeft)
{
  Deck deck;
  deck.box();
  deck.carrier(0.0, 0.0, START, 0.0, 0.0, -2.0);
  deck.wall_and_motion();
  dust(deck);
  deck("run 6000 post no");
  const double first = deck.global(3);
  deck("velocity all set 0 0 -2.0\nset atom 1 z 7.501e-4\nset atom 1 omega 0 0 0\nrun 6000 post no");
  EXPECT_EQ(deck.global(9), 2.0);
  EXPECT_NEAR(deck.global(3), first, 2.0);    // the same caps again: all that could leave is gone
  deck("velocity all set 0 0 -6.0\nset atom 1 z 7.501e-4\nrun 6000 post no");
  EXPECT_GT(deck.global(3), first + 50.0);
  EXPECT_EQ(deck.global(1), 4500.0);
}

TEST(FixDustDetach, WindowsAndEvents)
{
  Deck deck;
  deck.box();
  deck.carrier(0.0, 0.0, START, 3.0, 0.0, -8.0);
  deck.carrier(0.004, 0.0, START, 0.0, 0.0, -6.0);
  deck.wall_and_motion();
  dust(deck, "every 50 write dust_texture.txt tangential estimate");    // leaves at the end
  std::ifstream file("dust_texture.txt");
  std::vector<std::array<double, 4>> grains;
  std::string line;
  while (std::getline(file, line)) {
    std::array<double, 4> g;
    std::istringstream words(line);
    if (words >> g[0] >> g[1] >> g[2] >> g[3]) grains.push_back(g);
  }
  ASSERT_EQ(grains.size(), 4500u);

  std::map<std::pair<int, int>, int> seen;
  double mass[2] = {0.0, 0.0};
  for (int step = 50; step <= 5000; step += 50) {
    deck("run 50 post no");
    for (const auto &row : deck.events()) {
      EXPECT_GT(row[0], step - 50);
      EXPECT_LE(row[0], step);
      const int carrier = static_cast<int>(row[1]), grain = static_cast<int>(row[2]);
      const int times = ++seen[{carrier, grain}];
      EXPECT_EQ(times, 1);
      EXPECT_EQ(row[4], 20e-6);
      // on the carrier's surface where the texture has it: the carrier has moved on since by less than 50 steps
      for (int d = 0; d < 3; d++)
        EXPECT_NEAR(row[5 + d], deck.atom("x", carrier)[d] + 0.76e-3 * grains[grain - 1][d], 50e-9 * 12.0);
      if (row[3] == 1.0) {
        EXPECT_LE(std::hypot(row[8], row[10]), 9.0);    // leaves with its carrier's velocity
        EXPECT_EQ(row[9], 0.0);
      } else {
        EXPECT_EQ(row[3], 2.0);
        EXPECT_LT(row[10], deck.atom("v", carrier)[2]);    // overtaken by the carrier that rebounds
      }
    }
    for (int id : {1, 2}) mass[id - 1] += deck.columns(id)[2];
  }
  EXPECT_EQ(seen.size(), 9000.0 - deck.global(2));
  for (int id : {1, 2}) EXPECT_NEAR(mass[id - 1], deck.columns(id)[1], 1e-12 * mass[id - 1]);
  std::remove("dust_texture.txt");
}

TEST(FixDustDetach, TextureFromAFileIsTheSame)
{
  const std::vector<double> made = impact("write dust_texture_same.txt");
  Deck deck;
  deck.box();
  deck.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
  deck.wall_and_motion();
  deck("fix dust all dust/detach texture file dust_texture_same.txt counts yes\nrun 4000 post no");
  EXPECT_EQ(deck.vector(), made);
  std::remove("dust_texture_same.txt");
}

TEST(FixDustDetach, CarriersInsertedAndDeletedDuringTheRun)
{
  Deck deck;
  deck.box();
  deck("region top block -0.008 0.008 -0.008 0.008 0.002 0.009\ngroup carriers type 2\nfix move all nve/sphere\n"
       "fix wall all wall/gran granular " +
       contact(0.7) + " zplane 0.0 NULL");
  EXPECT_NE(deck.attempt("fix dust carriers dust/detach " + REFERENCE_DUST + "\nrun 0").find("no carriers"),
            std::string::npos);
  deck("unfix dust\ntimestep 1e-7\nfix dust carriers dust/detach " + REFERENCE_DUST +
       "\nfix down all gravity 9.81 vector 0 0 -1\n"
       "fix rain carriers pour 6 2 4711 region top diam one 1.5e-3 dens 7700 7700 vel 0 0 0 0 -6\nrun 0 post no");
  EXPECT_EQ(deck.global(0), 0.0);
  EXPECT_EQ(deck.global(1), 0.0);
  deck("run 20000 post no");
  EXPECT_EQ(lammps_get_natoms(deck.lmp), 6.0);
  EXPECT_EQ(deck.global(1), 6 * 4500.0);
  EXPECT_EQ(deck.global(9), 6.0);
  const double lost = deck.global(1) - deck.global(2);
  EXPECT_GT(lost, 6 * 2000.0);
  const double attached = deck.columns(3)[0];
  deck("group one id 3\ndelete_atoms group one compress no\nrun 10 post no");
  EXPECT_EQ(deck.global(1), 6 * 4500.0);    // what there was at first
  EXPECT_EQ(deck.global(2), 6 * 4500.0 - lost - attached);
  EXPECT_DOUBLE_EQ(deck.global(7), lost * deck.global(8) / deck.global(1));
}

TEST(FixDustDetach, ACarrierDeletedInContactLeavesTheOthersAlone)
{
  const auto run = [](bool remove) {
    Deck deck;
    deck.box();
    deck.carrier(-0.004, 0.0, START, 0.0, 0.0, -7.0);
    deck.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
    deck.carrier(0.004, 0.0, START, 0.0, 0.0, -9.0);
    deck.wall_and_motion();
    dust(deck);
    deck("run 1000 post no");
    if (remove) deck("group one id 1\ndelete_atoms group one compress no");
    deck("run 4000 post no");
    return std::make_pair(deck.columns(2), deck.columns(3));
  };
  EXPECT_EQ(run(true), run(false));
}

TEST(FixDustDetach, GroupsSortingAndClear)
{
  const std::vector<double> expected = impact();
  Deck deck;
  for (int round = 0; round < 2; round++) {
    deck.box();
    deck("atom_modify sort 7 0.001");
    for (int k = 0; k < 5; k++)
      deck.carrier(-0.008 + 0.004 * k, -0.003 * k, START, 0.0, 0.0, k == 3 ? -8.0 : -1.0 * (k + 1));
    deck("group dusty id 4\nneigh_modify every 1 delay 0 check no");
    deck.wall_and_motion();
    dust(deck, "", "dusty");
    deck("run 4000 post no");
    const std::vector<double> found = deck.vector();
    for (int n : {0, 1, 2, 3, 4, 5, 6, 9, 10, 11}) EXPECT_EQ(found[n], expected[n]) << n;
    EXPECT_EQ(deck.columns(2)[0], 0.0);    // not in the group: no carrier
    deck("clear");
  }
}

TEST(FixDustDetach, GrainsOfDistributedSizes)
{
  const auto slow = [](const std::string &texture) {
    Deck deck;
    deck.box();
    deck.carrier(0.0, 0.0, START, 0.0, 0.0, -1.0);
    deck.wall_and_motion();
    deck("fix dust all dust/detach texture " + texture + "\nrun 6000 post no");
    EXPECT_EQ(deck.global(9), 1.0);
    return deck.vector();
  };
  // the same as from a file; large grains leave first: F_c/m_d falls with the square of their size
  const std::vector<double> v =
      slow("monolayer 1 coverage 0.2 seed 1 distribution lognormal 15e-6 1.5 write dust_sizes.txt");
  EXPECT_EQ(slow("file dust_sizes.txt"), v);
  EXPECT_GT(v[7] / v[8], 1.2 * (v[1] - v[2]) / v[1]);
}

TEST(FixDustDetach, BadTextureFilesAreRefused)
{
  impact("write dust_texture_bad.txt");
  std::ifstream in("dust_texture_bad.txt");
  std::stringstream all;
  all << in.rdbuf();
  const std::string text = all.str();
  const auto error = [](const std::string &content) {
    std::ofstream("dust_texture_bad.txt") << content;
    Deck deck;
    deck.box();
    deck.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
    deck.wall_and_motion();
    return deck.attempt("fix dust all dust/detach texture file dust_texture_bad.txt");
  };
  EXPECT_EQ(error(text), "");
  EXPECT_NE(error(text.substr(0, text.size() / 2)).find("line"), std::string::npos);
  std::string broken = text;
  broken.replace(broken.find("\n0.") + 1, 4, "nan ");
  EXPECT_NE(error(broken).find("nan"), std::string::npos);
  broken = text;
  const size_t second = broken.rfind("\n", broken.size() - 6) + 1;    // the last grain twice
  const std::string last = broken.substr(second, broken.rfind("end") - second);
  broken.replace(broken.find("grains 4500"), 11, "grains 4501");
  broken.insert(second, last);
  EXPECT_NE(error(broken).find("overlap"), std::string::npos);
  broken = text;
  broken.replace(broken.find("carrier_diameter 0.0015"), 23, "carrier_diameter 0.0016");
  EXPECT_NE(error(broken).find("diameter"), std::string::npos);
  std::remove("dust_texture_bad.txt");
}

TEST(FixDustDetach, NoRowsWhereNoneAreWanted)
{
  Deck deck;
  deck.box();
  deck.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
  deck.wall_and_motion();
  dust(deck, "every 4000 rows no");
  deck("run 4000 post no");
  EXPECT_TRUE(deck.events().empty());
  EXPECT_EQ(deck.vector(), impact());
  EXPECT_EQ(deck.columns(1)[2], deck.columns(1)[1]);    // the mass of the window is there
}

TEST(FixDustDetach, StartInContactCountsTheFirstForceOnce)
{
  const auto run = [](const std::string &commands) {
    Deck deck;
    deck.box();
    deck.carrier(0.0, 0.0, 0.745e-3, 0.0, 0.0, -3.0);
    deck.wall_and_motion();
    dust(deck);
    deck(commands);
    return std::make_pair(deck.vector(), deck.columns(1));
  };
  const auto whole = run("run 5000 post no");
  EXPECT_EQ(whole.first[9], 1.0);
  EXPECT_EQ(run("run 0 post no\nrun 0 post no\nrun 5000 post no"), whole);
  // the force of step 0 is one of the steps of the contact
  Deck deck;
  deck.box();
  deck.carrier(0.0, 0.0, 0.745e-3, 0.0, 0.0, -3.0);
  deck.wall_and_motion();
  deck("run 0 post no");
  int steps = 0;
  for (; deck.atom("f", 1)[2] > 0.0; steps++) deck("run 1 pre no post no");
  EXPECT_NEAR(whole.second[3], steps * 1e-9, 1e-15);
}

TEST(FixDustDetach, CarriersResizedOrDeletedBetweenRuns)
{
  Deck deck;
  deck.box();
  deck.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
  deck.carrier(0.004, 0.0, START, 0.0, 0.0, -8.0);
  deck.wall_and_motion();
  dust(deck);
  deck("run 1000 post no");
  const double before = deck.global(2);
  deck("group one id 1\ndelete_atoms group one compress no");
  EXPECT_EQ(deck.global(2), 0.5 * before);    // at once, not only in the next step
  deck("set group all diameter 1e-3");
  EXPECT_NE(deck.attempt("run 10").find("diameter"), std::string::npos);
}

// a run without init(), in and out of contact
TEST(FixDustDetach, CarriersResizedInContact)
{
  for (const int steps : {50, 1000, 5000}) {    // before contact, in it, after it
    Deck deck;
    deck.box();
    deck.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
    deck.wall_and_motion();
    dust(deck);
    deck("run " + std::to_string(steps) + " post no\nset group all diameter 1.502e-3");
    const std::string message = deck.attempt("run 10 pre no post no");
    EXPECT_NE(message.find("carrier 1 has diameter 0.001502 now, and 0.0015"), std::string::npos) << message;
  }
}

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const int result = RUN_ALL_TESTS();
  lammps_mpi_finalize();
  return result;
}
