// create_dust and compute dust/carrier: real grains at rest on their carriers, which holds them, and since when.

#include "deck.h"

#include "hamaker.h"
#include "jkr.h"
#include "quaternion.h"
#include "texture_file.h"

#include <algorithm>
#include <array>
#include <fstream>

namespace {

const double HAMAKER = std::sqrt(10.1e-20 * 21.2e-20), GAMMA = Dust::surface_energy(HAMAKER, 0.4e-9);
const double R12 = Dust::effective_radius(0.75e-3, 10e-6), MODULUS = Dust::combined_modulus(75e9, 0.3, 210e9, 0.3);
const double A0 = Dust::equilibrium_contact_radius(GAMMA, R12, MODULUS);

// pair_coeff of grains (type 2) on carriers (type 1) and on each other, critically damped
std::string adhesion()
{
  char text[1024];
  const double young = 2.0 * 0.91 * MODULUS, mass = 4.0 / 3.0 * M_PI * 1e-15 * 2700.0;
  const double eta = 2.0 * std::sqrt(1.2 * MODULUS * A0 / mass) / A0;
  const char *rest =
      "0.3 %.17g 0.4e-9 tangential mindlin NULL 0.0 0.3 damping viscoelastic rolling dominik/tielens 0.15\n";
  std::string line = "pair_coeff 1 1 " + contact(0.7) + "\n";
  std::snprintf(text, sizeof(text), (std::string("pair_coeff 1 2 jkr/vdw %.17g %.17g ") + rest).c_str(), young, eta,
                HAMAKER);
  line += text;
  std::snprintf(text, sizeof(text), (std::string("pair_coeff 2 2 jkr/vdw 75e9 %.17g ") + rest).c_str(), eta, 10.1e-20);
  return line + text;
}

// carriers with few grains each, so that it is quick
void dusty_carriers(Deck &deck, int n, const char *more = "", const char *omega = "10 20 30")
{
  deck("units si\natom_style sphere\natom_modify map array\nboundary p p f\nnewton off\n"
       "region box block -0.004 0.004 -0.002 0.002 -0.002 0.004\ncreate_box 2 box\n"
       "neighbor 15e-6 multi\ncomm_modify mode multi vel yes\nneigh_modify one 10000 page 200000\ntimestep 1e-9");
  for (int k = 0; k < n; k++) deck.carrier(-0.0025 + 0.0025 * k, 0.0, 0.001, 0.1, 0.0, -0.2 * k);
  deck("group carriers type 1\nset group carriers omega " + std::string(omega) +
       "\n"
       "create_dust carriers type 2 texture monolayer 20e-6 coverage 0.01 seed 3 " +
       std::string(more) + "\ngroup grains type 2\npair_style granular\n" + adhesion() +
       "fix move all nve/sphere\ncompute tied grains dust/carrier carriers\n"
       "thermo_style custom step c_tied\nrun 0 post no");
}

// of the grains of a texture that a deck has written; takes the file away
std::vector<std::array<double, 3>> directions(const char *path)
{
  std::ifstream file(path);
  std::string line;
  std::vector<std::array<double, 3>> n;
  while (std::getline(file, line)) {
    std::array<double, 3> v;
    if (std::sscanf(line.c_str(), "%lf %lf %lf 2.0", &v[0], &v[1], &v[2]) == 3) n.push_back(v);
  }
  std::remove(path);
  return n;
}

double tied(Deck &deck)
{
  return *static_cast<double *>(lammps_extract_compute(deck.lmp, "tied", LMP_STYLE_GLOBAL, LMP_TYPE_SCALAR));
}

// step at which contacts with carriers last changed: 0 neck, 1 slide, 2 roll
double last_change(Deck &deck, int k)
{
  return static_cast<double *>(lammps_extract_compute(deck.lmp, "tied", LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR))[k];
}

}    // namespace

