// The words of fix dust/detach: each wrong one ends in one line that names the keyword, the value and what is allowed.

#include "deck.h"

#include <cstdio>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace {

constexpr double START = 0.7501e-3;    // height of a carrier just above the wall

std::string error(const std::string &words, bool carrier = true)
{
  Deck deck;
  deck.box();
  if (carrier) deck.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
  deck.wall_and_motion();
  const std::string at_once = deck.attempt("fix dust all dust/detach " + words);
  return at_once.empty() ? deck.attempt("run 0") : at_once;
}

// keywords with values that are right
const std::vector<std::pair<std::string, std::string>> KEYWORDS = {
    {"texture", "monolayer 20e-6"},
    {"coverage", "0.2"},
    {"seed", "1"},
    {"bare", "0.3 0 0 -1"},
    {"distribution", "lognormal 20e-6 1.1"},
    {"density", "2700"},
    {"hamaker", "1.4e-19 0.4e-9"},
    {"elastic", "75e9 0.3 210e9 0.3"},
    {"orientation", "random 7"},
    {"write", "dust_words.txt"},
    {"friction", "0.3"},
    {"rolling", "0.15"},
    {"damping", "1"},
    {"tangential", "integrate"},
    {"meet", "yes"},
    {"cohesion", "0.7"},
    {"meet_softening", "100"},
    {"meet_step", "1e-8"},
    {"criteria", "liftoff"},
    {"counts", "yes"},
    {"every", "10"},
    {"rows", "yes"},
    {"rotation", "yes"},
    {"stiffen", "1"},
    {"inertia", "contact"},
    {"mass", "no"},
    {"emit", "none"},
};

// all of them, but the one at a place
std::string all_but(size_t place)
{
  std::string words;
  for (size_t k = 0; k < KEYWORDS.size(); k++)
    if (k != place) words += KEYWORDS[k].first + " " + KEYWORDS[k].second + " ";
  return words;
}

}    // namespace

// as written to a texture file
TEST(FixDustDetachWords, BareCapByDefaultFromTheGeometry)
{
  const auto half_angle = [](const std::string &words) {
    EXPECT_EQ(error("coverage 0.05 seed 1 write dust_words.txt " + words), "");
    std::ifstream file("dust_words.txt");
    std::string word;
    double angle = -1.0;
    while (file >> word)
      if (word == "bare" && file >> angle) break;
    std::remove("dust_words.txt");
    return angle;
  };
  EXPECT_EQ(half_angle("texture monolayer 20e-6"), 0.33);
  EXPECT_EQ(half_angle("texture monolayer 40e-6"), 0.40);
  EXPECT_EQ(half_angle("texture monolayer 40e-6 bare 0.33"), 0.33);
  EXPECT_EQ(half_angle("texture monolayer 40e-6 orientation random 3"), 0.0);
  EXPECT_EQ(half_angle("texture monolayer 20e-6 distribution lognormal 15e-6 1.5"), 0.39);    // up to 38.5 um
}

TEST(FixDustDetachWords, AllAtOnceInAnyOrder)
{
  EXPECT_EQ(error(all_but(KEYWORDS.size())), "");
  std::string backwards;
  for (const auto &[keyword, values] : KEYWORDS) backwards = keyword + " " + values + " " + backwards;
  EXPECT_EQ(error(backwards), "");
  std::remove("dust_words.txt");
}

TEST(FixDustDetachWords, GivenTwice)
{
  for (size_t k = 0; k < KEYWORDS.size(); k++) {
    const auto &[keyword, values] = KEYWORDS[k];
    const std::string twice = keyword + " " + values + " ";
    const std::string message = error(twice + twice + all_but(k));
    EXPECT_NE(message.find("dust/detach " + keyword + " is given twice"), std::string::npos) << message;
  }
  EXPECT_NE(error(all_but(KEYWORDS.size()) + "surface 0.016").find("surface"), std::string::npos);
}

TEST(FixDustDetachWords, MissingValues)
{
  for (size_t k = 0; k < KEYWORDS.size(); k++) {
    const auto &[keyword, values] = KEYWORDS[k];
    // each of the values in turn is the first that is not there
    for (size_t end = 0; end != std::string::npos; end = values.find(' ', end + 1)) {
      const std::string given = values.substr(0, end);
      if (keyword == "bare" && given == "0.3") continue;    // its axis may be left out
      const std::string message = error(all_but(k) + keyword + " " + given);
      EXPECT_NE(message.find("dust/detach " + keyword + " "), std::string::npos) << message;
      EXPECT_NE(message.find("value is missing: it must be "), std::string::npos) << message;
    }
  }
}

