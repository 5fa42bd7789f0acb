/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "fix_dust_detach.h"

#include "core/jkr.h"
#include "dust_atoms.h"
#include "dust_gather.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix_wall_gran.h"
#include "force.h"
#include "gran_sub_mod_normal.h"
#include "granular_model.h"
#include "group.h"
#include "memory.h"
#include "modify.h"
#include "pair_granular.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

using namespace LAMMPS_NS;
using namespace FixConst;

static double distance2(const double *a, const double *b)
{
  const double e[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return Dust::dot(e, e);
}

static constexpr double NOT_WEIGHED = -1.0;    // in began: the mass of the grains is not in the carrier's yet

/* ---------------------------------------------------------------------- */

FixDustDetach::FixDustDetach(LAMMPS *lmp, int narg, char **arg) :
    Fix(lmp, narg, arg), settings(lmp, igroup, narg, arg), carrier_radius(0.0), texture_checksum(0.0), state(nullptr),
    attached(nullptr), orientation(nullptr), angle(nullptr), window_mass(nullptr), steps(0.0), began(nullptr),
    newcomers(true), mine{}, open_windows(0), too_soft(1.0), warned(false), exchange_room(0)
{
  collisions.work.locate = settings.keep_rows || settings.lose_mass;
  check_order();    // of what is there already; the rest before a run

  scalar_flag = vector_flag = global_freq = 1;
  size_vector = 14;
  extscalar = extvector = 0;
  peratom_flag = peratom_freq = 1;
  size_peratom_cols = NCOLUMNS;
  local_flag = local_freq = 1;
  size_local_rows = 0;
  size_local_cols = NROW;
  restart_global = restart_peratom = create_attribute = 1;
  maxexchange_dynamic = 1;
  force_reneighbor = settings.lose_mass;    // carriers get lighter and atoms are created where neighbour lists are new
  next_reneighbor = -1;
  maxexchange = fixed_size() + 1;

  // per-atom data exists before the carriers do: wrong words must stop the run here, where they stand
  grow_arrays(atom->nmax);
  for (int i = 0; i < atom->nlocal; i++) set_arrays(i);
  carrier_radius = settings.carrier_radius(igroup);
  if (carrier_radius > 0.0) build();
  // last, as an error above leaves no fix behind that could be called back
  atom->add_callback(Atom::GROW);
  atom->add_callback(Atom::RESTART);
}

/* ---------------------------------------------------------------------- */

FixDustDetach::~FixDustDetach()
{
  if (modify->get_fix_by_id(id)) {
    atom->delete_callback(id, Atom::GROW);
    atom->delete_callback(id, Atom::RESTART);
  }
  memory->destroy(state);
  memory->destroy(attached);
  memory->destroy(orientation);
  memory->destroy(angle);
  memory->destroy(window_mass);
  memory->destroy(began);
  memory->destroy(array_atom);
}

/* ----------------------------------------------------------------------
   texture and what depends on it; on all ranks at once
------------------------------------------------------------------------- */

void FixDustDetach::build()
{
  texture = settings.texture(carrier_radius);
  const Dust::Material material = {settings.density,  settings.surface_energy, settings.modulus(),
                                   settings.friction, settings.rolling,        settings.damping};
  functions = std::make_unique<Dust::GrainTable>(texture, material, settings.criteria);

  // a number that tells this texture from another one in a restart file
  texture_checksum = 0.0;
  int i = 0;
  for (const Dust::Grain &g : texture.grains)
    texture_checksum += std::cos(++i) * (g.n[0] + 2.0 * g.n[1] + 3.0 * g.n[2] + g.radius / carrier_radius);

  memory->destroy(attached);
  grow_arrays(atom->nmax);
  maxexchange = fixed_size() + 1 + exchange_room;
  adopt();

  if (comm->me == 0) {
    utils::logmesg(
        lmp, "Fix dust/detach {}: {} grains a carrier, mean mass {:.5g}, pull-off acceleration {:.5g} to {:.5g}\n", id,
        functions->grains(), functions->mean_mass(), functions->min_hold(), functions->max_hold());
  }
}

/* ---------------------------------------------------------------------- */

int FixDustDetach::setmask() { return INITIAL_INTEGRATE | PRE_EXCHANGE | POST_NEIGHBOR | POST_FORCE; }

/* ---------------------------------------------------------------------- */

void FixDustDetach::init()
{
  if (utils::strmatch(update->integrate_style, "^respa"))
    error->all(FLERR, "Fix dust/detach works with run_style verlet, not with {}", update->integrate_style);

  check_order();
  look_for_soft_contacts();

  if (functions) {
    const double radius = settings.carrier_radius(igroup);
    if (radius > 0.0 && !DustOptions::same_size(radius, carrier_radius))
      error->all(
          FLERR,
          "Fix dust/detach {} has a texture for carriers of diameter {}, but their diameter is now {}: set it before "
          "the fix",
          id, 2.0 * carrier_radius, 2.0 * radius);
    adopt();
  } else if ((carrier_radius = settings.carrier_radius(igroup)) > 0.0) {
    build();
  } else {
    bool inserts = false;
    for (const char *style : {"^pour", "^deposit", "^append/atoms", "^gcmc"})
      inserts = inserts || !modify->get_fix_by_style(style).empty();
    if (!inserts)
      error->all(FLERR, "Fix dust/detach group {} has no carriers, and no fix inserts any", group->names[igroup]);
  }
  weigh();
}

/* ----------------------------------------------------------------------
   what post_force() finds in f must be contact forces, all of them and nothing else
------------------------------------------------------------------------- */

void FixDustDetach::check_order() const
{
  bool after = false;
  for (const auto &other : modify->get_fix_list()) {
    if (other == this) after = true;
    if (utils::strmatch(other->style, "^dust/detach") || utils::strmatch(other->style, "^store/force")) continue;
    const bool contact = utils::strmatch(other->style, "^wall/gran") || utils::strmatch(other->style, "^surface/");
    if (contact && after)
      error->all(FLERR, "Fix {} ({}) must stand before fix {} (dust/detach), which needs its contact forces", other->id,
                 other->style, id);
    if (!contact && !after && (modify->get_fix_mask(other) & POST_FORCE))
      error->all(FLERR,
                 "Fix {} ({}) must stand after fix {} (dust/detach), which would take its force for a contact "
                 "force",
                 other->id, other->style, id);
  }
}

/* ----------------------------------------------------------------------
   carriers that are in contact at the very start: nothing has counted this force yet. They are at rest unless it can make a
   grain slide. Others have been counted by the run before, or by the one that wrote the restart file.
------------------------------------------------------------------------- */

void FixDustDetach::setup(int /*vflag*/)
{
  const double *const *f = atom->f;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & groupbit) || state[i] != FREE_FLIGHT) continue;
    if (f[i][0] != 0.0 || f[i][1] != 0.0 || f[i][2] != 0.0) {
      state[i] = AT_REST;
      began[i] = steps;
      collide(i);
    } else
      spin_off(i);
  }
}

