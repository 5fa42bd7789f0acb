// inertia motion: what carriers lose that are free, held, carried along, shaken, turned or on a rail.

#include "deck.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <utility>

namespace {

using Place = std::array<double, 3>;
constexpr double RADIUS = 0.75e-3, SHELL = 0.76e-3;
constexpr double HOLD = 1.32997e5;    // F_c/m_d of the reference grain
const std::string UNIFORM = REFERENCE_DUST + " bare 0 ";

// directions of the grains of a texture file
std::vector<Place> directions(const std::string &file)
{
  std::vector<Place> all;
  std::ifstream in(file);
  for (std::string text; std::getline(in, text);) {
    std::istringstream words(text);
    Place n;
    double diameter;
    if (words >> n[0] >> n[1] >> n[2] >> diameter) all.push_back(n);
  }
  return all;
}

// those of the uniform texture for which the question is answered with yes
double count(const std::function<bool(const Place &)> &question)
{
  const std::string file = testing::TempDir() + "motion.texture";
  Deck deck;
  deck.box();
  deck.carrier(0, 0, 0.005, 0, 0, 0);
  deck("fix dust all dust/detach " + UNIFORM + "write " + file);
  const auto all = directions(file);
  std::remove(file.c_str());
  EXPECT_EQ(all.size(), 4500u);
  return static_cast<double>(std::count_if(all.begin(), all.end(), question));
}

// grains that have left in the last window: carrier and number
std::set<std::pair<double, double>> gone(const Deck &deck)
{
  std::set<std::pair<double, double>> all;
  for (const auto &row : deck.events()) all.insert({row[1], row[2]});
  return all;
}

using Preparation = std::function<void(Deck &)>;

struct Outcome {
  std::set<std::pair<double, double>> grains;
  std::vector<double> totals;
};

Outcome outcome(const Preparation &prepare, const std::string &words, int steps = 7000)
{
  Deck deck;
  prepare(deck);
  deck("fix dust all dust/detach " + REFERENCE_DUST + " counts yes every " + std::to_string(steps) + " " + words);
  deck("run " + std::to_string(steps) + " post no");
  return {gone(deck), deck.vector()};
}

void expect_same(const Preparation &prepare, const std::string &words)
{
  const Outcome by_contact = outcome(prepare, words + " inertia contact"),
                by_motion = outcome(prepare, words + " inertia motion");
  EXPECT_EQ(by_motion.grains, by_contact.grains);
  for (size_t k = 0; k < by_contact.totals.size(); k++)
    EXPECT_NEAR(by_motion.totals[k], by_contact.totals[k], 1e-12 * by_contact.totals[k]) << k;
}

// a carrier in the middle of the box that nothing touches
void lone(Deck &deck, const std::string &motion, double timestep)
{
  deck.box();
  deck.carrier(0, 0, 0.005, 0, 0, 0);
  deck(line("timestep %.17g", timestep) + "\n" + motion);
}

}    // namespace

TEST(InertiaMotion, AFreeCarrierOnAWallLosesTheSame)
{
  for (double speed : {1.0, 4.0, 8.0, 12.0})
    for (double degrees : {90.0, 45.0})
      for (const char *words : {"tangential estimate", "tangential integrate", "rotation no"}) {
        SCOPED_TRACE(std::to_string(speed) + " m/s, " + std::to_string(degrees) + " degrees, " + words);
        const double angle = degrees * M_PI / 180.0;
        expect_same(
            [=](Deck &deck) {
              deck.box();
              deck.carrier(0, 0, 0.7501e-3, speed * std::cos(angle), 0, -speed * std::sin(angle));
              deck("fix move all nve/sphere\nfix wall all wall/gran granular " + contact(0.7, 0.3) +
                   " zplane 0.0 NULL");
            },
            words);
      }
}

TEST(InertiaMotion, FreeCarriersThatMeetLoseTheSame)
{
  for (double speed : {1.0, 4.0, 8.0, 12.0})
    for (double offset : {0.0, 0.6e-3}) {
      SCOPED_TRACE(std::to_string(speed) + " m/s, offset " + std::to_string(offset));
      expect_same(
          [=](Deck &deck) {
            const double apart = std::sqrt(4.0 * RADIUS * RADIUS - offset * offset) + 2e-7;
            deck.box();
            deck.carrier(0, 0, 0.005 - 0.5 * apart, 0, 0, 0.5 * speed);
            deck.carrier(offset, 0, 0.005 + 0.5 * apart, 0, 0, -0.5 * speed);
            deck("fix move all nve/sphere\npair_coeff * * " + contact(0.7, 0.3));
          },
          "tangential estimate orientation random 3");
    }
}

