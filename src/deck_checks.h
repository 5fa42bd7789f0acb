/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DECK_CHECKS_H
#define LMP_DECK_CHECKS_H

#include "pointers.h"

#include "core/motion.h"
#include "deck_contacts.h"
#include "deck_fixes.h"

#include <array>
#include <string>
#include <vector>

namespace LAMMPS_NS {

// What looks right and is not: a deck that asks a fix dust/detach for what it cannot do right gets a line. What can be
// told before a run stops it or is a warning then. What a run has to show is noticed by the rank that has the carrier,
// once a run, and said by the first rank, when all ranks are together.

class DeckChecks : protected Pointers {
 public:
  DeckChecks(class LAMMPS *, const class Fix *dust, class DetachSettings &settings);

  // of the fixes that are there, while the fix is made
  void check_order() const { fixes.check_order(); }
  // in init(), on all ranks; settles by which power of its factor stiffen acts
  void before_run();

  // whether an atom with this mask has no acceleration, whatever forces act on it
  bool holds(int mask) const { return fixes.holds(mask); }

  // stops if carrier i has another radius than when it became one
  void check_size(int i, double radius) const;
  // a force, torque or spin that is not a number stops the run
  void check_finite(int i, const Dust::Motion &motion) const
  {
    if (!motion.is_finite()) stop_at(i);
  }
  // stops if any carrier has: where a fix changes sizes, and in the first step of a run, which may have had no init()
  void look_at_sizes(const double *radii) const
  {
    if (sizes_change || is_first_step()) check_all_sizes(radii);
  }

  // how a carrier's collision has been so far, as stiff contacts would have it
  struct Course {
    const double *impulse;    // per mass
    double peak;              // acceleration
    double min_hold;          // pull-off force per grain mass
    double coarsest;          // radius of the grains
  };
  // in a step with contact force in which grains left carrier i
  void grains_left(int i, const double *acceleration, const Course &);
  // in the end of a collision of carrier i: so many steps after it has come the contact is lost; or it lasts, 0 steps
  void collision_over(int i, double steps, const Course &);
  // at the end of a run, of grains that meet: so many have lifted off carrier i in a collision that is not over
  void not_counted(int i, double steps, double grains);

  // whether another fix changes the motion that the contact force gives a carrier: one carrier is watched at a time,
  // over two strong steps
  void watch(int i, double acceleration2, double min_hold)
  {
    if (watched.wants(i) && acceleration2 > min_hold * min_hold) look_at_force(i);
  }
  void step_begins()
  {
    if (watched.stage != Watched::NONE)
      look_at_velocity();
    else
      watched.after = -1;
  }

  // says what any rank has noticed; on all ranks
  void tell();

 private:
  enum Notice { PULLS, FEW_STEPS, SOFT, NOT_FOLLOWED, NOT_COUNTED, NNOTICES };
  static unsigned bit(Notice notice) { return 1u << notice; }

  const Fix *dust;
  DetachSettings &settings;
  DeckFixes fixes;

  bool sizes_change;    // there is a fix that can
  bool is_first_step() const;

  // contacts of the carriers, as they are in this run
  std::vector<CarrierContact> contacts;
  std::vector<std::string> unread;    // further styles with contact forces
  std::string pulling;                // contacts that may pull
  double modulus;                     // E* of two carriers of the material
  double softest;      // factor by which the softest Hertz contact is softer than that and stiffen say, or 1
  std::string soft;    // which it is
  bool soft_wall;      // of a wall
  bool may_be_soft;    // or a Hooke contact, or one that cannot be read

  unsigned noticed, told;    // bits of what this rank has noticed, and of what has been said
  std::array<std::string, NNOTICES> lines;
  void notice(Notice, const std::string &);

  struct Watched {
    enum { NONE, FORCE, VELOCITY, FORCES, NEVER } stage = NONE;    // what is known
    int i;
    tagint tag;
    double mass, dt, force[3], next_force[3], velocity[3];

    int after = -1;    // the last one: then the next in the list has its turn

    bool wants(int carrier) const { return stage == NONE ? carrier > after : stage == VELOCITY && i == carrier; }
  } watched;
  void stop_at(int i) const;
  void watch_none();
  void look_at_force(int i);
  void look_at_velocity();
  bool follows(const double *velocity) const;

  void check_command() const;
  void look_at_contacts();
  void settle_stiffen();
  std::vector<Meets> what_atoms_are() const;
  enum { NOBODY = -1, SEVERAL = -2 };
  bool is_near(int i, int j, double ago) const;
  int neighbour(int i) const;
  bool touched_dust(int i, double coarsest) const;
  bool pulled_by_one(int i) const;
  void check_all_sizes(const double *radii) const;
  struct Softness {
    double factor;
    std::string which, advice;
  };
  Softness soft_contact(int i, double steps, const Course &) const;
  bool bounced(int i, double steps, const double *impulse) const;
};

}    // namespace LAMMPS_NS

#endif
