// What the fix keeps of each atom.

#include "carrier_data.h"

#include "core/pack.h"
#include "deck.h"
#include "lammps.h"

#include <cmath>
#include <vector>

using namespace LAMMPS_NS;

namespace {

// turned by this angle about z
void expect_turned(const Dust::Quaternion &q, double angle)
{
  const double expected[] = {std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle)};
  for (int d = 0; d < 4; d++) EXPECT_NEAR(q.q[d], expected[d], 1e-12) << angle;
}

}    // namespace

// the orientation is that of some steps ago; what the carrier has turned since counts at once
TEST(CarrierData, StandsAsItHasTurned)
{
  Deck deck;
  deck.box();
  deck.carrier(0.0, 0.0, 2e-3, 0.0, 0.0, 0.0);
  CarrierData carriers(static_cast<LAMMPS *>(deck.lmp), true, true, 0, false);
  carriers.grow(2);
  carriers.clear(0);
  carriers.orientation[0] = Dust::Quaternion();
  carriers.state[0] = CarrierData::FREE_FLIGHT;
  carriers.angle[0][2] = 0.3;
  expect_turned(carriers.standing(0), 0.3);
  carriers.turn();
  expect_turned(carriers.orientation[0], 0.3);
  EXPECT_EQ(carriers.angle[0][2], 0.0);
  carriers.angle[0][2] = 0.4;
  expect_turned(carriers.standing(0), 0.7);

  carriers.copy(0, 1);
  expect_turned(carriers.standing(1), 0.7);
  std::vector<double> numbers(carriers.size(0));
  Dust::Packer to(numbers.data());
  carriers.pack(1, to);
  EXPECT_EQ(to.size(), carriers.size(0));
  carriers.angle[0][2] = 0.0;
  Dust::Unpacker from(numbers.data());
  carriers.unpack(0, from);
  expect_turned(carriers.standing(0), 0.7);
}

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const int result = RUN_ALL_TESTS();
  lammps_mpi_finalize();
  return result;
}
