/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "deck_checks.h"

#include "core/geometry.h"
#include "core/hertz.h"
#include "core/jkr.h"
#include "detach_settings.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "fix.h"
#include "input.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;

// steps that a contact should have at least: at 8 m/s 50 change the ratio by 0.0003, 20 by 0.003 and 10 by 0.008.
// Softened contacts are for beds, which cannot afford as many, and are right to about 0.01
static constexpr double ENOUGH_STEPS = 50.0, ENOUGH_SOFT_STEPS = 12.0;
static constexpr double SOFTER = 1.05;               // by which a modulus may be too low
static constexpr double MUCH_SOFTER = 2.0;           // in accelerations, where the modulus is not known
static constexpr double NEAR = 1.01;                 // of a distance: atoms that touch
static constexpr double HERTZ = 0.4, HOOKE = 0.5;    // F ~ stiffness^power for the same impact

/* ---------------------------------------------------------------------- */

DeckChecks::DeckChecks(LAMMPS *_lmp, const Fix *_dust, DetachSettings &_settings) :
    Pointers(_lmp), dust(_dust), settings(_settings), fixes(_lmp, _dust, _settings.contacts), sizes_change(false),
    modulus(
        Dust::combined_modulus(_settings.elastic[2], _settings.elastic[3], _settings.elastic[2], _settings.elastic[3])),
    softest(1.0), soft_wall(false), may_be_soft(false), noticed(0), told(0)
{
}

/* ---------------------------------------------------------------------- */

void DeckChecks::before_run()
{
  check_command();
  fixes.check_order();
  fixes.before_run(settings.rotation, settings.by_motion);
  noticed = told = 0;
  watch_none();
  sizes_change = false;
  for (const Fix *fix : modify->get_fix_list()) sizes_change = sizes_change || fix->diam_flag;
  look_at_contacts();
  settle_stiffen();
}

/* ---------------------------------------------------------------------- */

void DeckChecks::check_command() const
{
  const char *style = update->integrate_style;
  if (update->whichflag == 2)
    error->all(FLERR, "Fix dust/detach {} works with run, not with minimize, in which nothing collides: unfix it",
               dust->id);
  if (utils::strmatch(style, "^respa") || utils::strmatch(style, "^verlet/split"))
    error->all(FLERR, "Fix dust/detach works with run_style verlet, not with {}", style);
  // it goes through the snapshots of a dump and makes no step, but its init() is that of a run
  if (input->command && strcmp(input->command, "rerun") == 0)
    error->all(FLERR,
               "Fix dust/detach {} works with run, not with rerun, which gives it the snapshots of a dump in place of "
               "the steps of a collision: unfix it",
               dust->id);
}

/* ----------------------------------------------------------------------
   by type: carriers are those in the group and those that are to be inserted. Grains of this fix are nothing: they come
   and go with the dust, and what they do to carriers is small
------------------------------------------------------------------------- */

std::vector<Meets> DeckChecks::what_atoms_are() const
{
  constexpr int ATOM = static_cast<int>(Meets::ATOM), CARRIER = static_cast<int>(Meets::CARRIER);
  std::vector<int> types(atom->ntypes + 1, 0);
  for (int i = 0; i < atom->nlocal; i++) {
    const bool carrier = atom->mask[i] & dust->groupbit;
    types[atom->type[i]] = std::max(types[atom->type[i]], carrier ? CARRIER : ATOM);
  }
  MPI_Allreduce(MPI_IN_PLACE, types.data(), atom->ntypes + 1, MPI_INT, MPI_MAX, world);
  for (const char *style : {"^pour", "^deposit"})
    for (Fix *fix : modify->get_fix_by_style(style))
      for (int t = 1; t <= atom->ntypes; t++) {
        int type = t;    // in return for which it says the largest radius
        const auto *radius = static_cast<const double *>(fix->extract("radius", type));
        if (radius && *radius > 0.0) types[t] = CARRIER;
      }
  types[settings.emit] = 0;
  std::vector<Meets> atoms;
  atoms.reserve(types.size());
  for (int type : types) atoms.push_back(static_cast<Meets>(type));
  return atoms;
}

