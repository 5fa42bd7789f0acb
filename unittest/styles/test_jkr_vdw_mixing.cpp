// Normal model jkr/vdw between pairs: mixed coefficients, the range of the attraction and the neighbour skin that it
// needs.

#include "deck.h"

#include "hamaker.h"
#include "jkr.h"

#include <algorithm>

namespace {

constexpr double RADIUS = 10e-6, Z0 = 0.4e-9;
const std::string REST = " damping viscoelastic tangential mindlin NULL 0.0 0.3";

// two grains of types 1 and 2 at a gap, that keep their velocities
std::string two_grains(Deck &deck, double gap, const std::string &coefficients, const std::string &skin = "1e-6",
                       double slide = 0.0)
{
  deck("units si\natom_style sphere\natom_modify map array\nboundary p p p\nnewton off\ncomm_modify vel yes\n"
       "region box block -1e-4 1e-4 -1e-4 1e-4 -1e-4 1e-4\ncreate_box 2 box\nneighbor " +
       skin + " bin\ntimestep 1e-9");
  deck(line("create_atoms 1 single 0 0 0\ncreate_atoms 2 single 0 0 %.17g\nset group all diameter %.17g density 2700\n"
            "group second type 2\nvelocity second set %.17g 0 0\nfix move all nve/noforce",
            2.0 * RADIUS + gap, 2.0 * RADIUS, slide));
  return deck.attempt("pair_style granular\n" + coefficients + "\nrun 0 post no");
}

std::string own(double young, double eta, double nu, double hamaker, double z0 = Z0)
{
  return line("jkr/vdw %.17g %.17g %.17g %.17g %.17g", young, eta, nu, hamaker, z0) + REST;
}

double shear_stiffness(double e1, double nu1, double e2, double nu2)    // 8 G*
{
  return 8.0 / (2.0 * (2.0 - nu1) * (1.0 + nu1) / e1 + 2.0 * (2.0 - nu2) * (1.0 + nu2) / e2);
}

}    // namespace

TEST(JkrVdwMixing, BothModuliOfTheTwoMaterials)
{
  for (const double nu : {0.3, 0.45, 0.1}) {
    const double e1 = 210e9, e2 = 5e9, nu1 = 0.3, a = std::sqrt(21.2e-20 * 10.1e-20);
    const double modulus = Dust::combined_modulus(e1, nu1, e2, nu), gamma = Dust::surface_energy(a, Z0),
                 r12 = RADIUS / 2.0;
    const double fc = Dust::pull_off_force(gamma, r12), a0 = Dust::equilibrium_contact_radius(gamma, r12, modulus);
    const double overlap = 2.0 * Dust::equilibrium_overlap(a0, r12), speed = 1e-3;
    const std::string coefficients =
        "pair_coeff 1 1 " + own(e1, 0.0, nu1, 21.2e-20) + "\npair_coeff 2 2 " + own(e2, 0.0, nu, 10.1e-20);
    Deck deck;
    ASSERT_EQ(two_grains(deck, -overlap, coefficients, "1e-6", speed), "");
    const double x = Dust::jkr_contact_radius(overlap / Dust::breaking_gap(a0, r12));
    EXPECT_NEAR(deck.atom("f", 2)[2], fc * Dust::jkr_force(x), 1e-5 * fc) << nu;
    deck("run 100 post no");
    const double expected = shear_stiffness(e1, nu1, e2, nu) * x * a0 * speed * 100e-9;
    EXPECT_NEAR(-deck.atom("f", 2)[0], expected, 1e-4 * expected) << nu;    // turns by 5e-6
  }
}

TEST(JkrVdwMixing, DampingIsTheGeometricMean)
{
  // between equal materials, so that only eta differs: eta m a v_n
  Deck mixed, given;
  const double v = 0.1;
  for (Deck *deck : {&mixed, &given}) {
    const std::string coefficients = deck == &mixed ? "pair_coeff 1 1 " + own(75e9, 4e13, 0.3, 1e-19) +
                                                          "\npair_coeff 2 2 " + own(75e9, 9e13, 0.3, 1e-19)
                                                    : "pair_coeff * * " + own(75e9, 6e13, 0.3, 1e-19);
    ASSERT_EQ(two_grains(*deck, -1e-9, coefficients), "");
    (*deck)(line("velocity second set 0 0 %.17g\nrun 0 post no", v));
  }
  EXPECT_NEAR(mixed.atom("f", 2)[2], given.atom("f", 2)[2], 1e-12 * std::fabs(given.atom("f", 2)[2]));
  const double before = given.atom("f", 2)[2];
  given("velocity second set 0 0 0\nrun 0 post no");
  EXPECT_GT(std::fabs(given.atom("f", 2)[2] - before), 0.1 * std::fabs(before));
}

