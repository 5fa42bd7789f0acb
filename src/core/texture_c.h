/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_TEXTURE_C_H
#define DUST_CORE_TEXTURE_C_H

/* The one judge of texture files, for other languages: the library libdustcore.so exports these functions and needs
   neither LAMMPS nor MPI. They keep no state, so that threads may call them at once on textures of their own. */

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define DUST_EXPORT __attribute__((visibility("default")))
#else
#define DUST_EXPORT
#endif

/*! A texture that has been read */
typedef struct DustTexture DustTexture;

/*! Reads a texture file and checks it against all rules of its format.
 *
 *  \param path     of the file, in the bytes of the file system
 *  \param message  what is wrong: one line of printable ASCII without the name of the file. It begins with "line N: "
 *                  if it is about the contents. Cut to size and ended with a 0; "" if nothing is wrong
 *  \param size     of message, in bytes
 *  \return         the texture, to be given to dust_texture_free(), or a null pointer if something is wrong */
DUST_EXPORT DustTexture *dust_texture_read(const char *path, char *message, int size);

/*! The same without the texture: 1 if all is well, else 0 */
DUST_EXPORT int dust_texture_check(const char *path, char *message, int size);

/*! Diameter of the carrier, in the file's unit of length */
DUST_EXPORT double dust_texture_carrier_diameter(const DustTexture *);

/*! The bare cap: its half-angle (rad) and axis (unit vector) */
DUST_EXPORT void dust_texture_bare(const DustTexture *, double *half_angle, double axis[3]);

/*! Number of grains */
DUST_EXPORT long long dust_texture_grains(const DustTexture *);

/*! For each grain, in the order of the file: nx, ny, nz (unit vector from the carrier's centre to its own), diameter
 *
 *  \param table  room for 4 dust_texture_grains() numbers */
DUST_EXPORT void dust_texture_table(const DustTexture *, double *table);

/*! For each grain, in the same order: the factor of its pull-off force, 1 where the file has none
 *
 *  \param factors  room for dust_texture_grains() numbers */
DUST_EXPORT void dust_texture_adhesion(const DustTexture *, double *factors);

/*! Gives the memory back; a null pointer is ignored */
DUST_EXPORT void dust_texture_free(DustTexture *);

#ifdef __cplusplus
}
#endif

#endif