/* ---------------------------------------------------------------------- */

void FixDustDetach::setup_post_neighbor() { post_neighbor(); }

/* ----------------------------------------------------------------------
   atoms have come, gone or changed places
------------------------------------------------------------------------- */

void FixDustDetach::post_neighbor()
{
  if (!functions && (carrier_radius = settings.carrier_radius(igroup)) > 0.0) build();
  if (newcomers) {
    adopt();
    weigh();
  }
  drop_lost_collisions();
}

/* ----------------------------------------------------------------------
   new atoms of the group become carriers with all their grains
------------------------------------------------------------------------- */

void FixDustDetach::adopt()
{
  if (!functions) return;
  newcomers = false;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & groupbit) || state[i] != NO_CARRIER) continue;
    if (settings.emit && atom->type[i] == settings.emit)
      error->one(FLERR, "Fix dust/detach emit {} is also the type of carrier {}", settings.emit, atom->tag[i]);
    if (!DustOptions::same_size(atom->radius[i], carrier_radius))
      error->one(FLERR, "Fix dust/detach carrier {} has diameter {}, not {} as the others: one texture serves one size",
                 atom->tag[i], 2.0 * atom->radius[i], 2.0 * carrier_radius);
    state[i] = FREE_FLIGHT;
    std::copy(functions->all_attached().begin(), functions->all_attached().end(), attached[i]);
    array_atom[i][ATTACHED] = functions->grains();
    mine.initial += functions->grains();
    if (orientation) orientation[i] = settings.orientation(atom->tag[i]);
    began[i] = NOT_WEIGHED;
  }
}

// not yet where the fix is made: a restart file may bring carriers that have lost some already
void FixDustDetach::weigh()
{
  if (!settings.lose_mass || !functions) return;
  for (int i = 0; i < atom->nlocal; i++) {
    if (state[i] == NO_CARRIER || began[i] != NOT_WEIGHED) continue;
    began[i] = 0.0;
    atom->rmass[i] += functions->grains() * functions->mean_mass();
  }
}

/* ----------------------------------------------------------------------
   counts of its own, as the user may reset the number of the step
------------------------------------------------------------------------- */

void FixDustDetach::initial_integrate(int /*vflag*/) { steps += 1.0; }

/* ----------------------------------------------------------------------
   here f holds contact forces only
------------------------------------------------------------------------- */

