/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "carrier_data.h"

#include "detach_columns.h"

#include "atom.h"
#include "memory.h"
#include "update.h"

#include <algorithm>
#include <utility>

using namespace LAMMPS_NS;

CarrierData::CarrierData(LAMMPS *_lmp, bool rotation, bool orientations, int motion, bool meet) :
    Pointers(_lmp), state(nullptr), coat(nullptr), radius(nullptr), orientation(nullptr), angle(nullptr),
    window_mass(nullptr), before(nullptr), began(nullptr), columns(nullptr), angle_used(rotation),
    orientation_used(orientations), meet_used(meet), motion_size(motion)
{
}

CarrierData::~CarrierData()
{
  memory->destroy(state);
  memory->destroy(coat);
  memory->destroy(radius);
  memory->destroy(orientation);
  memory->destroy(angle);
  memory->destroy(window_mass);
  memory->destroy(before);
  memory->destroy(began);
  memory->destroy(columns);
}

/* ---------------------------------------------------------------------- */

void CarrierData::grow(int nmax)
{
  memory->grow(state, nmax, "dust/detach:state");
  memory->grow(coat, nmax, "dust/detach:coat");
  memory->grow(radius, nmax, "dust/detach:radius");
  memory->grow(window_mass, nmax, "dust/detach:window_mass");
  memory->grow(began, nmax, "dust/detach:began");
  memory->grow(columns, nmax, DetachAtom::SIZE, "dust/detach:array_atom");
  if (orientation_used) memory->grow(orientation, nmax, "dust/detach:orientation");
  if (angle_used) memory->grow(angle, nmax, 3, "dust/detach:angle");
  if (motion_size) memory->grow(before, nmax, motion_size, "dust/detach:before");
  if (meet_used) together.resize(nmax);
}

// LAMMPS' arrays have room for 16384 atoms at least, of which a run of one carrier should not pay for the others
void CarrierData::make_room_for(int i)
{
  if (attached.size() <= static_cast<size_t>(i)) attached.resize(i + 1);
}

void CarrierData::copy(int i, int j)
{
  state[j] = state[i];
  coat[j] = coat[i];
  radius[j] = radius[i];
  make_room_for(std::max(i, j));
  attached[j] = attached[i];
  window_mass[j] = window_mass[i];
  began[j] = began[i];
  std::copy_n(columns[i], static_cast<int>(DetachAtom::SIZE), columns[j]);
  if (orientation) orientation[j] = orientation[i];
  if (angle) std::copy_n(angle[i], 3, angle[j]);
  if (before) std::copy_n(before[i], motion_size, before[j]);
  if (meet_used && i != j) together[j] = std::move(together[i]);    // an atom is copied where it moves to only
}

void CarrierData::clear(int i)
{
  state[i] = NO_CARRIER;
  coat[i] = 0;
  radius[i] = 0.0;
  make_room_for(i);
  attached[i] = std::vector<uint64_t>();
  window_mass[i] = began[i] = 0.0;
  if (angle) std::fill_n(angle[i], 3, 0.0);
  if (before) std::fill_n(before[i], motion_size, 0.0);
  if (meet_used) together[i].reset();
  std::fill_n(columns[i], static_cast<int>(DetachAtom::SIZE), 0.0);
}

// of all atoms: it costs less than to ask which are carriers
void CarrierData::add_turn(int first, int last)
{
  if (first == last) return;
  const double dt = update->dt, *omega = atom->omega[0];
  double *turned = angle[0];
  for (int d = 3 * first; d < 3 * last; d++) turned[d] += dt * omega[d];
}

/* ----------------------------------------------------------------------
   angles of a few steps may be summed, as they are small, at steps that depend on nothing else
------------------------------------------------------------------------- */

void CarrierData::turn()
{
  for (int i = 0; i < atom->nlocal; i++) {
    if (state[i] != NO_CARRIER) orientation[i].turn_by(angle[i], 1.0);
    std::fill_n(angle[i], 3, 0.0);
  }
}

Dust::Quaternion CarrierData::standing(int i) const
{
  Dust::Quaternion now = orientation ? orientation[i] : Dust::Quaternion();
  if (angle) now.turn_by(angle[i], 1.0);
  return now;
}

void CarrierData::show_standing()
{
  for (int i = 0; i < atom->nlocal; i++)
    if (state[i] != NO_CARRIER) std::copy_n(standing(i).q, 4, columns[i] + DetachAtom::QW);
}

/* ---------------------------------------------------------------------- */

void CarrierData::close_window()
{
  for (int i = 0; i < atom->nlocal; i++) {
    columns[i][DetachAtom::WINDOW_MASS] = window_mass[i];
    window_mass[i] = 0.0;
  }
}

double CarrierData::attached_grains(int groupbit) const
{
  double sum = 0.0;
  for (int i = 0; i < atom->nlocal; i++)
    if ((atom->mask[i] & groupbit) && state[i] != NO_CARRIER) sum += columns[i][DetachAtom::ATTACHED];
  return sum;
}

std::vector<bool> CarrierData::colliding(size_t collisions) const
{
  std::vector<bool> taken(collisions, false);
  for (int i = 0; i < atom->nlocal; i++)
    if (state[i] >= 0) taken[state[i]] = true;
  return taken;
}

/* ---------------------------------------------------------------------- */

// numbers before the orientation, it and what else is used, attached bits
int CarrierData::size(int words) const
{
  return 5 + DetachAtom::QW + layout() % 100 + static_cast<int>(Dust::PackedBits::most(words));
}

void CarrierData::pack(int i, Dust::Packer &to) const
{
  to.put(state[i] >= 0 ? 0 : state[i]);
  to.put(coat[i]);
  to.put(radius[i]);
  to.put(columns[i], DetachAtom::QW);    // the rest is made anew where it is shown
  to.put(window_mass[i]);
  to.put(began[i]);
  if (orientation) to.put(&orientation[i], 1);
  if (angle) to.put(angle[i], 3);
  if (before) to.put(before[i], motion_size);
  to.put_bits(attached[i]);
}

void CarrierData::unpack(int i, Dust::Unpacker &from)
{
  state[i] = static_cast<int>(from.number());
  coat[i] = static_cast<int>(from.number());
  radius[i] = from.number();
  from.get(columns[i], DetachAtom::QW);
  window_mass[i] = from.number();
  began[i] = from.number();
  if (orientation) from.get(&orientation[i], 1);
  if (angle) from.get(angle[i], 3);
  if (before) from.get(before[i], motion_size);
  from.get_bits(attached[i]);
}

/* ---------------------------------------------------------------------- */

double CarrierData::memory_usage() const
{
  double bytes = double(atom->nmax) * (size(0) * sizeof(double) + sizeof(std::vector<uint64_t>));
  for (const std::vector<uint64_t> &words : attached) bytes += words.capacity() * sizeof(uint64_t);
  for (const auto &followed : together) bytes += sizeof(followed) + (followed ? followed->memory_usage() : 0.0);
  return bytes;
}
