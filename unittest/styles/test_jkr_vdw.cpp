// Normal model jkr/vdw in LAMMPS: force over approach, contact and pull-off; energy lost in a bounce.

#include "deck.h"

#include "hamaker.h"
#include "jkr.h"

#include <algorithm>
#include <fstream>
#include <utility>

namespace {

const double HAMAKER = std::sqrt(10.1e-20 * 21.2e-20);

// a grain on a wall: what the model must know of it, from the core's equations
struct Grain {
  double radius, z0, modulus, gamma, fc, a0, delta_c, delta_0, mass;
  Grain(double _radius, double _z0, double young = 1.1053e11) : radius(_radius), z0(_z0)
  {
    modulus = Dust::combined_modulus(young, 0.3, young, 0.3);
    gamma = Dust::surface_energy(HAMAKER, z0);
    fc = Dust::pull_off_force(gamma, radius);
    a0 = Dust::equilibrium_contact_radius(gamma, radius, modulus);
    delta_c = Dust::breaking_gap(a0, radius);
    delta_0 = Dust::equilibrium_overlap(a0, radius);
    mass = 4.0 / 3.0 * M_PI * radius * radius * radius * 2700.0;
  }
  double attraction(double gap) const { return gap < 9.0 * z0 ? Dust::hamaker_force(HAMAKER, z0, radius, gap) : 0.0; }
  double branch(double overlap) const { return fc * Dust::jkr_force(Dust::jkr_contact_radius(overlap / delta_c)); }
};

std::string model(const Grain &g, const std::string &rolling = "", double eta = 0.0)
{
  return line("jkr/vdw 1.1053e11 %.17g 0.3 %.17g %.17g damping viscoelastic tangential mindlin NULL 0.0 0.3 ", eta,
              HAMAKER, g.z0) +
         rolling;
}

// a grain above a wall at z = 0, its centre at radius + gap
void grain_on_wall(Deck &deck, const Grain &g, double gap, const std::string &wall, double timestep, double vz)
{
  deck("units si\natom_style sphere\nboundary p p f\nnewton off\ncomm_modify vel yes\n"
       "region box block -1e-4 1e-4 -1e-4 1e-4 -1e-4 1e-4\ncreate_box 1 box\nneighbor 1e-5 bin\npair_style granular");
  deck("pair_coeff * * " + model(g));
  deck(line("create_atoms 1 single 0 0 %.17g\nset atom 1 diameter %.17g density 2700\nvelocity all set 0 0 "
            "%.17g\ntimestep %.17g",
            g.radius + gap, 2.0 * g.radius, vz, timestep));
  deck(wall);
}

std::string plane_wall(const std::string &model)
{
  return "fix wall all wall/gran granular " + model + " zplane 0.0 NULL";
}

std::string region_wall(const std::string &model)
{
  return "region above block INF INF INF INF 0.0 INF\nfix wall all wall/gran/region granular " + model +
         " region above";
}

// force of the wall on a grain that is moved down to an overlap and up again at constant speed; by gap
std::vector<std::pair<double, double>> pull(const Grain &g, const std::string &wall)
{
  Deck deck;
  const double step = 0.002e-9, from = 5e-9;
  grain_on_wall(deck, g, from, wall, 1e-9, -step / 1e-9);
  deck("fix move all nve/noforce\nrun 0 post no");
  std::vector<std::pair<double, double>> curve;
  const auto record = [&](double down_to_or_up) {
    while (true) {
      deck("run 1 pre no post no");
      const double gap = deck.atom("x", 1)[2] - g.radius;
      curve.push_back({gap, deck.atom("f", 1)[2]});
      if (down_to_or_up < 0.0 ? gap <= down_to_or_up : gap >= down_to_or_up) break;
    }
  };
  record(-2.0 * g.delta_0);
  deck(line("velocity all set 0 0 %.17g\nrun 0 post no", step / 1e-9));
  record(from);
  return curve;
}

}    // namespace