void FixDustDetach::post_force(int /*vflag*/)
{
  const int *const mask = atom->mask;
  const int nlocal = atom->nlocal;
  const double *f = nlocal ? atom->f[0] : nullptr;
  const double *const rmass = atom->rmass;
  const bool spins = settings.rotation && nlocal > 0;
  const double *torque = spins ? atom->torque[0] : nullptr, *omega = spins ? atom->omega[0] : nullptr;
  double *turned = spins ? angle[0] : nullptr;
  const double dt = update->dt;
  const int *const states = state;    // does not move in this loop

  const bool busy = collisions.any_taken();

  const auto squared = [](const double *v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; };
  constexpr int BLOCK = 256;    // spins that are asked for twice are still in the cache then
  for (int first = 0; first < nlocal; first += BLOCK) {
    const int last = std::min(first + BLOCK, nlocal);
    if (spins)    // all atoms: it costs less than to ask which are carriers
      for (int d = 3 * first; d < 3 * last; d++) turned[d] += dt * omega[d];
    for (int i = first; i < last; i++, f += 3) {
      // collisions are in no order, and a bed has more of them than a cache: those of atoms to come are fetched now
      constexpr int AHEAD = 24;
      if (busy && i + AHEAD < nlocal && states[i + AHEAD] >= 0) {
        const auto *lines = reinterpret_cast<const char *>(&collisions[states[i + AHEAD]]);
        __builtin_prefetch(lines, 1);
        __builtin_prefetch(lines + 64, 1);
      }
      // any bit of the three but their signs: one branch for what most carriers do in most steps, fly freely
      uint64_t x, y, z;
      std::memcpy(&x, f, sizeof(x));
      std::memcpy(&y, f + 1, sizeof(y));
      std::memcpy(&z, f + 2, sizeof(z));
      const bool touches = (x | y | z) << 1;
      if (!touches && states[i] <= FREE_FLIGHT) continue;
      if (touches && states[i] == AT_REST) {    // what most carriers of a bed do
        const double torque2 = spins ? squared(torque + 3 * i) : 0.0, spin2 = spins ? squared(omega + 3 * i) : 0.0;
        if (!functions->might_move(squared(f), torque2, spin2, settings.stiffen_time * rmass[i])) continue;
      }
      if (!(mask[i] & groupbit) || states[i] == NO_CARRIER) continue;
      if (touches)
        collide(i);
      else if (states[i] >= 0)
        finish_collision(i, FREE_FLIGHT);
      else if (states[i] == AT_REST)
        leave_contact(i);
    }
  }
  if (spins && update->ntimestep % TURN_EVERY == 0) turn();
  if (update->ntimestep % settings.every != 0) return;
  if (open_windows) close_window();
  if (settings.lose_mass) {
    int any = !losses.empty();
    MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, world);
    if (any) next_reneighbor = update->ntimestep + 1;
  }
}

/* ----------------------------------------------------------------------
   angles of a few steps may be summed, as they are small, at steps that depend on nothing else
------------------------------------------------------------------------- */

void FixDustDetach::turn()
{
  for (int i = 0; i < atom->nlocal; i++) {
    if (state[i] != NO_CARRIER) orientation[i].turn_by(angle[i], 1.0);
    std::fill_n(angle[i], 3, 0.0);
  }
}

/* ----------------------------------------------------------------------
   as stiff contacts would move carrier i; its spin is half a step behind
------------------------------------------------------------------------- */

Dust::Motion FixDustDetach::motion_of(int i) const
{
  Dust::Motion motion = {};
  const double per_mass = settings.stiffen_acceleration / atom->rmass[i];
  for (int d = 0; d < 3; d++) motion.acceleration[d] = atom->f[i][d] * per_mass;
  if (!settings.rotation) return motion;
  constexpr double INERTIA = 0.4;    // of a sphere, as in fix nve/sphere
  const double per_inertia = per_mass / (INERTIA * atom->radius[i] * atom->radius[i]);
  for (int d = 0; d < 3; d++) {
    motion.angular_acceleration[d] = atom->torque[i][d] * per_inertia;
    motion.spin[d] = atom->omega[i][d];
  }
  return motion;
}

/* ---------------------------------------------------------------------- */

void FixDustDetach::collide(int i)
{
  const Dust::Motion motion = motion_of(i);
  if (state[i] == AT_REST && !functions->may_move(motion)) return;
  if (state[i] == FREE_FLIGHT) began[i] = steps;
  if (state[i] < 0) begin_collision(i, motion);
  Dust::Collision &collision = collisions[state[i]];
  if (collision.step(*functions, motion, settings.stiffen_time * update->dt, attached[i], collisions.work)) record(i);
  const bool grows = !collision.weak() || settings.criteria.tangential == Dust::Criteria::INTEGRATE;
  if (grows) make_exchange_room(collision);
  if (collision.at_rest()) finish_collision(i, AT_REST);
}

/* ---------------------------------------------------------------------- */

void FixDustDetach::begin_collision(int i, const Dust::Motion &motion)
{
  state[i] = collisions.take();
  Dust::Quaternion now = orientation ? orientation[i] : Dust::Quaternion();
  if (settings.rotation) now.turn_by(angle[i], 1.0);
  collisions[state[i]].begin(now, motion.spin);
  make_exchange_room(collisions[state[i]]);
}

/* ---------------------------------------------------------------------- */

void FixDustDetach::finish_collision(int i, int next)
{
  Dust::Collision &collision = collisions[state[i]];
  const Dust::Motion motion = motion_of(i);
  if (collision.end(*functions, motion.spin, attached[i], collisions.work)) record(i);
  const double peak = collision.peak_acceleration();
  array_atom[i][PEAK_ACCELERATION] = peak;
  mine.collisions += 1.0;
  mine.north += collision.lost_north(*functions, attached[i]);
  mine.sliding += collision.grains_that(Dust::SLIDING, *functions, attached[i]);
  mine.rolling += collision.grains_that(Dust::ROLLING, *functions, attached[i]);
  collisions.give_back(state[i]);
  state[i] = next;
  if (next == FREE_FLIGHT) leave_contact(i);

  if (!warned && peak <= functions->min_hold() && peak * too_soft > functions->min_hold()) {
    warned = true;
    error
        ->warning(FLERR,
                  "Fix dust/detach {}: grains of carrier {} stay only because its contacts are softer than the carrier "
                  "material: see keyword stiffen",
                  id, atom->tag[i]);
  }
}

