/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_TEXTURE_FILE_H
#define DUST_CORE_TEXTURE_FILE_H

#include "texture.h"

#include <iosfwd>

namespace Dust {

/*! Text format: a line "# dust texture 1", the lines "carrier_diameter D", "bare HALF_ANGLE X Y Z" and "grains N", then
 *  a line "nx ny nz diameter" for each grain and at last "end". Lines that start with # are comments. Lengths are in
 *  the units of the deck that reads the file. Numbers are written so that they are read back exactly. */
void write_texture(const Texture &texture, std::ostream &out);

/*! Reads and checks what write_texture() wrote; throws TextureError naming the line that is wrong */
Texture read_texture(std::istream &in);

}    // namespace Dust

#endif
