// Carriers of many sizes in one fix: each class has a texture of its own, and all that is counted stays per carrier.

#include "deck.h"

#include "core/texture_file.h"
#include "core/texture_placement.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

using namespace LAMMPS_NS;

namespace {

constexpr double RD = 10.0e-6;

std::string joined(std::initializer_list<std::string> words)
{
  std::string all;
  for (const std::string &word : words) all += word;
  return all;
}

// carriers just above the wall, one each 3 mm; in the order of their IDs
void carriers(Deck &deck, const std::vector<double> &diameters, double vx = 1.0, double vz = -8.0)
{
  deck.box();
  for (size_t k = 0; k < diameters.size(); k++) {
    const int id = static_cast<int>(k) + 1;
    deck.carrier(-0.008 + 0.003 * k, 0.0, 0.5 * diameters[k] + 1.0e-9, vx, 0.0, vz * (1.0 - 0.1 * k));
    deck(line("set atom %.0f diameter %.17g density 7700\n", id, diameters[k]));
  }
  deck("fix move all nve/sphere\nfix wall all wall/gran granular " + contact(0.7, 0.3) + " zplane 0.0 NULL");
}

// one more, of which is known which ID it gets
void add(Deck &deck, int id, double diameter, double vz)
{
  deck(line("create_atoms 1 single 0.007 0 %.17g\n", 0.5 * diameter + 1.0e-9) +
       line("set atom %.0f diameter %.17g density 7700\n", id, diameter) + line("set atom %.0f vz %.17g", id, vz));
}

using Rows = std::vector<std::vector<double>>;

// the per-atom array and the rows of a fix for a carrier
struct Seen {
  std::vector<double> columns;
  Rows rows;
  bool operator==(const Seen &other) const { return columns == other.columns && rows == other.rows; }
};

Seen seen(const Deck &deck, const char *fix, int id)
{
  Seen all;
  const LAMMPS_NS::tagint *tag = deck.tags();
  int i = 0;
  while (tag[i] != id) i++;
  auto **array = static_cast<double **>(lammps_extract_fix(deck.lmp, fix, LMP_STYLE_ATOM, LMP_TYPE_ARRAY, 0, 0));
  all.columns.assign(array[i], array[i] + DetachAtom::SIZE);
  const int n = *static_cast<int *>(lammps_extract_fix(deck.lmp, fix, LMP_STYLE_LOCAL, LMP_SIZE_ROWS, 0, 0));
  auto **rows = static_cast<double **>(lammps_extract_fix(deck.lmp, fix, LMP_STYLE_LOCAL, LMP_TYPE_ARRAY, 0, 0));
  for (int k = 0; k < n; k++)
    if (rows[k][DetachRow::CARRIER] == id) all.rows.emplace_back(rows[k], rows[k] + DetachRow::SIZE);
  return all;
}

double total(const Deck &deck, const char *fix, int n)
{
  void *p = lammps_extract_fix(deck.lmp, fix, LMP_STYLE_GLOBAL, LMP_TYPE_VECTOR, n, 0);
  const double value = *static_cast<double *>(p);
  lammps_free(p);
  return value;
}

double grains_on(double diameter) { return Dust::grains_for_coverage(0.2, 0.5 * diameter, RD); }

}    // namespace