void FixDustDetach::leave_contact(int i)
{
  state[i] = FREE_FLIGHT;
  array_atom[i][CONTACT_TIME] = (steps - began[i]) * settings.stiffen_time * update->dt;
}

/* ----------------------------------------------------------------------
   a carrier that nothing touches, but that was given too fast a spin
------------------------------------------------------------------------- */

void FixDustDetach::spin_off(int i)
{
  const Dust::Motion motion = motion_of(i);
  if (!functions->may_spin_off(Dust::dot(motion.spin, motion.spin))) return;
  begin_collision(i, motion);
  if (collisions[state[i]].step(*functions, motion, settings.stiffen_time * update->dt, attached[i], collisions.work))
    record(i);
  collisions.give_back(state[i]);
  state[i] = FREE_FLIGHT;
}

/* ----------------------------------------------------------------------
   collisions whose carriers have left this rank or were deleted
------------------------------------------------------------------------- */

void FixDustDetach::drop_lost_collisions()
{
  if (!collisions.any_taken()) return;
  std::vector<bool> taken(collisions.capacity(), false);
  for (int i = 0; i < atom->nlocal; i++)
    if (state[i] >= 0) taken[state[i]] = true;
  collisions.keep_only(taken);
}

/* ----------------------------------------------------------------------
   the grains that have just left carrier i
------------------------------------------------------------------------- */

void FixDustDetach::record(int i)
{
  const double half_kick = 0.5 * update->dt / atom->rmass[i];    // v is half a step behind
  const double *x = atom->x[i], *v = atom->v[i], *f = atom->f[i];
  const double velocity[3] = {v[0] + half_kick * f[0], v[1] + half_kick * f[1], v[2] + half_kick * f[2]};
  double lost = 0.0;
  for (const Dust::Detachment &d : collisions.work.detached) {
    mine.modes[d.mode] += 1.0;
    lost += functions->weight(d.bit);
    if (!collisions.work.locate) continue;
    const int number = functions->grain(d.bit);
    const Dust::Grain &grain = texture.grains[number];
    const double distance = carrier_radius + grain.radius, *n = d.direction, *w = d.velocity;
    const double place[3] = {x[0] + distance * n[0], x[1] + distance * n[1], x[2] + distance * n[2]};
    const double speed[3] = {velocity[0] + w[0], velocity[1] + w[1], velocity[2] + w[2]};
    if (settings.keep_rows)
      events.push_back({double(update->ntimestep), double(atom->tag[i]), number + 1.0, d.mode + 1.0, 2.0 * grain.radius,
                        place[0], place[1], place[2], speed[0], speed[1], speed[2]});
    if (settings.lose_mass) {
      const double *spin = atom->omega[i];
      losses.push_back({double(atom->tag[i]), number + 1.0, functions->weight(d.bit) * functions->mean_mass(),
                        grain.radius, steps, place[0], place[1], place[2], speed[0], speed[1], speed[2], spin[0],
                        spin[1], spin[2]});
    }
  }
  mine.weight += lost;
  array_atom[i][ATTACHED] -= double(collisions.work.detached.size());
  array_atom[i][MASS] += lost * functions->mean_mass();
  window_mass[i] += lost * functions->mean_mass();
  collisions.work.detached.clear();
  open_windows = 2;    // this one, and the next to show that nothing more came
}

/* ---------------------------------------------------------------------- */

void FixDustDetach::close_window()
{
  open_windows--;
  for (int i = 0; i < atom->nlocal; i++) {
    array_atom[i][WINDOW_MASS] = window_mass[i];
    window_mass[i] = 0.0;
  }
  rows.swap(events);
  events.clear();
  show_rows();
}

// hands the rows to LAMMPS; as they are not empty, they are to be replaced by those of the next windows
void FixDustDetach::show_rows()
{
  row_pointers.clear();
  for (auto &row : rows) row_pointers.push_back(row.data());
  array_local = row_pointers.data();
  size_local_rows = static_cast<int>(rows.size());
  if (!rows.empty() || !events.empty()) open_windows = std::max(open_windows, events.empty() ? 1 : 2);
}

/* ---------------------------------------------------------------------- */

FixDustDetach::Sums FixDustDetach::sum_up() const
{
  Sums local = {mine, 0.0}, sums;
  for (int i = 0; i < atom->nlocal; i++)
    if ((atom->mask[i] & groupbit) && state[i] != NO_CARRIER) local.attached += array_atom[i][ATTACHED];
  static_assert(sizeof(Sums) % sizeof(double) == 0, "Sums must hold doubles only");
  MPI_Allreduce(&local, &sums, sizeof(Sums) / sizeof(double), MPI_DOUBLE, MPI_SUM, world);
  return sums;
}

/* ----------------------------------------------------------------------
   sum over all ranks of what each collision under way answers
------------------------------------------------------------------------- */