TEST(InertiaMotion, AFrozenCarrierLosesNothing)
{
  const Preparation hit = [](Deck &deck) {
    deck.box();
    deck.carrier(0, 0, 0.005, 0, 0, 0);
    deck.carrier(0.2e-3, 0, 0.00649, 0, 0, -8.0);
    deck("group frozen id 1\nfix move all nve/sphere");
  };
  const auto lost = [&](const char *inertia) {
    Deck deck;
    hit(deck);
    deck("fix dust all dust/detach " + REFERENCE_DUST + " inertia " + inertia + "\nfix hold frozen freeze");
    deck("run 6000 post no");
    EXPECT_EQ(deck.columns(1)[0], 4500.0);
    return 4500.0 - deck.columns(2)[0];
  };
  const double by_contact = lost("contact");
  EXPECT_GT(by_contact, 2000.0);
  EXPECT_EQ(lost("motion"), by_contact);
}

// the largest acceleration A w^2 pulls along z, to and fro
TEST(InertiaMotion, AShakenCarrierLosesWhatTheClosedFormSays)
{
  const double period = 1e-4, w = 2.0 * M_PI / period;
  for (double times : {0.9, 1.1, 2.0, 5.0}) {
    const double amplitude = times * HOLD / (w * w);
    const double expected = count([=](const Place &n) { return std::fabs(n[2]) * times > 1.0; });
    EXPECT_NEAR(expected / 4500.0, std::max(0.0, 1.0 - 1.0 / times), 0.02);
    Deck deck;
    lone(deck, line("fix shake all move wiggle 0 0 %.17g %.17g", amplitude, period), period / 2000.0);
    deck("fix dust all dust/detach " + UNIFORM + " tangential off inertia motion\nrun 10 post no");
    EXPECT_EQ(deck.global(3), 0.0);    // it starts with its largest velocity, and that is no jump
    deck("run 1990 post no");
    EXPECT_NEAR(deck.global(3), expected, 2.0) << times;
    deck("run 2000 post no");
    EXPECT_NEAR(deck.global(3), expected, 2.0);    // what has stayed stays
  }
}

// about an axis beside it: w^2 r outwards, and its own spin
TEST(InertiaMotion, ATurnedCarrierLosesWhatTheClosedFormSays)
{
  const double arm = 5e-3;
  for (double times : {0.8, 1.2, 2.0}) {
    const double w = std::sqrt(times * HOLD / arm), period = 2.0 * M_PI / w;
    const double expected =
        count([=](const Place &n) { return w * w * (arm * n[0] + SHELL * (1.0 - n[2] * n[2])) > HOLD; });
    Deck deck;
    deck.box();
    deck.carrier(arm, 0, 0.005, 0, 0, 0);
    deck(line("timestep %.17g", period / 5000.0) + "\n" +
         line("fix turn all move rotate 0 0 0.005 0 0 1 %.17g", period));
    deck("fix dust all dust/detach " + UNIFORM + " tangential off inertia motion\nrun 6000 post no");
    EXPECT_NEAR(deck.global(3), expected, 3.0) << times;
    EXPECT_EQ(deck.columns(1)[0], 4500.0 - deck.global(3));
  }
}

// On a rail along z at a wall of 45 degrees: after the way s the overlap is s/sqrt(2), and F/sqrt(2) acts along the
// rail: k 2^(-5/4) s^(3/2), as on a wall across it whose modulus is so many times smaller.
TEST(InertiaMotion, ACarrierOnARailHitsAnInclinedWallAsASofterFlatOne)
{
  const auto steel = [](double modulus) {
    return "hertz/material " + line("%.17g", modulus) +
           " 1.0 0.3 tangential linear_nohistory 0.0 0.0 damping coeff_restitution/limited";
  };
  for (double speed : {4.0, 8.0, 12.0}) {
    Deck rail, flat;
    for (Deck *deck : {&rail, &flat}) {
      deck->box();
      deck->carrier(0, 0, 0.005, 0, 0, -speed);
      (*deck)("fix move all nve/sphere");
    }
    rail(line("region slope plane 0 0 %.17g 1 0 1", 0.005 - std::sqrt(2.0) * RADIUS - 1e-7) +
         "\nfix wall all wall/gran/region granular " + steel(210e9) + " region slope");
    flat("fix wall all wall/gran granular " + steel(210e9 / std::pow(2.0, 1.25)) +
         line(" zplane %.17g NULL", 0.005 - RADIUS - 1e-7));
    rail("fix dust all dust/detach " + REFERENCE_DUST + " inertia motion\nfix rail all setforce 0 0 NULL");
    flat("fix dust all dust/detach " + REFERENCE_DUST + " inertia contact");
    rail("run 9000 post no");
    flat("run 9000 post no");
    EXPECT_NEAR(rail.atom("v", 1)[2], speed, 1e-3 * speed);
    EXPECT_GT(flat.global(3), 1500.0);
    for (int k : {3, 4, 5, 6}) EXPECT_NEAR(rail.global(k), flat.global(k), 2.0) << speed << " " << k;
    EXPECT_NEAR(rail.columns(1)[4], flat.columns(1)[4], 1e-4 * flat.columns(1)[4]);
    EXPECT_NEAR(rail.columns(1)[3], flat.columns(1)[3], 3e-9);
  }
}

