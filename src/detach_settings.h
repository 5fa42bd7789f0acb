/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_DETACH_SETTINGS_H
#define LMP_DUST_DETACH_SETTINGS_H

#include "core/criteria.h"
#include "dust_options.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

// what the input of a fix dust/detach asks for: the grains, and what it has keywords of its own for

class DetachSettings : public DustOptions {
 public:
  // all words of the fix, whose carriers are a group; an error names the word that is wrong
  DetachSettings(class LAMMPS *, int igroup, int narg, char **arg);

  Dust::Criteria criteria;
  double friction, rolling;
  double damping;    // below 0: none, the normal motion is quasi-static
  // of grains that meet: adhesion among them over that to the carrier; numbers of the following, 0: by default
  double cohesion, meet_softening, meet_step;
  int every;    // steps of a window
  bool keep_rows, rotation;
  double stiffen;                               // by which factor the deck's contacts are softer than the real ones
  double stiffen_acceleration, stiffen_time;    // what softened contacts give, times these, is what stiff ones would
  void stiffen_by(double power);    // the acceleration of the same impact goes with this power of the stiffness
  bool by_motion;                   // inertia from how carriers really move, not from contact forces
  bool lose_mass;
  int emit;                             // type of the atoms that detached grains become, or 0
  std::vector<std::string> contacts;    // IDs of fixes whose forces are contact forces, too

 private:
  bool weightless;    // mass no was asked for

  std::vector<Keyword> keywords();
  void check(int igroup);
  void check_meeting();
};

}    // namespace LAMMPS_NS

#endif