TEST(FixDustDetachWords, UnknownKeywordsGetTheListOfAll)
{
  std::string message = error("colour red " + all_but(KEYWORDS.size()));
  message.resize(message.find('\n'));    // LAMMPS repeats the command below
  EXPECT_NE(message.find("no keyword colour"), std::string::npos) << message;
  for (const auto &[keyword, values] : KEYWORDS)
    EXPECT_NE(message.find(" " + keyword), std::string::npos) << keyword << " -> " << message;
}

// in SI; other units have the same limits converted, units lj have none
TEST(FixDustDetachWords, SlipsOfUnitsAreRefused)
{
  const auto names = [](const std::string &words, const std::string &range) {
    const std::string message = error(REFERENCE_DUST + " " + words);
    EXPECT_NE(message.find(range), std::string::npos) << words << " -> " << message;
  };
  const auto fits = [](const std::string &words) { EXPECT_EQ(error(REFERENCE_DUST + " " + words), "") << words; };
  const std::string density = "density value ", densities = " must be from 10 to 30000 with units si";
  names("density 2.7", density + "2.7" + densities);
  names("density 9.99", density + "9.99" + densities);
  names("density 30001", density + "30001" + densities);
  fits("density 10");
  fits("density 30000");
  names("hamaker 0.9e-22 0.4e-9", "hamaker A value 0.9e-22 must be from 1e-22 to 1e-17 with units si");
  names("hamaker 1.1e-17 0.4e-9", "hamaker A value 1.1e-17 must be from 1e-22 to 1e-17 with units si");
  names("hamaker 1e-19 0.4", "hamaker z0 value 0.4 must be from 1e-11 to 1e-07 with units si");
  names("hamaker 1e-19 0.9e-11", "hamaker z0 value 0.9e-11 must be from 1e-11 to 1e-07 with units si");
  names("hamaker 1e-17 1e-10", "hamaker A and z0 give the surface energy 17.6839: it must be above 0 and at most 10");
  names("surface 16", "surface value 16 must be above 0 and at most 10 with units si");
  fits("surface 10");
  for (const char *side : {"E", "E_carrier"}) {
    const bool carrier = std::string(side) == "E_carrier";
    for (const char *value : {"75", "0.99e6", "1.1e13"})
      names(std::string("elastic ") + (carrier ? "75e9 0.3 " : "") + value + " 0.3" + (carrier ? "" : " 210e9 0.3"),
            std::string("elastic ") + side + " value " + value + " must be from 1e+06 to 1e+13 with units si");
  }
  fits("elastic 1e6 0.3 1e13 0.3");
  names("rolling 8.6", "rolling value 8.6 must be from 0 to 3.15");    // degrees
  // F_c/m_d = 3 pi gamma R_12 / (4/3 pi R_d^3 rho_d) of 20 um grains falls with gamma: 9.81 m/s2 at 1.192896e-6 J/m2
  const double gamma = 9.81 * 4.0 / 9.0 * 1e-15 * 2700.0 / (0.75e-3 * 10e-6 / 0.76e-3);
  fits(line("surface %.17g", 1.0001 * gamma));
  names(line("surface %.17g", 0.9999 * gamma), "it must be at least that of gravity, 9.81 with units si");
  // with a distribution the coarsest grain decides
  names(line("distribution lognormal 20e-6 1.5 surface %.17g", 1.0001 * gamma), "at least that of gravity");
}