TEST(CreateDust, GrainsSitAtTheEquilibriumOverlapAndMoveWithTheirCarrier)
{
  Deck deck;
  dusty_carriers(deck, 2, "write dust_created.txt");
  ASSERT_EQ(lammps_get_natoms(deck.lmp), 2 + 2 * 225.0);
  const auto n = directions("dust_created.txt");
  ASSERT_EQ(n.size(), 225u);
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < 225; i++) {
      const int grain = 3 + 225 * k + i;
      const double *xp = deck.atom("x", k + 1), *vp = deck.atom("v", k + 1), *w = deck.atom("omega", k + 1);
      const double *x = deck.atom("x", grain), *v = deck.atom("v", grain);
      const double distance = 0.76e-3 - Dust::equilibrium_overlap(A0, R12);
      double r[3];
      for (int d = 0; d < 3; d++) {
        r[d] = x[d] - xp[d];
        ASSERT_NEAR(r[d], distance * n[i][d], 1e-17);
      }
      ASSERT_NEAR(v[0], vp[0] + w[1] * r[2] - w[2] * r[1], 1e-14);
      ASSERT_NEAR(v[1], vp[1] + w[2] * r[0] - w[0] * r[2], 1e-14);
      ASSERT_NEAR(v[2], vp[2] + w[0] * r[1] - w[1] * r[0], 1e-14);
    }
}

TEST(CreateDust, CarriersOfSeveralSizesHaveATextureEach)
{
  // on their own radius, as a create_dust of their own places it; IDs by carrier
  const std::vector<double> sizes = {1.0e-3, 1.5e-3, 1.2e-3, 1.5e-3};
  const auto made = [&](const std::vector<std::string> &commands) {
    Deck deck;
    deck("units si\natom_style sphere\natom_modify map array\nboundary p p f\n"
         "region box block -0.008 0.004 -0.002 0.002 -0.002 0.004\ncreate_box 2 box");
    for (size_t k = 0; k < sizes.size(); k++) {
      deck.carrier(-0.0065 + 0.003 * k, 0.0, 0.001, 0.1, 0.0, -0.2 * k);
      deck(line("set atom %.0f diameter %.17g density 7700", k + 1.0, sizes[k]));
    }
    deck("group carriers type 1");
    for (const std::string &command : commands) deck(command);
    std::vector<std::array<double, 4>> grains;
    const auto *radius = static_cast<double *>(lammps_extract_atom(deck.lmp, "radius"));
    auto **x = static_cast<double **>(lammps_extract_atom(deck.lmp, "x"));
    const int n = lammps_extract_setting(deck.lmp, "nlocal");
    for (int i = 0; i < n; i++)
      if (radius[i] < 0.1e-3) grains.push_back({x[i][0], x[i][1], x[i][2], radius[i]});
    return grains;
  };
  const std::string dust = " type 2 texture monolayer 20e-6 coverage 0.02 seed 3";
  auto together = made({"create_dust carriers" + dust + " write dust_sizes_*.txt"});
  EXPECT_EQ(together.size(), 200u + 2 * 450u + 288u);
  const char *names[] = {"dust_sizes_0.001.txt", "dust_sizes_0.0012.txt", "dust_sizes_0.0015.txt"};
  size_t written = 0;
  for (const char *name : names) {
    written += Dust::read_texture_file(name).grains.size();
    std::remove(name);
  }
  EXPECT_EQ(written, 200u + 288u + 450u);
  auto apart = made({"group a id 1", "group b id 2 4", "group c id 3", "create_dust a" + dust, "create_dust b" + dust,
                     "create_dust c" + dust});
  std::sort(together.begin(), together.end());
  std::sort(apart.begin(), apart.end());
  EXPECT_EQ(together, apart);
}

