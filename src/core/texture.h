/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_TEXTURE_H
#define DUST_CORE_TEXTURE_H

#include <cstdint>
#include <iosfwd>
#include <stdexcept>
#include <vector>

namespace Dust {

/*! A texture that cannot be made, read or used; what() names the cause in one line */
class TextureError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/*! The part of a carrier that holds no grains: all centres closer than half_angle (rad) to axis (unit vector) */
struct BareCap {
  double half_angle = 0.33;
  double axis[3] = {0.0, 0.0, -1.0};
};

/*! One grain: unit vector from the carrier's centre to the grain's, and the grain's radius (length) */
struct Grain {
  double n[3];
  double radius;
};

/*! The grains that adhere to a carrier, as they touch it: centres at carrier_radius + radius */
struct Texture {
  double carrier_radius;
  BareCap bare;
  std::vector<Grain> grains;
};

/*! Sizes of grains by volume, as sieves and laser diffraction give them. Both kinds are cut at the volume fractions 0.01
 *  and 0.99, since by number their densities, q0 ~ q3/x^3, grow or even diverge towards fine grains. */
struct SizeDistribution {
  enum Kind {
    LOGNORMAL,    //!< spread = geometric standard deviation, above 1
    RRSB    //!< Rosin-Rammler-Sperling-Bennett, 1 - exp(-(x/x')^n) with x' = x50/(ln 2)^(1/n): spread = n, above 0
  } kind;
  double x50;    //!< median diameter by volume, x_50,3 (length)
  double spread;

  /*! Diameter below which this fraction of the volume would be without the cut; fraction between 0.01 and 0.99 */
  double quantile(double fraction) const;
};

/*! Number of equal grains with the coverage X0 = sum of grain cross-sections / carrier surface: 4 X0 (R_p/R_d)^2 */
double grains_for_coverage(double coverage, double carrier_radius, double grain_radius);

/*! Monolayer of equal grains by random sequential placement: each grain goes to a place drawn uniformly from what is
 *  free, until the coverage is reached. No gap between two grains is below 0.001 of their diameter.
 *
 * The free part is tracked by cells of the sphere that no grain covers entirely, refined as they fill, so that dense
 * monolayers need no more than a few tries a grain and a full one is recognised as full (the idea of Wang, Int. J. Mod.
 * Phys. C 5, 707 (1994), with cells of equal area on a sphere).
 *
 * \param coverage  X0, positive; the bare cap counts as surface
 * \param seed      the same seed gives the same texture, to the round-off of the C library's functions
 * \throw TextureError  wrong arguments, or coverage too high to be placed: near 0.547 of the shell of the centres
 *                      outside the cap the placement jams */
Texture place_monolayer(double carrier_radius, double grain_radius, double coverage, const BareCap &bare,
                        uint64_t seed);

/*! Monolayer of grains drawn from a distribution until their summed cross-section reaches the coverage, which the last one
 *  exceeds by a part of its own; placed from large to small. No gap between two grains is below 0.001 of the sum of their
 *  radii. */
Texture place_monolayer(double carrier_radius, const SizeDistribution &sizes, double coverage, const BareCap &bare,
                        uint64_t seed);

/*! No grain inside the bare cap, wider than the carrier or overlapping another; throws TextureError naming the grains */
void check_texture(const Texture &texture);

/*! Text format: a line "# dust texture 1", the lines "carrier_diameter D", "bare HALF_ANGLE X Y Z" and "grains N", then
 *  a line "nx ny nz diameter" for each grain and at last "end". Lines that start with # are comments. Lengths are in
 *  the units of the deck that reads the file. Numbers are written so that they are read back exactly. */
void write_texture(const Texture &texture, std::ostream &out);

/*! Reads and checks what write_texture() wrote; throws TextureError naming the line that is wrong */
Texture read_texture(std::istream &in);

}    // namespace Dust

#endif
