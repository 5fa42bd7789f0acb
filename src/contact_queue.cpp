/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "contact_queue.h"

#include "granular_model.h"

#include <algorithm>

using namespace LAMMPS_NS;
using Dust::ContactBatch;
using Dust::GrainBatch;

/* ----------------------------------------------------------------------
   what some contacts of these laws need
------------------------------------------------------------------------- */

ContactQueue::ContactQueue(const std::vector<ContactLaw> &laws, bool wall) : count(0)
{
  const auto some = [&laws](auto needs) { return std::any_of(laws.begin(), laws.end(), needs); };
  hertz.wall = grains.wall = wall;
  hertz.by_inverse = grains.by_inverse = ContactLaw::cuts_by_inverse();
  hertz.synchronized = grains.synchronized = some([](const ContactLaw &law) { return law.synchronized; });
  hertz.shear_damped = grains.shear_damped = some([](const ContactLaw &law) { return law.shear_damping != 0.0; });
}

/* ----------------------------------------------------------------------
   they stay, as the next contact in this place mostly has the same
------------------------------------------------------------------------- */

void ContactQueue::set_coefficients(const ContactLaw &law, ContactBatch &batch, int k)
{
  stamp[law.kind][k] = law.stamp;
  batch.half[k] = law.synchronized ? 0.5 * law.model->dt : 0.0;
  batch.damping[k] = law.damping;
  batch.shear_stiffness[k] = law.shear_stiffness;
  batch.shear_damping[k] = law.shear_damping;
  batch.friction[k] = law.friction;
  if (law.kind == ContactLaw::HERTZ) {
    hertz.stiffness[k] = law.stiffness;
    return;
  }
  const auto &adhesion = law.adhesion.by_radius;
  grains.effective_radius[k] = law.adhesion.effective_radius;
  grains.theta_crit[k] = law.theta_crit;
  grains.hamaker[k] = adhesion.hamaker;
  grains.z0[k] = adhesion.z0;
  grains.range[k] = adhesion.range;
  grains.pull_off_force[k] = adhesion.pull_off_force;
  grains.equilibrium_radius[k] = adhesion.equilibrium_radius;
  grains.breaking_gap[k] = adhesion.breaking_gap;
}

/* ---------------------------------------------------------------------- */

void ContactQueue::add_computed(ContactLaw *law, int i, int j)
{
  const Granular_NS::GranularModel *model = law->model;
  const int k = computed.count++;
  computed.i[k] = i;
  computed.j[k] = j;
  computed.dx.set(k, Dust::at(model->dx));
  computed.force.set(k, Dust::at(model->forces));
  computed.torque_i.set(k, Dust::at(model->torquesi));
  computed.torque_j.set(k, Dust::at(model->torquesj));
  contacts[count++] = {&computed, k, law};
}

/* ---------------------------------------------------------------------- */

void ContactQueue::compute(double dt, bool move, bigint step)
{
  if (hertz.count) Dust::compute_forces(hertz, dt, move);
  if (grains.count) Dust::compute_forces(grains, dt, move);
  hertz.keep();
  grains.keep();
  if (grains.count) tell_events(step);
}

/* ---------------------------------------------------------------------- */

void ContactQueue::tell_events(bigint step) const
{
  for (const Contact &contact : *this) {
    if (contact.law->kind != ContactLaw::GRAIN || grains.events[contact.place] == 0.0) continue;
    const int events = int(grains.events[contact.place]);
    auto &last = contact.law->normal->last_events;
    if (events & GrainBatch::NECK) last.neck = step;
    if (events & GrainBatch::SLIDE) last.slide = step;
    if (events & GrainBatch::ROLL) last.roll = step;
  }
}
