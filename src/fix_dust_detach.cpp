/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "fix_dust_detach.h"

#include "dust_atoms.h"
#include "dust_gather.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "group.h"
#include "memory.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

using namespace LAMMPS_NS;
using namespace FixConst;

static constexpr double NOT_WEIGHED = -1.0;    // in began: the mass of the grains is not in the carrier's yet

/* ---------------------------------------------------------------------- */

FixDustDetach::FixDustDetach(LAMMPS *lmp, int narg, char **arg) :
    Fix(lmp, narg, arg), settings(lmp, igroup, narg, arg), checks(lmp, this, settings), carrier_radius(0.0),
    texture_checksum(0.0), state(nullptr), attached(nullptr), orientation(nullptr), angle(nullptr),
    window_mass(nullptr), steps(0.0), began(nullptr), newcomers(true), mine{}, shedding(lmp, this, settings.emit),
    exchange_room(0)
{
  collisions.work.locate = settings.keep_rows || settings.lose_mass;
  checks.check_order();    // of what is there already; the rest before a run

  scalar_flag = vector_flag = global_freq = 1;
  size_vector = DetachVector::SIZE;
  extscalar = extvector = 0;
  peratom_flag = peratom_freq = 1;
  size_peratom_cols = DetachAtom::SIZE;
  local_flag = local_freq = 1;
  size_local_rows = 0;
  size_local_cols = DetachRow::SIZE;
  restart_global = restart_peratom = create_attribute = 1;
  maxexchange_dynamic = 1;
  comm_forward = settings.lose_mass;        // of the carriers' masses
  force_reneighbor = settings.emit != 0;    // after a run has ended with new atoms
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
  settings.save(texture);

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
  checks.before_run();
  shedding.check_deck();

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
  if (settings.lose_mass) tell_ghosts();
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
  shedding.drop_lost();
  if (settings.emit) shedding.check_new_ids();
  if (settings.lose_mass) tell_ghosts();
  checks.tell();
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
    array_atom[i][DetachAtom::ATTACHED] = functions->grains();
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
    shedding.mass_changed();
  }
}

/* ----------------------------------------------------------------------
   counts of its own, as the user may reset the number of the step
------------------------------------------------------------------------- */

void FixDustDetach::initial_integrate(int /*vflag*/)
{
  steps += 1.0;
  shedding.pass(update->dt);
  checks.step_begins();
}

/* ----------------------------------------------------------------------
   here f holds contact forces only
------------------------------------------------------------------------- */

void FixDustDetach::post_force(int /*vflag*/)
{
  if (functions) checks.look_at_sizes(carrier_radius);
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
  if (rows.is_open() && update->ntimestep % settings.every == 0) close_window();
  if (settings.lose_mass) tell_ghosts();
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
  if (checks.holds(atom->mask[i])) return;
  const Dust::Motion motion = motion_of(i);
  if (state[i] == AT_REST && !functions->may_move(motion)) return;
  if (state[i] == FREE_FLIGHT) began[i] = steps;
  if (state[i] < 0) begin_collision(i, motion);
  Dust::Collision &collision = collisions[state[i]];
  if (collision.step(*functions, motion, settings.stiffen_time * update->dt, attached[i], collisions.work)) {
    checks.grains_left(i, motion.acceleration, course_of(collision));
    record(i);
  }
  checks.watch(i, Dust::dot(motion.acceleration, motion.acceleration), functions->min_hold());
  const bool grows = !collision.weak() || settings.criteria.tangential == Dust::Criteria::INTEGRATE;
  if (grows) make_exchange_room(i);
  if (collision.at_rest()) finish_collision(i, AT_REST);
}

DeckChecks::Course FixDustDetach::course_of(const Dust::Collision &collision) const
{
  return {collision.impulse(), collision.peak_acceleration(), functions->min_hold()};
}

/* ---------------------------------------------------------------------- */

void FixDustDetach::begin_collision(int i, const Dust::Motion &motion)
{
  checks.check_size(i, carrier_radius);
  state[i] = collisions.take();
  Dust::Quaternion now = orientation ? orientation[i] : Dust::Quaternion();
  if (settings.rotation) now.turn_by(angle[i], 1.0);
  collisions[state[i]].begin(now, motion.spin);
  make_exchange_room(i);
}

/* ---------------------------------------------------------------------- */