template <typename Question> double FixDustDetach::sum_under_way(Question question) const
{
  double sum = 0.0;
  for (int i = 0; i < atom->nlocal; i++)
    if ((atom->mask[i] & groupbit) && state[i] >= 0) sum += question(collisions[state[i]], i);
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, world);
  return sum;
}

/* ---------------------------------------------------------------------- */

double FixDustDetach::compute_scalar()
{
  const Sums s = sum_up();
  return s.totals.initial > 0.0 ? s.totals.weight / s.totals.initial : 0.0;
}

/* ---------------------------------------------------------------------- */

double FixDustDetach::compute_vector(int n)
{
  const Sums s = sum_up();
  const Totals &t = s.totals;
  const double grain_mass = functions ? functions->mean_mass() : 0.0;
  const auto met = [this](Dust::Mode mode) {
    return sum_under_way([=](const Dust::Collision &c, int i) { return c.grains_that(mode, *functions, attached[i]); });
  };
  switch (n) {
    case 0: return t.initial;
    case 1: return s.attached;
    case 2: return t.modes[Dust::NORMAL];
    case 3: return t.modes[Dust::TANGENTIAL];
    case 4: return std::accumulate(t.modes, t.modes + Dust::NMODES, 0.0) - compute_vector(5);
    case 5:
      return t.north + sum_under_way([&](const Dust::Collision &c, int i) {
               return c.lost_north(*functions, attached[i]);    // with the velocity so far
             });
    case 6: return t.weight * grain_mass;
    case 7: return t.initial * grain_mass;
    case 8: return t.collisions;
    case 9: return t.sliding + met(Dust::SLIDING);
    case 10: return t.rolling + met(Dust::ROLLING);
    case 11: return t.modes[Dust::SLIDING];
    case 12: return t.modes[Dust::ROLLING];
    default: return t.no_room;
  }
}

/* ---------------------------------------------------------------------- */

double FixDustDetach::memory_usage()
{
  const double words = functions ? functions->words() : 0;
  const double numbers = words + NCOLUMNS + 2 + orientation_size();
  const double bytes = double(atom->nmax) * (sizeof(int) + numbers * sizeof(double)) + collisions.memory_usage();
  return bytes + (events.capacity() + rows.capacity()) * sizeof(rows[0]) + losses.capacity() * sizeof(Loss);
}

/* ----------------------------------------------------------------------
   what has been lost since the last window leaves the carriers' mass, as atoms if asked for
------------------------------------------------------------------------- */

void FixDustDetach::setup_pre_exchange()
{
  share_exchange_room();
  if (settings.lose_mass) shed();
}

void FixDustDetach::pre_exchange()
{
  share_exchange_room();
  if (settings.lose_mass && update->ntimestep == next_reneighbor) shed();
}

void FixDustDetach::shed()
{
  const std::vector<Loss> all = all_losses();
  losses.clear();
  if (all.empty()) return;

  // on which atom of this rank each was
  std::vector<int> carrier(all.size(), -1);
  const auto by_carrier = [](const Loss &a, const Loss &b) { return a[CARRIER] < b[CARRIER]; };
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & groupbit) || state[i] == NO_CARRIER) continue;
    Loss key = {};
    key[CARRIER] = double(atom->tag[i]);
    const auto range = std::equal_range(all.begin(), all.end(), key, by_carrier);
    for (auto loss = range.first; loss != range.second; ++loss) carrier[loss - all.begin()] = i;
  }
  std::vector<char> leaves(all.size(), 0);
  if (settings.emit) {
    find_room(all, carrier, leaves);
    MPI_Allreduce(MPI_IN_PLACE, leaves.data(), static_cast<int>(leaves.size()), MPI_CHAR, MPI_MAX, world);
    share_room(all, leaves);
  }

  for (size_t first = 0, last; first < all.size(); first = last) {
    const int i = carrier[first];
    double mass = 0.0, momentum[3] = {0.0, 0.0, 0.0};    // of what leaves carrier i
    for (last = first; last < all.size() && all[last][CARRIER] == all[first][CARRIER]; last++) {
      if (i >= 0 && settings.emit && !leaves[last]) mine.no_room += 1.0;
      if (settings.emit && !leaves[last]) continue;
      mass += all[last][LOSS_MASS];
      for (int d = 0; d < 3; d++) momentum[d] += all[last][LOSS_MASS] * all[last][LOSS_V + d];
    }
    if (i < 0) continue;
    const double rest = atom->rmass[i] - mass;
    for (int d = 0; d < 3; d++) atom->v[i][d] = (atom->rmass[i] * atom->v[i][d] - momentum[d]) / rest;
    atom->rmass[i] = rest;
  }
  if (!settings.emit) return;
  tagint tag = DustAtoms::highest_tag(lmp);
  DustAtoms atoms(lmp);
  for (size_t k = 0; k < all.size(); k++) {
    if (!leaves[k]) continue;
    double x[3];
    place_of(all[k], x);
    atoms.create(settings.emit, ++tag, x, all[k][LOSS_RADIUS], all[k][LOSS_MASS], &all[k][LOSS_V], &all[k][LOSS_SPIN]);
  }
  atoms.finish();
}

