/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_TEXTURE_PLACEMENT_H
#define DUST_CORE_TEXTURE_PLACEMENT_H

#include "texture.h"

#include <cstdint>

namespace Dust {

/*! Sizes of grains by volume, as sieves and laser diffraction give them. Both kinds are cut at the volume fractions
 *  0.01 and 0.99, since by number their densities, q0 ~ q3/x^3, grow or even diverge towards fine grains. */
struct SizeDistribution {
  enum Kind {
    LOGNORMAL,    //!< spread = geometric standard deviation, above 1
    RRSB    //!< Rosin-Rammler-Sperling-Bennett, 1 - exp(-(x/x')^n) with x' = x50/(ln 2)^(1/n): spread = n, above 0
  } kind;
  double x50;    //!< median diameter by volume, x_50,3 (length)
  double spread;

  /*! Diameter below which this fraction of the volume would be without the cut; fraction between 0.01 and 0.99 */
  double quantile(double fraction) const;

  /*! Diameter of the coarsest grains that there can be (length) */
  double largest() const;
};

/*! Number of equal grains with the coverage X0 = sum of grain cross-sections / carrier surface: 4 X0 (R_p/R_d)^2 */
double grains_for_coverage(double coverage, double carrier_radius, double grain_radius);

/*! Monolayer of equal grains by random sequential placement: each grain goes to a place drawn uniformly from what is
 *  free, until the coverage is reached. No gap between two grains is below 0.001 of their diameter.
 *
 * The free part is tracked by cells of the sphere that no grain covers entirely, refined as they fill, so that dense
 * monolayers need no more than a few tries a grain and a full one is recognised as full (the idea of Wang, Int. J. Mod.
 * Phys. C 5, 707 (1994), with cells of equal area on a sphere; sequential_placement.h).
 *
 * \param coverage  X0, positive; the bare cap counts as surface
 * \param seed      the same seed gives the same texture, to the round-off of the C library's functions
 * \throw TextureError  wrong arguments, more than MOST_GRAINS, or coverage too high to be placed: near 0.547 of the
 *                      shell of the centres outside the cap the placement jams; well above that it is not even tried */
Texture place_monolayer(double carrier_radius, double grain_radius, double coverage, const BareCap &bare,
                        uint64_t seed);

/*! Monolayer of grains drawn from a distribution until their summed cross-section reaches the coverage, which the last
 *  one exceeds by a part of its own; placed from large to small. No gap between two grains is below 0.001 of the sum of
 *  their radii. */
Texture place_monolayer(double carrier_radius, const SizeDistribution &sizes, double coverage, const BareCap &bare,
                        uint64_t seed);

}    // namespace Dust

#endif
