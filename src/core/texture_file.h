/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_TEXTURE_FILE_H
#define DUST_CORE_TEXTURE_FILE_H

#include "texture.h"

#include <iosfwd>
#include <string>

namespace Dust {

/*! Text format: a line "# dust texture 1", the lines "carrier_diameter D", "bare HALF_ANGLE X Y Z" and "grains N", then
 *  a line "nx ny nz diameter" for each grain and at last "end". After the first line, blank lines and lines that start
 *  with # are skipped. Lengths are in the units of the deck that reads the file. Numbers are written so that they are
 *  read back exactly. In a file "# dust texture 2" the lines of the grains have a fifth number, the factor of the
 *  pull-off force; it is written if any of them is not 1. */
void write_texture(const Texture &texture, std::ostream &out);

/*! The same into a file, which is there complete or, if that fails, is what it was before; throws TextureError with the
 *  cause, without the name of the file */
void write_texture_file(const Texture &texture, const std::string &path);

/*! Reads a texture and checks it against all rules of the format; throws TextureError naming the line that is wrong and
 *  what is allowed there, in printable ASCII */
Texture read_texture(std::istream &in);

/*! The same from a file; throws TextureError if it cannot be read, too, without the name of the file */
Texture read_texture_file(const std::string &path);

}    // namespace Dust

#endif