// in free flight since it left, as it leaves its carrier's mass now
void FixDustDetach::place_of(const Loss &loss, double *x) const
{
  const double flight = (steps - loss[LOSS_STEP]) * update->dt;
  for (int d = 0; d < 3; d++) x[d] = loss[LOSS_X + d] + flight * loss[LOSS_V + d];
}

// of all ranks and on all, in an order that does not depend on their number
std::vector<FixDustDetach::Loss> FixDustDetach::all_losses() const
{
  std::vector<Loss> all = dust_gather(losses, ALL_RANKS, world);
  std::sort(all.begin(), all.end());    // by carrier, then by grain
  return all;
}

/* ----------------------------------------------------------------------
   grains of this rank's carriers that would overlap no other atom and lie in the box; walls are not known here
------------------------------------------------------------------------- */

void FixDustDetach::find_room(const std::vector<Loss> &all, const std::vector<int> &carrier,
                              std::vector<char> &leaves) const
{
  // atoms along x, and those that some grain of a carrier could touch
  std::vector<int> along(atom->nlocal + atom->nghost), near;
  std::iota(along.begin(), along.end(), 0);
  std::sort(along.begin(), along.end(), [this](int a, int b) { return atom->x[a][0] < atom->x[b][0]; });
  const double largest = along.empty() ? 0.0 : *std::max_element(atom->radius, atom->radius + along.size());
  for (size_t first = 0, last; first < all.size(); first = last) {
    for (last = first + 1; last < all.size() && carrier[last] == carrier[first]; last++) {
    }
    const int i = carrier[first];
    if (i < 0) continue;

    const double *centre = atom->x[i];
    std::vector<std::array<double, 3>> places(last - first);    // next to the carrier, whose image may have changed
    double reach = 0.0;
    for (size_t k = first; k < last; k++) {
      double x[3], *place = places[k - first].data();
      place_of(all[k], x);
      domain->closest_image(centre, x, place);
      reach = std::max(reach, std::sqrt(distance2(centre, place)) + all[k][LOSS_RADIUS]);
    }
    const auto touches = [&](int j, const double *x, double radius) {
      const double sum = atom->radius[j] + radius;
      return distance2(atom->x[j], x) < sum * sum;
    };
    near.clear();
    const double low = centre[0] - reach - largest, high = centre[0] + reach + largest;
    auto j = std::lower_bound(along.begin(), along.end(), low, [this](int a, double x) { return atom->x[a][0] < x; });
    for (; j != along.end() && atom->x[*j][0] <= high; ++j)
      if (atom->tag[*j] != atom->tag[i] && touches(*j, centre, reach)) near.push_back(*j);

    for (size_t k = first; k < last; k++) {
      const double *x = places[k - first].data();
      const bool room = !DustAtoms::beyond_fixed_border(lmp, x) && std::none_of(near.begin(), near.end(), [&](int j) {
        return touches(j, x, all[k][LOSS_RADIUS]);
      });
      leaves[k] = room;
    }
  }
}

/* ----------------------------------------------------------------------
   of grains that would overlap each other the first stays in the list: the same on all ranks. Neighbours along x.
------------------------------------------------------------------------- */

void FixDustDetach::share_room(const std::vector<Loss> &all, std::vector<char> &leaves) const
{
  struct Place {
    double x[3];
    size_t number;
  };
  std::vector<Place> places;
  double largest = 0.0;
  for (size_t k = 0; k < all.size(); k++) {
    if (!leaves[k]) continue;
    Place place;
    place.number = k;
    place_of(all[k], place.x);
    domain->remap(place.x);
    places.push_back(place);
    largest = std::max(largest, all[k][LOSS_RADIUS]);
  }
  std::sort(places.begin(), places.end(), [](const Place &a, const Place &b) { return a.x[0] < b.x[0]; });
  std::vector<std::pair<size_t, size_t>> pairs;    // that overlap, the first first
  for (size_t a = 0; a < places.size(); a++)
    for (size_t b = a + 1; b < places.size() && places[b].x[0] - places[a].x[0] < 2.0 * largest; b++) {
      const size_t i = places[a].number, j = places[b].number;
      const double sum = all[i][LOSS_RADIUS] + all[j][LOSS_RADIUS];
      if (distance2(places[a].x, places[b].x) < sum * sum) pairs.emplace_back(std::minmax(i, j));
    }
  std::sort(pairs.begin(), pairs.end());
  for (const auto &[first, second] : pairs)
    if (leaves[first]) leaves[second] = 0;
}

/* ----------------------------------------------------------------------
   what stiff contacts of the carriers' material would do, by which factor more than those of the deck as they are taken
------------------------------------------------------------------------- */

