/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "adhesion_spread.h"

#include "random_numbers.h"

#include <cmath>
#include <random>

using namespace Dust;

void Dust::spread_adhesion(Texture &texture, double sigma_a, uint64_t seed)
{
  if (!(sigma_a >= 1.0 && sigma_a <= MOST_SPREAD))
    throw TextureError("spread of the adhesion " + number_text(sigma_a) + " is not from 1 to " +
                       number_text(MOST_SPREAD));
  if (sigma_a == 1.0) return;
  constexpr uint64_t OWN_STREAM = 0x9e3779b97f4a7c15;    // any bits that no seed of a user has: seeds are below 2^31
  std::mt19937_64 random(seed ^ OWN_STREAM);
  for (Grain &grain : texture.grains) grain.adhesion = std::pow(sigma_a, normal_deviate(random));
}