// five types, classes of factors from 1/8 to 8, of a factor 8^(2/5) each
TEST(CreateDust, ASpreadOfAdhesionGoesIntoTypesAndOverlaps)
{
  Deck deck;
  deck("units si\natom_style sphere\natom_modify map array\nboundary p p f\n"
       "region box block -0.002 0.002 -0.002 0.002 -0.002 0.004\ncreate_box 7 box");
  deck.carrier(0.0, 0.0, 0.001, 0.0, 0.0, 0.0);
  const std::string dust = "create_dust all type 2 texture monolayer 20e-6 coverage 0.01 seed 3 spread 2.5 ";
  const auto refused = [&](const std::string &words, const char *what) {
    const std::string message = deck.attempt(dust + words);
    EXPECT_NE(message.find(what), std::string::npos) << words << " -> " << message;
  };
  refused("", "needs classes K LOW HIGH");
  refused("classes 7 0.125 8", "classes K value 7 must be a whole number from 1 to 6");
  refused("classes 5 0.125 0.1", "classes HIGH value 0.1 must be above 0.125");
  refused("classes 5 0 1", "classes LOW value 0 must be above 0");
  ASSERT_EQ(lammps_get_natoms(deck.lmp), 1.0);
  deck(dust + "classes 5 0.125 8 write dust_classes.txt");
  const Dust::Texture texture = Dust::read_texture_file("dust_classes.txt");
  std::remove("dust_classes.txt");
  ASSERT_EQ(texture.grains.size(), 225u);
  const auto *type = static_cast<int *>(lammps_extract_atom(deck.lmp, "type"));
  int number[7] = {};
  for (int i = 0; i < 225; i++) {
    // the atoms are in the order of their IDs still
    const int k = type[i + 1] - 2;
    ASSERT_GE(k, 0);
    ASSERT_LT(k, 5);
    number[k]++;
    const double factor = texture.grains[i].adhesion, middle = 0.125 * std::pow(64.0, (k + 0.5) / 5.0);
    const double half = std::pow(64.0, 0.1);
    if (k > 0) {
      ASSERT_GE(factor, middle / half * (1.0 - 1e-12));
    }
    if (k < 4) {
      ASSERT_LT(factor, middle * half * (1.0 + 1e-12));
    }
    const double *x = deck.atom("x", i + 2), z = x[2] - 0.001;
    const double overlap = Dust::equilibrium_overlap(A0, R12) * std::pow(middle, 2.0 / 3.0);
    ASSERT_NEAR(std::sqrt(x[0] * x[0] + x[1] * x[1] + z * z), 0.76e-3 - overlap, 1e-17);
  }
  EXPECT_GT(number[2], number[1]);
  EXPECT_GT(number[2], number[3]);
  EXPECT_GT(number[0], 0);
  EXPECT_GT(number[4], 0);
}

TEST(CreateDust, RandomOrientationTurnsTheGrainsByTheCarriersID)
{
  Deck deck;
  dusty_carriers(deck, 2, "orientation random 77 write dust_turned.txt");
  const auto n = directions("dust_turned.txt");
  ASSERT_EQ(n.size(), 225u);
  const double distance = 0.76e-3 - Dust::equilibrium_overlap(A0, R12);
  for (int k = 0; k < 2; k++) {
    const double *xp = deck.atom("x", k + 1);
    const Dust::Quaternion turn = Dust::random_orientation(77, k + 1);
    for (int i = 0; i < 225; i++) {
      const double *x = deck.atom("x", 3 + 225 * k + i);
      double wanted[3];
      turn.to_space(n[i].data(), wanted);
      for (int d = 0; d < 3; d++) ASSERT_NEAR(x[d] - xp[d], distance * wanted[d], 1e-17);
    }
  }
}

// coverage high enough that some of 2250 grains lie in the default's bare cap, 2.7 % of the sphere
TEST(CreateDust, RandomOrientationLeavesNoBareCapUnlessToldTo)
{
  const auto in_cap = [](const char *more) {
    Deck deck;
    deck.box();
    deck.carrier(0.0, 0.0, 0.001, 0.0, 0.0, 0.0);
    deck("create_dust all type 2 texture monolayer 20e-6 coverage 0.1 seed 3 write dust_cap.txt " + std::string(more));
    const auto n = directions("dust_cap.txt");
    EXPECT_EQ(n.size(), 2250u);
    return std::count_if(n.begin(), n.end(), [](const std::array<double, 3> &v) { return v[2] < -std::cos(0.33); });
  };
  EXPECT_EQ(in_cap(""), 0);
  EXPECT_EQ(in_cap("orientation same"), 0);
  EXPECT_EQ(in_cap("orientation random 5 bare 0.33"), 0);
  EXPECT_GT(in_cap("orientation random 5"), 30);    // of 61 on average
}

