// Single impacts: that each is followed to its rebound, and what a row says of the moment in which a grain leaves.

#include "deck.h"

#include "core/hamaker.h"
#include "core/jkr.h"
#include "core/texture_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

using namespace LAMMPS_NS;

namespace {

constexpr double R = 0.75e-3, START = R + 1.0e-9;

void set_up(Deck &deck, double restitution, double friction, double vx, double vz, const std::string &options)
{
  deck.box();
  deck.carrier(0.0, 0.0, START, vx, 0.0, vz);
  deck("fix move all nve/sphere\nfix wall all wall/gran granular " + contact(restitution, friction) +
       " zplane 0.0 NULL");
  deck("fix dust all dust/detach " + REFERENCE_DUST + " " + options);
}

struct Rebound {
  double vx, vz, time, dispersion;
};

// as the decks end: halt once the collision is finished
Rebound rebound(double restitution, double vx, double vz, const std::string &options)
{
  Deck deck;
  set_up(deck, restitution, 0.05, vx, vz, options);
  deck("variable finished equal f_dust[9]\nfix stop all halt 100 v_finished > 0 error continue message no\n"
       "run 60000 post no");
  EXPECT_EQ(deck.global(9), 1.0);
  const double *v = deck.atom("v", 1);
  return {v[0], v[2], deck.columns(1)[DetachAtom::CONTACT_TIME], deck.global(0)};
}

// of a Hertz impact without damping: 2.9432 (largest overlap)/v
double elastic_time(double v)
{
  const double m = 4.0 / 3.0 * M_PI * R * R * R * 7700.0, k = 4.0 / 3.0 * 210e9 / (2.0 * (1.0 - 0.09)) * std::sqrt(R);
  return 2.9432 * std::pow(1.25 * m * v * v / k, 0.4) / v;
}

}    // namespace

TEST(FixDustDetachImpacts, WeakAndGrazingOnesEndByRebound)
{
  for (const std::string law : {"off", "impulse", "estimate", "integrate"}) {
    for (double speed : {1.0e-3, 0.1, 0.3})
      for (double e : {0.1, 0.2, 0.7, 1.0}) {
        const Rebound r = rebound(e, 0.0, -speed, "tangential " + law);
        EXPECT_NEAR(r.vz, e * speed, 0.005 * e * speed) << law << " " << speed << " " << e;
        // times go with v^-0.2 whatever e; 8.65 us without damping at 0.1 m/s, 7.55 us at 0.7
        const double slower = std::pow(0.1 / speed, 0.2);
        if (e == 1.0) {
          EXPECT_NEAR(r.time, elastic_time(speed), 2.0e-3 * r.time);
        } else if (e == 0.7) {
          EXPECT_NEAR(r.time, 7.55e-6 * slower, 0.02e-6 * slower);
        }
        if (speed < 0.2) {
          EXPECT_EQ(r.dispersion, 0.0);
        }
      }
    const double angle = M_PI / 180.0;    // 8 m/s at 1 degree: friction takes 0.05 of what the wall gives
    const Rebound grazing = rebound(0.7, 8.0 * std::cos(angle), -8.0 * std::sin(angle), "tangential " + law);
    EXPECT_NEAR(grazing.vz, 0.7 * 8.0 * std::sin(angle), 1.0e-3);
    EXPECT_NEAR(grazing.vx, 8.0 * std::cos(angle) - 0.05 * 1.7 * 8.0 * std::sin(angle), 1.0e-3);
    // grains that hold 16 times as hard
    const Rebound held = rebound(0.7, 0.0, -1.0, "hamaker 14.633e-20 1e-10 tangential " + law);
    EXPECT_NEAR(held.vz, 0.7, 0.0035);
    EXPECT_NEAR(held.time, 4.765e-6, 0.02e-6);
  }
}

