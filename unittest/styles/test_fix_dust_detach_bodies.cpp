// fix dust/detach beyond the single carrier on a wall: spin, carriers that collide, softened contacts, beds, and the
// mass and momentum of what comes off.

#include "deck.h"

#include <algorithm>
#include <array>
#include <functional>

namespace {

using Vec = std::array<double, 3>;

constexpr double RADIUS = 0.75e-3;

void dust(Deck &deck, const std::string &options = "", const std::string &group = "all", const std::string &id = "dust")
{
  deck("fix " + id + " " + group + " dust/detach " + REFERENCE_DUST + " " + options);
}

void spin(Deck &deck, int id, double x, double y, double z)
{
  deck("set atom " + std::to_string(id) + line(" omega %.17g %.17g %.17g", x, y, z));
}

// a cubic box without walls, periodic
void space(Deck &deck, double half = 0.01)
{
  deck("units si\natom_style sphere\nboundary p p p\nnewton off\ncomm_modify vel yes\nregion box block" +
       line(" -%g %g", half, half) + line(" -%g %g", half, half) + line(" -%g %g", half, half) +
       "\ncreate_box 2 box\ntimestep 1e-9\nneighbor 3e-4 bin\npair_style granular\npair_coeff * * " + contact(0.7));
}

double size(const Vec &v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

}    // namespace

// a spin at which |r| omega^2 exceeds F_c/m throws off the grains around the equator, z = 0, from |r| omega^2 (1 -
// n_z^2) > c on: the fraction sqrt(1 - c/(|r| omega^2)) of the sphere. 4500 grains scatter by 0.5 %; three times that.
TEST(FixDustDetachBodies, SpinAloneThrowsOffTheEquator)
{
  const double c = 1.330e5, shell = 0.76e-3;
  for (double factor : {0.9999, 1.02, 1.5, 4.0}) {
    Deck deck;
    space(deck);
    deck.carrier(0, 0, 0, 1.0, 2.0, 3.0);
    spin(deck, 1, 0, 0, -std::sqrt(factor * c / shell));
    deck("fix move all nve/sphere");
    dust(deck, "bare 0 hamaker 14.633e-20 0.4e-9");
    deck("run 10 post no");
    const double expected = factor > 1.0 ? std::sqrt(1.0 - 1.0 / factor) : 0.0;
    EXPECT_NEAR(deck.global(0), expected, factor > 1.0 ? 0.015 : 0.0) << factor;
    EXPECT_EQ(deck.global(9), 0.0);    // no collision
    deck("run 10 post no");
    EXPECT_NEAR(deck.global(0), expected, factor > 1.0 ? 0.015 : 0.0);    // once
  }
}

// rows say where a grain is and how fast: it moves with the surface
TEST(FixDustDetachBodies, RowsOfASpinningCarrier)
{
  Deck deck;
  space(deck);
  deck.carrier(1e-3, -2e-3, 0.5e-3, 1.0, 2.0, 3.0);
  const Vec omega = {-7000.0, 12000.0, 15000.0};
  spin(deck, 1, omega[0], omega[1], omega[2]);
  deck("fix move all nve/sphere");
  dust(deck, "bare 0 orientation random 5");
  deck("run 0");
  deck("run 1 post no");
  const auto rows = deck.events();
  ASSERT_GT(rows.size(), 100u);
  for (const auto &row : rows) {
    // the carrier has moved on by a step of 3.7 nm since
    const Vec r = {row[5] - 1e-3, row[6] + 2e-3, row[7] - 0.5e-3};
    EXPECT_NEAR(size(r), 0.76e-3, 1e-11);
    EXPECT_NEAR(row[8], 1.0 + omega[1] * r[2] - omega[2] * r[1], 1e-9);
    EXPECT_NEAR(row[9], 2.0 + omega[2] * r[0] - omega[0] * r[2], 1e-9);
    EXPECT_NEAR(row[10], 3.0 + omega[0] * r[1] - omega[1] * r[0], 1e-9);
  }
}

// the orientation follows the spin: half a turn about x in free flight brings the bare cap from below to above
TEST(FixDustDetachBodies, OrientationFollowsTheSpin)
{
  const auto lost = [](bool rotation, double turns) {
    Deck deck;
    deck.box();
    const double v = 1.0, wait = 2e-3;
    deck.carrier(0, 0, RADIUS + v * wait, 0, 0, -v);
    spin(deck, 1, turns * 2.0 * M_PI / wait, 0, 0);
    // a wall without friction: the spin does not change
    deck("fix move all nve/sphere\nfix wall all wall/gran granular hertz/material 210e9 0.7 0.3 tangential "
         "linear_nohistory 0.0 0.0 "
         "damping coeff_restitution/limited zplane 0.0 NULL\ntimestep 5e-9");
    dust(deck, std::string("bare 1.2 rotation ") + (rotation ? "yes" : "no"));
    deck("run 402000 post no");
    EXPECT_EQ(deck.global(9), 1.0);
    return deck.global(3);
  };
  const double cap_below = lost(true, 0.0);
  EXPECT_EQ(lost(false, 0.5), cap_below);
  // a spin of 3.1e3 rad/s adds |r| omega^2 = 7.5e3 m/s2, 6 % of what holds a grain, so a turn is not quite no turn; the
  // grains of half the sphere less the cap, 0.32 of 0.5, are those that come off with the cap below
  EXPECT_NEAR(lost(true, 1.0), cap_below, 0.02 * 4500);
  EXPECT_GT(lost(true, 0.5), cap_below + 0.2 * 4500);
}

// columns 6 to 9 at the start and the end of a run, whatever step that is: half the angle about a fixed axis
TEST(FixDustDetachBodies, OrientationIsShown)
{
  for (const bool rotation : {true, false})
    for (const char *inertia : {"contact", "motion"}) {
      Deck deck;
      space(deck);
      deck.carrier(0, 0, 0, 0, 0, 0);
      const double wx = 200.0, wy = -300.0, wz = 600.0, w = 700.0, dt = 1e-6;
      spin(deck, 1, wx, wy, wz);
      deck("fix move all nve/sphere\ntimestep 1e-6");
      dust(deck, std::string("inertia ") + inertia + " rotation " + (rotation ? "yes" : "no"));
      for (const int steps : {0, 1003, 1500}) {    // of neither is 16 a factor
        deck("run " + std::to_string(steps - (steps == 1500 ? 1003 : 0)));
        const double half = rotation ? 0.5 * w * dt * steps : 0.0;
        const double expected[] = {std::cos(half), std::sin(half) * wx / w, std::sin(half) * wy / w,
                                   std::sin(half) * wz / w};
        for (int d = 0; d < 4; d++)
          EXPECT_NEAR(deck.columns(1)[LAMMPS_NS::DetachAtom::QW + d], expected[d], 1e-12) << inertia << steps;
      }
    }
}

// each of two equal carriers that meet head-on moves as on a rigid wall: that has E* of one elastic side alone, twice
// theirs
TEST(FixDustDetachBodies, HeadOnCollisionIsTheImpactOnARigidWall)
{
  for (double v : {2.0, 8.0, 12.0})
    for (const char *tangential : {"impulse", "estimate", "integrate"}) {
      Deck wall;
      wall.box();
      wall.carrier(0, 0, 0.7501e-3, 0, 0, -v);
      wall("fix move all nve/sphere\nfix wall all wall/gran granular hertz/material 420e9 0.7 0.3 tangential "
           "linear_nohistory 0.0 0.0 "
           "damping coeff_restitution/limited zplane 0.0 NULL");
      dust(wall, std::string("tangential ") + tangential);
      wall("run 5000 post no");

      Deck pair;
      space(pair);
      pair.carrier(0, 0, 0.7501e-3, 0, 0, -v);
      pair.carrier(0, 0, -0.7501e-3, 0, 0, v);
      pair("group up id 1\ngroup down id 2\nfix move all nve/sphere");
      dust(pair, std::string("tangential ") + tangential, "up");
      dust(pair, std::string("bare 0.33 0 0 1 tangential ") + tangential, "down", "other");
      pair("run 5000 post no\nvariable other equal f_other\nvariable done equal f_other[9]");
      EXPECT_EQ(wall.global(9), 1.0);
      EXPECT_EQ(pair.global(9), 1.0);
      EXPECT_EQ(*static_cast<double *>(lammps_extract_variable(pair.lmp, "done", nullptr)), 1.0);
      // the wall's friction is none and the pair's has nothing to do: the same but for round-off that may move a grain
      EXPECT_NEAR(pair.global(0), wall.global(0), 2.0 / 4500) << v;
      EXPECT_NEAR(pair.columns(1)[3], wall.columns(1)[3], 1.1e-9);
      EXPECT_NEAR(pair.columns(1)[4], wall.columns(1)[4], 1e-6 * wall.columns(1)[4]);
      // another texture's side: its own scatter
      EXPECT_NEAR(*static_cast<double *>(lammps_extract_variable(pair.lmp, "other", nullptr)), wall.global(0), 0.015)
          << v;
    }
}

// off-centre collision of two spinning carriers; all of it turned by 90 degrees about x: y -> z, z -> -y, textures too
TEST(FixDustDetachBodies, TurningEverythingChangesNothing)
{
  const auto run = [](const std::function<Vec(Vec)> &turn, const char *tangential) {
    Deck deck;
    space(deck);
    const auto put = [&](Vec x, Vec v) {
      x = turn(x), v = turn(v);
      deck.carrier(x[0], x[1], x[2], v[0], v[1], v[2]);
    };
    put({0.2e-3, 0.3e-3, 0.7266e-3}, {0.5, -1.0, -9.0});    // 0.1 um apart
    put({-0.2e-3, -0.2e-3, -0.63e-3}, {0.0, 1.0, 5.0});
    const Vec w1 = turn({1000.0, -3000.0, 2000.0}), w2 = turn({-500.0, 4000.0, 300.0}), axis = turn({0.2, 0.3, -0.93});
    spin(deck, 1, w1[0], w1[1], w1[2]);
    spin(deck, 2, w2[0], w2[1], w2[2]);
    deck("pair_coeff * * " + contact(0.7, 0.4) + "\nfix move all nve/sphere");
    // a file of which the grains are turned
    std::string text = "# dust texture 1\ncarrier_diameter 1.5e-3\nbare 0.3 " +
                       line("%.17g %.17g %.17g", axis[0] / size(axis), axis[1] / size(axis), axis[2] / size(axis)) +
                       "\ngrains 300\n";
    for (int k = 0; k < 300; k++) {    // a spiral from pole to pole, along the axis that is not bare
      const double z = 1.0 - 1.9 * (k + 0.5) / 300, phi = 2.399963 * k, s = std::sqrt(1.0 - z * z);
      const Vec e = {0.2 / size({0.2, 0.3, -0.93}), 0.3 / size({0.2, 0.3, -0.93}), -0.93 / size({0.2, 0.3, -0.93})};
      const Vec u = {0.0, 0.93 / std::hypot(0.93, 0.3), 0.3 / std::hypot(0.93, 0.3)};
      const Vec w = {e[1] * u[2] - e[2] * u[1], e[2] * u[0] - e[0] * u[2], e[0] * u[1] - e[1] * u[0]};
      Vec n;
      for (int d = 0; d < 3; d++) n[d] = -z * e[d] + s * (std::cos(phi) * u[d] + std::sin(phi) * w[d]);
      n = turn(n);
      if (-z < std::cos(0.3)) text += line("%.17g %.17g %.17g %.17g\n", n[0], n[1], n[2], 20e-6);
    }
    int lines = 0;
    for (char ch : text) lines += ch == '\n';
    text.replace(text.find("grains 300"), 10, "grains " + std::to_string(lines - 4));
    std::FILE *file = std::fopen("dust_turned.txt", "w");
    std::fputs((text + "end\n").c_str(), file);
    std::fclose(file);
    deck(std::string("fix dust all dust/detach texture file dust_turned.txt tangential ") + tangential +
         "\nrun 6000 post no");
    std::remove("dust_turned.txt");
    return deck.vector();
  };
  for (const char *tangential : {"impulse", "estimate", "integrate"}) {
    const auto straight = run([](Vec v) { return v; }, tangential);
    const auto turned = run([](Vec v) { return Vec{v[0], -v[2], v[1]}; }, tangential);
    EXPECT_GT(straight[3], 50.0);
    EXPECT_EQ(straight[9], 2.0);
    EXPECT_EQ(turned, straight) << tangential;    // counts; no grain is so close to its limit that round-off moves it
  }
}

// E/S with stiffen S gives the stiff impact, straight and oblique. The time step is larger, too, as a user would have
// it.
TEST(FixDustDetachBodies, StiffenUndoesSoftContacts)
{
  struct Case {
    double v, angle;
  };
  for (const Case &c : {Case{4.0, 90.0}, Case{8.0, 90.0}, Case{12.0, 60.0}, Case{8.0, 30.0}}) {
    double stiff[3] = {};
    for (double S : {1.0, 10.0, 100.0, 1000.0}) {
      Deck deck;
      deck.box();
      const double vx = c.v * std::cos(c.angle * M_PI / 180.0), vz = c.v * std::sin(c.angle * M_PI / 180.0),
                   longer = std::pow(S, 0.4);
      const std::string soft = "hertz/material " + std::to_string(210e9 / S) +
                               " 0.7 0.3 tangential mindlin NULL 0.0 0.05 damping coeff_restitution/limited";
      deck.carrier(0, 0, 0.7501e-3, vx, 0, -vz);
      deck("pair_coeff * * " + soft + "\nfix move all nve/sphere\nfix wall all wall/gran granular " + soft +
           " zplane 0.0 NULL" + line("\ntimestep %g", 1e-9 * longer));
      dust(deck, "stiffen " + std::to_string(S));
      deck("run 6000 post no");
      EXPECT_EQ(deck.global(9), 1.0);
      const double found[3] = {deck.global(0), deck.columns(1)[3], deck.columns(1)[4]};
      if (S == 1.0) std::copy_n(found, 3, stiff);
      EXPECT_NEAR(found[0], stiff[0], 0.01) << c.v << " m/s " << c.angle << " S " << S;
      EXPECT_NEAR(found[1], stiff[1], 0.01 * stiff[1]);    // contact time and peak acceleration as they would be
      EXPECT_NEAR(found[2], stiff[2], 0.02 * stiff[2]);
    }
  }
}

// a carrier that lies on the wall under gravity, others on top of it: nothing comes off, and the contact counts as one
// collision that came to rest. Then a hit from above is a collision again.
TEST(FixDustDetachBodies, ACarrierAtRestLosesNothingUntilItIsHit)
{
  Deck deck;
  deck.box();
  const std::string soft =
      "hertz/material 2.1e8 0.3 0.3 tangential mindlin NULL 0.0 0.3 damping coeff_restitution/limited";
  deck.carrier(0, 0, RADIUS, 0, 0, 0);
  deck.carrier(0, 0, 3.0 * RADIUS, 0, 0, 0);
  deck("pair_coeff * * " + soft + "\nfix move all nve/sphere\nfix wall all wall/gran granular " + soft +
       " zplane 0.0 NULL\ntimestep 2e-7");
  dust(deck, "stiffen 1000 orientation random 3");
  deck("fix weight all gravity 9.81 vector 0 0 -1\nrun 40000 post no");
  EXPECT_EQ(deck.global(0), 0.0);
  const double collisions = deck.global(9);
  EXPECT_GE(collisions, 2.0);
  deck("run 10000 post no");
  EXPECT_EQ(deck.global(9), collisions);    // both rest
  EXPECT_EQ(deck.global(0), 0.0);
  deck.carrier(0, 0, 5.0 * RADIUS + 1e-5, 0, 0, -6.0);
  deck("run 2000 post no");
  EXPECT_GT(deck.global(0), 0.1);
  EXPECT_GT(deck.columns(1)[1], 0.0);    // through the others, also from the lowest
}
