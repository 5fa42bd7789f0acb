/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_LANES_H
#define DUST_CORE_LANES_H

#include <cstddef>    // tells which C library there is

/*! Compiled for wide vector registers too, of which the machine's widest are taken at run time. All give the same bits:
 *  each lane does what one contact alone would do, and nothing is contracted (-ffp-contract=off). Only for functions of
 *  one file: clang makes of one that a header declares without it a single one, for the widest registers. */
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(DUST_ONE_TARGET)
#define DUST_LANES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define DUST_LANES
#endif
/*! A part of such a function: compiled with it, for the same registers */
#define DUST_IN_LANES inline __attribute__((always_inline))

#endif