/* ---------------------------------------------------------------------- */

void DeckChecks::look_at_contacts()
{
  const DeckContacts deck(lmp, what_atoms_are(), [this](const Fix *fix) { return fixes.acts_on_carriers(fix); });
  if (!deck.wrong.empty()) error->all(FLERR, deck.wrong);
  contacts = deck.all;
  unread = fixes.unread_contacts();
  for (const std::string &style : deck.other_styles) unread.push_back("pair_style " + style);
  pulling.clear();
  softest = 1.0;
  soft_wall = false;
  for (const CarrierContact &contact : contacts) {
    if (contact.pulls)
      pulling += fmt::format("{}{} (damping {})", pulling.empty() ? "" : ", ", contact.where, contact.damping);
    if (contact.law == CarrierContact::HOOKE || contact.stiffness <= 0.0) continue;
    const double factor = modulus / (contact.stiffness * settings.stiffen);
    if (factor <= softest) continue;
    softest = factor;
    soft = contact.where;
    soft_wall = contact.wall;
  }
  may_be_soft = softest > SOFTER || !unread.empty();
  for (const CarrierContact &contact : contacts) may_be_soft = may_be_soft || contact.law == CarrierContact::HOOKE;
  for (const std::string &style : deck.far_styles)
    if (comm->me == 0)
      error->warning(
          FLERR,
          "Fix dust/detach {}: the forces of pair_style {} count as contact forces, at whatever distance they "
          "act",
          dust->id, style);
}

/* ----------------------------------------------------------------------
   by which power it acts; all contacts of carriers must have the same
------------------------------------------------------------------------- */

void DeckChecks::settle_stiffen()
{
  if (settings.stiffen == 1.0) return;
  const CarrierContact *first = nullptr;
  for (const CarrierContact &contact : contacts) {
    if (!contact.not_stiffened.empty())
      error->all(FLERR, "Fix dust/detach {} stiffen: does not hold for {}, which {}", dust->id, contact.where,
                 contact.not_stiffened);
    if (!first) first = &contact;
    if (contact.law != first->law)
      error->all(FLERR, "Fix dust/detach {} stiffen: {} and {} must both be Hertz or both be Hooke contacts", dust->id,
                 first->where, contact.where);
    constexpr double RIGID_WALL = 2.0;    // E* of two bodies of which one is rigid, in that of two alike
    if (contact.law == CarrierContact::HERTZ && contact.stiffness * settings.stiffen > 1.05 * RIGID_WALL * modulus &&
        comm->me == 0)
      error->warning(
          FLERR,
          "Fix dust/detach {}: {} is {:.4g} times softer than the carrier material (keyword elastic), and not "
          "{:.4g} times as stiffen says: inertia is too large",
          dust->id, contact.where, modulus / contact.stiffness, settings.stiffen);
  }
  if (!unread.empty())
    error->all(FLERR,
               "Fix dust/detach {} stiffen: holds for contacts of pair_style granular and surf/granular, fix wall/gran "
               "and fix surface/global, not for those of {}",
               dust->id, unread[0]);
  settings.stiffen_by(first && first->law == CarrierContact::HOOKE ? HOOKE : HERTZ);
}

/* ---------------------------------------------------------------------- */

void DeckChecks::check_size(int i, double radius) const
{
  if (!DustOptions::same_size(atom->radius[i], radius))
    error->one(
        FLERR,
        "Fix dust/detach {} carrier {} has diameter {} now, and {} when its texture was made: the size of carriers "
        "must not change",
        dust->id, atom->tag[i], 2.0 * atom->radius[i], 2.0 * radius);
}

bool DeckChecks::is_first_step() const { return update->ntimestep == update->firststep + 1; }

