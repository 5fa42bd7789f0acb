/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "pair_granular_fused.h"

#include "contact_queue.h"

#include "atom.h"
#include "error.h"
#include "fix_neigh_history.h"
#include "force.h"
#include "granular_model.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>

using namespace LAMMPS_NS;
using Dust::at;
using Dust::put;
using Dust::Vector;


/* ---------------------------------------------------------------------- */

PairGranularFused::PairGranularFused(LAMMPS *_lmp) :
    PairGranular(_lmp), laws_known(false), none_fused(true), hertz_alone(false), heats(false), size_kept(0),
    margin(0.1), gap(0.0), found_at(0), close_known(false)
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
  if (first) size_kept = get_size_history();
}

void PairGranularFused::reset_dt()
{
  laws_known = false;
  PairGranular::reset_dt();
}

/* ---------------------------------------------------------------------- */

void PairGranularFused::read_laws()
{
  // LAMMPS would write beyond it, or take one contact's for another's; said here, when no list is asked for any more
  if (get_size_history() != size_kept)
    error->all(FLERR,
               "Pair granular keeps {} values of each contact since its first run, and now has models with {}: give "
               "their pair_coeff before it, or pair_style none before pair_style granular",
               size_kept, get_size_history());
  laws.clear();
  for (int m = 0; m < nmodels; m++) laws.emplace_back(models_list[m], m + 1);
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
  close_known = false;
  if (!none_fused) queue = std::make_unique<ContactQueue>(laws);
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
    close_known = false;    // LAMMPS has changed which of them touch
    return;
  }
  ev_init(eflag, vflag);
  for (int m = 0; m < nmodels; m++) models_list[m]->history_update = update->setupflag == 0;
  if (list->inum == 0) return;
  if (!still_close()) find_close();
  queue->clear();    // an error may have left some
  hertz_alone ? gather<true>() : gather<false>();
}

/* ----------------------------------------------------------------------
   Another type has another law, with another reach and another adhesion. Atoms are counted as the list has them: LAMMPS
   may have forgotten how many ghosts there are, as when atoms are displaced, and still goes on with them.
------------------------------------------------------------------------- */

bool PairGranularFused::still_close() const
{
  constexpr double HALF = 0.5 * (1.0 - 1.0e-6);    // of two atoms; less what rounding may add
  const int listed = static_cast<int>(types_then.size());
  return close_known && neighbor->ago != 0 && !then.left(atom->x[0], atom->radius, listed, HALF * gap) &&
         std::equal(types_then.begin(), types_then.end(), atom->type);
}

/* ----------------------------------------------------------------------
   the margin, in skins: wide enough for the pairs to last, and no wider, as each that does not touch costs time
------------------------------------------------------------------------- */

void PairGranularFused::adapt_margin()
{
  constexpr int SOON = 10, LATE = 40;    // steps
  constexpr double NARROW = 0.02, WIDE = 0.5;
  const bigint lasted = update->ntimestep - found_at;
  if (lasted < SOON && neighbor->ago != 0) margin = std::min(2.0 * margin, WIDE);
  if (lasted > LATE) margin = std::max(0.5 * margin, NARROW);
  found_at = update->ntimestep;
}

/* ----------------------------------------------------------------------
   Of each pair of the list, where its history stands. What touches is close even if it has been moved far away: its
   history is to be forgotten.
------------------------------------------------------------------------- */

void PairGranularFused::find_close()
{
  const double *x = atom->x[0], *radius = atom->radius, *special = force->special_lj;
  const int *type = atom->type, ntypes = atom->ntypes, size = get_size_history();
  adapt_margin();
  gap = margin * neighbor->skin;
  close.clear();
  int listed = 0;
  for (int ii = 0; ii < list->inum; ii++) {
    const int i = list->ilist[ii], *neighbors = list->firstneigh[i], *touch = fix_history->firstflag[i];
    double *history = fix_history->firstvalue[i];
    listed = std::max(listed, i + 1);
    for (int jj = 0; jj < list->numneigh[i]; jj++, history += size) {
      if (special[sbmask(neighbors[jj])] == 0.0) continue;
      const int j = neighbors[jj] & NEIGHMASK;
      listed = std::max(listed, j + 1);
      ContactLaw *law = law_of[type[i] * (ntypes + 1) + type[j]];
      const Vector dx = at(x, i) - at(x, j);
      if (touch[jj] || !law->ends() || law->touches(dot(dx, dx), radius[i], radius[j], gap))
        close.push_back({history, i, j, touch[jj]});
    }
  }
  adhesions.assign(hertz_alone ? 0 : close.size(), {});
  then.note(x, radius, listed);
  types_then.assign(type, type + listed);
  close_known = true;
}

/* ---------------------------------------------------------------------- */

void PairGranularFused::change(ClosePair &pair, bool touches)
{
  const int size = get_size_history();
  fix_history->firstflag[pair.i][(pair.history - fix_history->firstvalue[pair.i]) / size] = pair.touches = touches;
  if (!touches) std::fill_n(pair.history, size, 0.0);    // else it is 0 already
}