// Centrifugal force F = m omega^2 |r| sin^2 against pull-off force: equal at the equator at 13.2e3 rad/s. It comes all
// at once, so that the undamped springs along the surface go twice as far as they must: at 9e3, F = 0.46 F_c at the
// equator, they hold that, 2 F cot < mu (2 F_c - F) at all latitudes.
TEST(CreateDust, GrainsTurnWithTheirCarrierUntilItThrowsThemOff)
{
  {
    Deck deck;
    dusty_carriers(deck, 1, "", "0 0 9e3");
    deck("run 20000 post no");
    EXPECT_EQ(tied(deck), 225.0);
    EXPECT_EQ(last_change(deck, 1), -1.0);
    EXPECT_EQ(last_change(deck, 2), -1.0);
    // 0.18 rad on, at 6.8 m/s. They swing on their rolling contacts: a force of 0.23 F_c along the surface moves them
    // by 0.59 um at the angular frequency sqrt(4 F_c R12/(7/5 m R^2)) = 1.94e5/s, which is 0.12 m/s
    const double *xp = deck.atom("x", 1), *vp = deck.atom("v", 1);
    for (int grain = 2; grain <= 226; grain++) {
      const double *x = deck.atom("x", grain), *v = deck.atom("v", grain);
      EXPECT_NEAR(v[0], vp[0] - 9e3 * (x[1] - xp[1]), 0.12) << grain;
      EXPECT_NEAR(v[1], vp[1] + 9e3 * (x[0] - xp[0]), 0.12) << grain;
    }
  }
  const double mass = 4.0 / 3.0 * M_PI * 1e-15 * 2700.0, pull_off = 3.0 * M_PI * GAMMA * R12;
  for (const double spin : {13.0e3, 14.5e3}) {
    Deck deck;
    dusty_carriers(deck, 1, "", line("0 0 %.17g", spin).c_str());
    int surely = 0, hardly = 0;
    const double *xp = deck.atom("x", 1);
    for (int grain = 2; grain <= 226; grain++) {
      const double *x = deck.atom("x", grain);
      const double arm2 = (x[0] - xp[0]) * (x[0] - xp[0]) + (x[1] - xp[1]) * (x[1] - xp[1]);
      const double share = mass * spin * spin * arm2 / 0.76e-3 / pull_off;
      surely += share > 1.02;
      hardly += share > 1.0;
    }
    deck(
        "run 3000 post no");    // others have slid by a few um at most, and a force just above the limit takes its time
    EXPECT_GE(225.0 - tied(deck), surely);
    EXPECT_LE(225.0 - tied(deck), hardly);
    if (spin < 13.2e3)
      EXPECT_EQ(hardly, 0);
    else
      EXPECT_GT(surely, 50);
  }
}

TEST(CreateDust, GrainsStayOnAFlyingCarrier)
{
  Deck deck;
  dusty_carriers(deck, 1);
  deck("set group all omega 0 0 0\nvelocity all set 3 0 -2\nrun 10000 post no");
  EXPECT_EQ(tied(deck), 225.0);
  EXPECT_NEAR(deck.atom("v", 1)[0], 3.0, 3e-9);
  EXPECT_NEAR(deck.atom("v", 1)[2], -2.0, 2e-9);
}

TEST(CreateDust, ComputeKnowsWhichCarrierHoldsAGrain)
{
  Deck deck;
  dusty_carriers(deck, 3);
  deck("run 1 post no");
  const auto *label = static_cast<double *>(lammps_extract_compute(deck.lmp, "tied", LMP_STYLE_ATOM, LMP_TYPE_VECTOR));
  const LAMMPS_NS::tagint *tag = deck.tags();
  ASSERT_NE(label, nullptr);
  for (int i = 0; i < static_cast<int>(lammps_get_natoms(deck.lmp)); i++) {
    const auto expected = tag[i] <= 3 ? 0 : 1 + (tag[i] - 4) / 225;    // 225 grains each
    ASSERT_EQ(label[i], static_cast<double>(expected)) << tag[i];      // carriers are not in the group of the grains
  }
  EXPECT_EQ(tied(deck), 675.0);
  // a grain pulled off is tied to nothing, one that holds on to another grain is tied to that one's carrier
  const double *x = deck.atom("x", 10), *xp = deck.atom("x", 1);
  char move[256];
  const double reach = (0.76e-3 + 20e-6 - Dust::equilibrium_overlap(A0, R12)) / 0.76e-3;
  std::snprintf(move, sizeof(move),
                "set atom 11 x %.17g y %.17g z %.17g\nset atom 12 z 0.0035\nset atom 11 omega 0 0 0",
                xp[0] + reach * (x[0] - xp[0]), xp[1] + reach * (x[1] - xp[1]), xp[2] + reach * (x[2] - xp[2]));
  deck(std::string(move) + "\nvelocity all set 0 0 0\nset group all omega 0 0 0\nrun 5 post no");
  EXPECT_EQ(tied(deck), 674.0);
}

