/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

/* what is booked when grains leave, and grains that meet, which are followed after a collision */

#include "fix_dust_detach.h"

#include "atom.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

using namespace LAMMPS_NS;

/* ----------------------------------------------------------------------
   place and velocity of carrier i; v is half a step behind, but not at the start of a run or the end of a step
------------------------------------------------------------------------- */

FixDustDetach::Carried FixDustDetach::now(int i) const
{
  const double half_kick = update->setupflag || settings.by_motion ? 0.0 : 0.5 * update->dt / atom->rmass[i];
  const double *x = atom->x[i], *v = atom->v[i], *f = atom->f[i];
  return {{x[0], x[1], x[2]}, {v[0] + half_kick * f[0], v[1] + half_kick * f[1], v[2] + half_kick * f[2]}};
}

/* ----------------------------------------------------------------------
   a grain has left, sign 1, or come back, -1, with its velocity
------------------------------------------------------------------------- */

void FixDustDetach::add(Loss &loss, int i, int bit, Dust::Mode mode, double sign, const double *velocity)
{
  const Dust::GrainTable &table = table_of(i);
  const double weight = sign * table.weight(bit), mass = weight * table.mean_mass();
  mine.modes[mode] += sign;
  loss.grains += sign;
  loss.weight += weight;
  loss.mass += mass;
  for (int k = 0; k < 3; k++) loss.momentum[k] += mass * velocity[k];
}

void FixDustDetach::book(int i, const Loss &loss)
{
  const DustCoat &coat = coats[carriers.coat[i]];
  if (settings.lose_mass) shedding.take_off(i, loss.mass, loss.momentum);
  mine.weight += loss.weight * coat.mass;
  array_atom[i][DetachAtom::ATTACHED] -= loss.grains;
  array_atom[i][DetachAtom::MASS] += loss.weight * coat.table->mean_mass();
  carriers.window_mass[i] += loss.weight * coat.table->mean_mass();
  rows.open();
}

// before: so long ago
void FixDustDetach::add_row(int i, const DustShedding::Grain &left, Dust::Mode mode, double before)
{
  if (!settings.keep_rows) return;
  rows.add({double(update->ntimestep) - std::round(before / update->dt), double(atom->tag[i]), left.number, mode + 1.0,
            2.0 * left.radius, left.x[0], left.x[1], left.x[2], left.v[0], left.v[1], left.v[2],
            2.0 * coats[carriers.coat[i]].radius});
}

/* ----------------------------------------------------------------------
   how a grain of carrier i was when it left: as the carrier moved then
   before: so long ago; height: of its surface over the carrier's
------------------------------------------------------------------------- */

DustShedding::Grain FixDustDetach::as_it_left(int i, const Carried &carrier, const Dust::Detachment &d, double before,
                                              double height) const
{
  const DustCoat &coat = coats[carriers.coat[i]];
  const int number = coat.table->grain(d.bit);
  const double radius = coat.texture->grains[number].radius, distance = carriers.radius[i] + radius + height;
  const double mass = coat.table->weight(d.bit) * coat.table->mean_mass();
  DustShedding::Grain left = {number + 1.0, mass, radius, shedding.now() - before, {}, {}, {}};
  for (int k = 0; k < 3; k++) {
    left.x[k] =
        carrier.x[k] - before * carrier.v[k] + d.carrier_place[k] / settings.stiffen_time + distance * d.direction[k];
    left.v[k] = carrier.v[k] + d.carrier_velocity[k] + d.velocity[k];
    left.spin[k] = atom->omega[i][k];
  }
  return left;
}

/* ----------------------------------------------------------------------
   the grains that have just left carrier i
------------------------------------------------------------------------- */

void FixDustDetach::record(int i)
{
  const Carried carrier = now(i);
  Loss loss = {};
  for (const Dust::Detachment &d : collisions.work.detached) {
    if (!collisions.work.locate) {
      constexpr double UNKNOWN[3] = {0.0, 0.0, 0.0};
      add(loss, i, d.bit, d.mode, 1.0, UNKNOWN);
      continue;
    }
    const double before = d.before_end / settings.stiffen_time;
    const DustShedding::Grain left = as_it_left(i, carrier, d, before, 0.0);
    add(loss, i, d.bit, d.mode, 1.0, left.v);
    add_row(i, left, d.mode, before);
    if (settings.emit) shedding.wait(i, left);
  }
  book(i, loss);
  collisions.work.detached.clear();
}

