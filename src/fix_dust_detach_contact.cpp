/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.

   Inertia from contact forces: what fix dust/detach does in a step, and the course of a collision.
------------------------------------------------------------------------- */

#include "fix_dust_detach.h"

#include "atom.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

using namespace LAMMPS_NS;

// any bit of the three but their signs: no branch for what most carriers do in most steps, fly freely
static bool acts(const double *f)
{
  uint64_t x, y, z;
  std::memcpy(&x, f, sizeof(x));
  std::memcpy(&y, f + 1, sizeof(y));
  std::memcpy(&z, f + 2, sizeof(z));
  return (x | y | z) << 1;
}

/* ----------------------------------------------------------------------
   here f holds contact forces only
------------------------------------------------------------------------- */

void FixDustDetach::post_force(int /*vflag*/)
{
  checks.look_at_sizes(carriers.radius);
  if (settings.by_motion) return note_contacts();
  if (settings.criteria.meet) follow_grains();
  const int nlocal = atom->nlocal, blocks = (nlocal + Busy::BLOCK - 1) / Busy::BLOCK;
  Busy line[Busy::GOES];    // what carriers need of memory is on its way while others are looked at
  for (int block = 0; block < blocks + Busy::GOES - 1; block++) {
    Busy &first = line[block % Busy::GOES], &second = line[(block + 2) % Busy::GOES],
         &third = line[(block + 1) % Busy::GOES];
    first.count = 0;
    if (block < blocks) find_busy(block, first);
    fetch_motion(first);
    fetch(first, Dust::Collision::Fetch::FIRST);
    fetch(second, Dust::Collision::Fetch::SECOND);
    fetch(third, Dust::Collision::Fetch::THIRD);
    attend(third);
  }
  if (settings.rotation && nlocal > 0 && update->ntimestep % CarrierData::TURN_EVERY == 0) carriers.turn();
  close_step();
}

/* ----------------------------------------------------------------------
   not those in free flight, nor carriers at rest in contacts that can move no grain
------------------------------------------------------------------------- */

void FixDustDetach::find_busy(int block, Busy &busy)
{
  const int first = block * Busy::BLOCK, last = std::min(first + Busy::BLOCK, atom->nlocal);
  if (settings.rotation) carriers.add_turn(first, last);    // whose spins are still in the cache below
  const double *f = atom->f[0];
  const int *const states = carriers.state;
  int *const atoms = busy.atoms;
  int found = 0;
  for (int i = first; i < last; i++) {
    atoms[found] = i;
    found += static_cast<int>(acts(f + 3 * i)) | static_cast<int>(states[i] > FREE_FLIGHT);
  }

  const auto squared = [](const double *v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; };
  const bool spins = settings.rotation;
  const double *const rmass = atom->rmass;
  const double *torque = spins ? atom->torque[0] : nullptr, *omega = spins ? atom->omega[0] : nullptr;
  const int *const mask = atom->mask;
  for (int k = 0; k < found; k++) {
    const int i = atoms[k];
    const bool touches = acts(f + 3 * i);
    if (touches && states[i] == AT_REST) {    // what most carriers of a bed do
      const double torque2 = spins ? squared(torque + 3 * i) : 0.0, spin2 = spins ? squared(omega + 3 * i) : 0.0;
      if (!table_of(i).might_move(squared(f + 3 * i), torque2, spin2, settings.stiffen_time * rmass[i])) continue;
    }
    if (!(mask[i] & groupbit) || states[i] == NO_CARRIER || (touches && checks.holds(mask[i]))) continue;
    atoms[busy.count++] = i;
  }
}

/* ----------------------------------------------------------------------
   contacts are rare enough that the processor does not guess what they need
------------------------------------------------------------------------- */

void FixDustDetach::fetch_motion(const Busy &busy) const
{
  const double *torque = settings.rotation && atom->nlocal ? atom->torque[0] : nullptr;
  for (int k = 0; k < busy.count; k++) {
    const int i = busy.atoms[k];
    __builtin_prefetch(atom->rmass + i);
    __builtin_prefetch(atom->radius + i);
    __builtin_prefetch(carriers.coat + i);
    if (!torque) continue;
    __builtin_prefetch(torque + 3 * i);    // not always in one line
    __builtin_prefetch(torque + 3 * i + 2);
  }
}

// collisions are in no order, and a bed or a gas has more of them than a cache
void FixDustDetach::fetch(const Busy &busy, Dust::Collision::Fetch go) const
{
  for (int k = 0; k < busy.count; k++)
    if (const int number = carriers.state[busy.atoms[k]]; number >= 0) collisions[number].fetch(go);
}

/* ----------------------------------------------------------------------
   All motions first: one that has just been written would be waited for
------------------------------------------------------------------------- */

void FixDustDetach::attend(const Busy &busy)
{
  Dust::Motion motion[Busy::BLOCK];
  for (int k = 0; k < busy.count; k++)
    if (acts(atom->f[busy.atoms[k]])) motion[k] = motion_of(busy.atoms[k]);
  for (int k = 0; k < busy.count; k++) {
    const int i = busy.atoms[k];
    if (acts(atom->f[i]))
      collide(i, motion[k]);
    else if (carriers.state[i] >= 0)
      finish_collision(i, FREE_FLIGHT);
    else
      leave_contact(i);
  }
}