TEST(CreateDust, GrainsInFlightStayAndLeaveTheirCarrierAlone)
{
  // oblique, so that coordinates round differently at each step; 100,000 steps are twice an impact
  Deck deck;
  dusty_carriers(deck, 1);
  deck("velocity all set 5 3 8\nset group all omega 0 0 0\nneighbor 15e-6 bin\ncomm_modify mode single\nrun 100000 "
       "post no");
  EXPECT_EQ(tied(deck), 225.0);
  const double *v = deck.atom("v", 1), start[3] = {5.0, 3.0, 8.0};
  for (int d = 0; d < 3; d++) EXPECT_NEAR(v[d], start[d], 1e-9 * std::sqrt(98.0));
}

TEST(ComputeDustCarrier, SaysWhenContactsWithCarriersLastChanged)
{
  Deck deck;
  dusty_carriers(deck, 1);
  deck("velocity all set 0 0 0\nset group all omega 0 0 0\nrun 100 post no");
  const auto last = [&](int k) { return last_change(deck, k); };
  EXPECT_EQ(last(0), 1.0);    // the grains were placed in contact
  EXPECT_EQ(last(1), -1.0);
  EXPECT_EQ(last(2), -1.0);

  const auto push = [&](int grain, bool along, double speed) {
    const double *x = deck.atom("x", grain), *xp = deck.atom("x", 1);
    const double n[3] = {(x[0] - xp[0]) / 0.76e-3, (x[1] - xp[1]) / 0.76e-3, (x[2] - xp[2]) / 0.76e-3};
    const double size = std::hypot(n[0], n[1]);
    const double v[3] = {along ? n[1] / size : n[0], along ? -n[0] / size : n[1], along ? 0.0 : n[2]};
    deck(line("group one id %.0f\nvelocity one set %.17g %.17g %.17g\ngroup one delete", grain, speed * v[0],
              speed * v[1], speed * v[2]));
  };
  // along the surface at 2 m/s: friction is at its limit soon, the pivot gives way after 1.5 um
  push(20, true, 2.0);
  deck("run 300 post no");
  EXPECT_EQ(last(0), 1.0);
  EXPECT_GT(last(1), 100.0);
  EXPECT_EQ(last(2), -1.0);
  deck("run 9700 post no");    // it slides for 7 us before it rolls
  EXPECT_EQ(last(0), 1.0);
  EXPECT_GT(last(2), 1000.0);

  // outwards: the neck breaks soon
  push(30, false, 0.1);
  deck("run 200 post no");
  EXPECT_GT(last(0), 10100.0);
  EXPECT_LT(last(0), 10200.0);
  EXPECT_EQ(tied(deck), 224.0);
}

TEST(ComputeDustCarrier, WhatGrainsDoAmongThemselvesDoesNotCount)
{
  Deck deck;
  dusty_carriers(deck, 1);
  deck("velocity all set 0 0 0\nset group all omega 0 0 0\nset atom 40 x 0.002 y 0 z 0.003\nset atom 41 x 0.00202001 y "
       "0 z 0.003\n"
       "run 100 post no\nset atom 41 x 0.00201999 omega 0 0 5e4\nrun 200 post no");
  EXPECT_EQ(last_change(deck, 0), 1.0);
  EXPECT_EQ(last_change(deck, 1), -1.0);
  EXPECT_NE(deck.atom("omega", 40)[2], 0.0);    // they did touch
}

