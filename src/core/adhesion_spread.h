/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_ADHESION_SPREAD_H
#define DUST_CORE_ADHESION_SPREAD_H

#include "texture.h"

#include <cstdint>

namespace Dust {

constexpr double MOST_SPREAD = 100.0;

/*! Gives each grain of a texture a factor of its pull-off force of its own, as roughness and shape do: log-normal with
 *  the median 1 and the geometric standard deviation sigma_a: ln(factor)/ln(sigma_a) is a normal deviate.
 *
 * The factors come from a stream of their own: sizes and directions of a texture of this seed stay as they are, and the
 * same normal deviates serve all sigma_a.
 *
 * \param sigma_a  from 1 to MOST_SPREAD; 1 leaves the texture as it is
 * \param seed     that of the texture
 * \throw TextureError  another sigma_a */
void spread_adhesion(Texture &texture, double sigma_a, uint64_t seed);

}    // namespace Dust

#endif