/* ----------------------------------------------------------------------
   as stiff contacts would move carrier i; its spin is half a step behind
------------------------------------------------------------------------- */

Dust::Motion FixDustDetach::motion_of(int i) const
{
  Dust::Motion motion = {};
  if (carriers.before) {
    motion = motions.of(i, carriers.before[i], settings.rotation);
    checks.check_finite(i, motion);
    return motion;
  }
  const double per_mass = settings.stiffen_acceleration / atom->rmass[i], *f = atom->f[i];
  for (int d = 0; d < 3; d++) motion.acceleration[d] = f[d] * per_mass;
  if (settings.rotation) {
    constexpr double INERTIA = 0.4;    // of a sphere, as in fix nve/sphere
    const double radius = atom->radius[i], per_inertia = per_mass / (INERTIA * radius * radius);
    const double *torque = atom->torque[i], *omega = atom->omega[i];
    for (int d = 0; d < 3; d++) {
      motion.angular_acceleration[d] = torque[d] * per_inertia;
      motion.spin[d] = omega[d];
    }
  }
  checks.check_finite(i, motion);
  return motion;
}

void FixDustDetach::collide(int i, const Dust::Motion &motion)
{
  if (carriers.state[i] == AT_REST && !table_of(i).may_move(motion)) return;
  if (carriers.state[i] == FREE_FLIGHT) carriers.began[i] = steps;
  if (carriers.state[i] < 0) begin_collision(i, motion);
  Dust::Collision &collision = collisions[carriers.state[i]];
  if (collision.step(table_of(i), motion, settings.stiffen_time * update->dt, carriers.attached[i], collisions.work)) {
    checks.grains_left(i, motion.acceleration, course_of(i));
    if (settings.criteria.meet)
      collisions.work.detached.clear();    // the end of the collision tells
    else
      record(i);
  }
  if (settings.criteria.meet && carriers.together[i] && !collision.weak()) stop_following(i);
  if (!settings.by_motion) checks.watch(i, Dust::dot(motion.acceleration, motion.acceleration), table_of(i).min_hold());
  const bool grown = collision.grows(table_of(i)) && collision.max_packed_size(table_of(i)) > exchange_room;
  if (settings.emit || grown) make_exchange_room(i);
  if (collision.at_rest()) finish_collision(i, AT_REST);
}

DeckChecks::Course FixDustDetach::course_of(int i) const
{
  const Dust::Collision &collision = collisions[carriers.state[i]];
  const Dust::GrainTable &table = table_of(i);
  return {collision.impulse(), collision.peak_acceleration(), table.min_hold(),
          table.max_shell() - table.carrier_radius()};
}

void FixDustDetach::begin_collision(int i, const Dust::Motion &motion)
{
  checks.check_size(i, carriers.radius[i]);
  carriers.state[i] = collisions.take();
  collisions[carriers.state[i]].begin(carriers.standing(i), motion.spin);
  make_exchange_room(i);
}

void FixDustDetach::finish_collision(int i, int next)
{
  Dust::Collision &collision = collisions[carriers.state[i]];
  const Dust::Motion motion = motion_of(i);
  // a strong one has ended the following: this one is passed over
  const bool followed = settings.criteria.meet && carriers.together[i];
  if (!followed && collision.end(table_of(i), motion.spin, carriers.attached[i].data(), collisions.work) &&
      !settings.criteria.meet)
    record(i);
  array_atom[i][DetachAtom::PEAK_ACCELERATION] = collision.peak_acceleration();
  checks.collision_over(i, next == FREE_FLIGHT ? steps - carriers.began[i] : 0.0, course_of(i));
  mine.collisions += 1.0;
  if (!settings.criteria.meet) mine.north += collision.lost_north(table_of(i), carriers.attached[i].data());
  mine.sliding += collision.grains_that(Dust::SLIDING, table_of(i), carriers.attached[i].data());
  mine.rolling += collision.grains_that(Dust::ROLLING, table_of(i), carriers.attached[i].data());
  if (settings.criteria.meet && !collision.weak()) begin_following(i, motion.spin);
  collisions.give_back(carriers.state[i]);
  carriers.state[i] = next;
  if (next == FREE_FLIGHT) leave_contact(i);
}

void FixDustDetach::leave_contact(int i)
{
  carriers.state[i] = FREE_FLIGHT;
  array_atom[i][DetachAtom::CONTACT_TIME] = (steps - carriers.began[i]) * settings.stiffen_time * update->dt;
}

/* ----------------------------------------------------------------------
   a carrier that nothing touches, but that was given too fast a spin
------------------------------------------------------------------------- */

void FixDustDetach::spin_off(int i)
{
  const Dust::Motion motion = motion_of(i);
  if (!table_of(i).may_spin_off(Dust::dot(motion.spin, motion.spin))) return;
  begin_collision(i, motion);
  if (collisions[carriers.state[i]].step(table_of(i), motion, settings.stiffen_time * update->dt, carriers.attached[i],
                                         collisions.work))
    record(i);
  collisions.give_back(carriers.state[i]);
  carriers.state[i] = FREE_FLIGHT;
}
