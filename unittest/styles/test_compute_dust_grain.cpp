// compute dust/grain: a row for every grain that is still attached, where it is.

#include "deck.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

namespace {

using LAMMPS_NS::GrainRow::SIZE;
using Row = std::array<double, SIZE>;
using Place = std::array<double, 3>;
constexpr double RADIUS = 0.75e-3;

// on this rank
std::vector<Row> grains(const Deck &deck)
{
  const int rows = *static_cast<int *>(lammps_extract_compute(deck.lmp, "grain", LMP_STYLE_LOCAL, LMP_SIZE_ROWS));
  auto **array = static_cast<double **>(lammps_extract_compute(deck.lmp, "grain", LMP_STYLE_LOCAL, LMP_TYPE_ARRAY));
  std::vector<Row> all(rows);
  for (int k = 0; k < rows; k++) std::copy_n(array[k], static_cast<int>(SIZE), all[k].begin());
  return all;
}

// the directions of a texture file, by number of the grain from 1, and their diameters
std::map<int, std::pair<Place, double>> texture_of(const std::string &file)
{
  std::map<int, std::pair<Place, double>> all;
  std::ifstream in(file);
  for (std::string text; std::getline(in, text);) {
    std::istringstream words(text);
    Place n;
    double diameter;
    if (words >> n[0] >> n[1] >> n[2] >> diameter) all[static_cast<int>(all.size()) + 1] = {n, diameter};
  }
  return all;
}

void grains_of(Deck &deck, const std::string &words, const std::string &group = "all")
{
  deck("fix dust all dust/detach " + words + "\ncompute grain " + group + " dust/grain dust");
}

}    // namespace

TEST(ComputeDustGrain, GrainsSitWhereTheTextureSays)
{
  const std::string file = testing::TempDir() + "grains.texture";
  Deck deck;
  deck.box();
  deck.carrier(0.001, -0.002, 0.003, 0, 0, 0);
  deck("fix move all nve/sphere");
  grains_of(deck, "texture monolayer 20e-6 coverage 0.2 seed 1 distribution lognormal 20e-6 1.3 write " + file);
  deck("run 1 post no");
  const auto texture = texture_of(file);
  const std::vector<Row> rows = grains(deck);
  ASSERT_EQ(rows.size(), static_cast<size_t>(deck.global(2)));
  ASSERT_EQ(rows.size(), texture.size());
  std::map<int, int> seen;
  for (const Row &row : rows) {
    const auto &[n, diameter] = texture.at(static_cast<int>(row[1]));
    seen[static_cast<int>(row[1])]++;
    EXPECT_EQ(row[0], 1.0);
    EXPECT_NEAR(row[2], diameter, 1e-9 * diameter);
    const Place centre = {0.001, -0.002, 0.003};
    for (int d = 0; d < 3; d++) EXPECT_NEAR(row[3 + d], centre[d] + (RADIUS + 0.5 * diameter) * n[d], 1e-11);
    EXPECT_EQ(row[6], 0.0);
  }
  EXPECT_EQ(seen.size(), rows.size());
  std::remove(file.c_str());
}

// about a tilted axis, at steps within and beyond the fix's own bookkeeping
TEST(ComputeDustGrain, GrainsTurnWithTheirCarrier)
{
  const double axis[3] = {0.6, 0.0, 0.8}, spin = 800.0, dt = 1e-6;
  for (int steps : {3, 16, 1000}) {
    Deck deck;
    deck.box();
    deck.carrier(0, 0, 0.003, 1.0, 0, 0);
    deck(line("set atom 1 omega %.17g %.17g %.17g\nfix move all nve/sphere\ntimestep 1e-6", spin * axis[0],
              spin * axis[1], spin * axis[2]));
    grains_of(deck, REFERENCE_DUST + " orientation random 7");
    deck("run 0 post no");
    const std::vector<Row> before = grains(deck);
    deck("run " + std::to_string(steps) + " post no");
    const std::vector<Row> after = grains(deck);
    ASSERT_EQ(before.size(), 4500u);
    ASSERT_EQ(after.size(), 4500u);
    const double c = std::cos(spin * steps * dt), s = std::sin(spin * steps * dt);
    for (size_t k = 0; k < before.size(); k++) {
      ASSERT_EQ(before[k][1], after[k][1]);
      const double r[3] = {before[k][3], before[k][4], before[k][5] - 0.003};
      const double along = axis[0] * r[0] + axis[2] * r[2];
      const double side[3] = {-axis[2] * r[1], axis[2] * r[0] - axis[0] * r[2], axis[0] * r[1]};    // axis x r
      for (int d = 0; d < 3; d++) {
        const double turned = c * r[d] + s * side[d] + (1.0 - c) * along * axis[d];
        EXPECT_NEAR(after[k][3 + d], turned + deck.atom("x", 1)[d], 1e-11);
      }
    }
  }
}

