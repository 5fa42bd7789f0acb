/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "fix_dust_detach.h"

#include "core/tangential_law.h"
#include "dust_atoms.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "group.h"
#include "memory.h"
#include "modify.h"
#include "output.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

using namespace LAMMPS_NS;
using namespace FixConst;

static constexpr double RESTART_FORMAT = 4.0;
static constexpr double NOT_COUNTED = -1.0;    // no number of grains

/* ---------------------------------------------------------------------- */

FixDustDetach::FixDustDetach(LAMMPS *_lmp, int narg, char **arg) :
    Fix(_lmp, narg, arg), settings(lmp, igroup, narg, arg), checks(lmp, this, settings), coats(lmp, this, settings),
    carriers(lmp, settings.rotation, settings.rotation || !settings.same_orientation(),
             settings.by_motion ? CarrierMotion::SIZE : 0, settings.criteria.meet),
    steps(0.0), newcomers(true), motions(lmp), mine{}, shedding(lmp, this, settings.emit), exchange_room(0)
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
  nevery = 1;                               // end_of_step()
  comm_forward = settings.lose_mass;        // of the carriers' masses
  force_reneighbor = settings.emit != 0;    // after a run has ended with new atoms
  next_reneighbor = -1;
  maxexchange = fixed_size() + 1;

  // per-atom data exists before the carriers do: wrong words must stop the run here, where they stand
  FixDustDetach::grow_arrays(atom->nmax);
  for (int i = 0; i < atom->nlocal; i++) FixDustDetach::set_arrays(i);
  adopt();
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
}

int FixDustDetach::setmask()
{
  return INITIAL_INTEGRATE | PRE_EXCHANGE | POST_NEIGHBOR | POST_FORCE | (settings.by_motion ? END_OF_STEP : 0);
}

/* ---------------------------------------------------------------------- */

void FixDustDetach::init()
{
  checks.before_run();
  shedding.check_deck();
  motions.look();

  for (int i = 0; i < atom->nlocal; i++)
    if ((atom->mask[i] & groupbit) && carriers.radius[i] > 0.0 &&
        !DustOptions::same_size(atom->radius[i], carriers.radius[i]))
      error->one(
          FLERR,
          "Fix dust/detach {} has a texture for carriers of diameter {}, but their diameter is now {}: set it before "
          "the fix",
          id, 2.0 * carriers.radius[i], 2.0 * atom->radius[i]);
  adopt();
  if (coats.empty()) {
    bool inserts = false;
    for (const char *other : {"^pour", "^deposit", "^append/atoms", "^gcmc"})
      inserts = inserts || !modify->get_fix_by_style(other).empty();
    if (!inserts)
      error->all(FLERR, "Fix dust/detach group {} has no carriers, and no fix inserts any", group->names[igroup]);
  }
  weigh();
  share_exchange_room();    // commands between runs move atoms, too
}

/* ----------------------------------------------------------------------
   carriers that are in contact at the very start: nothing has counted this force yet. They are at rest unless it can
   make a grain slide. Others have been counted by the run before, or by the one that wrote the restart file.
------------------------------------------------------------------------- */

void FixDustDetach::setup(int /*vflag*/)
{
  const double *const *f = atom->f;
  if (carriers.before) motions.note_middle();    // no motion yet
  for (int i = 0; i < atom->nlocal; i++) {
    if (carriers.before) motions.remember(i, carriers.before[i]);
    if (!(atom->mask[i] & groupbit) || carriers.state[i] != FREE_FLIGHT) continue;
    if (f[i][0] != 0.0 || f[i][1] != 0.0 || f[i][2] != 0.0) {
      carriers.state[i] = AT_REST;
      carriers.began[i] = steps;
      if (!checks.holds(atom->mask[i])) collide(i, motion_of(i));
    } else if (!settings.criteria.meet || !carriers.together[i])    // those that are followed know the spin
      spin_off(i);
  }
  carriers.show_standing();
  if (settings.lose_mass) tell_ghosts();
}

/* ----------------------------------------------------------------------
   atoms have come, gone or changed places
------------------------------------------------------------------------- */

void FixDustDetach::post_neighbor()
{
  int any = newcomers;    // of a size that is new to all ranks, perhaps
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, world);
  if (any) {
    adopt();
    weigh();
  }
  if (collisions.any_taken()) collisions.keep_only(carriers.colliding(collisions.capacity()));
  shedding.drop_lost();
  if (settings.emit) shedding.check_new_ids();
  if (settings.lose_mass) tell_ghosts();
  checks.tell();
}

/* ----------------------------------------------------------------------
   new atoms of the group become carriers with all their grains; on all ranks at once, as their sizes may be new
------------------------------------------------------------------------- */

bool FixDustDetach::is_newcomer(int i) const { return (atom->mask[i] & groupbit) && carriers.state[i] == NO_CARRIER; }