TEST(JkrVdw, ForceOnApproachInContactAndOnPullOff)
{
  const Grain g(10e-6, 0.4e-9);
  for (const std::string &wall : {plane_wall(model(g)), region_wall(model(g))}) {
    const auto curve = pull(g, wall);
    const size_t turn = std::min_element(curve.begin(), curve.end()) - curve.begin();
    bool broken = false;
    double most = 0.0;
    for (size_t k = 0; k < curve.size(); k++) {
      const auto [gap, force] = curve[k];
      const bool neck = k <= turn ? gap <= 0.0 : -gap > -g.delta_c;
      if (std::fabs(gap - (k <= turn ? 0.0 : g.delta_c)) < 1e-15)
        continue;    // within round-off of the step where it forms or breaks
      const double expected = neck ? g.branch(-gap) : -g.attraction(std::max(gap, 0.0));
      ASSERT_NEAR(force, expected, 1e-5 * g.fc) << "gap " << gap;    // round-off of the position, 1e-6 of delta_c
      broken |= k > turn && !neck;
      most = std::min(most, force);
    }
    EXPECT_TRUE(broken);
    EXPECT_NEAR(most, -g.fc, 1e-3 * g.fc);
  }
}

TEST(JkrVdw, BounceLosesTheWorkOfThePhysicsPage)
{
  // F_c (0.9355 delta_c - z0 delta_c/(z0 + delta_c)); below the sticking speed the grain stays
  for (double radius : {5e-6, 10e-6, 20e-6})
    for (double z0 : {0.3e-9, 0.4e-9}) {
      const Grain g(radius, z0);
      const double loss = g.fc * (0.9355 * g.delta_c - z0 * g.delta_c / (z0 + g.delta_c));
      ASSERT_GT(loss, 0.0);
      const double sticking = std::sqrt(2.0 * loss / g.mass);
      const double k0 = 1.2 * g.modulus * g.a0, period = 2.0 * M_PI * std::sqrt(g.mass / k0);
      for (double factor : {0.8, 1.2, 3.0}) {
        Deck deck;
        const double speed = factor * sticking, from = 9.5 * z0;
        grain_on_wall(deck, g, from, plane_wall(model(g)), period / 5000.0, -speed);
        deck("fix move all nve/sphere\nrun 0 post no");
        bool left = false;
        for (int k = 0; k < 1000 && !left; k++) {
          deck("run 100 pre no post no");
          left = deck.atom("x", 1)[2] > g.radius + from;
        }
        ASSERT_EQ(left, factor > 1.0) << radius << " " << z0 << " " << factor;
        // 1 % in speed; where the rest is small against the loss that means its square
        if (left) {
          EXPECT_NEAR(deck.atom("v", 1)[2], sticking * std::sqrt(factor * factor - 1.0), 0.01 * speed);
        }
      }
    }
}

TEST(JkrVdw, StickingSpeedOfTheReferenceGrainOnItsCarrier)
{
  Grain g(9.8684e-6, 0.4e-9);
  g.mass = 4.0 / 3.0 * M_PI * 1e-15 * 2700.0;
  const double loss = g.fc * (0.9355 * g.delta_c - g.z0 * g.delta_c / (g.z0 + g.delta_c));
  EXPECT_NEAR(std::sqrt(2.0 * loss / g.mass), 4.23e-3, 0.005e-3);
}