void FixDustDetach::look_for_soft_contacts()
{
  too_soft = 1.0;
  warned = false;
  const double modulus =
      Dust::combined_modulus(settings.elastic[2], settings.elastic[3], settings.elastic[2], settings.elastic[3]);
  const auto look = [&](const Granular_NS::GranularModel *model) {
    const Granular_NS::GranSubModNormal *normal = model->normal_model;
    if (!normal->get_material_properties()) return;
    const double E = normal->get_emod(), nu = normal->get_poiss();
    too_soft = std::max(too_soft,
                        std::pow(modulus / Dust::combined_modulus(E, nu, E, nu), 0.4) / settings.stiffen_acceleration);
  };

  std::vector<int> carriers(atom->ntypes + 1, 0);
  for (int i = 0; i < atom->nlocal; i++)
    if (atom->mask[i] & groupbit) carriers[atom->type[i]] = 1;
  MPI_Allreduce(MPI_IN_PLACE, carriers.data(), atom->ntypes + 1, MPI_INT, MPI_MAX, world);
  const auto *pair = dynamic_cast<PairGranular *>(force->pair);
  for (int t = 1; pair && pair->types_indices && t <= atom->ntypes; t++)
    if (carriers[t]) look(pair->models_list[pair->types_indices[t][t]]);
  for (Fix *other : modify->get_fix_list())
    if (const auto *wall = dynamic_cast<FixWallGran *>(other))
      if (wall->model) look(wall->model);
}

/* ----------------------------------------------------------------------
   per-atom data
------------------------------------------------------------------------- */

void FixDustDetach::grow_arrays(int nmax)
{
  memory->grow(state, nmax, "dust/detach:state");
  memory->grow(window_mass, nmax, "dust/detach:window_mass");
  memory->grow(began, nmax, "dust/detach:began");
  memory->grow(array_atom, nmax, NCOLUMNS, "dust/detach:array_atom");
  if (oriented()) memory->grow(orientation, nmax, "dust/detach:orientation");
  if (settings.rotation) memory->grow(angle, nmax, 3, "dust/detach:angle");
  if (functions) memory->grow(attached, nmax, functions->words(), "dust/detach:attached");
}

/* ---------------------------------------------------------------------- */

void FixDustDetach::copy_arrays(int i, int j, int /*delflag*/)
{
  state[j] = state[i];
  window_mass[j] = window_mass[i];
  began[j] = began[i];
  std::copy_n(array_atom[i], static_cast<int>(NCOLUMNS), array_atom[j]);
  if (orientation) orientation[j] = orientation[i];
  if (angle) std::copy_n(angle[i], 3, angle[j]);
  if (functions) std::copy_n(attached[i], functions->words(), attached[j]);
}

/* ---------------------------------------------------------------------- */

void FixDustDetach::set_arrays(int i)
{
  state[i] = NO_CARRIER;
  window_mass[i] = began[i] = 0.0;
  if (angle) std::fill_n(angle[i], 3, 0.0);
  std::fill_n(array_atom[i], static_cast<int>(NCOLUMNS), 0.0);
  newcomers = true;
}

/* ----------------------------------------------------------------------
   layout: words of a texture or 0, state, columns, mass of the window, first contact, orientation and angle, bits,
   collision
------------------------------------------------------------------------- */

int FixDustDetach::fixed_size() const
{
  return 2 + NCOLUMNS + 2 + orientation_size() + (functions ? functions->words() : 0);
}

bool FixDustDetach::oriented() const { return settings.rotation || !settings.same_orientation(); }

int FixDustDetach::orientation_size() const { return settings.rotation ? 7 : oriented() ? 4 : 0; }

// twice what is needed now, so that Comm need not enlarge its buffers each time
void FixDustDetach::make_exchange_room(const Dust::Collision &collision)
{
  if (collision.packed_size() <= exchange_room) return;
  exchange_room = 2 * collision.packed_size();
  maxexchange = fixed_size() + 1 + exchange_room;
}

// the same on all ranks: one may take in a carrier along x and hand it on along y in the same exchange
void FixDustDetach::share_exchange_room()
{
  MPI_Allreduce(MPI_IN_PLACE, &exchange_room, 1, MPI_INT, MPI_MAX, world);
  maxexchange = fixed_size() + 1 + exchange_room;
}

int FixDustDetach::packed_size(int i) const
{
  if (state[i] == NO_CARRIER) return 1;
  return fixed_size() + (state[i] >= 0 ? collisions[state[i]].packed_size() : 0);
}

int FixDustDetach::pack(int i, double *buf) const
{
  if (state[i] == NO_CARRIER) {
    buf[0] = 0.0;
    return 1;
  }
  const int words = functions->words();
  double *p = buf;
  *p++ = words;
  *p++ = state[i] >= 0 ? 0 : state[i];
  p = std::copy_n(array_atom[i], static_cast<int>(NCOLUMNS), p);
  *p++ = window_mass[i];
  *p++ = began[i];
  if (orientation) p = std::copy_n(orientation[i].q, 4, p);
  if (angle) p = std::copy_n(angle[i], 3, p);
  std::memcpy(p, attached[i], words * sizeof(uint64_t));
  p += words;
  if (state[i] >= 0) {
    Dust::Packer packer(p);
    collisions[state[i]].pack(packer);
    p += packer.size();
  }
  return static_cast<int>(p - buf);
}

