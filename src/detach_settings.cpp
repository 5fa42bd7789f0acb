/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "detach_settings.h"

#include "atom.h"
#include "domain.h"
#include "error.h"
#include "group.h"

#include <cmath>
#include <utility>

using namespace LAMMPS_NS;

static constexpr double UNSET = -1.0;

/* ---------------------------------------------------------------------- */

DetachSettings::DetachSettings(LAMMPS *_lmp, int igroup, int narg, char **arg) :
    DustOptions(_lmp, "Fix dust/detach"), friction(UNSET), rolling(0.15), damping(UNSET), cohesion(UNSET),
    meet_softening(UNSET), meet_step(UNSET), every(1), keep_rows(true), rotation(true), stiffen(1.0),
    stiffen_acceleration(1.0), stiffen_time(1.0), by_motion(false), lose_mass(false), emit(0), weightless(false)
{
  class_width = 0.05;
  constexpr int FIRST = 3;    // after ID, group and style
  Keywords(lmp, command, narg, arg).read(keywords(), FIRST);
  complete();
  check(igroup);
}

void DetachSettings::stiffen_by(double power)
{
  stiffen_acceleration = std::pow(stiffen, power);
  stiffen_time = 1.0 / stiffen_acceleration;
}

/* ---------------------------------------------------------------------- */

std::vector<Keyword> DetachSettings::keywords()
{
  std::vector<Keyword> table = DustOptions::keywords();
  const std::vector<Keyword> own = {
      {"sizes", [this](Keywords &words) { class_width = words.number(Range::from_to(0.0, 1.0)); }},
      {"friction", [this](Keywords &words) { friction = words.number(Range::at_least(0.0)); }},
      {"rolling", [this](Keywords &words) { rolling = words.number(Range::from_to(0.0, 3.15)); }},
      {"damping", [this](Keywords &words) { damping = words.number(Range::at_least(0.0)); }},
      {"tangential",
       [this](Keywords &words) {
         // in the order of their names
         constexpr decltype(criteria.tangential) LAWS[] = {Dust::Criteria::IMPULSE, Dust::Criteria::ESTIMATE,
                                                           Dust::Criteria::INTEGRATE, Dust::Criteria::FRICTIONLESS,
                                                           Dust::Criteria::OFF};
         criteria.tangential = LAWS[words.one_of({"impulse", "estimate", "integrate", "frictionless", "off"})];
       }},
      {"criteria", [this](Keywords &words) { criteria.ibrahim = words.one_of({"liftoff", "ibrahim"}) == 1; }},
      {"meet", [this](Keywords &words) { criteria.meet = words.yes_or_no(); }},
      {"cohesion", [this](Keywords &words) { cohesion = words.number(Range::above(0.0)); }},
      {"meet_softening", [this](Keywords &words) { meet_softening = words.number(Range::from_to(1.0, 1000.0)); }},
      {"meet_step", [this](Keywords &words) { meet_step = words.number(Range::above(0.0)); }},
      {"counts", [this](Keywords &words) { criteria.count = words.yes_or_no(); }},
      {"every", [this](Keywords &words) { every = words.whole_number(1, MAXSMALLINT); }},
      {"rows", [this](Keywords &words) { keep_rows = words.yes_or_no(); }},
      {"rotation", [this](Keywords &words) { rotation = words.yes_or_no(); }},
      {"stiffen", [this](Keywords &words) { stiffen = words.number(Range::at_least(1.0)); }},
      {"inertia", [this](Keywords &words) { by_motion = words.one_of({"contact", "motion"}) == 1; }},
      {"mass",
       [this](Keywords &words) {
         lose_mass = words.yes_or_no();
         weightless = !lose_mass;
       }},
      {"emit", [this](Keywords &words) { emit = words.whole_number_or("none", 1, atom->ntypes); }},
      {"contact", [this](Keywords &words) { contacts.push_back(words.word("the ID of a fix")); }, true},
  };
  table.insert(table.end(), own.begin(), own.end());
  return table;
}

void DetachSettings::check_meeting()
{
  constexpr double REFERENCE_COHESION = 10.1 / 14.633, REFERENCE_SOFTENING = 100.0;
  if (!criteria.meet) {
    for (const auto &[value, word] : {std::pair(cohesion, "cohesion"), std::pair(meet_softening, "meet_softening"),
                                      std::pair(meet_step, "meet_step")})
      if (value != UNSET) error->all(FLERR, "{} {} needs meet yes: else no grain meets another", command, word);
    return;
  }
  if (criteria.tangential != Dust::Criteria::INTEGRATE)
    error->all(FLERR, "{} meet yes needs tangential integrate: grains that meet are followed", command);
  if (criteria.ibrahim)
    error->all(FLERR, "{} meet yes needs criteria liftoff: grains that only slide or roll have not left", command);
  if (cohesion == UNSET) cohesion = REFERENCE_COHESION;
  if (meet_softening == UNSET) meet_softening = REFERENCE_SOFTENING;
  if (meet_step == UNSET) meet_step = 0.0;
}

/* ----------------------------------------------------------------------
   what goes with what
------------------------------------------------------------------------- */

void DetachSettings::check(int igroup)
{
  if (group->dynamic[igroup])
    error->all(FLERR, "{} group {} is dynamic: carriers are the atoms of a static group", command,
               group->names[igroup]);
  if (friction == UNSET && !reference_units())
    error->all(FLERR, "{} needs keyword friction (it has a default with units si only)", command);
  if (friction == UNSET) friction = 0.3;
  if (rotation && (!atom->omega_flag || !atom->torque_flag))
    error->all(FLERR, "{} rotation yes needs atoms with spin and torque, such as atom_style sphere", command);
  if (damping != UNSET && criteria.tangential != Dust::Criteria::IMPULSE &&
      criteria.tangential != Dust::Criteria::INTEGRATE)
    error->all(FLERR,
               "{} damping needs tangential impulse or integrate: no other law knows how a grain's contact rings",
               command);
  check_meeting();
  if (by_motion && stiffen != 1.0)
    error->all(FLERR, "{} stiffen {} needs inertia contact: a motion does not tell which part contacts have", command,
               stiffen);
  if (!emit) return;
  if (weightless)
    error->all(FLERR, "{} emit {} needs mass yes: grains bring the mass that their carriers lose", command, emit);
  if (igroup == 0)
    error->all(FLERR, "{} emit {} needs a group of carriers without the emitted grains, not group all", command, emit);
  if (domain->triclinic) error->all(FLERR, "{} emit {} needs an orthogonal box", command, emit);
  lose_mass = true;
}