TEST(JkrVdw, EnergyIsConservedWhereNothingDissipates)
{
  // oscillation about the equilibrium overlap; the energy is the kinetic one at the equilibrium, passed each period
  const Grain g(10e-6, 0.4e-9);
  Deck deck;
  const double k0 = 1.2 * g.modulus * g.a0, period = 2.0 * M_PI * std::sqrt(g.mass / k0), speed = 0.5e-3;
  grain_on_wall(deck, g, -g.delta_0, plane_wall(model(g)), period / 200.0, speed);
  deck("fix move all nve/sphere\nrun 0 post no");
  double first = 0.0, last = 0.0;
  for (int k = 0; k < 200; k++) {
    double fastest = 0.0;
    for (int i = 0; i < 200; i++) {    // one period in single steps, then four at once
      deck("run 1 pre no post no");
      fastest = std::max(fastest, std::fabs(deck.atom("v", 1)[2]));
    }
    deck("run 800 pre no post no");
    if (k == 0) first = fastest;
    last = fastest;
  }
  EXPECT_NEAR(first, speed, 1e-3 * speed);
  EXPECT_NEAR(last * last, first * first, 1e-4 * first * first);
}

TEST(JkrVdw, DampingRatioAtTheEquilibrium)
{
  // eta = 2 zeta sqrt(k0/m)/a0 with stock viscoelastic: free oscillation decays by exp(-2 pi zeta/sqrt(1 - zeta^2)) a
  // period
  const Grain g(10e-6, 0.4e-9);
  const double zeta = 0.1, k0 = 1.2 * g.modulus * g.a0, omega = std::sqrt(k0 / g.mass);
  EXPECT_NEAR(k0 / g.mass, 1.2 * g.modulus * g.a0 / g.mass, 1.0);
  Deck deck;
  const double damped = omega * std::sqrt(1.0 - zeta * zeta), dt = 2.0 * M_PI / damped / 1000.0, speed = 1e-5;
  grain_on_wall(deck, g, -g.delta_0, plane_wall(model(g, "", 2.0 * zeta * omega / g.a0)), dt, speed);
  deck("fix move all nve/sphere\nrun 1000 post no");
  EXPECT_NEAR(deck.atom("v", 1)[2], speed * std::exp(-2.0 * M_PI * zeta / std::sqrt(1.0 - zeta * zeta)), 0.01 * speed);
}

TEST(JkrVdw, LeavesACurvedWallWhereThePullOffForceHoldsItNoLonger)
{
  // glides round a sphere that is a wall: m w^2/(R + r) > F_c, whatever the time step
  const double radius = 10e-6, carrier = 0.75e-3;
  Grain g(radius * carrier / (radius + carrier), 0.4e-9);    // the contact's effective radius
  g.mass = 4.0 / 3.0 * M_PI * radius * radius * radius * 2700.0;
  const double held = std::sqrt(g.fc * (carrier + radius) / g.mass), k0 = 1.2 * g.modulus * g.a0;
  for (double dt : {2e-9, 1e-9})
    for (double factor : {0.9995, 1.0005}) {
      Deck deck;
      deck("units si\natom_style sphere\nboundary f f f\nnewton off\ncomm_modify vel yes\n"
           "region box block -2e-3 2e-3 -2e-3 2e-3 -2e-3 2e-3\ncreate_box 1 box\nneighbor 1e-4 bin\npair_style "
           "granular");
      const std::string words = line("jkr/vdw 1.1053e11 %.17g 0.3 %.17g 4e-10 damping viscoelastic "
                                     "tangential mindlin NULL 0.0 0.0",
                                     2.0 * std::sqrt(k0 / g.mass) / g.a0, HAMAKER);
      deck("pair_coeff * * " + words);
      deck(line("create_atoms 1 single 0 0 %.17g\nset atom 1 diameter %.17g density 2700\nvelocity all set %.17g 0 0\n"
                "timestep %g\nregion carrier sphere 0 0 0 %.17g side out",
                carrier + radius - g.delta_0, 2.0 * radius, factor * held, dt, carrier));
      deck("fix wall all wall/gran/region granular " + words + " region carrier\nfix move all nve/sphere\n" +
           line("run %g post no", std::round(40e-6 / dt)));
      const double *x = deck.atom("x", 1);
      const double gap = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) - carrier - radius;
      EXPECT_EQ(gap > g.delta_c, factor > 1.0) << dt << " " << factor;
    }
}