TEST(FixDustDetachSizes, OneFixGivesEachSizeWhatAFixOfItsOwnGives)
{
  const std::vector<double> sieve = {1.0e-3, 1.5e-3, 1.2e-3, 1.5e-3};
  const std::vector<std::string> groups = {"id 1", "id 2 4", "id 3"};
  for (const std::string words : {"", "orientation random 7", "tangential integrate", "criteria ibrahim rotation no",
                                  "mass yes", "distribution lognormal 15e-6 1.3 spread 2"}) {
    const std::string dust = joined({"dust/detach ", REFERENCE_DUST, " every 9000 counts yes ", words});
    Deck one, own;
    carriers(one, sieve);
    carriers(own, sieve);
    one(joined({"fix dust all ", dust, " sizes 0\nrun 9000 post no"}));
    for (size_t g = 0; g < groups.size(); g++) {
      const std::string name = std::to_string(g);
      own(joined({"group g", name, " ", groups[g], "\nfix d", name, " g", name, " ", dust}));
    }
    own("run 9000 post no");
    const std::map<int, const char *> fix_of = {{1, "d0"}, {2, "d1"}, {3, "d2"}, {4, "d1"}};
    size_t rows = 0;
    for (const auto &[id, fix] : fix_of) {
      const Seen mine = seen(one, "dust", id), theirs = seen(own, fix, id);
      EXPECT_EQ(mine.columns, theirs.columns) << words << ", carrier " << id;
      EXPECT_EQ(mine.rows, theirs.rows) << words << ", carrier " << id;
      for (const auto &row : mine.rows) ASSERT_EQ(row[DetachRow::TEXTURE], sieve[id - 1]);
      for (int d = 0; d < 3; d++) EXPECT_EQ(one.atom("v", id)[d], own.atom("v", id)[d]);
      rows += mine.rows.size();
    }
    EXPECT_GT(rows, 3000u);
    for (int n = 0; n < DetachVector::SIZE; n++) {
      const double sum = total(own, "d0", n) + total(own, "d1", n) + total(own, "d2", n);
      const bool whole = n != DetachVector::DETACHED_MASS && n != DetachVector::INITIAL_MASS;
      EXPECT_NEAR(one.global(n + 1), sum, whole ? 0.0 : 1.0e-12 * sum) << words << ", component " << n + 1;
    }
    EXPECT_NEAR(one.global(0), one.global(7) / one.global(8), 1.0e-14);
  }
}

TEST(FixDustDetachSizes, ClassesAreAFactorApart)
{
  // round(ln(d/1.5 mm)/ln 1.05): 0, 0, -1, -6, -8
  const std::vector<double> sizes = {1.5e-3, 1.47e-3, 1.42e-3, 1.1e-3, 1.0e-3};
  const std::vector<double> classes = {0.0, 0.0, -1.0, -6.0, -8.0};
  Deck deck;
  carriers(deck, sizes);
  deck("fix dust all dust/detach " + REFERENCE_DUST + " every 9000 write dust_size_*.txt\nrun 9000 post no");
  double mass = 0.0;
  for (int id = 1; id <= 5; id++) {
    const Seen mine = seen(deck, "dust", id);
    const double placed = 1.5e-3 * std::pow(1.05, classes[id - 1]);
    ASSERT_FALSE(mine.rows.empty());
    for (const auto &row : mine.rows) ASSERT_NEAR(row[DetachRow::TEXTURE], placed, 1.0e-15);
    EXPECT_EQ(mine.columns[DetachAtom::ATTACHED] + mine.rows.size(), grains_on(placed));
    mass += 0.8 * std::pow(sizes[id - 1] / 2.0 / RD, 2) * 4.0 / 3.0 * M_PI * RD * RD * RD * 2700.0;
    if (id == 2) continue;
    char name[64];
    std::snprintf(name, sizeof(name), "dust_size_%.9g.txt", placed);
    const Dust::Texture written = Dust::read_texture_file(name),
                        wanted = Dust::place_monolayer(0.5 * placed, RD, 0.2, Dust::BareCap(), 1);
    EXPECT_NEAR(written.carrier_radius, 0.5 * placed, 1.0e-15);
    ASSERT_EQ(written.grains.size(), wanted.grains.size());
    std::remove(name);
  }
  EXPECT_NEAR(deck.global(8), mass, 0.05 * mass);
}

TEST(FixDustDetachSizes, OneSizeWithinItsClassIsAsOneSize)
{
  // what serves several sizes does not show with one
  const auto outcome = [](const std::string &words) {
    Deck deck;
    carriers(deck, {1.5e-3, 1.5e-3});
    deck("fix dust all dust/detach " + REFERENCE_DUST + " every 9000 " + words + "\nrun 9000 post no");
    std::vector<double> all = deck.vector();
    for (const auto &row : deck.events()) all.insert(all.end(), row.begin(), row.end());
    return all;
  };
  const auto plain = outcome("");
  EXPECT_GT(plain.size(), 10000u);
  EXPECT_EQ(outcome("sizes 0"), plain);
  EXPECT_EQ(outcome("sizes 0.3"), plain);
}