TEST(FixDustDetachWords, SlipsOfUnitsInOtherUnits)
{
  struct Units {
    const char *style;
    double length, mass, time;
  };
  for (const Units &u :
       {Units{"cgs", 1e2, 1e3, 1.0}, {"micro", 1e6, 1e15, 1e6}, {"nano", 1e9, 1e21, 1e9}, {"lj", 1, 1, 1}}) {
    const bool lj = std::string(u.style) == "lj";
    const double L = u.length, density = u.mass / (L * L * L), pressure = u.mass / (L * u.time * u.time),
                 surface = u.mass / (u.time * u.time);
    const auto message = [&](double rho, double E, double gamma, double A, double z0) {
      Deck deck;
      deck(std::string("units ") + u.style + "\natom_style sphere\natom_modify map array\n" +
           line("region box block %.17g %.17g %.17g %.17g 0 1", -L, L, -L, L) + "\ncreate_box 1 box\n" +
           line("create_atoms 1 single 0 0 0\nset atom 1 diameter %.17g density %.17g\n", 1.5e-3 * L, 7700 * density));
      const std::string adhesion = A > 0.0 ? line("hamaker %.17g %.17g", A * pressure * L * L * L, z0 * L)
                                           : line("surface %.17g", gamma * surface);
      return deck.attempt(line("fix dust all dust/detach texture monolayer %.17g coverage 0.2 seed 1 density %.17g "
                               "friction 0.3 elastic %.17g 0.3 %.17g 0.3 ",
                               20e-6 * L, rho * density, E * pressure, 210e9 * pressure) +
                          adhesion);
    };
    EXPECT_EQ(message(2700, 75e9, 0.016, 0, 0), "") << u.style;
    EXPECT_EQ(message(10.001, 1.001e6, 9.99, 0, 0), "") << u.style;
    EXPECT_EQ(message(29999, 0.999e13, 0, 1.001e-22, 1.001e-11), "") << u.style;
    EXPECT_EQ(message(2700, 75e9, 0, 0.999e-17, 0.999e-7), "") << u.style;
    const auto refused = [&](const std::string &text, const char *word) {
      if (lj)
        EXPECT_EQ(text, "") << word;
      else
        EXPECT_NE(text.find(word), std::string::npos) << u.style << ": " << text;
      EXPECT_EQ(text.find(std::string("with units ") + u.style) == std::string::npos, lj) << text;
    };
    refused(message(9.99, 75e9, 0.016, 0, 0), "density value");
    refused(message(30001, 75e9, 0.016, 0, 0), "density value");
    refused(message(2700, 0.999e6, 0.016, 0, 0), "elastic E value");
    refused(message(2700, 1.001e13, 0.016, 0, 0), "elastic E value");
    refused(message(2700, 75e9, 10.01, 0, 0), "surface value");
    refused(message(2700, 75e9, 0, 0.999e-22, 0.4e-9), "hamaker A value");
    refused(message(2700, 75e9, 0, 1.001e-17, 0.4e-9), "hamaker A value");
    refused(message(2700, 75e9, 0, 1e-20, 0.999e-11), "hamaker z0 value");
    refused(message(2700, 75e9, 0, 1e-19, 1.001e-7), "hamaker z0 value");
    refused(message(2700, 75e9, 1e-6, 0, 0), "gravity");
  }
}

TEST(FixDustDetachWords, GrainsAreFinerThanTheirCarrier)
{
  EXPECT_EQ(error("texture monolayer 0.749e-3 coverage 0.2 seed 1"), "");
  const std::string message = error("texture monolayer 0.751e-3 coverage 0.2 seed 1");
  EXPECT_NE(message.find("grain diameter 0.000751 is not below the carrier's radius, 0.00075"), std::string::npos)
      << message;
}

TEST(FixDustDetachWords, DampingIsRefusedWhereNoLawKnowsIt)
{
  for (const char *law : {"tangential estimate", "tangential frictionless", "tangential off"}) {
    const std::string message = error(REFERENCE_DUST + " damping 0.5 " + law);
    EXPECT_NE(message.find("damping needs tangential impulse or integrate"), std::string::npos)
        << law << " -> " << message;
  }
}

TEST(FixDustDetachWords, TexturesFromAFileBringTheirOwnGrains)
{
  EXPECT_EQ(error("texture monolayer 20e-6 coverage 0.01 seed 1 write dust_words.txt"), "");
  EXPECT_EQ(error("texture file dust_words.txt"), "");
  for (const std::string words : {"coverage 0.2", "seed 3", "bare 0.3", "distribution rrsb 20e-6 3", "spread 2"}) {
    const std::string message = error("texture file dust_words.txt " + words);
    EXPECT_NE(message.find(words.substr(0, words.find(' ')) + " goes with texture monolayer"), std::string::npos)
        << message;
  }
  std::remove("dust_words.txt");
}

TEST(FixDustDetachWords, ATextureThatCannotBeWrittenStopsTheRun)
{
  const auto one_line = [](const std::string &path, const std::string &cause) {
    const std::string message = error(REFERENCE_DUST + " write " + path);
    EXPECT_NE(message.find("Fix dust/detach write " + path + ": it cannot be written: " + cause), std::string::npos)
        << message;
  };
  one_line("/dev/full", "No space left on device");
  one_line("/no/such/folder/texture", "No such file or directory");
  one_line("/tmp", "Is a directory");
}

