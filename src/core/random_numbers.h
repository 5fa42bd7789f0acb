/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_RANDOM_NUMBERS_H
#define DUST_CORE_RANDOM_NUMBERS_H

#include "geometry.h"

#include <cmath>
#include <random>

/* The same numbers with every library: the standard fixes its engines, but not its distributions. */

namespace Dust {

/*! Evenly from 0 up to 1, without it */
inline double uniform(std::mt19937_64 &random) { return (random() >> 11) * 0x1.0p-53; }

/*! Normal with mean 0 and deviation 1, from two of them (Box and Muller, Ann. Math. Stat. 29, 610 (1958)) */
inline double normal_deviate(std::mt19937_64 &random)
{
  const double r = std::sqrt(-2.0 * std::log1p(-uniform(random)));
  return r * std::cos(2.0 * PI * uniform(random));
}

}    // namespace Dust

#endif