TEST(FixDustDetachSizes, TexturesFromFilesServeTheNearestSize)
{
  for (const double d : {1.5e-3, 1.0e-3}) {
    Deck deck;
    carriers(deck, {d});
    deck("fix dust all dust/detach " + REFERENCE_DUST + line(" write dust_file_%.0f.txt", d * 1e6));
  }
  const std::string files = "texture file dust_file_1000.txt texture file dust_file_1500.txt ";
  const std::vector<double> sieve = {1.0e-3, 1.5e-3, 1.03e-3};
  Deck placed, read;
  carriers(placed, sieve);
  carriers(read, sieve);
  placed("fix dust all dust/detach " + REFERENCE_DUST + " every 9000 sizes 0\nrun 9000 post no");
  read("fix dust all dust/detach " + files + " every 9000\nrun 9000 post no");
  for (int id : {1, 2}) EXPECT_EQ(seen(read, "dust", id), seen(placed, "dust", id)) << id;
  for (const auto &row : seen(read, "dust", 3).rows) ASSERT_EQ(row[DetachRow::TEXTURE], 1.0e-3);

  const auto refused = [&](const std::string &words, const char *what, double d = 1.5e-3) {
    Deck deck;
    carriers(deck, {d});
    const std::string message = deck.attempt("fix dust all dust/detach " + words);
    EXPECT_NE(message.find(what), std::string::npos) << words << " -> " << message;
  };
  refused(files, "texture file dust_file_1000.txt is for carriers of diameter 0.001, not 0.00106", 1.06e-3);
  refused(files + "sizes 0", "is for carriers of diameter 0.0015, not 0.00151", 1.51e-3);
  refused(files + "sizes 0.07", "texture file dust_file_1500.txt is for carriers of diameter 0.0015, not 0.0013",
          1.3e-3);
  refused("texture file dust_file_1000.txt texture file dust_file_1000.txt", "are both for carriers of diameter 0.001");
  refused(files + "texture monolayer 20e-6 coverage 0.1 seed 1", "texture is given twice");
  std::remove("dust_file_1000.txt");
  std::remove("dust_file_1500.txt");
}

TEST(FixDustDetachSizes, OneNameServesOneTextureOnly)
{
  Deck deck;
  carriers(deck, {1.5e-3, 1.0e-3});
  const std::string message = deck.attempt("fix dust all dust/detach " + REFERENCE_DUST + " write dust_one.txt");
  EXPECT_NE(message.find("write dust_one.txt needs a * where the diameter goes"), std::string::npos) << message;
  std::remove("dust_one.txt");
}

TEST(FixDustDetachSizes, NewSizesComeAndOldOnesGo)
{
  Deck deck;
  carriers(deck, {1.2e-3, 1.0e-3});
  deck("fix dust all dust/detach " + REFERENCE_DUST + " sizes 0 every 100\nrun 6000 post no");
  const double initial = deck.global(1);
  EXPECT_EQ(initial, grains_on(1.2e-3) + grains_on(1.0e-3));
  const double lost = initial - deck.global(2), of_first = grains_on(1.2e-3) - deck.columns(1)[DetachAtom::ATTACHED];
  EXPECT_GT(of_first, 500.0);
  // books: what a carrier has lost stays lost when it is gone
  deck("group gone id 1\ndelete_atoms group gone compress no\ngroup gone delete");
  add(deck, 3, 1.5e-3, -5.0);
  deck("run 6000 post no");
  EXPECT_EQ(deck.global(1), initial + grains_on(1.5e-3));
  double detached = 0.0;
  for (int mode : {3, 4}) detached += deck.global(mode);
  const auto *tag = deck.tags();
  double attached = 0.0, gone = of_first;
  for (int i = 0; i < 2; i++) {
    const double now = deck.columns(tag[i])[DetachAtom::ATTACHED];
    attached += now;
    gone += (tag[i] == 2 ? grains_on(1.0e-3) : grains_on(1.5e-3)) - now;
  }
  EXPECT_EQ(deck.global(2), attached);
  EXPECT_EQ(detached, gone);
  EXPECT_GT(detached, lost + 1500.0);
}