void FixDustDetach::finish_collision(int i, int next)
{
  Dust::Collision &collision = collisions[state[i]];
  const Dust::Motion motion = motion_of(i);
  if (collision.end(*functions, motion.spin, attached[i], collisions.work)) record(i);
  array_atom[i][DetachAtom::PEAK_ACCELERATION] = collision.peak_acceleration();
  checks.collision_over(i, next == FREE_FLIGHT ? steps - began[i] : 0.0, course_of(collision));
  mine.collisions += 1.0;
  mine.north += collision.lost_north(*functions, attached[i]);
  mine.sliding += collision.grains_that(Dust::SLIDING, *functions, attached[i]);
  mine.rolling += collision.grains_that(Dust::ROLLING, *functions, attached[i]);
  collisions.give_back(state[i]);
  state[i] = next;
  if (next == FREE_FLIGHT) leave_contact(i);
}

void FixDustDetach::leave_contact(int i)
{
  state[i] = FREE_FLIGHT;
  array_atom[i][DetachAtom::CONTACT_TIME] = (steps - began[i]) * settings.stiffen_time * update->dt;
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
  // v is half a step behind, but not at the start of a run
  const double half_kick = update->setupflag ? 0.0 : 0.5 * update->dt / atom->rmass[i];
  const double *x = atom->x[i], *v = atom->v[i], *f = atom->f[i], *spin = atom->omega[i];
  const double velocity[3] = {v[0] + half_kick * f[0], v[1] + half_kick * f[1], v[2] + half_kick * f[2]};
  double lost = 0.0, lost_mass = 0.0, momentum[3] = {0.0, 0.0, 0.0};
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
      rows.add({double(update->ntimestep), double(atom->tag[i]), number + 1.0, d.mode + 1.0, 2.0 * grain.radius,
                place[0], place[1], place[2], speed[0], speed[1], speed[2]});
    if (!settings.lose_mass) continue;
    const double mass = functions->weight(d.bit) * functions->mean_mass();
    lost_mass += mass;
    for (int k = 0; k < 3; k++) momentum[k] += mass * speed[k];
    if (settings.emit)
      shedding.wait(i, {number + 1.0,
                        mass,
                        grain.radius,
                        shedding.now(),
                        {place[0], place[1], place[2]},
                        {speed[0], speed[1], speed[2]},
                        {spin[0], spin[1], spin[2]}});
  }
  if (settings.lose_mass) shedding.take_off(i, lost_mass, momentum);
  mine.weight += lost;
  array_atom[i][DetachAtom::ATTACHED] -= double(collisions.work.detached.size());
  array_atom[i][DetachAtom::MASS] += lost * functions->mean_mass();
  window_mass[i] += lost * functions->mean_mass();
  collisions.work.detached.clear();
  rows.open();
}

/* ---------------------------------------------------------------------- */

void FixDustDetach::close_window()
{
  for (int i = 0; i < atom->nlocal; i++) {
    array_atom[i][DetachAtom::WINDOW_MASS] = window_mass[i];
    window_mass[i] = 0.0;
  }
  rows.close();
  show_rows();
}

void FixDustDetach::show_rows()
{
  array_local = rows.pointers();
  size_local_rows = rows.size();
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
  const DetachTotals t = mine.sum(world);
  return t.initial > 0.0 ? t.weight / t.initial : 0.0;
}

/* ---------------------------------------------------------------------- */

double FixDustDetach::compute_vector(int n)
{
  using namespace DetachVector;
  const DetachTotals t = mine.sum(world);
  const double grain_mass = functions ? functions->mean_mass() : 0.0;
  const auto met = [this](Dust::Mode mode) {
    return sum_under_way([=](const Dust::Collision &c, int i) { return c.grains_that(mode, *functions, attached[i]); });
  };
  switch (n) {
    case INITIAL_GRAINS: return t.initial;
    case ATTACHED_GRAINS: return attached_grains();
    case NORMAL: return t.modes[Dust::NORMAL];
    case TANGENTIAL: return t.modes[Dust::TANGENTIAL];
    case SOUTH: return t.detached() - compute_vector(NORTH);
    case NORTH:
      return t.north + sum_under_way([&](const Dust::Collision &c, int i) {
               return c.lost_north(*functions, attached[i]);    // with the velocity so far
             });
    case DETACHED_MASS: return t.weight * grain_mass;
    case INITIAL_MASS: return t.initial * grain_mass;
    case COLLISIONS: return t.collisions;
    case MET_SLIDING: return t.sliding + met(Dust::SLIDING);
    case MET_ROLLING: return t.rolling + met(Dust::ROLLING);
    case SLIDING: return t.modes[Dust::SLIDING];
    case ROLLING: return t.modes[Dust::ROLLING];
    default: return t.no_room;
  }
}