TEST(FixDustDetachImpacts, ASpreadOfAdhesionReleasesWhatItsLogNormalSays)
{
  // straight, lift-off alone: a grain leaves when the largest acceleration, outward by its cosine, exceeds its own c.
  // Averaged over the texture's directions; the scatter is that of as many grains on their own
  const double gamma = Dust::surface_energy(std::sqrt(10.1e-20 * 21.2e-20), 0.4e-9);
  const double c = Dust::pull_off_force(gamma, Dust::effective_radius(R, 10e-6)) / (4.0 / 3.0 * M_PI * 1e-15 * 2700.0);
  for (double speed : {0.3, 1.0, 3.0})
    for (double sigma_a : {1.2, 2.0, 4.0}) {
      Deck deck;
      set_up(deck, 0.7, 0.05, 0.0, -speed, line("tangential off spread %.17g write dust_spread.txt", sigma_a));
      deck("variable finished equal f_dust[9]\nfix stop all halt 100 v_finished > 0 error continue message no\n"
           "run 20000 post no");
      const double peak = deck.columns(1)[DetachAtom::PEAK_ACCELERATION];
      double expected = 0.0, variance = 0.0;
      for (const Dust::Grain &grain : Dust::read_texture_file("dust_spread.txt").grains) {
        const double load = -peak * grain.n[2] / c;
        const double p = load > 0.0 ? 0.5 * std::erfc(-std::log(load) / (std::sqrt(2.0) * std::log(sigma_a))) : 0.0;
        expected += p;
        variance += p * (1.0 - p);
      }
      EXPECT_NEAR(deck.global(3), expected, 3.0 * std::sqrt(variance) + 0.5) << sigma_a << " at " << speed << " m/s";
      EXPECT_EQ(deck.global(1), 4500.0);
    }
  std::remove("dust_spread.txt");
}

TEST(FixDustDetachImpacts, NoSpreadIsAsBefore)
{
  const auto left = [](const std::string &options) {
    Deck deck;
    set_up(deck, 0.7, 0.05, 2.0, -8.0, options);
    deck("run 8000 post no");
    std::vector<double> all = deck.vector();
    for (const double x : deck.columns(1)) all.push_back(x);
    return all;
  };
  for (const std::string law : {"impulse", "estimate", "integrate", "frictionless"}) {
    EXPECT_EQ(left("spread 1 tangential " + law), left("tangential " + law));
    EXPECT_NE(left("spread 1.1 tangential " + law), left("tangential " + law));
  }
}

TEST(FixDustDetachImpacts, RowsAreOfTheMomentInWhichAGrainLeaves)
{
  struct Law {
    std::string name;
    double velocity, place;    // that it may miss, the place in R
  };
  // the carrier's own course, step by step, which the impulse law takes for half a sine
  for (const Law &law : {Law{"integrate", 0.3, 0.0}, Law{"impulse", 1.0, 2e-4}})
    for (const auto &[e, stiffen] :
         {std::pair(0.3, 1.0), std::pair(0.3, 100.0), std::pair(0.7, 1.0), std::pair(0.7, 100.0)}) {
      Deck deck;
      deck.box();
      deck.carrier(0.0, 0.0, START, 0.0, 0.0, -9.0);
      const double E = 210e9 / stiffen, dt = 1.0e-9 * std::pow(stiffen, 0.4);
      deck("fix move all nve/sphere\nfix wall all wall/gran granular " +
           line("hertz/material %.17g %.17g 0.3 tangential mindlin NULL 0 0.05", E, e) +
           " damping coeff_restitution/limited zplane 0.0 NULL\n" + line("timestep %.17g", dt));
      deck("fix dust all dust/detach " + REFERENCE_DUST + " tangential " + law.name +
           line(" every 4000 stiffen %g", stiffen));
      std::vector<std::array<double, 2>> course = {{START, -9.0}};
      for (int k = 0; k < 4000; k++) {
        deck("run 1 pre " + std::string(k ? "no" : "yes") + " post no");
        course.push_back({deck.atom("x", 1)[2], deck.atom("v", 1)[2]});
      }
      const auto rows = deck.events();
      double fastest = 0.0;
      int early = 0;
      for (const auto &row : rows) {
        const int step = static_cast<int>(row[DetachRow::STEP]);
        ASSERT_GT(step, 0);
        ASSERT_LE(step, 4000);
        const auto [z, vz] = course[step];
        const double *x = &row[DetachRow::X], *v = &row[DetachRow::VX];
        const double n[3] = {x[0] / (R + 1.0e-5), x[1] / (R + 1.0e-5), (x[2] - z) / (R + 1.0e-5)};
        // on the carrier where that was then, to half a step's way
        EXPECT_NEAR(std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), 1.0, 5.0 * dt / R + law.place);
        if (row[DetachRow::MODE] != 2.0) continue;
        // along its surface; the record of the collision has spans of 32 or 64 steps
        EXPECT_NEAR(v[0] * n[0] + v[1] * n[1] + (v[2] - vz) * n[2], 0.0, law.velocity) << step;
        fastest = std::min(fastest, v[2]);
        early += step < 2000;
      }
      // those that have slid past the equator go on as the carrier came; by the velocity at its end it would be +0.5
      EXPECT_NEAR(fastest, -8.95, law.velocity - 0.25);
      EXPECT_GT(early, 50);
    }
}

