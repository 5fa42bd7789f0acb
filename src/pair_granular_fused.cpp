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

using namespace LAMMPS_NS;
using Dust::ContactBatch;
using Dust::GrainBatch;
using Dust::Vector;

namespace {

Vector difference(const double *a, const double *b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

void add_to(double *sum, const Vector &v)
{
  sum[0] += v.x;
  sum[1] += v.y;
  sum[2] += v.z;
}

Vector three(const double *v) { return {v[0], v[1], v[2]}; }

void put(double *to, const Vector &v)
{
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

// one contact of the list: where it waits
struct Contact {
  ContactLaw *law;
  double *history;
  int i, j, place;
};

}    // namespace

/* ----------------------------------------------------------------------
   no more contacts than fit into a batch: none of them can overflow
------------------------------------------------------------------------- */

struct PairGranularFused::Waiting {
  Dust::HertzBatch hertz;
  GrainBatch grains;
  ContactBatch done;    // of other laws
  Contact contacts[ContactBatch::SIZE];
  int count = 0;

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

PairGranularFused::PairGranularFused(LAMMPS *_lmp) : PairGranular(_lmp), laws_known(false), none_fused(true) {}

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
  PairGranular::init_style();
}

/* ---------------------------------------------------------------------- */

void PairGranularFused::read_laws()
{
  laws.clear();
  for (int m = 0; m < nmodels; m++) laws.emplace_back(models_list[m]);
  none_fused = std::all_of(laws.begin(), laws.end(), [](const auto &law) { return law.kind == ContactLaw::MODEL; });
  laws_known = true;
  if (!waiting && !none_fused) waiting = std::make_unique<Waiting>();
}

/* ----------------------------------------------------------------------
   bodies have their masses from LAMMPS' own loop, which also knows heat; forces between bonded atoms may be scaled
------------------------------------------------------------------------- */

bool PairGranularFused::left_to_parent() const
{
  if (none_fused || !use_history || heat_flag || fix_rigid) return true;
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
  for (int ii = 0; ii < list->inum; ii++) gather(list->ilist[ii]);
  compute_all();
}

/* ----------------------------------------------------------------------
   contacts of an atom with those of its list
------------------------------------------------------------------------- */

void PairGranularFused::gather(int i)
{
  double *const *x = atom->x;
  const double *radius = atom->radius, *special = force->special_lj;
  const int *type = atom->type, *indices = types_indices[type[i]];
  const int *neighbors = list->firstneigh[i], n = list->numneigh[i];
  int *touch = fix_history->firstflag[i];
  double *history = fix_history->firstvalue[i];
  const double xi = x[i][0], yi = x[i][1], zi = x[i][2], radius_i = radius[i];

  for (int jj = 0; jj < n; jj++) {
    const int j = neighbors[jj] & NEIGHMASK;
    if (special[sbmask(neighbors[jj])] == 0.0) continue;
    ContactLaw &law = laws[indices[type[j]]];
    const double dx = xi - x[j][0], dy = yi - x[j][1], dz = zi - x[j][2];
    const double rsq = dx * dx + dy * dy + dz * dz;
    const bool touches =
        law.kind == ContactLaw::MODEL ? model_touches(law, i, j, touch[jj]) : law.touch(rsq, radius_i, radius[j]);
    if (touches) {
      touch[jj] = 1;
      add(law, i, j, rsq, history + size_history * jj);
    } else if (touch[jj]) {    // else its history is 0 already
      touch[jj] = 0;
      std::fill_n(history + size_history * jj, size_history, 0.0);
    }
  }
}

/* ---------------------------------------------------------------------- */

bool PairGranularFused::model_touches(const ContactLaw &law, int i, int j, int touched)
{
  Granular_NS::GranularModel *model = law.model;
  model->xi = atom->x[i];
  model->xj = atom->x[j];
  model->radi = atom->radius[i];
  model->radj = atom->radius[j];
  model->i = i;
  model->j = j;
  model->itype = atom->type[i];
  model->jtype = atom->type[j];
  model->touch = touched;
  return model->check_contact();
}

/* ----------------------------------------------------------------------
   a frozen atom does not move: the mass is the other's
------------------------------------------------------------------------- */

double PairGranularFused::effective_mass(int i, int j) const
{
  const double mi = atom->rmass[i], mj = atom->rmass[j];
  if (atom->mask[j] & freeze_group_bit) return mi;
  if (atom->mask[i] & freeze_group_bit) return mj;
  return mi * mj / (mi + mj);
}

/* ----------------------------------------------------------------------
   a contact to those that wait, with all that its law needs
------------------------------------------------------------------------- */

void PairGranularFused::add(ContactLaw &law, int i, int j, double rsq, double *history)
{
  ContactBatch &batch = waiting->batch(law.kind);
  const int k = batch.count++;
  waiting->contacts[waiting->count++] = {&law, history, i, j, k};

  if (law.kind == ContactLaw::MODEL) {
    compute_model(law, i, j, history, k);
  } else {
    const double *wi = atom->omega[i], *wj = atom->omega[j], ri = atom->radius[i], rj = atom->radius[j];
    batch.dx.set(k, difference(atom->x[i], atom->x[j]));
    batch.rsq[k] = rsq;
    batch.radius_i[k] = ri;
    batch.radius_j[k] = rj;
    batch.velocity.set(k, difference(atom->v[i], atom->v[j]));
    batch.turning.set(k, {ri * wi[0] + rj * wj[0], ri * wi[1] + rj * wj[1], ri * wi[2] + rj * wj[2]});
    batch.mass[k] = effective_mass(i, j);
    batch.half[k] = law.synchronized ? 0.5 * law.model->dt : 0.0;
    batch.synchronized |= law.synchronized;
    batch.damping[k] = law.damping;
    batch.shear_stiffness[k] = law.shear_stiffness;
    batch.shear_damping[k] = law.shear_damping;
    batch.friction[k] = law.friction;
    batch.shear.set(k, three(history + law.shear_place));
    if (law.kind == ContactLaw::HERTZ)
      waiting->hertz.stiffness[k] = law.stiffness;
    else
      add_grain(law, i, j, history + law.neck_place, k);
  }
  if (waiting->count == ContactBatch::SIZE) compute_all();
}

/* ---------------------------------------------------------------------- */

void PairGranularFused::add_grain(const ContactLaw &law, int i, int j, const double *kept, int k)
{
  GrainBatch &batch = waiting->grains;
  batch.spin.set(k, difference(atom->omega[i], atom->omega[j]));
  batch.hamaker[k] = law.adhesion.hamaker;
  batch.z0[k] = law.adhesion.z0;
  batch.range[k] = law.adhesion.range;
  batch.pull_off_force[k] = law.adhesion.pull_off_force;
  batch.equilibrium_radius[k] = law.adhesion.equilibrium_radius;
  batch.breaking_gap[k] = law.adhesion.breaking_gap;
  batch.theta_crit[k] = law.theta_crit;
  batch.neck[k] = kept[0];
  batch.rolling.set(k, three(kept + 1));
  batch.overlap[k] = kept[4];
  batch.coasting[k] = kept[5];
  batch.rate[k] = kept[6];
}

/* ----------------------------------------------------------------------
   by LAMMPS' own functions, after model_touches()
------------------------------------------------------------------------- */

void PairGranularFused::compute_model(const ContactLaw &law, int i, int j, double *history, int k)
{
  Granular_NS::GranularModel *model = law.model;
  model->meff = effective_mass(i, j);
  model->vi = atom->v[i];
  model->vj = atom->v[j];
  model->omegai = atom->omega[i];
  model->omegaj = atom->omega[j];
  model->history = history;
  model->calculate_forces();
  ContactBatch &batch = waiting->done;
  batch.dx.set(k, three(model->dx));
  batch.force.set(k, three(model->forces));
  batch.torque_i.set(k, three(model->torquesi));
  batch.torque_j.set(k, three(model->torquesj));
}

/* ---------------------------------------------------------------------- */

void PairGranularFused::compute_all()
{
  const bool move = update->setupflag == 0;
  const double dt = models_list[0]->dt;
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
   in the order of the list, so that each sum is the parent's
------------------------------------------------------------------------- */

void PairGranularFused::apply_forces()
{
  double **f = atom->f, **torque = atom->torque;
  const int nlocal = atom->nlocal, newton = force->newton_pair;
  for (int m = 0; m < waiting->count; m++) {
    const auto [law, history, i, j, k] = waiting->contacts[m];
    const ContactBatch &batch = waiting->batch(law->kind);
    const Vector on_i = batch.force[k];
    add_to(f[i], on_i);
    add_to(torque[i], batch.torque_i[k]);
    if (newton || j < nlocal) {
      add_to(f[j], -1.0 * on_i);
      add_to(torque[j], batch.torque_j[k]);
    }
    if (evflag)
      ev_tally_xyz(i, j, nlocal, newton, 0.0, 0.0, on_i.x, on_i.y, on_i.z, batch.dx.x[k], batch.dx.y[k], batch.dx.z[k]);
  }
}

/* ---------------------------------------------------------------------- */

double PairGranularFused::memory_usage()
{
  return PairGranular::memory_usage() + (waiting ? double(sizeof(Waiting)) : 0.0);
}