double FixDustDetach::attached_grains() const
{
  double sum = 0.0;
  for (int i = 0; i < atom->nlocal; i++)
    if ((atom->mask[i] & groupbit) && state[i] != NO_CARRIER) sum += array_atom[i][DetachAtom::ATTACHED];
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, world);
  return sum;
}

/* ---------------------------------------------------------------------- */

double FixDustDetach::memory_usage()
{
  const double words = functions ? functions->words() : 0;
  const double numbers = words + DetachAtom::SIZE + 2 + orientation_size();
  const double bytes = double(atom->nmax) * (sizeof(int) + numbers * sizeof(double)) + collisions.memory_usage();
  return bytes + rows.memory_usage() + shedding.memory_usage();
}

/* ----------------------------------------------------------------------
   grains become atoms where LAMMPS builds neighbour lists anew, but not at the start of a run: one continued from a
   restart file goes on as the one that wrote it
------------------------------------------------------------------------- */

void FixDustDetach::setup_pre_exchange()
{
  next_reneighbor = -1;
  if (settings.emit) shedding.follow_displaced();
  share_exchange_room();
}

void FixDustDetach::pre_exchange()
{
  if (settings.emit) mine.no_room += shedding.emit_grains([this](int i) { return state[i] < 0; });
  share_exchange_room();
}

// whatever comes between two runs finds all grains as atoms
void FixDustDetach::post_run()
{
  if (settings.emit) {
    mine.no_room += shedding.emit_all();
    next_reneighbor = update->ntimestep + 1;
  }
  if (settings.lose_mass) tell_ghosts();
  share_exchange_room();
  checks.tell();
}

/* ----------------------------------------------------------------------
   pair forces take the masses of ghosts, which LAMMPS sends when neighbour lists are built only
------------------------------------------------------------------------- */

void FixDustDetach::tell_ghosts()
{
  if (shedding.masses_changed()) comm->forward_comm(this);
}

int FixDustDetach::pack_forward_comm(int n, int *list, double *buf, int /*pbc_flag*/, int * /*pbc*/)
{
  for (int k = 0; k < n; k++) buf[k] = atom->rmass[list[k]];
  return n;
}

void FixDustDetach::unpack_forward_comm(int n, int first, double *buf) { std::copy_n(buf, n, atom->rmass + first); }

/* ----------------------------------------------------------------------
   per-atom data
------------------------------------------------------------------------- */

void FixDustDetach::grow_arrays(int nmax)
{
  shedding.grow(nmax);
  memory->grow(state, nmax, "dust/detach:state");
  memory->grow(window_mass, nmax, "dust/detach:window_mass");
  memory->grow(began, nmax, "dust/detach:began");
  memory->grow(array_atom, nmax, DetachAtom::SIZE, "dust/detach:array_atom");
  if (oriented()) memory->grow(orientation, nmax, "dust/detach:orientation");
  if (settings.rotation) memory->grow(angle, nmax, 3, "dust/detach:angle");
  if (functions) memory->grow(attached, nmax, functions->words(), "dust/detach:attached");
}

/* ---------------------------------------------------------------------- */

void FixDustDetach::copy_arrays(int i, int j, int /*delflag*/)
{
  shedding.copy(i, j);
  state[j] = state[i];
  window_mass[j] = window_mass[i];
  began[j] = began[i];
  std::copy_n(array_atom[i], static_cast<int>(DetachAtom::SIZE), array_atom[j]);
  if (orientation) orientation[j] = orientation[i];
  if (angle) std::copy_n(angle[i], 3, angle[j]);
  if (functions) std::copy_n(attached[i], functions->words(), attached[j]);
}

/* ---------------------------------------------------------------------- */

void FixDustDetach::set_arrays(int i)
{
  shedding.set_new(i);
  state[i] = NO_CARRIER;
  window_mass[i] = began[i] = 0.0;
  if (angle) std::fill_n(angle[i], 3, 0.0);
  std::fill_n(array_atom[i], static_cast<int>(DetachAtom::SIZE), 0.0);
  newcomers = true;
}

/* ----------------------------------------------------------------------
   layout: words of a texture, state, columns, mass of the window, first contact, orientation and angle, bits, waiting
   grains, collision; or 0, NEWCOMER
------------------------------------------------------------------------- */

int FixDustDetach::fixed_size() const
{
  return 2 + DetachAtom::SIZE + 2 + 1 + orientation_size() + (functions ? functions->words() : 0);
}

bool FixDustDetach::oriented() const { return settings.rotation || !settings.same_orientation(); }

int FixDustDetach::orientation_size() const { return settings.rotation ? 7 : oriented() ? 4 : 0; }

