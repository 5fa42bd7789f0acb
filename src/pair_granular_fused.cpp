/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "pair_granular_fused.h"

#include "contact_law.h"
#include "core/grain_contacts.h"
#include "core/hertz_contacts.h"

#include "atom.h"
#include "error.h"
#include "fix_neigh_history.h"
#include "force.h"
#include "granular_model.h"
#include "neigh_list.h"
#include "update.h"

#include <algorithm>
#include <cstdint>

using namespace LAMMPS_NS;
using Dust::ContactBatch;
using Dust::GrainBatch;
using Dust::Vector;

namespace {

constexpr int AHEAD = 8;    // contacts, of what is fetched from memory before it is needed

Vector at(const double *v, int i = 0) { return {v[3 * i], v[3 * i + 1], v[3 * i + 2]}; }

void put(double *to, const Vector &v)
{
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

}    // namespace

// one contact of the list
struct PairGranularFused::Contact {
  ContactLaw *law;
  double *history;
  int i, j, place;    // in its law's batch
  double rsq;
  Vector dx;
};

/* ----------------------------------------------------------------------
   no more contacts than fit into a batch: none of them can overflow
------------------------------------------------------------------------- */

struct PairGranularFused::Waiting {
  Dust::HertzBatch hertz;
  GrainBatch grains;
  ContactBatch done;    // of other laws
  Contact contacts[ContactBatch::COUNT];
  int count = 0;
  std::int64_t stamp[2][ContactBatch::COUNT] = {};    // of the law whose coefficients stand there

  void clear()
  {
    count = 0;
    hertz.clear();
    grains.clear();
    done.clear();
  }

