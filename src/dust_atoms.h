/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_ATOMS_H
#define LMP_DUST_ATOMS_H

#include "pointers.h"

namespace LAMMPS_NS {

// creates grains as atoms: all ranks ask for all of them, each makes those of its part of the box. Ghost atoms must not
// be needed any more.

class DustAtoms : protected Pointers {
 public:
  explicit DustAtoms(class LAMMPS *);

  // whether atoms cannot be there: on the outside of a border that is fixed
  static bool beyond_fixed_border(class LAMMPS *, const double *x);
  // of the atoms of all ranks
  static tagint highest_tag(class LAMMPS *);

  void create(int type, tagint tag, const double *place, double radius, double mass, const double *v,
              const double *omega);
  // after the last one; returns the number made on all ranks: fewer than asked for if some lay outside the box
  bigint finish();

 private:
  int before;    // local atoms
  bool is_mine(const double *) const;
};

}    // namespace LAMMPS_NS

#endif