TEST(FixDustDetachWords, WrongInputIsNamed)
{
  const auto names = [&](const std::string &words, const std::string &word) {
    const std::string message = error(words);
    EXPECT_NE(message.find(word), std::string::npos) << words << " -> " << message;
  };
  const std::string ok = REFERENCE_DUST + " ";
  EXPECT_EQ(error(ok), "");
  EXPECT_EQ(error("texture monolayer 20e-6 seed 3 coverage 0.5"), "");
  names("texture monolayer 20e-6 coverage 0 seed 1", "coverage value 0 must be above 0");
  names("texture monolayer 20e-6 coverage 0.7 seed 1", "coverage 0.7 cannot be placed");
  names("texture monolayer 20e-6 coverage -1 seed 1", "coverage value -1");
  names("texture monolayer 2e-3 coverage 0.2 seed 1", "grain diameter 0.002");
  names("texture monolayer -1 coverage 0.2 seed 1", "texture DIAMETER value -1 must be above 0");
  names("texture monolayer 20e-6 coverage 0.2", "seed");
  names("texture monolayer 20e-6 seed 1", "coverage");
  names("texture monolayer 20e-6 coverage 0.2 seed 0", "seed value 0");
  names("texture patchy 20e-6", "texture SOURCE value patchy must be file or monolayer");
  names("texture file no_such_file", "no_such_file");
  names("density 2700", "texture");
  names(ok + ok, "twice");
  names("texture monolayer 20e-6 coverage 0.2 coverage 0.3 seed 1", "coverage is given twice");
  names(ok + "hamaker 1e-19 4e-10 surface 0.01", "surface");
  names(ok + "rows maybe", "rows value maybe must be yes or no");
  names(ok + "write /no/such/folder/texture", "/no/such/folder/texture");
  names(ok + "colour red", "colour");
  names(ok + "friction", "friction");
  names(ok + "friction -0.1", "friction");
  names(ok + "friction abc", "friction value abc must be a number");
  names(ok + "hamaker 1e-19", "hamaker");
  names(ok + "hamaker 1e-19 0", "hamaker");
  names(ok + "surface 0", "surface");
  names(ok + "density -1", "density");
  names(ok + "elastic 75e9 0.3 210e9", "elastic");
  names(ok + "elastic 75e9 0.7 210e9 0.3", "elastic");
  names(ok + "bare 4", "bare");
  names(ok + "bare 0.3 0 0 0", "bare");
  names(ok + "bare 0.3 0 0", "bare");
  names(ok + "distribution", "distribution");
  names(ok + "distribution lognormal 15e-6", "distribution");
  names(ok + "distribution normal 15e-6 1.5", "normal");
  names(ok + "distribution lognormal 15e-6 1", "distribution SIGMA_G value 1 must be above 1");
  names(ok + "distribution rrsb 0 3", "distribution");
  names(ok + "sizes", "sizes");
  names(ok + "sizes -0.01", "sizes value -0.01 must be from 0 to 1");
  names(ok + "sizes 1.1", "sizes value 1.1 must be from 0 to 1");
  names(ok + "texture file x", "texture is given twice");
  names(ok + "spread", "spread");
  names(ok + "spread 0.99", "spread value 0.99 must be from 1 to 100");
  names(ok + "spread 101", "spread value 101 must be from 1 to 100");
  names(ok + "tangential sideways", "sideways");
  names(ok + "rolling -1", "rolling");
  names(ok + "damping -1", "damping");
  names(ok + "tangential integrate meet maybe", "maybe");
  names(ok + "meet yes", "meet yes needs tangential integrate");
  names(ok + "tangential impulse meet yes", "meet yes needs tangential integrate");
  names(ok + "tangential integrate criteria ibrahim meet yes", "meet yes needs criteria liftoff");
  names(ok + "tangential integrate cohesion 1", "cohesion needs meet yes");
  names(ok + "tangential integrate meet no meet_step 1e-8", "meet_step needs meet yes");
  names(ok + "tangential integrate meet_softening 10", "meet_softening needs meet yes");
  names(ok + "tangential integrate meet yes cohesion 0", "cohesion");
  names(ok + "tangential integrate meet yes meet_softening 0.5", "meet_softening");
  names(ok + "tangential integrate meet yes meet_step -1e-9", "meet_step");
  names(ok + "tangential integrate meet yes meet_step 1e-7", "meet_step 1e-07 must be at most");
  names(ok + "rolling", "rolling");
  names(ok + "criteria all", "all");
  names(ok + "every 0", "every value 0");
  names(ok + "every 1.5", "every value 1.5 must be a whole number");
  names("texture monolayer 20e-6 coverage 0.2 seed two", "seed value two must be a whole number");
  names(ok + "rotation maybe", "rotation value maybe must be yes or no");
  names(ok + "mass 3.5", "mass value 3.5");
  names(ok + "orientation random", "orientation");
  names(ok + "orientation random 0", "orientation SEED value 0");
  names(ok + "orientation random x", "orientation SEED value x");
  names(ok + "orientation up", "up");
  names(ok + "stiffen 0.1", "stiffen value 0.1");
  names(ok + "stiffen", "stiffen");
  names(ok + "emit 3", "emit value 3");
  names(ok + "emit some", "emit value some");
  names(ok + "emit 2 mass no", "mass");
  names(ok + "emit 2", "group");

  EXPECT_NE(error(ok, false).find("no carriers"), std::string::npos);
  Deck points;
  points.box("atomic");
  EXPECT_NE(points.attempt("fix dust all dust/detach " + ok).find("radius"), std::string::npos);
}