TEST(FixDustDetachImpacts, AngularAccelerationIsTorqueOverTheMomentOfInertia)
{
  // a carrier that slips on the wall: grains that would slide at any step, from the forces of the deck
  const std::string file = ::testing::TempDir() + "texture_of_impacts.txt";
  Deck deck;
  set_up(deck, 0.7, 0.3, 0.0, -0.12, "tangential off counts yes write " + file);
  deck("set atom 1 omega 0 3000 0");
  const Dust::Texture texture = Dust::read_texture_file(file);
  std::remove(file.c_str());
  const double m = 4.0 / 3.0 * M_PI * R * R * R * 7700.0, inertia = 0.4 * m * R * R, shell = R + 1.0e-5;
  const double hold = 1.5042e-6 / 1.1310e-11;    // F_c/m_d of the reference grain
  std::vector<char> slides(texture.grains.size(), 0), without(texture.grains.size(), 0);
  double angle = 0.0;
  for (int step = 0; step < 9000; step++) {
    deck("run 1 pre " + std::string(step ? "no" : "yes") + " post no");
    const double *f = deck.atom("f", 1), *torque = deck.atom("torque", 1), *omega = deck.atom("omega", 1);
    angle += 1.0e-9 * omega[1];
    if (f[2] == 0.0) continue;
    for (size_t k = 0; k < slides.size(); k++) {
      const double *g = texture.grains[k].n, c = std::cos(angle), s = std::sin(angle);
      const double n[3] = {c * g[0] + s * g[2], g[1], c * g[2] - s * g[0]};
      for (const bool turns : {true, false}) {
        // all about y: alpha x r and omega x (omega x r)
        const double alpha = turns ? torque[1] / inertia : 0.0, w2 = omega[1] * omega[1];
        const double a[3] = {-f[0] / m - shell * (alpha * n[2] - w2 * n[0]), -f[1] / m,
                             -f[2] / m + shell * (alpha * n[0] + w2 * n[2])};
        const double gn = a[0] * n[0] + a[1] * n[1] + a[2] * n[2];
        const double gt = std::sqrt(std::max(0.0, a[0] * a[0] + a[1] * a[1] + a[2] * a[2] - gn * gn));
        if (gt > 0.3 * std::fabs(2.0 * hold - gn)) (turns ? slides : without)[k] = 1;
      }
    }
  }
  EXPECT_EQ(deck.global(9), 1.0);
  const auto count = [](const std::vector<char> &v) { return static_cast<double>(std::count(v.begin(), v.end(), 1)); };
  const double expected = count(slides);
  EXPECT_EQ(deck.global(0), 0.0);
  EXPECT_GT(expected, 300.0);
  EXPECT_GT(std::fabs(expected - count(without)), 0.2 * expected);    // the test tests something
  EXPECT_NEAR(deck.global(10), expected, 0.01 * expected);
}

TEST(FixDustDetachImpacts, MotionThatIsNotFiniteStopsTheRunAndNamesTheCarrier)
{
  for (const char *law : {"impulse", "impulse damping 0.1", "estimate", "integrate damping 0.1"})
    for (const bool rests : {false, true})
      for (const double wrong : {double(NAN), double(INFINITY)}) {
        Deck deck;
        deck.box();
        deck.carrier(3.0e-3, 0.0, 5.0e-3, 0.0, 0.0, 0.0);
        deck.carrier(0.0, 0.0, rests ? R - 1.0e-9 : START, 0.0, 0.0, rests ? 0.0 : -8.0);
        deck.wall_and_motion();
        deck("fix dust all dust/detach " + REFERENCE_DUST + " tangential " + law + "\nrun 500 post no");
        const_cast<double *>(deck.atom("omega", 2))[0] = wrong;    // the wall's friction follows
        const std::string error = deck.attempt("run 100 pre no post no");
        EXPECT_NE(error.find("dust: force, torque or spin of carrier 2 is not finite at step 50"), std::string::npos)
            << error;
      }
}