void DeckChecks::check_all_sizes(const double *radii) const
{
  for (int i = 0; i < atom->nlocal; i++)
    if ((atom->mask[i] & dust->groupbit) && radii[i] > 0.0) check_size(i, radii[i]);
}

/* ---------------------------------------------------------------------- */

void DeckChecks::stop_at(int i) const
{
  error->one(FLERR, "Fix dust/detach {}: force, torque or spin of carrier {} is not finite at step {}", dust->id,
             atom->tag[i], update->ntimestep);
}

// whether two atoms touch, nearly, or did so long ago
bool DeckChecks::is_near(int i, int j, double ago) const
{
  double d[3];
  for (int k = 0; k < 3; k++) d[k] = atom->x[i][k] - atom->x[j][k] - ago * (atom->v[i][k] - atom->v[j][k]);
  const double reach = NEAR * (atom->radius[i] + atom->radius[j]);
  return Dust::dot(d, d) < reach * reach;
}

/* ----------------------------------------------------------------------
   the only atom that carrier i touches; NOBODY if only walls can push it, and then one, or such that are no more than
   90 degrees apart
------------------------------------------------------------------------- */

int DeckChecks::neighbour(int i) const
{
  int found = NOBODY;
  for (int j = 0; j < atom->nlocal + atom->nghost; j++) {
    if (j == i || !is_near(i, j, 0.0)) continue;
    if (found != NOBODY) return SEVERAL;
    found = j;
  }
  return found;
}

// whether what pushes carrier i is one contact; of two atoms it is if each is drawn to the other, or would be by a wall
bool DeckChecks::pulled_by_one(int i) const
{
  const int j = neighbour(i);
  if (j == NOBODY) return true;
  if (j == SEVERAL || j >= atom->nlocal || neighbour(j) != i) return false;
  const double *a = atom->x[i], *b = atom->x[j], d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  return Dust::dot(atom->f[i], d) > 0.0 && Dust::dot(atom->f[j], d) < 0.0;
}

/* ----------------------------------------------------------------------
   A contact that only pushes never acts against the impulse that it has given. One that does, stronger than the
   adhesion, throws off grains on the far side.
------------------------------------------------------------------------- */

void DeckChecks::grains_left(int i, const double *acceleration, const Course &course)
{
  if ((noticed & bit(PULLS)) || (pulling.empty() && unread.empty())) return;
  const double along = Dust::dot(acceleration, course.impulse),
               impulse = std::sqrt(Dust::dot(course.impulse, course.impulse));
  if (along >= -course.min_hold * impulse) return;
  if (pulling.empty() && !pulled_by_one(i)) return;
  const std::string which = pulling.empty() ? utils::join_words(unread, ", ") + "; use contacts that do not"
                                            : pulling + "; use damping coeff_restitution/limited, or limit_damping";
  notice(PULLS,
         fmt::format("a contact force pulls carrier {} back at the end of its rebound, and grains leave for it: {}",
                     atom->tag[i], which));
}

/* ----------------------------------------------------------------------
   steps: with contact, if it is over; 0 if the carrier has come to rest with it
------------------------------------------------------------------------- */

void DeckChecks::collision_over(int i, double steps, const Course &course)
{
  const double enough = settings.stiffen > 1.0 ? ENOUGH_SOFT_STEPS : ENOUGH_STEPS;
  if (!(noticed & bit(FEW_STEPS)) && steps > 0.0 && steps < enough && course.peak > course.min_hold &&
      !touched_dust(i, course.coarsest))
    notice(
        FEW_STEPS,
        fmt::format("carrier {} was in contact for {} steps, too few to follow its collision: use a timestep of {:.2g} "
                    "or less, for {} steps",
                    atom->tag[i], steps, update->dt * steps / enough, enough));
  if ((noticed & bit(SOFT)) || !may_be_soft) return;
  const Softness softness = soft_contact(i, steps, course);
  if (softness.factor <= 1.0 || course.peak * softness.factor <= course.min_hold) return;
  notice(SOFT,
         fmt::format("{} softer than contacts of the carrier material (keyword elastic), and the inertia of carrier {} "
                     "{:.3g} times too small: {}",
                     softness.which, atom->tag[i], softness.factor, softness.advice));
}