TEST(FixDustDetachSizes, GrainsOfAllSizesOfCarriersAreEmittedWhereTheyWere)
{
  Deck deck;
  carriers(deck, {1.5e-3, 1.0e-3});
  deck("group balls type 1\nfix dust balls dust/detach texture monolayer 20e-6 coverage 0.02 seed 1 emit 2\n"
       "neigh_modify one 10000 page 200000\nrun 6000 post no");
  const double detached = deck.global(3) + deck.global(4);
  EXPECT_GT(detached, 300.0);
  EXPECT_EQ(lammps_get_natoms(deck.lmp), 2.0 + detached - deck.global(14));
  EXPECT_LT(deck.global(14), 0.5 * detached);
  // total mass: the carriers and the grains they came with
  const double grain = 4.0 / 3.0 * M_PI * RD * RD * RD * 2700.0, *mass = nullptr;
  mass = static_cast<double *>(lammps_extract_atom(deck.lmp, "rmass"));
  double sum = 0.0, bare = 0.0;
  for (int i = 0; i < lammps_extract_setting(deck.lmp, "nlocal"); i++) sum += mass[i];
  for (double d : {1.5e-3, 1.0e-3}) bare += M_PI / 6.0 * d * d * d * 7700.0;
  EXPECT_NEAR(sum - bare, deck.global(1) * grain, 1.0e-9 * sum);
}

TEST(FixDustDetachSizes, ACarrierKeepsItsSize)
{
  Deck deck;
  carriers(deck, {1.5e-3, 1.0e-3});
  deck("fix dust all dust/detach " + REFERENCE_DUST + "\nrun 0 post no\nset atom 2 diameter 1.01e-3");
  EXPECT_NE(deck.attempt("run 1").find("carriers of diameter 0.001, but their diameter is now 0.00101"),
            std::string::npos);
}

TEST(FixDustDetachSizes, RestartWithTheLargestCarrierGone)
{
  // classes and textures are those of the first run, in which it was there; a class that comes later is one of them
  const std::string words = "dust all dust/detach " + REFERENCE_DUST + " every 100 orientation random 3 ";
  for (const std::string more : {"", "sizes 0"}) {
    Deck whole;
    carriers(whole, {1.6e-3, 1.47e-3, 1.1e-3});
    whole(joined({"fix ", words, more,
                  "\nrun 1000 post no\ngroup gone id 1\ndelete_atoms group gone compress no\n"
                  "group gone delete\nrun 500 post no\nwrite_restart dust_sizes.restart"}));
    const auto go_on = [](Deck &deck) {
      deck("run 100 post no");
      add(deck, 4, 1.3e-3, -5.0);
      deck("run 6000 post no");
      const auto *tag = deck.tags();
      const int n = lammps_extract_setting(deck.lmp, "nlocal");
      std::vector<std::vector<double>> all = {deck.vector()};
      for (int i = 0; i < n; i++) all.push_back(deck.columns(tag[i]));
      std::sort(all.begin() + 1, all.end());
      return all;
    };
    Deck rest;
    rest("units si\nread_restart dust_sizes.restart\ncomm_modify vel yes\ntimestep 1e-9\nneighbor 3e-4 bin\n"
         "pair_style granular");
    rest(joined({"pair_coeff * * ", contact(0.7), "\nfix move all nve/sphere"}));
    rest(joined({"fix wall all wall/gran granular ", contact(0.7, 0.3), " zplane 0.0 NULL\nfix ", words, more}));
    // the wall's history comes back in setup: forces alike to 1e-10, and the same grains leave
    const auto expected = go_on(whole), found = go_on(rest);
    ASSERT_EQ(found.size(), expected.size());
    for (int n = 0; n < 6; n++) EXPECT_EQ(found[0][n], expected[0][n]) << n;
    for (size_t k = 1; k < found.size(); k++)
      EXPECT_EQ(found[k][DetachAtom::ATTACHED], expected[k][DetachAtom::ATTACHED]) << more;
  }
  Deck other;
  other("units si\nread_restart dust_sizes.restart\ncomm_modify vel yes\ntimestep 1e-9\n"
        "pair_style granular\npair_coeff * * " +
        contact(0.7) + "\nfix move all nve/sphere");
  const std::string message = other.attempt("fix " + words + "sizes 0.1");
  EXPECT_NE(message.find("sizes is not that of the restart file: 0"), std::string::npos) << message;
  std::remove("dust_sizes.restart");
}

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const int result = RUN_ALL_TESTS();
  lammps_mpi_finalize();
  return result;
}