TEST(CreateDust, SortingAtomsChangesNothing)
{
  // sorting swaps i and j of contacts: necks, sliding and rolling displacements must survive, also beside carriers' own
  // contacts of another model; sums of forces then run in another order, which is round-off
  const auto run = [](const char *sorting, double *omega) {
    Deck deck;
    dusty_carriers(deck, 3);
    deck("atom_modify sort 0 0\nvelocity all set 0 0 0\nset group carriers omega 0 0 0\nset group grains omega 2e3 "
         "-1e3 5e2\n"
         "neigh_modify every 200 delay 0 check no\nrun 500\n" +
         std::string(sorting) + "\nrun 500 post no");    // sorts when a run starts
    for (int grain = 4; grain < 4 + 675; grain++)
      for (int d = 0; d < 3; d++) *omega++ = deck.atom("omega", grain)[d];
    return tied(deck);
  };
  std::vector<double> sorted(3 * 675), unsorted(3 * 675);
  EXPECT_EQ(run("atom_modify sort 200 1e-4", sorted.data()), run("atom_modify sort 0 0", unsorted.data()));
  double largest = 0.0;
  for (double w : unsorted) largest = std::max(largest, std::fabs(w));
  for (size_t k = 0; k < sorted.size(); k++) ASSERT_NEAR(sorted[k], unsorted[k], 1e-6 * largest);
}

// wrong words leave nothing behind: no grain and no file
TEST(CreateDust, WrongInputIsNamed)
{
  const auto error = [](const std::string &words, const std::string &before = "") {
    Deck deck;
    deck.box();
    deck.carrier(0.0, 0.0, 0.001, 0.0, 0.0, 0.0);
    deck("group none type 2\ngroup carriers type 1\n" + before);
    std::string message = deck.attempt("create_dust " + words + " write dust_wrong.txt");
    const bool written = std::ifstream("dust_wrong.txt").good();
    std::remove("dust_wrong.txt");
    EXPECT_EQ(lammps_get_natoms(deck.lmp), message.empty() ? 226.0 : 1.0) << words;
    EXPECT_EQ(written, message.empty()) << words;
    message.resize(message.find('\n') == std::string::npos ? message.size() : message.find('\n'));
    return message;    // without LAMMPS' echo of the command
  };
  const auto names = [&](const std::string &words, const std::string &what) {
    const std::string message = error(words);
    EXPECT_NE(message.find(what), std::string::npos) << words << " -> " << message;
  };
  const std::string texture = "texture monolayer 20e-6 coverage 0.01 seed 1", ok = "carriers type 2 " + texture;
  EXPECT_EQ(error(ok), "");
  names("all", "create_dust");
  names("nobody type 2 " + texture, "nobody");
  names("none type 2 " + texture, "no carriers");
  names("carriers kind 2 " + texture, "kind");
  names("carriers type 3 " + texture, "type 3");
  names("carriers type 2 density 2700", "Create_dust needs keyword texture");
  names("carriers type 2 texture monolayer 20e-6 coverage 0.7 seed 1", "coverage 0.7 cannot be placed");
  names(ok + " density 2.7", "density value 2.7 must be from 10 to 30000 with units si");
  names(ok + " density 2700 density 2700", "density is given twice");
  names(ok + " " + texture, "texture is given twice");
  names(ok + " elastic 75e9 0.3 210e9", "elastic nu_carrier value write must be");
  names(ok + " write a.txt", "write is given twice");
  for (const char *word : {"friction 0.3", "tangential off", "emit 2", "colour red"})
    names(ok + " " + word, std::string("Create_dust has no keyword ") +
                               std::string(word).substr(0, std::string(word).find(' ')) +
                               ": use texture, coverage, seed, bare, distribution, spread, density, hamaker, surface, "
                               "elastic, orientation, write or classes");
  // the lowest grains would be below the box, which ends at -2 mm
  const std::string message = error(ok, "set atom 1 z -0.0013");
  EXPECT_NE(message.find("grains would lie outside the box"), std::string::npos) << message;
}

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const int result = RUN_ALL_TESTS();
  lammps_mpi_finalize();
  return result;
}