// a load that lasts, such as that of an arm that turns, is a collision that never ends
void DeckChecks::not_counted(int i, double steps, double grains)
{
  if ((noticed & bit(NOT_COUNTED)) || grains == 0.0) return;
  notice(NOT_COUNTED,
         fmt::format(
             "{:.0f} grains have lifted off carrier {} in a collision of {:.0f} steps so far: with meet yes they are "
             "counted when it is over; use meet no for a load that lasts",
             grains, atom->tag[i], steps));
}

/* ----------------------------------------------------------------------
   whether what carrier i has just lost contact with is dust: atoms that are no carriers and no larger than its grains,
   and no other atom. The collision with a carrier or a wall is what should be followed.
------------------------------------------------------------------------- */

bool DeckChecks::touched_dust(int i, double coarsest) const
{
  bool dusty = false;
  for (int j = 0; j < atom->nlocal + atom->nghost; j++) {
    if (j == i || !is_near(i, j, update->dt)) continue;
    if ((atom->mask[j] & dust->groupbit) || !(atom->radius[j] < NEAR * coarsest)) return false;
    dusty = true;
  }
  return dusty;
}

/* ----------------------------------------------------------------------
   by which factor the inertia of carrier i would be larger in contacts of its material; its impulse is 1 to 2 times
   its speed
------------------------------------------------------------------------- */

DeckChecks::Softness DeckChecks::soft_contact(int i, double steps, const Course &course) const
{
  constexpr const char *BUT_WALLS = "; a wall that is as soft in truth needs nothing";
  if (softest > SOFTER)
    return {std::pow(softest, HERTZ), fmt::format("{} is {:.4g} times", soft, softest * settings.stiffen),
            fmt::format("give stiffen {:.4g}{}", softest * settings.stiffen, soft_wall ? BUT_WALLS : "")};
  // two alike, or one and a wall
  const double mass = atom->rmass[i], radius = atom->radius[i];
  const double speed = 0.5 * std::sqrt(Dust::dot(course.impulse, course.impulse));
  const auto stiff_peak = [&](double share) {
    return Dust::hertz_peak_force(modulus, share * radius, share * mass, speed / share);
  };
  for (const CarrierContact &contact : contacts) {
    if (contact.law != CarrierContact::HOOKE) continue;
    const double share = contact.wall ? 1.0 : 0.5, peak = speed / share * std::sqrt(contact.stiffness * share * mass);
    const double factor = stiff_peak(share) / (peak * settings.stiffen_acceleration);
    if (factor > MUCH_SOFTER)
      return {factor, contact.where + " is",
              std::string("use a larger stiffness, or stiffen") + (contact.wall ? BUT_WALLS : "")};
  }
  if (!unread.empty() && steps > 0.0 && bounced(i, steps, course.impulse)) {
    const int j = neighbour(i);
    const double factor = stiff_peak(j == NOBODY ? 1.0 : 0.5) / (mass * course.peak);
    if (factor > MUCH_SOFTER && j != SEVERAL)
      return {factor, "contacts of " + utils::join_words(unread, ", ") + " are",
              std::string("use a larger stiffness") + BUT_WALLS};
  }
  return {1.0, "", ""};
}

/* ----------------------------------------------------------------------
   whether one push has turned back carrier i: it came against its impulse, went off along it, and meanwhile has not got
   far across it
------------------------------------------------------------------------- */

bool DeckChecks::bounced(int i, double steps, const double *impulse) const
{
  const double *v = atom->v[i], size2 = Dust::dot(impulse, impulse), along = Dust::dot(v, impulse);
  const double across2 = Dust::dot(v, v) - along * along / size2, time = steps * update->dt;
  return along > 0.0 && along < size2 && across2 * time * time < atom->radius[i] * atom->radius[i];
}

