// The words of fix dust/detach: each wrong one ends in one line that names the keyword, the value and what is allowed.

#include "deck.h"

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
    {"criteria", "liftoff"},
    {"counts", "yes"},
    {"every", "10"},
    {"rows", "yes"},
    {"rotation", "yes"},
    {"stiffen", "1"},
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
  names(ok + "tangential sideways", "sideways");
  names(ok + "rolling -1", "rolling");
  names(ok + "damping -1", "damping");
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

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const int result = RUN_ALL_TESTS();
  lammps_mpi_finalize();
  return result;
}