// a fall pulls grains as it pulls their carrier; what does not fall carries them
TEST(InertiaMotion, GravityPullsGrainsToo)
{
  for (bool held : {false, true}) {
    Deck deck;
    lone(deck, held ? "" : "fix move all nve/sphere", 1e-7);
    deck("fix dust all dust/detach " + UNIFORM + " tangential off inertia motion\n" +
         line("fix fall all gravity %.17g vector 0 0 -1\nrun 20 post no", 2.0 * HOLD));
    const double below = count([](const Place &n) { return -2.0 * n[2] > 1.0; });
    EXPECT_NEAR(deck.global(3), held ? below : 0.0, 1.0);
  }
}

// neither a steady velocity nor one that means nothing, nor a velocity that is given between runs
TEST(InertiaMotion, WhatIsNoAcceleration)
{
  for (const char *motion : {"fix m all move linear 1 2 -1", "", "fix m all nve/sphere", "fix m all nve/noforce"}) {
    Deck deck;
    lone(deck, motion, 1e-6);
    deck("fix dust all dust/detach " + UNIFORM + " inertia motion\nrun 10 post no");
    deck("velocity all set 3 0 1\nrun 10 post no");
    EXPECT_EQ(deck.global(2), 4500.0) << motion;
  }
}

// a carrier that comes during a run has the velocity that it comes with; one that spins steadily keeps its grains
TEST(InertiaMotion, CarriersThatCome)
{
  Deck deck;
  lone(deck, "fix move all nve/sphere", 1e-6);
  deck("region up block -0.005 0.005 -0.005 0.005 0.007 0.009\nset atom 1 omega 0 0 1e4");
  deck("fix dust all dust/detach " + UNIFORM +
       " inertia motion\nfix fall all gravity 9.81 vector 0 0 -1\n"
       "fix come all pour 3 1 1234 region up diam one 1.5e-3 dens 7700 7700 vol 0.1 50 vel 0 0 0 0 -5\nrun 60 post no");
  EXPECT_EQ(lammps_get_natoms(deck.lmp), 4.0);
  EXPECT_EQ(deck.global(2), 4.0 * 4500);
}

// mass and momentum of what leaves: as by contact forces, but for the order of a step
TEST(InertiaMotion, MassThatLeaves)
{
  const Preparation impact = [](Deck &deck) {
    deck.box();
    deck.carrier(0, 0, 0.7501e-3, 4.0, 0, -8.0);
    deck("group carriers id 1");
    deck.wall_and_motion();
  };
  for (const char *words : {"mass yes", "mass yes tangential off"}) {
    std::array<double, 2> lost, speed;
    for (int k : {0, 1}) {
      Deck deck;
      impact(deck);
      deck("fix dust carriers dust/detach " + REFERENCE_DUST + " " + words + " inertia " + (k ? "motion" : "contact"));
      deck("run 6000 post no");
      lost[k] = deck.global(2);
      speed[k] = deck.atom("v", 1)[2];
    }
    EXPECT_LT(lost[0], 3000.0);
    EXPECT_NEAR(lost[1], lost[0], 2.0);
    EXPECT_NEAR(speed[1], speed[0], 1e-5 * speed[0]);
  }
}

TEST(InertiaMotion, WhatDoesNotGoTogether)
{
  Deck deck;
  lone(deck, "fix move all nve/sphere", 1e-6);
  const auto expect = [&](const std::string &words, const std::string &message) {
    const std::string error = deck.attempt("fix dust all dust/detach " + REFERENCE_DUST + " " + words);
    EXPECT_NE(error.find(message), std::string::npos) << error;
  };
  expect("inertia motion stiffen 10", "stiffen 10 needs inertia contact");
  expect("inertia force", "inertia value force must be contact or motion");
}