TEST(JkrVdw, SetupAndRestartRepeatTheDampingOfTheLastStep)
{
  const Grain g(10e-6, 0.4e-9);
  const double omega = std::sqrt(1.2 * g.modulus * g.a0 / g.mass);
  const std::string wall = plane_wall(model(g, "", 2.0 * omega / g.a0));
  const auto force = [&](Deck &deck) { return deck.atom("f", 1)[2]; };
  Deck whole, split, restarted;
  for (Deck *deck : {&whole, &split}) {
    grain_on_wall(*deck, g, -g.delta_0, wall, 1e-9, 5e-3);
    (*deck)("fix move all nve/sphere\nrun 37 post no");
  }
  const double last = force(whole), gap = whole.atom("x", 1)[2] - g.radius;
  EXPECT_GT(std::fabs(last - g.branch(-gap)), 0.05 * g.fc);
  split("run 0 post no");
  EXPECT_NEAR(force(split), last, 1e-6 * g.fc);    // round-off of the position
  split("write_restart rate.restart");
  restarted("read_restart rate.restart\nneighbor 1e-5 bin\ncomm_modify vel yes\npair_style granular\npair_coeff * * " +
            model(g) + "\ntimestep 1e-9\n" + wall + "\nfix move all nve/sphere\nrun 0 post no");
  EXPECT_NEAR(force(restarted), last, 1e-6 * g.fc);
  for (Deck *deck : {&whole, &split, &restarted}) {
    (*deck)("run 20 post no");
    EXPECT_NEAR(deck->atom("x", 1)[2], whole.atom("x", 1)[2], 1e-6 * g.delta_0);
  }
  std::remove("rate.restart");
}

TEST(JkrVdw, MovedWithoutVelocityItIsDampedByItsOverlap)
{
  // held against a wall that swings: the overlap's rate is known, the damping force eta m a times it
  const Grain g(10e-6, 0.4e-9);
  const double amplitude = 0.02e-9, period = 0.5e-6, eta = 1e14;
  Deck deck;
  grain_on_wall(deck, g, -g.delta_0, "", 1e-9, 0.0);
  deck(plane_wall(model(g, "", eta)) + line(" wiggle z %.17g %.17g", amplitude, period) + "\nrun 0 post no");
  for (int k = 1; k <= 700; k++) {
    deck("run 1 pre no post no");
    const double phase = 2.0 * M_PI / period * 1e-9 * k;
    const double overlap = g.delta_0 + amplitude * (1.0 - std::cos(phase)),
                 rate = 2.0 * M_PI / period * amplitude * std::sin(phase);
    const double a = g.a0 * Dust::jkr_contact_radius(overlap / g.delta_c),
                 scale = eta * g.mass * g.a0 * amplitude / period;
    if (k > 3) {
      ASSERT_NEAR(deck.atom("f", 1)[2], g.branch(overlap) + eta * g.mass * a * rate, 1e-2 * scale) << k;
    }
  }
}

TEST(JkrVdw, RollingResistance)
{
  // a grain that turns without moving: xi = R omega t, moment 4 F_c xi at the equilibrium overlap up to R theta_crit
  const Grain g(10e-6, 0.4e-9);
  const double theta_crit = 0.15, spin = 1e5;
  for (const std::string &wall :
       {plane_wall(model(g, "rolling dominik/tielens 0.15")), region_wall(model(g, "rolling dominik/tielens 0.15"))}) {
    Deck deck;
    grain_on_wall(deck, g, -g.delta_0, wall, 1e-9, 0.0);
    deck(line("set atom 1 omega 0 %.17g 0\nfix move all nve/noforce\nrun 0 post no", spin));
    const double friction_torque_max = 0.3 * 2.0 * g.fc * g.radius;
    double rolling = 0.0;
    for (int k = 1; k <= 3000; k++) {
      deck("run 1 pre no post no");
      const double xi = std::min(g.radius * spin * k * 1e-9, g.radius * theta_crit);
      // what is left of the torque is friction, the force times the radius
      rolling = deck.atom("torque", 1)[1] + deck.atom("f", 1)[0] * g.radius;
      ASSERT_NEAR(rolling, -4.0 * g.fc * xi, 1e-5 * g.fc * g.radius) << k;
      ASSERT_LE(std::fabs(deck.atom("f", 1)[0]) * g.radius, friction_torque_max * 1.001);
      ASSERT_NEAR(deck.atom("torque", 1)[0], 0.0, 1e-9 * friction_torque_max);
    }
    EXPECT_NEAR(rolling, -4.0 * g.fc * g.radius * theta_crit, 1e-5 * g.fc * g.radius);
  }
}

