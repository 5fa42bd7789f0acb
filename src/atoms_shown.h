/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_ATOMS_SHOWN_H
#define DUST_ATOMS_SHOWN_H

#include "atom.h"

#include <utility>
#include <vector>

namespace LAMMPS_NS {

// The atoms that a fix of LAMMPS sees while this lives: it asks the groups of each atom first of all. What is hidden is
// as if it were in no group.

class AtomsShown {
 public:
  AtomsShown(Atom *_atom, std::vector<int> &groups) : atom(_atom), whole(std::exchange(atom->mask, groups.data())) {}
  ~AtomsShown() { atom->mask = whole; }
  AtomsShown(const AtomsShown &) = delete;
  AtomsShown &operator=(const AtomsShown &) = delete;

 private:
  Atom *atom;
  int *whole;
};

}    // namespace LAMMPS_NS

#endif