void FixDustDetach::adopt()
{
  std::vector<double> radii;
  for (int i = 0; i < atom->nlocal; i++)
    if (is_newcomer(i)) radii.push_back(settings.carrier_radius(i));
  coats.place(radii);
  maxexchange = fixed_size() + 1 + exchange_room;
  newcomers = false;
  for (int i = 0; i < atom->nlocal; i++)
    if (is_newcomer(i)) adopt(i);
}

void FixDustDetach::adopt(int i)
{
  if (settings.emit && atom->type[i] == settings.emit)
    error->one(FLERR, "Fix dust/detach emit {} is also the type of carrier {}", settings.emit, atom->tag[i]);
  carriers.state[i] = NOT_WEIGHED;
  carriers.radius[i] = atom->radius[i];
  carriers.coat[i] = coats.number_of(atom->radius[i]);
  const Dust::GrainTable &table = table_of(i);
  carriers.attached[i] = table.all_attached();
  array_atom[i][DetachAtom::ATTACHED] = table.grains();
  mine.initial += table.grains();
  mine.initial_weight += table.grains() * coats[carriers.coat[i]].mass;
  if (carriers.orientation) carriers.orientation[i] = settings.orientation(atom->tag[i]);
  if (carriers.before) motions.remember(i, carriers.before[i]);
}

// not yet where the fix is made: a restart file may bring carriers that have lost some already
void FixDustDetach::weigh()
{
  for (int i = 0; i < atom->nlocal; i++) {
    if (carriers.state[i] != NOT_WEIGHED) continue;
    carriers.state[i] = FREE_FLIGHT;
    if (!settings.lose_mass) continue;
    atom->rmass[i] += table_of(i).grains() * table_of(i).mean_mass();
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

/* ---------------------------------------------------------------------- */

// all grains that leave in this step have left
void FixDustDetach::close_step()
{
  if (update->ntimestep == output->next) carriers.show_standing();
  if (rows.is_open() && update->ntimestep % settings.every == 0) close_window();
  if (settings.lose_mass) tell_ghosts();
}

/* ---------------------------------------------------------------------- */

void FixDustDetach::close_window()
{
  carriers.close_window();
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
    if ((atom->mask[i] & groupbit) && carriers.state[i] >= 0) sum += question(collisions[carriers.state[i]], i);
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, world);
  return sum;
}

double FixDustDetach::compute_scalar()
{
  const DetachTotals t = mine.sum(world);
  return t.initial > 0.0 ? t.weight / t.initial_weight : 0.0;
}

double FixDustDetach::compute_vector(int n)
{
  using namespace DetachVector;
  const DetachTotals t = mine.sum(world);
  const double grain_mass = coats.unit_mass();
  const auto met = [this](double so_far, Dust::Mode mode) {
    if (!settings.criteria.count) return NOT_COUNTED;
    return so_far + sum_under_way([=](const Dust::Collision &c, int i) {
             return c.grains_that(mode, table_of(i), carriers.attached[i].data());
           });
  };
  switch (n) {
    case INITIAL_GRAINS: return t.initial;
    case ATTACHED_GRAINS: return attached_grains();
    case NORMAL: return t.modes[Dust::NORMAL];
    case TANGENTIAL: return t.modes[Dust::TANGENTIAL];
    case SOUTH: return t.detached() - compute_vector(NORTH);
    case NORTH:
      if (settings.criteria.meet) return t.north;
      return t.north + sum_under_way([&](const Dust::Collision &c, int i) {
               return c.lost_north(table_of(i), carriers.attached[i].data());    // with the velocity so far
             });
    case DETACHED_MASS: return t.weight * grain_mass;
    case INITIAL_MASS: return t.initial_weight * grain_mass;
    case COLLISIONS: return t.collisions;
    case MET_SLIDING: return met(t.sliding, Dust::SLIDING);
    case MET_ROLLING: return met(t.rolling, Dust::ROLLING);
    case SLIDING: return t.modes[Dust::SLIDING];
    case ROLLING: return t.modes[Dust::ROLLING];
    case KNOCKED: return t.modes[Dust::KNOCKED];
    case FOLLOWED: return followed_carriers();
    default: return t.no_room;
  }
}

double FixDustDetach::attached_grains() const
{
  double sum = carriers.attached_grains(groupbit);
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, world);
  return sum;
}

double FixDustDetach::memory_usage()
{
  return carriers.memory_usage() + collisions.memory_usage() + rows.memory_usage() + shedding.memory_usage();
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
  if (settings.emit) mine.no_room += shedding.emit_grains([this](int i) { return carriers.state[i] < 0; });
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
  for (int i = 0; i < atom->nlocal; i++) {    // of collisions that are not over, too
    if (carriers.state[i] < 0) continue;
    checks.collision_over(i, 0.0, course_of(i));
    if (settings.criteria.meet) checks.not_counted(i, steps - carriers.began[i], lifted(i));
  }
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
  carriers.grow(nmax);
  array_atom = carriers.columns;
}