/* ----------------------------------------------------------------------
   grains of carrier i that meet: when no chain joins them to it they are lost, and are so no longer if they come back.
   Rows and emitted grains come when they have left for good.
------------------------------------------------------------------------- */

void FixDustDetach::record_together(int i)
{
  Dust::Entrainment &together = *carriers.together[i];
  if (together.changes.empty() && together.departures.empty()) return;
  const Carried carrier = now(i);
  Loss loss = {};
  for (const Dust::Entrainment::Change &change : together.changes) {
    double velocity[3];
    for (int k = 0; k < 3; k++) velocity[k] = carrier.v[k] + change.velocity[k];
    const double sign = change.released ? 1.0 : -1.0;
    add(loss, i, change.bit, change.mode, sign, velocity);
    if (change.north) mine.north += sign;
    carriers.attached[i][change.bit / 64] ^= uint64_t(1) << (change.bit % 64);
  }
  for (const Dust::Entrainment::Departure &departure : together.departures) {
    const Dust::Detachment &d = departure.left;
    const double before = d.before_end / settings.stiffen_time + departure.flown;
    DustShedding::Grain left = as_it_left(i, carrier, d, before, departure.height);
    add_row(i, left, d.mode, before);
    // what it has met since then has changed its velocity
    for (int k = 0; k < 3; k++) loss.momentum[k] += left.mass * (carrier.v[k] + departure.velocity[k] - left.v[k]);
    if (!settings.emit) continue;
    left.time = shedding.now();
    for (int k = 0; k < 3; k++) {
      left.x[k] = carrier.x[k] + departure.place[k];
      left.v[k] = carrier.v[k] + departure.velocity[k];
      left.spin[k] = departure.spin[k];
    }
    shedding.wait(i, left);
  }
  book(i, loss);
  together.changes.clear();
  together.departures.clear();
  if (settings.emit || together.packed_size() > exchange_room) make_exchange_room(i);
}

// grains of carrier i that have lifted off in the collision that is under way, which nobody has counted
double FixDustDetach::lifted(int i) const
{
  double left = 0.0;
  for (const uint64_t word : carriers.attached[i]) left += __builtin_popcountll(word);
  return array_atom[i][DetachAtom::ATTACHED] - left;
}

/* ----------------------------------------------------------------------
   after a collision of carrier i, with its spin: all grains that were there at its first contact are followed. The
   collision itself has told who would have left alone.
------------------------------------------------------------------------- */

void FixDustDetach::begin_following(int i, const double *spin)
{
  std::vector<Dust::Detachment> late;
  late.swap(collisions.work.detached);
  carriers.together[i] = std::make_unique<Dust::Entrainment>(table_of(i));
  collisions[carriers.state[i]].hand_over(table_of(i), spin, late, carriers.attached[i].data(), *carriers.together[i]);
  record_together(i);
  make_exchange_room(i);
}

void FixDustDetach::follow_grains()
{
  for (int i = 0; i < atom->nlocal; i++) {
    if (!carriers.together[i]) continue;
    carriers.together[i]->fly(update->dt);
    if (carriers.together[i]->over())
      stop_following(i);
    else
      record_together(i);
  }
}

// those that are released have left, and those that still move settle where they were
void FixDustDetach::stop_following(int i)
{
  carriers.together[i]->stop();
  record_together(i);
  carriers.together[i].reset();
}

double FixDustDetach::followed_carriers() const
{
  double number = 0.0;
  if (settings.criteria.meet)
    for (int i = 0; i < atom->nlocal; i++) number += carriers.together[i] != nullptr;
  MPI_Allreduce(MPI_IN_PLACE, &number, 1, MPI_DOUBLE, MPI_SUM, world);
  return number;
}

void FixDustDetach::pack_following(int i, Dust::Packer &to) const
{
  if (!settings.criteria.meet) return;
  to.put(carriers.together[i] != nullptr);
  if (carriers.together[i]) carriers.together[i]->pack(to);
}

void FixDustDetach::unpack_following(int i, Dust::Unpacker &from)
{
  if (!settings.criteria.meet || from.number() == 0.0) return;
  carriers.together[i] = std::make_unique<Dust::Entrainment>(table_of(i));
  carriers.together[i]->unpack(from);
}