TEST(JkrVdw, SlidingLimit)
{
  // dragged along at the equilibrium overlap (no load), pushed and pulled: friction ends at mu |F + 2 F_c|
  const Grain g(10e-6, 0.4e-9);
  for (double overlap : {g.delta_0, 3.0 * g.delta_0, -0.4 * g.delta_c}) {
    Deck deck;
    grain_on_wall(deck, g, -std::max(overlap, g.delta_0), plane_wall(model(g)), 1e-9, 0.0);
    deck("fix move all nve/noforce\nrun 1 post no");    // a neck forms
    deck(line("set atom 1 z %.17g\nvelocity all set 0.1 0 0\nrun 3000 post no", g.radius - overlap));
    const double normal = deck.atom("f", 1)[2];
    EXPECT_NEAR(normal, g.branch(overlap), 1e-4 * g.fc);
    EXPECT_NEAR(-deck.atom("f", 1)[0], 0.3 * std::fabs(normal + 2.0 * g.fc), 1e-3 * g.fc);
  }
}

TEST(JkrVdw, NoFrictionRollingOrDampingWithoutANeck)
{
  const Grain g(10e-6, 0.4e-9);
  Deck deck;
  grain_on_wall(deck, g, 0.5e-9, plane_wall(model(g, "rolling dominik/tielens 0.15", 1e13)), 1e-9, 0.0);
  deck("set atom 1 omega 1e4 2e4 3e4\nvelocity all set 0.1 0.2 0.0\nfix move all nve/noforce\nrun 1000 post no");
  EXPECT_EQ(deck.atom("f", 1)[0], 0.0);
  EXPECT_EQ(deck.atom("f", 1)[1], 0.0);
  EXPECT_NEAR(deck.atom("f", 1)[2], -g.attraction(0.5e-9), 1e-5 * g.fc);
  for (int d = 0; d < 3; d++) EXPECT_EQ(deck.atom("torque", 1)[d], 0.0);
  // and what it did meanwhile is forgotten when the neck forms
  deck(line("set atom 1 z %.17g omega 0 0 0\nvelocity all set 0 0 0\nrun 10 post no", g.radius - g.delta_0));
  EXPECT_EQ(deck.atom("f", 1)[0], 0.0);
  for (int d = 0; d < 3; d++) EXPECT_EQ(deck.atom("torque", 1)[d], 0.0);
}

TEST(JkrVdw, EndOfTheAttractionIsACoefficient)
{
  const Grain g(10e-6, 0.4e-9);
  const auto force = [&](double gap, const std::string &words) {
    Deck deck;
    grain_on_wall(deck, g, gap, plane_wall(words), 1e-9, 0.0);
    deck("fix move all nve/noforce\nrun 0 post no");
    return deck.atom("f", 1)[2];
  };
  const std::string coefficients = line("1.1053e11 0 0.3 %.17g 4e-10", HAMAKER),
                    rest = " damping viscoelastic tangential mindlin NULL 0.0 0.3";
  const auto with = [&](const char *end) { return "jkr/vdw/cut " + coefficients + " " + end + rest; };
  for (double gap : {-1e-9, -0.2e-9, 0.1e-9, 3.5e-9, 3.599e-9, 3.601e-9})
    EXPECT_EQ(force(gap, with("4e-9")), force(gap, "jkr/vdw " + coefficients + rest)) << gap;
  EXPECT_EQ(force(3.601e-9, with("4e-9")), 0.0);
  EXPECT_EQ(force(0.7e-9, with("1e-9")), 0.0);
  const double expected = Dust::hamaker_force(HAMAKER, g.z0, g.radius, 19e-9);
  EXPECT_NEAR(-force(19e-9, with("20e-9")), expected, 1e-5 * expected);
  EXPECT_EQ(force(19.7e-9, with("20e-9")), 0.0);
  EXPECT_LT(force(-g.delta_0, with("4e-9 rolling dominik/tielens 0.15")), 1e-3 * g.fc);    // accepted
}