  ContactBatch &batch(ContactLaw::Kind kind)
  {
    if (kind == ContactLaw::HERTZ) return hertz;
    if (kind == ContactLaw::GRAIN) return grains;
    return done;
  }
};

/* ---------------------------------------------------------------------- */

PairGranularFused::PairGranularFused(LAMMPS *_lmp) :
    PairGranular(_lmp), laws_known(false), none_fused(true), hertz_alone(false), heats(false), laws_made(0),
    size_kept(0)
{
}

PairGranularFused::~PairGranularFused() = default;

/* ---------------------------------------------------------------------- */

void PairGranularFused::coeff(int narg, char **arg)
{
  laws_known = false;
  PairGranular::coeff(narg, arg);
}

void PairGranularFused::init_style()
{
  laws_known = false;
  const bool first = !fix_history;
  PairGranular::init_style();
  const int size = get_size_history();
  if (first) size_kept = size;
  if (size != size_kept)    // LAMMPS would write beyond it, or take one contact's for another's
    error->all(FLERR,
               "Pair granular keeps {} values of each contact since its first run, and now has models with {}: give "
               "their pair_coeff before it, or pair_style none before pair_style granular",
               size_kept, size);
}

void PairGranularFused::reset_dt()
{
  laws_known = false;
  PairGranular::reset_dt();
}

/* ---------------------------------------------------------------------- */

void PairGranularFused::read_laws()
{
  laws.clear();
  for (int m = 0; m < nmodels; m++) laws.emplace_back(models_list[m], ++laws_made);
  none_fused = std::all_of(laws.begin(), laws.end(), [](const auto &law) { return law.kind == ContactLaw::MODEL; });
  hertz_alone = std::all_of(laws.begin(), laws.end(), [](const auto &law) { return law.kind == ContactLaw::HERTZ; });
  heats = std::any_of(laws.begin(), laws.end(), [](const auto &law) { return law.heats(); });
  const int n = atom->ntypes + 1;
  law_of.assign(n * n, nullptr);
  for (int i = 1; i < n; i++)
    for (int j = 1; j < n; j++) {
      const int m = types_indices[i][j];    // nothing, where pair style hybrid has another style
      if (m >= 0 && m < nmodels) law_of[i * n + j] = &laws[m];
    }
  laws_known = true;
  if (waiting || none_fused) return;
  waiting = std::make_unique<Waiting>();
  waiting->hertz.by_inverse = waiting->grains.by_inverse = ContactLaw::cuts_by_inverse();
}

/* ----------------------------------------------------------------------
   bodies have their masses from LAMMPS' own loop, which also knows heat; forces between bonded atoms may be scaled
------------------------------------------------------------------------- */

bool PairGranularFused::left_to_parent() const
{
  if (none_fused || !use_history || heats || fix_rigid) return true;
  return std::any_of(force->special_lj, force->special_lj + 4, [](double s) { return s != 0.0 && s != 1.0; });
}

/* ---------------------------------------------------------------------- */

void PairGranularFused::compute(int eflag, int vflag)
{
  if (!laws_known) read_laws();
  if (left_to_parent()) {
    PairGranular::compute(eflag, vflag);
    return;
  }
  ev_init(eflag, vflag);
  for (int m = 0; m < nmodels; m++) models_list[m]->history_update = update->setupflag == 0;
  if (list->inum) hertz_alone ? gather<true>() : gather<false>();
}

/* ----------------------------------------------------------------------
   Contacts in the order of the list. Which of its pairs touch is as good as random to a processor: so each pair is
   written down, and the next one over it if it does not touch. What changes is rare.
------------------------------------------------------------------------- */

template <bool HERTZ_ALONE> void PairGranularFused::gather()
{
  const double *x = atom->x[0], *radius = atom->radius, *special = force->special_lj;
  const int *type = atom->type, *ilist = list->ilist, *numneigh = list->numneigh, *const *firstneigh = list->firstneigh;
  int *const *firsttouch = fix_history->firstflag;
  double *const *firsthistory = fix_history->firstvalue;
  const int size = get_size_history(), inum = list->inum, ntypes = atom->ntypes;
  waiting->clear();    // an error may have left some
  Contact *contacts = waiting->contacts;
  int m = 0;

  for (int ii = 0; ii < inum; ii++) {
    const int i = ilist[ii], n = numneigh[i], *neighbors = firstneigh[i];
    ContactLaw *const *law_with = law_of.data() + type[i] * (ntypes + 1);
    int *touch = firsttouch[i];
    double *history = firsthistory[i];
    const Vector xi = at(x, i);
    const double radius_i = radius[i];
    for (int jj = 0; jj < n; jj++, history += size) {
      const int j = neighbors[jj] & NEIGHMASK;
      if (j != neighbors[jj] && special[sbmask(neighbors[jj])] == 0.0) continue;
      ContactLaw *law = law_with[type[j]];
      const Vector dx = xi - at(x, j);
      const double rsq = dot(dx, dx), radius_j = radius[j], radii = radius_i + radius_j;
      contacts[m] = {law, history, i, j, 0, rsq, dx};
      bool touches = rsq < radii * radii;
      if (!HERTZ_ALONE && law->kind != ContactLaw::HERTZ)
        touches = law->kind == ContactLaw::GRAIN ? law->grain_touches(rsq, radius_i, radius_j)
                                                 : compute_model(contacts[m], touch[jj]);
      if (touches != bool(touch[jj])) {
        touch[jj] = touches;
        if (!touches) forget(history);    // else it is 0 already
      }
      if (!HERTZ_ALONE && touches) take_place(contacts[m]);
      m += touches;
      if (m == ContactBatch::COUNT) {
        compute_waiting(m);
        m = 0;
      }
    }
  }
  compute_waiting(m);
}

void PairGranularFused::forget(double *history) { std::fill_n(history, get_size_history(), 0.0); }

/* ----------------------------------------------------------------------
   a frozen atom does not move: the mass is the other's
------------------------------------------------------------------------- */

double PairGranularFused::effective_mass(int i, int j) const
{
  const double mi = atom->rmass[i], mj = atom->rmass[j];
  if (freeze_group_bit) {
    if (atom->mask[j] & freeze_group_bit) return mi;
    if (atom->mask[i] & freeze_group_bit) return mj;
  }
  return mi * mj / (mi + mj);
}

/* ----------------------------------------------------------------------
   in the batch of its law, whose coefficients stand there if the last contact had the same
------------------------------------------------------------------------- */

void PairGranularFused::take_place(Contact &contact)
{
  const ContactLaw &law = *contact.law;
  if (law.kind == ContactLaw::MODEL) return;    // has one
  contact.place = waiting->batch(law.kind).count++;
  if (waiting->stamp[law.kind][contact.place] != law.stamp) set_coefficients(law, contact.place);
}

/* ---------------------------------------------------------------------- */

void PairGranularFused::set_coefficients(const ContactLaw &law, int k)
{
  waiting->stamp[law.kind][k] = law.stamp;
  ContactBatch &batch = waiting->batch(law.kind);
  batch.half[k] = law.synchronized ? 0.5 * law.model->dt : 0.0;
  batch.damping[k] = law.damping;
  batch.shear_stiffness[k] = law.shear_stiffness;
  batch.shear_damping[k] = law.shear_damping;
  batch.friction[k] = law.friction;
  if (law.kind == ContactLaw::HERTZ) {
    waiting->hertz.stiffness[k] = law.stiffness;
    return;
  }
  GrainBatch &grains = waiting->grains;
  grains.effective_radius[k] = law.effective_radius;
  grains.theta_crit[k] = law.theta_crit;
  grains.hamaker[k] = law.adhesion.hamaker;
  grains.z0[k] = law.adhesion.z0;
  grains.range[k] = law.adhesion.range;
  grains.pull_off_force[k] = law.adhesion.pull_off_force;
  grains.equilibrium_radius[k] = law.adhesion.equilibrium_radius;
  grains.breaking_gap[k] = law.adhesion.breaking_gap;
}

/* ----------------------------------------------------------------------
   what the laws need of those that wait
------------------------------------------------------------------------- */

void PairGranularFused::complete()
{
  const double *v = atom->v[0], *omega = atom->omega[0], *radius = atom->radius, *rmass = atom->rmass;
  const int count = waiting->count;
  for (int m = 0; m < count; m++) {
    if (m + AHEAD < count) {
      const Contact &later = waiting->contacts[m + AHEAD];
      __builtin_prefetch(v + 3 * later.j);
      __builtin_prefetch(omega + 3 * later.j);
      __builtin_prefetch(rmass + later.j);
      __builtin_prefetch(later.history);
    }
    Contact &contact = waiting->contacts[m];
    const ContactLaw &law = *contact.law;
    if (law.kind == ContactLaw::MODEL) continue;
    const int i = contact.i, j = contact.j;
    const double ri = radius[i], rj = radius[j];
    ContactBatch &batch = waiting->batch(law.kind);
    if (hertz_alone) take_place(contact);
    const int k = contact.place;

    const Vector wi = at(omega, i), wj = at(omega, j);
    batch.dx.set(k, contact.dx);
    batch.rsq[k] = contact.rsq;
    batch.radius_i[k] = ri;
    batch.radius_j[k] = rj;
    batch.velocity.set(k, at(v, i) - at(v, j));
    batch.turning.set(k, ri * wi + rj * wj);
    batch.mass[k] = effective_mass(i, j);
    batch.synchronized |= law.synchronized;
    batch.shear_damped |= law.shear_damping != 0.0;
    batch.shear.set(k, at(contact.history + law.shear_place));
    if (law.kind == ContactLaw::HERTZ) continue;
    GrainBatch &grains = waiting->grains;
    const double *kept = contact.history + law.neck_place;
    grains.spin.set(k, wi - wj);
    grains.neck[k] = kept[0];
    grains.rolling.set(k, at(kept + 1));
    grains.overlap[k] = kept[4];
    grains.coasting[k] = kept[5];
    grains.rate[k] = kept[6];
  }
}

/* ----------------------------------------------------------------------
   a contact that LAMMPS' own functions compute, at once; returns whether it is one
------------------------------------------------------------------------- */

bool PairGranularFused::compute_model(Contact &contact, bool touched)
{
  const int i = contact.i, j = contact.j;
  Granular_NS::GranularModel *model = contact.law->model;
  model->xi = atom->x[i];
  model->xj = atom->x[j];
  model->radi = atom->radius[i];
  model->radj = atom->radius[j];
  model->i = i;
  model->j = j;
  model->itype = atom->type[i];
  model->jtype = atom->type[j];
  model->touch = touched;
  if (!model->check_contact()) return false;

  model->meff = effective_mass(i, j);
  model->vi = atom->v[i];
  model->vj = atom->v[j];
  model->omegai = atom->omega[i];
  model->omegaj = atom->omega[j];
  model->history = contact.history;
  model->calculate_forces();
  ContactBatch &batch = waiting->done;
  const int k = contact.place = batch.count++;
  batch.force.set(k, at(model->forces));
  batch.torque_i.set(k, at(model->torquesi));
  batch.torque_j.set(k, at(model->torquesj));
  return true;
}

/* ---------------------------------------------------------------------- */

void PairGranularFused::compute_waiting(int count)
{
  waiting->count = count;
  if (count == 0) return;
  const bool move = update->setupflag == 0;
  const double dt = waiting->contacts[0].law->model->dt;    // a model that no pair has may have none
  complete();
  if (waiting->hertz.count) Dust::compute_forces(waiting->hertz, dt, move);
  if (waiting->grains.count) Dust::compute_forces(waiting->grains, dt, move);
  keep_history();
  apply_forces();
  waiting->clear();
}

/* ---------------------------------------------------------------------- */

void PairGranularFused::keep_history()
{
  const GrainBatch &grains = waiting->grains;
  for (int m = 0; m < waiting->count; m++) {
    const Contact &contact = waiting->contacts[m];
    const ContactLaw &law = *contact.law;
    const int k = contact.place;
    if (law.kind == ContactLaw::MODEL) continue;
    put(contact.history + law.shear_place, waiting->batch(law.kind).shear[k]);
    if (law.kind == ContactLaw::HERTZ) continue;
    double *kept = contact.history + law.neck_place;
    kept[0] = grains.neck[k];
    put(kept + 1, grains.rolling[k]);
    kept[4] = grains.overlap[k];
    kept[5] = grains.coasting[k];
    kept[6] = grains.rate[k];
    if (grains.events[k] == 0.0) continue;
    const int events = int(grains.events[k]);
    auto &last = law.normal->last_events;
    if (events & GrainBatch::NECK) last.neck = update->ntimestep;
    if (events & GrainBatch::SLIDE) last.slide = update->ntimestep;
    if (events & GrainBatch::ROLL) last.roll = update->ntimestep;
  }
}

/* ----------------------------------------------------------------------
   In the order of the list, so that each sum is the parent's. Contacts of an atom i follow each other, and are none of
   another's j meanwhile.
------------------------------------------------------------------------- */

void PairGranularFused::apply_forces()
{
  double *f = atom->f[0], *torque = atom->torque[0];
  const int nlocal = atom->nlocal, newton = force->newton_pair, count = waiting->count;
  const Contact *contacts = waiting->contacts;
  for (int m = 0; m < count;) {
    const int i = contacts[m].i;
    Vector on_i = at(f, i), turning_i = at(torque, i);
    for (; m < count && contacts[m].i == i; m++) {
      if (m + AHEAD < count) {
        __builtin_prefetch(f + 3 * contacts[m + AHEAD].j, 1);
        __builtin_prefetch(torque + 3 * contacts[m + AHEAD].j, 1);
      }
      const int j = contacts[m].j, k = contacts[m].place;
      const ContactBatch &batch = waiting->batch(contacts[m].law->kind);
      const Vector pushed = batch.force[k], &dx = contacts[m].dx;
      on_i = on_i + pushed;
      turning_i = turning_i + batch.torque_i[k];
      if (newton || j < nlocal) {
        put(f + 3 * j, at(f, j) - pushed);
        put(torque + 3 * j, at(torque, j) + batch.torque_j[k]);
      }
      if (evflag) ev_tally_xyz(i, j, nlocal, newton, 0.0, 0.0, pushed.x, pushed.y, pushed.z, dx.x, dx.y, dx.z);
    }
    put(f + 3 * i, on_i);
    put(torque + 3 * i, turning_i);
  }
}

/* ---------------------------------------------------------------------- */

double PairGranularFused::memory_usage()
{
  return PairGranular::memory_usage() + (waiting ? double(sizeof(Waiting)) : 0.0);
}
