/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_PATCH_BITS_H
#define DUST_CORE_PATCH_BITS_H

#include <cstdint>

namespace Dust {

/*! Grains of a patch: the bits of one word */
constexpr int PATCH = 64;

/*! Calls visit(k) for each set bit k of a word */
template <typename Visit> void each_bit(uint64_t word, Visit visit)
{
  for (; word; word &= word - 1) visit(__builtin_ctzll(word));
}

}    // namespace Dust

#endif