TEST(JkrVdw, WarnsOnceWhereABounceWouldGainEnergy)
{
  // delta_c/z0 is 0.069 at R = 17.9 nm for these; it grows as the cube root of R
  const auto warnings = [](double ratio) {
    const Grain one(1e-6, 0.4e-9), g(1e-6 * std::pow(ratio * one.z0 / one.delta_c, 3.0), 0.4e-9);
    EXPECT_NEAR(g.delta_c / g.z0, ratio, 1e-6);
    Deck deck;
    deck("log dust_warnings.txt");
    grain_on_wall(deck, g, 1e-9, plane_wall(model(g)), 1e-9, 0.0);
    deck("fix move all nve/noforce\nrun 3 post no\nrun 3 post no\nlog none");
    std::ifstream file("dust_warnings.txt");
    int found = 0;
    for (std::string text; std::getline(file, text);)
      found += text.find("WARNING") != std::string::npos && text.find("gains energy") != std::string::npos;
    std::remove("dust_warnings.txt");
    return found;
  };
  EXPECT_EQ(warnings(0.0685), 1);
  EXPECT_EQ(warnings(0.0695), 0);
}

TEST(JkrVdw, WrongInputIsNamed)
{
  const Grain g(10e-6, 0.4e-9);
  const auto error = [&](const std::string &words) {
    Deck deck;
    grain_on_wall(deck, g, 1e-6, "", 1e-9, 0.0);
    return deck.attempt(plane_wall(words));
  };
  const std::string rest = " damping viscoelastic tangential mindlin NULL 0.0 0.3";
  EXPECT_EQ(error("jkr/vdw 1e11 0 0.3 1e-19 4e-10" + rest), "");
  EXPECT_NE(error("jkr/vdw 0 0 0.3 1e-19 4e-10" + rest).find("E 0"), std::string::npos);
  EXPECT_NE(error("jkr/vdw 1e11 -1 0.3 1e-19 4e-10" + rest).find("eta"), std::string::npos);
  EXPECT_NE(error("jkr/vdw 1e11 0 0.7 1e-19 4e-10" + rest).find("nu"), std::string::npos);
  EXPECT_NE(error("jkr/vdw 1e11 0 0.3 0 4e-10" + rest).find("A 0"), std::string::npos);
  EXPECT_NE(error("jkr/vdw 1e11 0 0.3 1e-19 0" + rest).find("z0 0"), std::string::npos);
  EXPECT_NE(error("jkr/vdw/cut 1e11 0 0.3 1e-19 4e-10 4e-10" + rest).find("z_cut 4e-10"), std::string::npos);
  EXPECT_NE(error("jkr/vdw 1e11 0 0.3 1e-19 4e-10 rolling dominik/tielens 0" + rest).find("theta_crit"),
            std::string::npos);
  EXPECT_NE(error("hertz/material 1e11 0.5 0.3 rolling dominik/tielens 0.15" + rest).find("jkr/vdw"),
            std::string::npos);
  EXPECT_NE(error("jkr/vdw 1e11 0.5 0.3 1e-19 4e-10 damping coeff_restitution/limited tangential mindlin NULL 0.0 0.3"),
            "");
}

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const int result = RUN_ALL_TESTS();
  lammps_mpi_finalize();
  return result;
}