// the range says why: none of these is below what it starts with
TEST(FixDustDetachWords, ValuesThatNoNumberHolds)
{
  const auto is = [](const std::string &words, const std::string &message) {
    const std::string said = error(REFERENCE_DUST + " " + words);
    EXPECT_NE(said.find("Fix dust/detach " + message), std::string::npos) << words << " -> " << said;
  };
  is("friction 1e400", "friction value 1e400 must be from 0 to 1.79769e+308");
  is("friction -1e400", "friction value -1e400 must be from 0 to 1.79769e+308");
  is("rolling 1e400", "rolling value 1e400 must be from 0 to 3.15");
  is("stiffen 1e999", "stiffen value 1e999 must be from 1 to 1.79769e+308");
  is("bare 0.3 -1e400 0 0", "bare nx value -1e400 must be from -1.79769e+308 to 1.79769e+308");
  is("distribution rrsb 2e-5 1e400", "distribution N value 1e400 must be above 0 and at most 1.79769e+308");
  is("every 3000000000", "every value 3000000000 must be a whole number from 1 to 2147483647");
  is("every 99999999999999999999", "every value 99999999999999999999 must be a whole number from 1 to 2147483647");
  is("every 0", "every value 0 must be a whole number, at least 1");
  is("every -99999999999999999999", "every value -99999999999999999999 must be a whole number, at least 1");
  is("orientation random 3000000000", "orientation SEED value 3000000000 must be a whole number from 1 to 2147483647");
  is("emit 99999999999", "emit value 99999999999 must be none or a whole number from 1 to 2");
  is("write \"\"", "write value \"\" must be the name of a file");
  is("contact \"\"", "contact value \"\" must be the ID of a fix");
  const std::string file = error("texture file \"\"");
  EXPECT_NE(file.find("texture value \"\" must be the name of a file"), std::string::npos) << file;
}

// the carriers of a run are those that it started with, and those that come to be inserted
TEST(FixDustDetachWords, ADynamicGroupIsRefused)
{
  Deck deck;
  deck.box();
  deck.carrier(0.0, 0.0, START, 0.0, 0.0, -8.0);
  deck.wall_and_motion();
  deck("variable all atom 1\ngroup some dynamic all var all every 1");
  const std::string message = deck.attempt("fix dust some dust/detach " + REFERENCE_DUST);
  EXPECT_NE(message.find("Fix dust/detach group some is dynamic: carriers are the atoms of a static group"),
            std::string::npos)
      << message;
}

// each carrier's orientation follows from its ID
TEST(FixDustDetachWords, RandomOrientationNeedsIds)
{
  Deck deck;
  deck("units si\natom_style sphere\natom_modify id no\nregion box block -4e-3 4e-3 -4e-3 4e-3 -4e-3 4e-3\n"
       "create_box 1 box\ncreate_atoms 1 single 0 0 0\nset group all diameter 1.5e-3 density 7700");
  EXPECT_NE(deck.attempt("fix dust all dust/detach " + std::string(REFERENCE_DUST) + " orientation random 5")
                .find("orientation random needs atom IDs"),
            std::string::npos);
}

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const int result = RUN_ALL_TESTS();
  lammps_mpi_finalize();
  return result;
}