void FixDustDetach::unpack(int i, const double *buf)
{
  set_arrays(i);
  const double *p = buf;
  const int words = static_cast<int>(*p++);
  if (words == 0) return;
  if (!functions || words != functions->words())
    error->one(FLERR, "Fix dust/detach texture is not the one of the restart file");
  state[i] = static_cast<int>(*p++);
  std::copy_n(p, static_cast<int>(NCOLUMNS), array_atom[i]);
  p += NCOLUMNS;
  window_mass[i] = *p++;
  began[i] = *p++;
  open_windows = 2;
  if (orientation) std::copy_n(p, 4, orientation[i].q);
  if (angle) std::copy_n(p + 4, 3, angle[i]);
  p += orientation_size();
  std::memcpy(attached[i], p, words * sizeof(uint64_t));
  p += words;
  if (state[i] == 0) {
    state[i] = collisions.take();
    Dust::Unpacker unpacker(p);
    collisions[state[i]].unpack(unpacker);
    make_exchange_room(collisions[state[i]]);
  }
}

/* ---------------------------------------------------------------------- */

int FixDustDetach::pack_exchange(int i, double *buf)
{
  buf[0] = packed_size(i) + 1;
  return pack(i, buf + 1) + 1;
}

int FixDustDetach::unpack_exchange(int nlocal, double *buf)
{
  unpack(nlocal, buf + 1);
  return static_cast<int>(buf[0]);
}

/* ----------------------------------------------------------------------
   restart: totals, the rows of two windows and losses; per carrier what a migrating carrier takes along
------------------------------------------------------------------------- */

void FixDustDetach::write_restart(FILE *fp)
{
  std::vector<double> list = {texture_checksum, double(orientation_size()), double(settings.lose_mass), steps};
  Totals total;
  MPI_Reduce(&mine, &total, sizeof(Totals) / sizeof(double), MPI_DOUBLE, MPI_SUM, 0, world);
  const auto *p = reinterpret_cast<const double *>(&total);
  list.insert(list.end(), p, p + sizeof(Totals) / sizeof(double));
  // LAMMPS counts the bytes of a fix's restart data as int
  constexpr double MOST = 2.0e9;
  double bytes[2] = {double(events.size() + rows.size()) * sizeof(Row), double(losses.size()) * sizeof(Loss)};
  MPI_Allreduce(MPI_IN_PLACE, bytes, 2, MPI_DOUBLE, MPI_SUM, world);
  if (bytes[1] > MOST)
    error->all(
        FLERR,
        "Fix dust/detach {}: a restart file cannot hold the {} grains that are to leave their carriers' mass: use a "
        "smaller every",
        id, bytes[1] / sizeof(Loss));
  const bool fits = bytes[0] + bytes[1] < MOST;
  if (!fits && comm->me == 0)
    error->warning(FLERR, "Fix dust/detach {} leaves its {} local rows out of the restart file: too many", id,
                   bytes[0] / sizeof(Row));
  const auto append = [&list](const auto &records) {
    list.push_back(double(records.size()));
    for (const auto &record : records) list.insert(list.end(), record.begin(), record.end());
  };
  for (const auto *window : {&events, &rows}) append(fits ? dust_gather(*window, 0, world) : std::vector<Row>());
  append(all_losses());
  if (comm->me == 0) {
    const int size = static_cast<int>(list.size() * sizeof(double));
    fwrite(&size, sizeof(int), 1, fp);
    fwrite(list.data(), size, 1, fp);
  }
}

void FixDustDetach::restart(char *buf)
{
  const auto *p = reinterpret_cast<const double *>(buf);
  const double checksum = *p++;
  if (checksum != 0.0 && functions && std::fabs(checksum - texture_checksum) > 1.0e-9 * (1.0 + std::fabs(checksum)))
    error->all(FLERR, "Fix dust/detach texture is not the one of the restart file");
  if (checksum != 0.0 && *p != orientation_size())
    error->all(FLERR, "Fix dust/detach rotation or orientation is not that of the restart file");
  p++;
  if (checksum != 0.0 && *p != double(settings.lose_mass))
    error->all(FLERR, "Fix dust/detach keyword mass is not that of the restart file: {}", *p != 0.0 ? "yes" : "no");
  p++;
  steps = *p++;
  mine = Totals{};
  events.clear();
  rows.clear();
  losses.clear();
  if (comm->me == 0) {
    std::memcpy(&mine, p, sizeof(Totals));
    p += sizeof(Totals) / sizeof(double);
    const auto take = [&p](auto &records) {
      records.resize(static_cast<size_t>(*p++));
      std::memcpy(records.data(), p, records.size() * sizeof(records[0]));
      p += records.size() * sizeof(records[0]) / sizeof(double);
    };
    for (auto *window : {&events, &rows}) take(*window);
    take(losses);
  }
  show_rows();
  newcomers = true;
}

int FixDustDetach::pack_restart(int i, double *buf)
{
  return pack_exchange(i, buf);    // LAMMPS wants the size first, too
}

void FixDustDetach::unpack_restart(int i, int nth)
{
  const double *buf = atom->extra[i];
  for (int k = 0; k < nth; k++) buf += static_cast<int>(buf[0]);
  unpack(i, buf + 1);
}

int FixDustDetach::size_restart(int i) { return packed_size(i) + 1; }

int FixDustDetach::maxsize_restart()
{
  int size = fixed_size() + 1;
  for (int i = 0; i < atom->nlocal; i++) size = std::max(size, packed_size(i) + 1);
  MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPI_INT, MPI_MAX, world);
  return size;
}