// one carrier is hit, one is not, and one is in no group
TEST(ComputeDustGrain, GrainsThatHaveLeftHaveNoRow)
{
  Deck deck;
  deck.box();
  deck.carrier(0, 0, 0.7501e-3, 0, 0, -8.0);
  deck.carrier(0.005, 0, 0.005, 0, 0, 0);
  deck.carrier(-0.005, 0, 0.005, 0, 0, 0);
  deck.wall_and_motion();
  deck("group shown id 1 2");
  grains_of(deck, REFERENCE_DUST + " every 6000", "shown");
  deck("run 6000 post no");
  std::map<int, std::vector<Row>> rows;
  for (const Row &row : grains(deck)) rows[static_cast<int>(row[0])].push_back(row);
  EXPECT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[2].size(), 4500u);
  EXPECT_GT(deck.global(3) + deck.global(4), 2000.0);
  EXPECT_EQ(static_cast<double>(rows[1].size()), deck.columns(1)[0]);
  std::map<double, int> times;    // each grain has left or has a row
  for (const auto &event : deck.events()) times[event[2]]++;
  for (const Row &row : rows[1]) times[row[1]]++;
  EXPECT_EQ(times.size(), 4500u);
  for (const auto &[grain, n] : times) EXPECT_EQ(n, 1) << grain;
  EXPECT_EQ(rows[2][0][6], 0.0);
  EXPECT_NEAR(rows[1][0][6], 1.0 - static_cast<double>(rows[1].size()) / 4500.0, 1e-12);
}

// a carrier that reaches over a periodic border keeps its grains about it
TEST(ComputeDustGrain, GrainsStayTogetherAtAPeriodicBorder)
{
  Deck deck;
  deck.box();
  deck.carrier(0.0099, 0, 0.005, 0, 0, 0);
  deck("fix move all nve/sphere");
  grains_of(deck, REFERENCE_DUST);
  deck("run 1 post no");
  double beyond = 0.0;
  for (const Row &row : grains(deck)) {
    const double r[3] = {row[3] - 0.0099, row[4], row[5] - 0.005};
    EXPECT_NEAR(std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]), RADIUS + 10e-6, 1e-11);
    beyond += row[3] > 0.01;
  }
  EXPECT_GT(beyond, 1000.0);
}

// each carrier has the texture of its class on its own radius
TEST(ComputeDustGrain, GrainsOfManySizes)
{
  Deck deck;
  deck.box();
  deck.carrier(0, 0, 0.003, 0, 0, 0);
  deck.carrier(0.004, 0, 0.003, 0, 0, 0);
  deck("set atom 2 diameter 1.2e-3\nfix move all nve/sphere");
  grains_of(deck, REFERENCE_DUST + " sizes 0.05");
  deck("run 1 post no");
  std::map<int, int> number;
  for (const Row &row : grains(deck)) {
    const int id = static_cast<int>(row[0]);
    const double *x = deck.atom("x", id), radius = id == 1 ? RADIUS : 0.6e-3;
    const double r[3] = {row[3] - x[0], row[4] - x[1], row[5] - x[2]};
    EXPECT_NEAR(std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]), radius + 10e-6, 1e-11);
    EXPECT_NEAR(row[7], 2.0 * radius, 0.05 * radius);
    number[id]++;
  }
  EXPECT_EQ(number[1], deck.columns(1)[0]);
  EXPECT_EQ(number[2], deck.columns(2)[0]);
  EXPECT_LT(number[2], 0.7 * number[1]);
}

TEST(ComputeDustGrain, WrongWords)
{
  Deck deck;
  deck.box();
  deck.carrier(0, 0, 0.005, 0, 0, 0);
  deck("fix move all nve/sphere");
  const auto expect = [&](const std::string &command, const std::string &words) {
    const std::string error = deck.attempt(command);
    EXPECT_NE(error.find(words), std::string::npos) << error;
  };
  expect("compute grain all dust/grain", "wants one value, the ID of a fix dust/detach, not 0");
  expect("compute grain all dust/grain a b", "not 2");
  expect("compute grain all dust/grain dust", "there is no fix dust/detach with the ID dust");
  expect("compute grain all dust/grain move", "there is no fix dust/detach with the ID move");
  grains_of(deck, REFERENCE_DUST);
  deck("run 0 post no");
  deck("unfix dust");
  expect("run 0 post no", "there is no fix dust/detach with the ID dust");
}