/* ----------------------------------------------------------------------
   The velocity before and after a step, and the contact forces that change it: by the mean of both, or by the second
   if the integrator stands before this fix. Atoms do not change places between the force and the step that follows.
------------------------------------------------------------------------- */

void DeckChecks::watch_none() { watched.stage = (noticed & bit(NOT_FOLLOWED)) ? Watched::NEVER : Watched::NONE; }

void DeckChecks::look_at_force(int i)
{
  const tagint tag = atom->tag ? atom->tag[i] : 0;
  if (watched.stage == Watched::NONE) {
    watched.stage = Watched::FORCE;
    watched.i = watched.after = i;
    watched.tag = tag;
    watched.mass = atom->rmass[i];
    watched.dt = update->dt;
    std::copy_n(atom->f[i], 3, watched.force);
  } else if (watched.stage == Watched::VELOCITY && watched.i == i && watched.tag == tag) {
    watched.stage = Watched::FORCES;
    std::copy_n(atom->f[i], 3, watched.next_force);
  }
}

void DeckChecks::look_at_velocity()
{
  const int i = watched.i;
  const bool same = i < atom->nlocal && watched.tag == (atom->tag ? atom->tag[i] : 0) &&
                    watched.mass == atom->rmass[i] && watched.dt == update->dt;
  if (same && watched.stage == Watched::FORCE) {
    watched.stage = Watched::VELOCITY;
    std::copy_n(atom->v[i], 3, watched.velocity);
    return;
  }
  const bool complete = same && watched.stage == Watched::FORCES;
  watch_none();
  if (!complete || follows(atom->v[i])) return;
  const std::string suspects = fixes.suspects(i);
  notice(NOT_FOLLOWED,
         fmt::format(
             "carrier {} does not move as its contact force says, and what it loses is not right: other fixes hold or "
             "push it{}{}",
             atom->tag[i], suspects.empty() ? "" : ", such as fix ", suspects));
}

bool DeckChecks::follows(const double *velocity) const
{
  constexpr double PART = 0.3;
  const double per = watched.dt / watched.mass, *f = watched.force, *g = watched.next_force;
  double mean2 = 0.0, second2 = 0.0;
  for (int d = 0; d < 3; d++) {
    const double change = velocity[d] - watched.velocity[d];
    const double mean = change - 0.5 * per * (f[d] + g[d]), second = change - per * g[d];
    mean2 += mean * mean;
    second2 += second * second;
  }
  const double largest2 = per * per * std::max(Dust::dot(f, f), Dust::dot(g, g));
  return std::min(mean2, second2) <= PART * PART * largest2;
}

/* ---------------------------------------------------------------------- */

void DeckChecks::notice(Notice what, const std::string &line)
{
  noticed |= bit(what);
  watch_none();
  lines[what] = line;
  if (comm->nprocs == 1) tell();
}

void DeckChecks::tell()
{
  watch_none();
  if (told == bit(NNOTICES) - 1) return;
  unsigned all = noticed & ~told;
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_UNSIGNED, MPI_BOR, world);
  for (int what = 0; what < NNOTICES; what++) {
    const unsigned its = bit(static_cast<Notice>(what));
    if (!(all & its)) continue;
    int who = (noticed & its) ? comm->me : comm->nprocs;
    MPI_Allreduce(MPI_IN_PLACE, &who, 1, MPI_INT, MPI_MIN, world);
    int length = static_cast<int>(lines[what].size());
    MPI_Bcast(&length, 1, MPI_INT, who, world);
    lines[what].resize(length);
    MPI_Bcast(lines[what].data(), length, MPI_CHAR, who, world);
    if (comm->me == 0) error->warning(FLERR, "Fix dust/detach {}: {}", dust->id, lines[what]);
  }
  noticed |= all;
  told |= all;
}
