// Where emitted grains can be put, asked directly: each by the rules of doc/fix_dust_detach.rst.

#include "dust_room.h"

#include "deck.h"
#include "lammps.h"

#include <utility>
#include <vector>

using namespace LAMMPS_NS;

namespace {

constexpr double R = 1e-5, X = 0.01, Z = 0.01;    // radius; the box of deck.h, periodic along x and y

DustRoom::Sphere at(double x, double y, double z, tagint carrier = 1) { return {{x, y, z}, {x, y, z}, R, carrier}; }

std::vector<int> room(Deck &deck, std::vector<DustRoom::Sphere> spheres)
{
  return DustRoom(static_cast<LAMMPS *>(deck.lmp), std::move(spheres)).find();
}

}    // namespace

// of those that overlap the first has the room; one that has none keeps nobody off
TEST(DustRoom, AmongEachOther)
{
  Deck deck;
  deck.box();
  EXPECT_EQ(room(deck, {at(0, 0, 0), at(1.9 * R, 0, 0)}), (std::vector<int>{1, 0}));
  EXPECT_EQ(room(deck, {at(0, 0, 0), at(2.1 * R, 0, 0)}), (std::vector<int>{1, 1}));
  EXPECT_EQ(room(deck, {at(0, 0, 0), at(1.5 * R, 0, 0), at(3.0 * R, 0, 0)}), (std::vector<int>{1, 0, 1}));
  EXPECT_EQ(room(deck, {at(3.0 * R, 0, 0), at(1.5 * R, 0, 0), at(0, 0, 0), at(4.5 * R, 0, 0)}),
            (std::vector<int>{1, 0, 1, 0}));
  EXPECT_EQ(room(deck, {at(1.5 * R, 0, 0), at(0, 0, 0), at(3.0 * R, 0, 0), at(4.5 * R, 0, 0)}),
            (std::vector<int>{1, 0, 0, 1}));
}

TEST(DustRoom, AcrossBorders)
{
  Deck deck;
  deck.box();
  const double in = X - 0.9 * R;
  EXPECT_EQ(room(deck, {at(-in, 0, 0), at(in, 0, 0), at(0, in, 0), at(0, -in, 0), at(-in, in, 0)}),
            (std::vector<int>{1, 0, 1, 0, 1}));
  EXPECT_EQ(room(deck, {at(in + 2 * X, 0, 0), at(-in, 4 * X, 0)}), (std::vector<int>{1, 0}));    // other images
  EXPECT_EQ(room(deck, {at(0, 0, Z + R), at(0, 0, Z - R)}), (std::vector<int>{0, 1}));    // beyond the fixed border
}

// a grain may touch its own carrier, to round-off, and no other atom
TEST(DustRoom, AmongAtoms)
{
  Deck deck;
  deck.box();
  deck.carrier(X - 1e-4, 0.0, 2e-3, 0.0, 0.0, 0.0);
  const double touch = 0.75e-3 + R, z = 2e-3, x = -X - 1e-4 + touch;    // of its image
  for (const double part : {1.0 - 1e-7, 1.0 - 1e-5}) {
    const double close = x - (1.0 - part) * touch;
    EXPECT_EQ(room(deck, {at(close, 0, z, 1)})[0], part > 1.0 - 1e-6);
    EXPECT_EQ(room(deck, {at(close, 0, z, 2)})[0], 0);
  }
  EXPECT_EQ(room(deck, {at(x + 1e-9, 0, z, 2)})[0], 1);
}

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const int result = RUN_ALL_TESTS();
  lammps_mpi_finalize();
  return result;
}
