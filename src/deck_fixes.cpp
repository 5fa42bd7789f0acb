/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "deck_fixes.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "fix.h"
#include "fix_setforce.h"
#include "modify.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace FixConst;

namespace {

bool is_granular_wall(const Fix *fix)
{
  return utils::strmatch(fix->style, "^wall/gran") || utils::strmatch(fix->style, "^surface/");
}

// turns carriers back by their positions and velocities
bool is_wall_without_force(const Fix *fix)
{
  return utils::strmatch(fix->style, "^wall/reflect") || utils::strmatch(fix->style, "^wall/piston");
}

bool is_wall(const Fix *fix)
{
  return utils::strmatch(fix->style, "^wall/") || utils::strmatch(fix->style, "^indent") ||
         utils::strmatch(fix->style, "^smd/wall_surface");
}

// a fix setforce that makes all of the force zero, everywhere; a class for its members, which have no other way out
class ZeroForce : public FixSetForce {
 public:
  static bool is(const Fix *fix)
  {
    const auto *set = dynamic_cast<const FixSetForce *>(fix);
    if (!set || set->*(&ZeroForce::region)) return false;
    constexpr int NONE = 0;    // leaves this component as it is
    for (auto style : {&ZeroForce::xstyle, &ZeroForce::ystyle, &ZeroForce::zstyle})
      if (set->*style == NONE) return false;
    for (auto variable : {&ZeroForce::xstr, &ZeroForce::ystr, &ZeroForce::zstr})
      if (set->*variable) return false;
    return set->*(&ZeroForce::xvalue) == 0.0 && set->*(&ZeroForce::yvalue) == 0.0 && set->*(&ZeroForce::zvalue) == 0.0;
  }
};

// takes the forces away or moves atoms whatever they are
bool holds_atoms(const Fix *fix)
{
  return utils::strmatch(fix->style, "^freeze") || ZeroForce::is(fix) || utils::strmatch(fix->style, "noforce") ||
         utils::strmatch(fix->style, "^move");
}

// integrates atoms as points
bool leaves_spin_alone(const Fix *fix)
{
  for (const char *style : {"^nve$", "^nve/limit$", "^nvt$", "^npt$", "^nph$", "^nvk$"})
    if (utils::strmatch(fix->style, style)) return true;
  return false;
}

}    // namespace

/* ---------------------------------------------------------------------- */

DeckFixes::DeckFixes(LAMMPS *_lmp, const Fix *_dust, const std::vector<std::string> &_contacts) :
    Pointers(_lmp), dust(_dust), contacts(_contacts), holding(0), moving(~0)
{
}

/* ---------------------------------------------------------------------- */

bool DeckFixes::is_contact(const Fix *fix) const
{
  return is_granular_wall(fix) || std::find(contacts.begin(), contacts.end(), fix->id) != contacts.end();
}

bool DeckFixes::changes_force(const Fix *fix) const
{
  return modify->get_fix_mask(const_cast<Fix *>(fix)) & POST_FORCE;
}

/* ----------------------------------------------------------------------
   the fix itself is not yet in the list while it is made, and after all others then
------------------------------------------------------------------------- */

void DeckFixes::check_order() const
{
  check_contacts();
  bool after = false;
  for (const Fix *other : modify->get_fix_list()) {
    // a fix that is defined again has its place in the list, with nothing there yet
    if (other == dust || !other) after = true;
    if (!other || utils::strmatch(other->style, "^dust/detach") || utils::strmatch(other->style, "^store/force"))
      continue;
    const bool contact = is_contact(other);
    if (contact && after)
      error->all(FLERR,
                 "Fix {0} ({1}) must stand before fix {2} (dust/detach), which needs its contact forces. A fix that is "
                 "there already keeps its place when it is defined again with the same ID and style; or write_restart, "
                 "clear and read_restart, and define fix {0} before fix {2}",
                 other->id, other->style, dust->id);
    if (!contact && !after && changes_force(other))
      error->all(FLERR,
                 "Fix {0} ({1}) must stand after fix {2} (dust/detach), which would take its force for a contact "
                 "force; if it is one, give fix {2} the keyword: contact {0}",
                 other->id, other->style, dust->id);
  }
}

