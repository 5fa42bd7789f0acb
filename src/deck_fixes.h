/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DECK_FIXES_H
#define LMP_DECK_FIXES_H

#include "pointers.h"

#include <functional>
#include <string>
#include <vector>

namespace LAMMPS_NS {

// what the other fixes of a deck do to the carriers of a fix dust/detach, and where they stand beside it

class DeckFixes : protected Pointers {
 public:
  // contacts: IDs of further fixes whose forces are contact forces
  DeckFixes(class LAMMPS *, const class Fix *dust, const std::vector<std::string> &contacts);

  // what stands in the force array when it is the fix's turn must be contact forces, all of them and nothing else
  void check_order() const;
  // warns, on all ranks, of walls that do not count and of carriers that do not move as their contact forces say
  void before_run(bool rotation);

  // whether the atoms with this mask have no acceleration, whatever forces act on them
  bool holds(int mask) const { return (mask & holding) || !(mask & moving); }
  // whether a fix's group has carriers, or is to have them; on all ranks
  bool acts_on_carriers(const class Fix *) const;
  // fixes with contact forces that are no granular walls: "fix w (indent)"
  std::vector<std::string> unread_contacts() const;
  // those that may keep an atom from moving as its contact force says
  std::string suspects(int i) const;

 private:
  const class Fix *dust;
  std::vector<std::string> contacts;
  int holding, moving;    // bits of the groups of fixes that do

  bool is_contact(const class Fix *) const;
  bool changes_force(const Fix *) const;
  void check_contacts() const;
  bigint count(const std::function<bool(int)> &question) const;
  void look_at_walls() const;
  void look_at_motion(bool rotation);
};

}    // namespace LAMMPS_NS

#endif