TEST(JkrVdwMixing, UnlikeDistancesAreRefused)
{
  Deck least, end, both;
  const std::string z0 = two_grains(least, 1e-9,
                                    "pair_coeff 1 1 " + own(75e9, 0, 0.3, 1e-19, 0.4e-9) + "\npair_coeff 2 2 " +
                                        own(75e9, 0, 0.3, 1e-19, 0.3e-9));
  EXPECT_NE(z0.find("z0 4e-10 and 3e-10"), std::string::npos) << z0;
  const std::string cut = two_grains(end, 1e-9,
                                     "pair_coeff 1 1 jkr/vdw/cut 75e9 0 0.3 1e-19 4e-10 4e-9" + REST +
                                         "\npair_coeff 2 2 jkr/vdw/cut 75e9 0 0.3 1e-19 4e-10 6e-9" + REST);
  EXPECT_NE(cut.find("z_cut 4e-09 and 6e-09"), std::string::npos) << cut;
  EXPECT_EQ(two_grains(both, 1e-9,
                       "pair_coeff 1 1 jkr/vdw/cut 75e9 0 0.3 1e-19 4e-10 4e-9" + REST +
                           "\npair_coeff 2 2 jkr/vdw/cut 75e9 0 0.3 2e-19 4e-10 4e-9" + REST),
            "");
}

TEST(JkrVdwMixing, RangeInPairs)
{
  const auto force = [](double gap, const std::string &model) {
    Deck deck;
    EXPECT_EQ(two_grains(deck, gap,
                         "pair_coeff * * " + model + " 75e9 0 0.3 1e-19 4e-10" + (model == "jkr/vdw" ? "" : " 20e-9") +
                             REST),
              "");
    return deck.atom("f", 1)[2];
  };
  const auto attraction = [](double gap) { return Dust::hamaker_force(1e-19, Z0, RADIUS / 2.0, gap); };
  EXPECT_NEAR(force(3.5e-9, "jkr/vdw"), attraction(3.5e-9), 1e-6 * attraction(3.5e-9));
  EXPECT_EQ(force(3.7e-9, "jkr/vdw"), 0.0);
  EXPECT_NEAR(force(19.5e-9, "jkr/vdw/cut"), attraction(19.5e-9), 1e-6 * attraction(19.5e-9));
  EXPECT_EQ(force(19.7e-9, "jkr/vdw/cut"), 0.0);
}

TEST(JkrVdwMixing, SkinBelowTheRange)
{
  // 4Jul2026 adds the range to the lists; 4Feb2025 does not, and a skin that is too small is refused
  Deck deck;
  const std::string message = two_grains(deck, 3.5e-9, "pair_coeff * * " + own(75e9, 0, 0.3, 1e-19), "3e-9");
  if (LAMMPS_VERSION_NUMBER < 20260000)
    EXPECT_NE(message.find("skin of at least"), std::string::npos) << message;
  else {
    EXPECT_EQ(message, "");
    EXPECT_GT(deck.atom("f", 1)[2], 0.0);
  }
  Deck enough;
  EXPECT_EQ(two_grains(enough, 3.5e-9, "pair_coeff * * " + own(75e9, 0, 0.3, 1e-19), "3.7e-9"), "");
  EXPECT_GT(enough.atom("f", 1)[2], 0.0);
}

TEST(JkrVdwMixing, DampingThatActsWithoutANeckIsRefused)
{
  for (const char *damping : {"velocity", "mass_velocity"}) {
    Deck deck;
    deck.box();
    const std::string error =
        deck.attempt("pair_coeff 1 1 jkr/vdw 75e9 0 0.3 10.1e-20 0.4e-9 tangential mindlin NULL 0.0 0.3 damping " +
                     std::string(damping) + "\npair_coeff 1 2 " + contact(0.7) + "\nrun 0 post no");
    EXPECT_NE(error.find("cannot use damping " + std::string(damping)), std::string::npos) << error;
  }
}

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const int result = RUN_ALL_TESTS();
  lammps_mpi_finalize();
  return result;
}