void DeckFixes::check_contacts() const
{
  for (const std::string &id : contacts) {
    const Fix *fix = modify->get_fix_by_id(id);
    if (!fix)
      error->all(FLERR,
                 "Fix dust/detach {} contact {}: there is no fix {}; contact takes the ID of a fix that is defined "
                 "before",
                 dust->id, id, id);
    if (fix == dust || !changes_force(fix))
      error->all(FLERR, "Fix dust/detach {} contact {}: fix {} ({}) has no contact force; use fix wall/gran", dust->id,
                 id, id, fix->style);
  }
}

/* ----------------------------------------------------------------------
   carriers on all ranks for whose mask the answer is yes
------------------------------------------------------------------------- */

bigint DeckFixes::count(const std::function<bool(int)> &question) const
{
  bigint mine = 0, all = 0;
  for (int i = 0; i < atom->nlocal; i++)
    if ((atom->mask[i] & dust->groupbit) && question(atom->mask[i])) mine++;
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  return all;
}

bool DeckFixes::acts_on_carriers(const Fix *fix) const
{
  if (count([](int) { return true; }) == 0) return fix->igroup == 0 || fix->igroup == dust->igroup;
  return count([fix](int mask) { return mask & fix->groupbit; }) > 0;
}

/* ---------------------------------------------------------------------- */

void DeckFixes::before_run(bool rotation)
{
  look_at_walls();
  look_at_motion(rotation);
}

void DeckFixes::look_at_walls() const
{
  for (const Fix *other : modify->get_fix_list()) {
    if (!is_wall(other) || is_contact(other) || !acts_on_carriers(other) || comm->me != 0) continue;
    if (is_wall_without_force(other))
      error->warning(FLERR,
                     "Fix dust/detach {}: fix {} ({}) turns carriers back without a force, so that no dust comes off: "
                     "use fix wall/gran",
                     dust->id, other->id, other->style);
    else
      error
          ->warning(FLERR,
                    "Fix dust/detach {0}: fix {1} ({2}) pushes carriers, but its forces do not count: define it before "
                    "fix {0} and give that the keyword: contact {1}",
                    dust->id, other->id, other->style);
  }
}

/* ----------------------------------------------------------------------
   who moves the carriers, and who keeps them from moving
------------------------------------------------------------------------- */

void DeckFixes::look_at_motion(bool rotation)
{
  holding = moving = 0;
  for (const Fix *other : modify->get_fix_list()) {
    const int bit = other->groupbit;
    if (other->time_integrate) moving |= bit;
    std::string what, so;
    if (holds_atoms(other)) {
      holding |= bit;
      what = "held";
      so = "contact forces do not accelerate them, and they lose nothing";
    } else if (other->rigid_flag) {
      what = "moved in rigid bodies";
      so = "the contact force on one of them is not what accelerates it, and what they lose is not right";
    } else if (rotation && other->time_integrate && leaves_spin_alone(other)) {
      what = "moved without their spin";
      so = "contact torques count, but do not turn them; use fix nve/sphere, or rotation no";
    } else
      continue;
    const bigint carriers = count([bit](int mask) { return mask & bit; });
    if (carriers && comm->me == 0)
      error->warning(FLERR, "Fix dust/detach {}: carriers are {} by fix {} ({}), {} of them: {}", dust->id, what,
                     other->id, other->style, carriers, so);
  }
  const bigint still = count([this](int mask) { return !(mask & moving); });
  if (still && comm->me == 0)
    error->warning(FLERR,
                   "Fix dust/detach {}: carriers are moved by no fix such as nve/sphere, {} of them: contact forces do "
                   "not accelerate them, and they lose nothing",
                   dust->id, still);
}

/* ---------------------------------------------------------------------- */

std::vector<std::string> DeckFixes::unread_contacts() const
{
  std::vector<std::string> list;
  for (const Fix *other : modify->get_fix_list())
    if (is_contact(other) && !utils::strmatch(other->style, "^wall/gran"))
      list.push_back(fmt::format("fix {} ({})", other->id, other->style));
  return list;
}

/* ---------------------------------------------------------------------- */

std::string DeckFixes::suspects(int i) const
{
  std::string list;
  bool after = false;
  for (const Fix *other : modify->get_fix_list()) {
    if (other == dust) after = true;
    if (other == dust || !(atom->mask[i] & other->groupbit)) continue;
    const bool pushes = after && changes_force(other);
    if (!pushes && !other->rigid_flag && !utils::strmatch(other->style, "limit")) continue;
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", other->id, other->style);
  }
  return list;
}