/* ---------------------------------------------------------------------- */

template <bool HERTZ_ALONE> void PairGranularFused::gather()
{
  const double *x = atom->x[0], *radius = atom->radius;
  const int *type = atom->type, ntypes = atom->ntypes;
  ContactLaw *only = laws.size() == 1 ? laws.data() : nullptr;
  for (ClosePair &pair : close) {
    const int i = pair.i, j = pair.j;
    ContactLaw *law = only ? only : law_of[type[i] * (ntypes + 1) + type[j]];
    bool touches;
    if (!HERTZ_ALONE && law->kind == ContactLaw::MODEL) {
      touches = compute_model(pair, law);
    } else {
      const Vector dx = at(x, i) - at(x, j);
      const double rsq = dot(dx, dx), radius_i = radius[i], radius_j = radius[j];
      const bool of_last = HERTZ_ALONE || law->kind == ContactLaw::HERTZ || law->adhesion.is_of(radius_i, radius_j);
      touches = of_last ? law->touches(rsq, radius_i, radius_j) : grains_touch(law, pair, rsq, radius_i, radius_j);
      if (touches) queue->add(law, pair.history, i, j);
    }
    if (touches != bool(pair.touches)) change(pair, touches);
    if (queue->full()) compute_waiting();
  }
  compute_waiting();
}

/* ----------------------------------------------------------------------
   grains of other sizes than the last ones: what they have of each other is found once for a close pair
------------------------------------------------------------------------- */

bool PairGranularFused::grains_touch(ContactLaw *law, const ClosePair &pair, double rsq, double radius_i,
                                     double radius_j)
{
  ContactLaw::Adhesion &found = adhesions[&pair - close.data()];
  const bool known = found.is_of(radius_i, radius_j);
  if (known) law->recall(found);
  const bool touches = law->touches(rsq, radius_i, radius_j);
  if (touches && !known) found = law->adhesion;
  return touches;
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
   a contact that LAMMPS' own functions compute, at once; returns whether it is one
------------------------------------------------------------------------- */

bool PairGranularFused::compute_model(const ClosePair &pair, ContactLaw *law)
{
  const int i = pair.i, j = pair.j;
  Granular_NS::GranularModel *model = law->model;
  model->xi = atom->x[i];
  model->xj = atom->x[j];
  model->radi = atom->radius[i];
  model->radj = atom->radius[j];
  model->i = i;
  model->j = j;
  model->itype = atom->type[i];
  model->jtype = atom->type[j];
  model->touch = pair.touches;
  if (!model->check_contact()) return false;

  model->meff = effective_mass(i, j);
  model->vi = atom->v[i];
  model->vj = atom->v[j];
  model->omegai = atom->omega[i];
  model->omegaj = atom->omega[j];
  model->history = pair.history;
  model->calculate_forces();
  queue->add_computed(law, i, j);
  return true;
}

/* ----------------------------------------------------------------------
   in the order of the list, so that each sum is the parent's
------------------------------------------------------------------------- */

void PairGranularFused::compute_waiting()
{
  if (queue->empty()) return;
  queue->meet(Dust::Spheres{atom->x[0], atom->v[0], atom->omega[0], atom->radius, atom->rmass});
  if (freeze_group_bit)
    for (const ContactQueue::Contact &contact : *queue)
      contact.batch->mass[contact.place] = effective_mass(contact.i(), contact.j());
  // a model that no pair has may have no time step
  queue->compute(queue->begin()->law->model->dt, update->setupflag == 0, update->ntimestep);
  double *f = atom->f[0], *torque = atom->torque[0];
  const int nlocal = atom->nlocal, newton = force->newton_pair;
  for (const ContactQueue::Contact &contact : *queue) {
    const int i = contact.i(), j = contact.j();
    const Vector pushed = contact.force();
    put(f + 3 * i, at(f, i) + pushed);
    put(torque + 3 * i, at(torque, i) + contact.torque_i());
    if (newton || j < nlocal) {
      put(f + 3 * j, at(f, j) - pushed);
      put(torque + 3 * j, at(torque, j) + contact.torque_j());
    }
    if (!evflag) continue;
    const Vector dx = contact.dx();
    ev_tally_xyz(i, j, nlocal, newton, 0.0, 0.0, pushed.x, pushed.y, pushed.z, dx.x, dx.y, dx.z);
  }
  queue->clear();
}

/* ---------------------------------------------------------------------- */

double PairGranularFused::memory_usage()
{
  return PairGranular::memory_usage() + double(close.capacity() * sizeof(ClosePair)) +
         double(adhesions.capacity() * sizeof(ContactLaw::Adhesion)) + then.memory_usage() +
         double(types_then.capacity() * sizeof(int)) + (queue ? double(sizeof(ContactQueue)) : 0.0);
}