void FixDustDetach::copy_arrays(int i, int j, int /*delflag*/)
{
  shedding.copy(i, j);
  carriers.copy(i, j);
}

void FixDustDetach::set_arrays(int i)
{
  shedding.set_new(i);
  carriers.clear(i);
  newcomers = true;
}

/* ----------------------------------------------------------------------
   layout: CARRIER, its data, waiting grains, collision; or NO_DATA, NEWCOMER
------------------------------------------------------------------------- */

int FixDustDetach::fixed_size() const { return 2 + carriers.size(coats.max_words()); }

// twice what is needed now, so that Comm need not enlarge its buffers each time
void FixDustDetach::make_exchange_room(int i)
{
  Dust::Packer counter;
  shedding.pack(i, false, counter);
  pack_following(i, counter);
  if (carriers.state[i] >= 0) collisions[carriers.state[i]].pack(counter);
  const int needed = counter.size();
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
  if (carriers.state[i] == NO_CARRIER) {
    to.put(shedding.is_new(i) ? NEWCOMER : NO_DATA);
    return;
  }
  to.put(CARRIER);
  carriers.pack(i, to);
  shedding.pack(i, for_file, to);
  pack_following(i, to);
  if (carriers.state[i] >= 0) collisions[carriers.state[i]].pack(to);
}

void FixDustDetach::unpack(int i, const double *buf)
{
  const bool before = newcomers;
  set_arrays(i);
  Dust::Unpacker from(buf);
  const int kind = static_cast<int>(from.number());
  if (kind != NEWCOMER) shedding.set_seen(i);
  if (kind != CARRIER) return;
  newcomers = before;
  carriers.unpack(i, from);
  if (carriers.coat[i] >= coats.size()) error->one(FLERR, "Fix dust/detach texture is not the one of the restart file");
  rows.open();
  shedding.unpack(i, from);
  unpack_following(i, from);
  if (carriers.state[i] == 0) {
    carriers.state[i] = collisions.take();
    collisions[carriers.state[i]].unpack(from);
  }
  make_exchange_room(i);
}

/* ----------------------------------------------------------------------
   LAMMPS wants the size first
------------------------------------------------------------------------- */

int FixDustDetach::pack_with_size(int i, bool for_file, double *buf) const
{
  Dust::Packer to(buf + 1);
  pack(i, for_file, to);
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
  std::vector<double> list = {RESTART_FORMAT, double(carriers.layout()), double(settings.lose_mass), steps};
  for (double number : coats.numbers_to_keep()) list.push_back(number);
  for (double number : shedding.numbers()) list.push_back(number);
  for (double number : mine.sum(world).numbers()) list.push_back(number);
  if (!rows.save(list, world) && comm->me == 0)
    error->warning(FLERR, "Fix dust/detach {} leaves its local rows out of the restart file: too many", id);
  if (comm->me == 0) {
    const int size = static_cast<int>(list.size() * sizeof(double));
    fwrite(&size, sizeof(int), 1, fp);
    fwrite(list.data(), size, 1, fp);
  }
}

void FixDustDetach::restart(char *buf)
{
  const auto *p = reinterpret_cast<const double *>(buf);
  if (*p++ != RESTART_FORMAT) error->all(FLERR, "Fix dust/detach data of the restart file are of another version");
  const double layout = *p++, lost_mass = *p++;
  steps = *p++;
  const bool any = DustCoats::any_in(p);
  p = coats.restore(p);
  if (any && layout != carriers.layout())
    error->all(FLERR, "Fix dust/detach rotation, orientation, inertia or meet is not that of the restart file");
  if (any && lost_mass != double(settings.lose_mass))
    error->all(FLERR, "Fix dust/detach keyword mass is not that of the restart file: {}",
               lost_mass != 0.0 ? "yes" : "no");
  maxexchange = fixed_size() + 1 + exchange_room;
  shedding.set(p);
  p += DustShedding::SIZE;
  mine = comm->me == 0 ? DetachTotals::from(p) : DetachTotals{};
  p += DetachTotals::SIZE;
  rows.restore(p, comm->me == 0);
  show_rows();
  newcomers = true;
}

void FixDustDetach::unpack_restart(int i, int nth)
{
  const double *buf = atom->extra[i];
  for (int k = 0; k < nth; k++) buf += static_cast<int>(buf[0]);
  unpack(i, buf + 1);
}

int FixDustDetach::maxsize_restart()
{
  int size = fixed_size() + 1;
  for (int i = 0; i < atom->nlocal; i++) size = std::max(size, packed_size(i) + 1);
  MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPI_INT, MPI_MAX, world);
  return size;
}
