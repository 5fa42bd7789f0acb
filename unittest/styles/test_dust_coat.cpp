// The last monolayer of a process and its table: kept for whoever asks for the very same again.

#include "deck.h"

#include "core/texture_placement.h"
#include "fix_dust_detach.h"
#include "lammps.h"
#include "modify.h"

#include <memory>
#include <string>
#include <vector>

using namespace LAMMPS_NS;

namespace {

const std::string MATERIAL = " density 2700 hamaker 14.633e-20 0.4e-9 elastic 75e9 0.3 210e9 0.3 friction 0.3";

struct Coat {
  std::shared_ptr<const Dust::Texture> texture;
  std::shared_ptr<const Dust::GrainTable> table;
};

// that of a carrier of the reference case in a fix with these words
Coat coat_of(Deck &deck, const std::string &words)
{
  deck("fix dust all dust/detach " + words);
  const auto *fix = dynamic_cast<const FixDustDetach *>(static_cast<LAMMPS *>(deck.lmp)->modify->get_fix_by_id("dust"));
  return {fix->coat_of(0).texture, fix->coat_of(0).table};
}

void set_up(Deck &deck)
{
  deck.box();
  deck.carrier(0.0, 0.0, 0.75e-3, 0.0, 0.0, -8.0);
  deck.wall_and_motion();
}

bool same_grains(const Dust::Texture &a, const Dust::Texture &b)
{
  bool same = a.grains.size() == b.grains.size();
  for (size_t i = 0; same && i < a.grains.size(); i++)
    for (int d = 0; d < 3; d++) same = same && a.grains[i].n[d] == b.grains[i].n[d];
  return same;
}

}    // namespace

TEST(DustCoat, TheLastMonolayerIsKept)
{
  Deck deck;
  set_up(deck);
  const std::string words = REFERENCE_DUST + MATERIAL;
  const Coat first = coat_of(deck, words), again = coat_of(deck, words);
  EXPECT_EQ(again.texture, first.texture);
  EXPECT_EQ(again.table, first.table);
  EXPECT_TRUE(same_grains(*first.texture, Dust::place_monolayer(0.75e-3, 10.0e-6, 0.2, Dust::BareCap(), 1)));
  // in another instance, too
  Deck other;
  set_up(other);
  EXPECT_EQ(coat_of(other, words).texture, first.texture);
  other("clear");
  set_up(other);
  EXPECT_EQ(coat_of(other, words).table, first.table);
}

TEST(DustCoat, OtherGrainsAreOfTheSameTextureWithAnotherTable)
{
  Deck deck;
  set_up(deck);
  const Coat first = coat_of(deck, REFERENCE_DUST + MATERIAL);
  for (const std::string &words :
       {MATERIAL + " tangential estimate", MATERIAL + " criteria ibrahim", MATERIAL + " counts yes",
        MATERIAL + " damping 0.5", MATERIAL + " rolling 0.2 tangential integrate",
        std::string(" density 2800 hamaker 14.633e-20 0.4e-9 elastic 75e9 0.3 210e9 0.3 friction 0.3"),
        std::string(" density 2700 hamaker 14.633e-20 0.5e-9 elastic 75e9 0.3 210e9 0.3 friction 0.3"),
        std::string(" density 2700 hamaker 14.633e-20 0.4e-9 elastic 75e9 0.3 200e9 0.3 friction 0.3"),
        std::string(" density 2700 hamaker 14.633e-20 0.4e-9 elastic 75e9 0.3 210e9 0.3 friction 0.4")}) {
    const Coat other = coat_of(deck, REFERENCE_DUST + words);
    EXPECT_EQ(other.texture, first.texture) << words;
    EXPECT_NE(other.table, first.table) << words;
  }
}

TEST(DustCoat, AnyOtherWordIsAnotherTexture)
{
  Deck deck;
  set_up(deck);
  const Coat first = coat_of(deck, REFERENCE_DUST);
  for (const std::string words :
       {"texture monolayer 21e-6 coverage 0.2 seed 1", "texture monolayer 20e-6 coverage 0.201 seed 1",
        "texture monolayer 20e-6 coverage 0.2 seed 2", "texture monolayer 20e-6 coverage 0.2 seed 1 bare 0.4",
        "texture monolayer 20e-6 coverage 0.2 seed 1 bare 0.33 1 0 0",
        "texture monolayer 20e-6 coverage 0.2 seed 1 bare 0.33 0 1 0",
        "texture monolayer 20e-6 coverage 0.2 seed 1 spread 2",
        "texture monolayer 20e-6 coverage 0.2 seed 1 distribution lognormal 20e-6 1.3",
        "texture monolayer 20e-6 coverage 0.2 seed 1 distribution lognormal 20e-6 1.4",
        "texture monolayer 20e-6 coverage 0.2 seed 1 distribution lognormal 21e-6 1.4",
        "texture monolayer 20e-6 coverage 0.2 seed 1 distribution rrsb 21e-6 1.4"}) {
    const Coat other = coat_of(deck, words);
    EXPECT_NE(other.texture, first.texture) << words;
    EXPECT_FALSE(words.find("spread") == std::string::npos && same_grains(*other.texture, *first.texture)) << words;
  }
  // placed anew, and the same
  const Coat again = coat_of(deck, REFERENCE_DUST);
  EXPECT_NE(again.texture, first.texture);
  EXPECT_TRUE(same_grains(*again.texture, *first.texture));
  deck("fix dust all dust/detach " + REFERENCE_DUST + " sizes 0\nset group all diameter 1.6e-3");
  EXPECT_NE(coat_of(deck, REFERENCE_DUST).texture->carrier_radius, first.texture->carrier_radius);
}

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const int result = RUN_ALL_TESTS();
  lammps_mpi_finalize();
  return result;
}
