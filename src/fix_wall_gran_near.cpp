/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "fix_wall_gran_near.h"

#include "contact_queue.h"

#include "atom.h"
#include "granular_model.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <utility>

using namespace LAMMPS_NS;
using Dust::at;
using Dust::put;
using Dust::Vector;

static constexpr int DIMENSIONS = 3;     // planes have the wall style of their axis
static constexpr double MARGIN = 0.5;    // of the skin of the neighbor list, to which atoms count as near

/* ---------------------------------------------------------------------- */

FixWallGranNear::FixWallGranNear(LAMMPS *_lmp, int narg, char **arg) :
    FixWallGran(_lmp, narg, arg), left_to_parent(true), margin(0.0), near_known(false)
{
}

FixWallGranNear::~FixWallGranNear() = default;

/* ----------------------------------------------------------------------
   ours are planes at rest or sliding along themselves, whose contacts end where it is known
------------------------------------------------------------------------- */

void FixWallGranNear::init()
{
  FixWallGran::init();
  read_law();
  left_to_parent = wallstyle < 0 || wallstyle >= DIMENSIONS || wiggle || heat_flag || peratom_flag || fix_rigid ||
                   !use_history || !laws.front().ends();
}

void FixWallGranNear::reset_dt()
{
  FixWallGran::reset_dt();
  read_law();
}

void FixWallGranNear::read_law()
{
  laws.clear();
  laws.emplace_back(model, 1);
  queue = std::make_unique<ContactQueue>(laws, true);
  near_known = false;
}

/* ----------------------------------------------------------------------
   whatever else LAMMPS does with a wall it does without atoms
------------------------------------------------------------------------- */

void FixWallGranNear::post_force(int vflag)
{
  if (left_to_parent) {
    FixWallGran::post_force(vflag);
    return;
  }
  const int nlocal = std::exchange(atom->nlocal, 0);
  FixWallGran::post_force(vflag);
  atom->nlocal = nlocal;
  if (nlocal == 0) return;
  if (!near_known || neighbor->ago == 0 || then.left(atom->x[0], atom->radius, nlocal, margin)) find_near();
  add_contacts();
}

/* ---------------------------------------------------------------------- */

Dust::Planes FixWallGranNear::planes() const
{
  double velocity[3] = {0.0, 0.0, 0.0};
  if (wshear) velocity[axis] = vshear;
  return {wallstyle, lo, hi, at(velocity)};
}

/* ----------------------------------------------------------------------
   An atom that is far has no history any more. One that has left the group keeps what it had, as long as it stays out.
------------------------------------------------------------------------- */

void FixWallGranNear::find_near()
{
  constexpr double SLACK = 1.0e-6;    // more than rounding may add
  const Dust::Planes wall = planes();
  margin = MARGIN * neighbor->skin;
  const double reach = (1.0 + SLACK) * margin;
  const int nlocal = atom->nlocal;
  near.clear();
  for (int i = 0; i < nlocal; i++) {
    const double distance = wall.distance(atom->x[i][wallstyle]), *history = history_one[i];
    const bool is_near = laws.front().touches(distance * distance, atom->radius[i], 0.0, reach);
    if (!is_near && atom->mask[i] & groupbit)
      std::fill_n(history_one[i], size_history, 0.0);
    else if (is_near || std::any_of(history, history + size_history, [](double kept) { return kept != 0.0; }))
      near.push_back(i);
  }
  then.note(atom->x[0], atom->radius, nlocal);
  near_known = true;
}

/* ---------------------------------------------------------------------- */

void FixWallGranNear::add_contacts()
{
  constexpr std::size_t FEW = 4;    // below, batches would be mostly empty
  ContactLaw *law = laws.data();
  const Dust::Planes wall = planes();
  queue->clear();    // an error may have left some
  for (const int i : near) {
    if (!(atom->mask[i] & groupbit)) continue;
    const double distance = wall.distance(atom->x[i][wallstyle]);
    if (!law->touches(distance * distance, atom->radius[i], 0.0)) {
      std::fill_n(history_one[i], size_history, 0.0);
      continue;
    }
    if (model->beyond_contact) history_one[i][0] = 1.0;
    if (law->kind == ContactLaw::MODEL || near.size() < FEW)
      compute_model(i, distance);
    else
      queue->add(law, history_one[i], i, i);
    if (queue->full()) compute_waiting();
  }
  compute_waiting();
}

/* ----------------------------------------------------------------------
   a contact that LAMMPS' own functions compute
------------------------------------------------------------------------- */

void FixWallGranNear::compute_model(int i, double distance)
{
  double velocity[3], resting[3] = {0.0, 0.0, 0.0};
  put(velocity, planes().velocity);
  std::fill_n(model->dx, 3, 0.0);
  model->dx[wallstyle] = distance;
  model->radi = atom->radius[i];
  model->radj = 0.0;
  model->touch = true;
  model->check_contact();
  model->meff = atom->rmass[i];
  model->vi = atom->v[i];
  model->vj = velocity;
  model->omegai = atom->omega[i];
  model->omegaj = resting;
  model->history = history_one[i];
  model->calculate_forces();
  queue->add_computed(laws.data(), i, i);
}

/* ---------------------------------------------------------------------- */

void FixWallGranNear::compute_waiting()
{
  if (queue->empty()) return;
  queue->meet(Dust::Spheres{atom->x[0], atom->v[0], atom->omega[0], atom->radius, atom->rmass}, planes());
  queue->compute(dt, update->setupflag == 0, update->ntimestep);
  for (const ContactQueue::Contact &contact : *queue) {
    const int i = contact.i();
    put(atom->f[i], at(atom->f[i]) + contact.force());
    put(atom->torque[i], at(atom->torque[i]) + contact.torque_i());
  }
  queue->clear();
}

/* ---------------------------------------------------------------------- */

double FixWallGranNear::memory_usage()
{
  return FixWallGran::memory_usage() + double(near.capacity() * sizeof(int)) + then.memory_usage() +
         (queue ? double(sizeof(ContactQueue)) : 0.0);
}