// twice what is needed now, so that Comm need not enlarge its buffers each time
void FixDustDetach::make_exchange_room(int i)
{
  const int needed = packed_size(i) - fixed_size();
  if (needed <= exchange_room) return;
  exchange_room = 2 * needed;
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
  Dust::Packer counter;
  pack(i, false, counter);
  return counter.size();
}

void FixDustDetach::pack(int i, bool for_file, Dust::Packer &to) const
{
  if (state[i] == NO_CARRIER) {
    to.put(shedding.is_new(i) ? NEWCOMER : 0.0);
    return;
  }
  const int words = functions->words();
  to.put(words);
  to.put(state[i] >= 0 ? 0 : state[i]);
  to.put(array_atom[i], DetachAtom::SIZE);
  to.put(window_mass[i]);
  to.put(began[i]);
  if (orientation) to.put(&orientation[i], 1);
  if (angle) to.put(angle[i], 3);
  to.put(attached[i], words);
  shedding.pack(i, for_file, to);
  if (state[i] >= 0) collisions[state[i]].pack(to);
}

void FixDustDetach::unpack(int i, const double *buf)
{
  set_arrays(i);
  Dust::Unpacker from(buf);
  const int words = static_cast<int>(from.number());
  if (words != NEWCOMER) shedding.set_seen(i);
  if (words <= 0) return;
  if (!functions || words != functions->words())
    error->one(FLERR, "Fix dust/detach texture is not the one of the restart file");
  state[i] = static_cast<int>(from.number());
  from.get(array_atom[i], DetachAtom::SIZE);
  window_mass[i] = from.number();
  began[i] = from.number();
  rows.open();
  if (orientation) from.get(&orientation[i], 1);
  if (angle) from.get(angle[i], 3);
  from.get(attached[i], words);
  shedding.unpack(i, from);
  if (state[i] == 0) {
    state[i] = collisions.take();
    collisions[state[i]].unpack(from);
  }
  make_exchange_room(i);
}

/* ----------------------------------------------------------------------
   LAMMPS wants the size first
------------------------------------------------------------------------- */

int FixDustDetach::pack_exchange(int i, double *buf)
{
  Dust::Packer to(buf + 1);
  pack(i, false, to);
  buf[0] = to.size() + 1;
  return to.size() + 1;
}

int FixDustDetach::pack_restart(int i, double *buf)
{
  Dust::Packer to(buf + 1);
  pack(i, true, to);
  buf[0] = to.size() + 1;
  return to.size() + 1;
}

int FixDustDetach::unpack_exchange(int nlocal, double *buf)
{
  unpack(nlocal, buf + 1);
  return static_cast<int>(buf[0]);
}

/* ----------------------------------------------------------------------
   restart: totals and the rows of two windows; per carrier what a migrating carrier takes along
------------------------------------------------------------------------- */

void FixDustDetach::write_restart(FILE *fp)
{
  std::vector<double> list = {texture_checksum, double(orientation_size()), double(settings.lose_mass), steps};
  for (double number : shedding.numbers()) list.push_back(number);
  for (double number : mine.sum(world).numbers()) list.push_back(number);
  // LAMMPS counts the bytes of a fix's restart data as int
  constexpr double MOST = 2.0e9;
  double bytes = double(rows.present().size() + rows.last().size()) * sizeof(DetachmentRows::Row);
  MPI_Allreduce(MPI_IN_PLACE, &bytes, 1, MPI_DOUBLE, MPI_SUM, world);
  const bool fits = bytes < MOST;
  if (!fits && comm->me == 0)
    error->warning(FLERR, "Fix dust/detach {} leaves its {} local rows out of the restart file: too many", id,
                   bytes / sizeof(DetachmentRows::Row));
  for (const auto *window : {&rows.present(), &rows.last()}) {
    const auto all = fits ? dust_gather(*window, 0, world) : std::vector<DetachmentRows::Row>();
    list.push_back(double(all.size()));
    for (const auto &row : all) list.insert(list.end(), row.begin(), row.end());
  }
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
  shedding.set(p);
  p += DustShedding::SIZE;
  mine = DetachTotals{};
  std::vector<DetachmentRows::Row> present, last;
  if (comm->me == 0) {
    mine = DetachTotals::from(p);
    p += DetachTotals::SIZE;
    for (auto *window : {&present, &last}) {
      window->resize(static_cast<size_t>(*p++));
      std::memcpy(window->data(), p, window->size() * sizeof(DetachmentRows::Row));
      p += window->size() * DetachRow::SIZE;
    }
  }
  rows.set(std::move(present), std::move(last));
  show_rows();
  newcomers = true;
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
