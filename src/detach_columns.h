/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_DETACH_COLUMNS_H
#define LMP_DUST_DETACH_COLUMNS_H

/* The numbers that fix dust/detach and compute dust/grain put out, by name, counted from 0; a deck counts them from 1.
   Tables in doc/ say what they are. A test reads this file: one name a line, the number of them last. */

namespace LAMMPS_NS {

// of the global vector
namespace DetachVector {
enum {
  INITIAL_GRAINS,
  ATTACHED_GRAINS,
  NORMAL,
  TANGENTIAL,
  SOUTH,
  NORTH,
  DETACHED_MASS,
  INITIAL_MASS,
  COLLISIONS,
  MET_SLIDING,
  MET_ROLLING,
  SLIDING,
  ROLLING,
  NO_ROOM,
  KNOCKED,
  FOLLOWED,
  SIZE
};
}

// columns of the per-atom array
namespace DetachAtom {
enum { ATTACHED, MASS, WINDOW_MASS, CONTACT_TIME, PEAK_ACCELERATION, QW, QX, QY, QZ, SIZE };
}

// columns of the local array
namespace DetachRow {
enum { STEP, CARRIER, GRAIN, MODE, DIAMETER, X, Y, Z, VX, VY, VZ, TEXTURE, SIZE };
}

// columns of the local array of compute dust/grain
namespace GrainRow {
enum { CARRIER, GRAIN, DIAMETER, X, Y, Z, LOST, TEXTURE, SIZE };
}

}    // namespace LAMMPS_NS

#endif
