/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "entrainment.h"

#include "collision_course.h"
#include "geometry.h"
#include "jkr.h"
#include "patch_bits.h"

#include <algorithm>
#include <cmath>
#include <utility>

using namespace Dust;

namespace {

// of contacts where none is given: grains are then taken to be well damped, as in the resolved runs
double damping_of(const GrainTable &table) { return table.material().damping >= 0.0 ? table.material().damping : 1.0; }

}    // namespace

Entrainment::Entrainment(const GrainTable &grains_of) :
    table(grains_of), grains(table, damping_of(table)), pairs(table, damping_of(table), table.material().softening),
    clear(2.0 * (table.max_shell() - table.carrier_radius())), present(table.grains(), 0), released(table.grains(), 0),
    north(table.grains(), 0), mode(table.grains(), KNOCKED), spin{}, flown(0.0), due(0.0), linked(table.grains(), 0),
    past_motion(nullptr), before_end(0.0)
{
  // rolling stops a grain of the mean mass within that time that moves as fast as adhesion can hold it on its curve:
  // sqrt(c |r|) over 5/7 of 4 c theta_crit
  const double mean_radius = std::cbrt(table.mean_mass() / (4.0 / 3.0 * PI * table.material().density));
  const double r12 = effective_radius(table.carrier_radius(), mean_radius);
  const double hold = pull_off_force(table.material().gamma, r12) / table.mean_mass();
  constexpr double LEAST_ROLLING = 0.05;
  longest = std::sqrt(table.max_shell() / hold) / (20.0 / 7.0 * std::max(table.material().rolling, LEAST_ROLLING));
}

/* ---------------------------------------------------------------------- */

void Entrainment::follow(const PastCollision &past, const Quaternion &axes, const uint64_t *start,
                         const std::vector<Detachment> &alone)
{
  for (int word = 0; word < table.words(); word++)
    each_bit(start[word], [&](int k) {
      const int bit = word * PATCH + k;
      present[bit] = 1;
      north[bit] = dot(table.site(bit).n, past.dv) < 0.0;
    });
  for (const Detachment &d : alone) mode[d.bit] = d.mode;
  frame = axes;
  now = frame;
  frame.to_space(past.spin_before, spin);
  const Retrospect carrier(*past.impulses);
  past_motion = &carrier;
  follow_collision(past);
  past_motion = nullptr;
  before_end = 0.0;
}

void Entrainment::follow_collision(const PastCollision &past)
{
  bool was_loaded = false;
  for (const Substep &part : substeps(past)) {
    const int steps = std::max(1, static_cast<int>(std::ceil(part.dt / table.step() - 1.0e-9)));
    Motion motion = {};
    double spin0[3], spin1[3];
    frame.to_space(part.acceleration, motion.acceleration);
    frame.to_space(part.spin_after, spin1);
    std::copy_n(spin, 3, spin0);
    for (int d = 0; d < 3; d++) motion.angular_acceleration[d] = (spin1[d] - spin0[d]) / part.dt;
    const double h = part.dt / steps;
    for (int k = 0; k < steps; k++) {
      for (int d = 0; d < 3; d++) spin[d] = spin0[d] + (k + 0.5) / steps * (spin1[d] - spin0[d]);
      std::copy_n(spin, 3, motion.spin);
      const bool loaded = table.may_move(motion);
      if (loaded && !was_loaded)    // under a load nobody is put to rest
        for (int bit = 0; bit < table.grains(); bit++)
          if (present[bit]) grains.set_awake(bit, true);
      now.turn_by(spin, 0.5 * h);
      before_end = part.before_end + 0.5 * part.dt - (k + 1) * h;
      advance({motion.in_body(now), h}, !loaded);
      was_loaded = loaded;
      now.turn_by(spin, 0.5 * h);
    }
    std::copy_n(spin1, 3, spin);
  }
}

/* ---------------------------------------------------------------------- */

void Entrainment::fly(double time)
{
  due += time;
  const double h = table.step();
  Motion motion = {};
  std::copy_n(spin, 3, motion.spin);
  for (; due >= h && !over(); due -= h) {
    now.turn_by(spin, 0.5 * h);
    advance({motion.in_body(now), h}, true);
    now.turn_by(spin, 0.5 * h);
    flown += h;
  }
}

void Entrainment::advance(const CarrierStep &step, bool settle)
{
  pairs.push(grains, present, step.h);
  grains.advance(step, settle);
  pairs.moved(grains.max_speed() * step.h);
  look_who_is_released();
}

/* ----------------------------------------------------------------------
   whom no chain of necks joins to the carrier any more, or again; and who is out of all others' way
------------------------------------------------------------------------- */

void Entrainment::look_who_is_released()
{
  grains.find_flying(flying);
  for (int bit : flying) linked[bit] = 0;
  link();
  changing.clear();
  for (int bit : flying)
    if (released[bit] == linked[bit]) changing.push_back(bit);
  std::sort(changing.begin(), changing.end());    // sums must not depend on how grains are put side by side
  for (int bit : changing) change(bit, !linked[bit]);
  const auto is_over = [this](Moment &moment) {
    const int bit = moment.departure.left.bit;
    if (released[bit] && grains.held(bit)) change(bit, false);    // back on the carrier
    if (released[bit] && grains.gap(bit) > clear) depart(moment);
    return !released[bit] || !present[bit];
  };
  moments.erase(std::remove_if(moments.begin(), moments.end(), is_over), moments.end());
}

// marks flying grains that others hold: necks are few, and chains short
void Entrainment::link()
{
  if (flying.empty()) return;
  chains.clear();
  for (const GrainPairs::Neck &neck : pairs.necks()) {
    const bool first = grains.held(neck.first), second = grains.held(neck.second);
    if (first != second)
      linked[first ? neck.second : neck.first] = 1;
    else if (!first)
      chains.push_back(neck);
  }
  for (bool more = true; more;) {
    more = false;
    for (const GrainPairs::Neck &neck : chains) {
      if (linked[neck.first] == linked[neck.second]) continue;
      linked[neck.first] = linked[neck.second] = 1;
      more = true;
    }
  }
}

void Entrainment::change(int bit, bool is_released)
{
  released[bit] = is_released;
  double place[3];
  Moment moment = {};
  Detachment &left = moment.departure.left;
  Change c = {bit, mode[bit], is_released, north[bit] != 0, {}};
  in_space(bit, place, c.velocity);
  std::copy_n(c.velocity, 3, left.velocity);
  moment.flown = flown;
  left.bit = bit;
  left.mode = mode[bit];
  left.before_end = before_end;
  if (past_motion) {
    past_motion->at(before_end, left.carrier_velocity, left.carrier_place);
    frame.to_space(left.carrier_velocity, left.carrier_velocity);
    frame.to_space(left.carrier_place, left.carrier_place);
  }
  for (int d = 0; d < 3; d++) c.velocity[d] += left.carrier_velocity[d];
  changes.push_back(c);
  if (!is_released) return;
  const double distance = std::sqrt(dot(place, place));
  for (int d = 0; d < 3; d++) left.direction[d] = place[d] / distance;
  moment.departure.height = grains.gap(bit);
  moments.push_back(moment);
}

void Entrainment::depart(Moment &moment)
{
  Departure &departure = moment.departure;
  const int bit = departure.left.bit;
  departure.flown = flown - moment.flown;
  in_space(bit, departure.place, departure.velocity);
  double turning[3];
  grains.spin(bit, turning);
  now.to_space(turning, departure.spin);
  for (int d = 0; d < 3; d++) departure.spin[d] += spin[d];
  departures.push_back(departure);
  present[bit] = 0;
  grains.set_awake(bit, false);
}

void Entrainment::stop()
{
  for (Moment &moment : moments) depart(moment);
  moments.clear();
  flown = longest;
}

void Entrainment::in_space(int bit, double *place, double *velocity) const
{
  double turning[3], along[3];
  grains.velocity(bit, along);
  now.to_space(grains.place(bit), place);
  now.to_space(along, velocity);
  cross(spin, place, turning);
  for (int d = 0; d < 3; d++) velocity[d] += turning[d];
}

/* ----------------------------------------------------------------------
   numbers of each grain that is still there; flags as bits of one number
------------------------------------------------------------------------- */

void Entrainment::pack(Packer &to) const
{
  to.put(&now, 1);
  to.put(spin, 3);
  to.put(flown);
  to.put(due);
  to.put(moments);
  to.put(static_cast<double>(std::count(present.begin(), present.end(), 1)));
  for (int bit = 0; bit < table.grains(); bit++) {
    if (!present[bit]) continue;
    to.put(bit);
    to.put(mode[bit]);
    to.put(2 * released[bit] + north[bit]);
    const GrainLanes::Grain grain = grains.get(bit);
    to.put(&grain, 1);
  }
  to.put(static_cast<double>(pairs.necks().size()));
  for (const GrainPairs::Neck &neck : pairs.necks()) {
    to.put(neck.first);
    to.put(neck.second);
  }
}

void Entrainment::unpack(Unpacker &from)
{
  from.get(&now, 1);
  from.get(spin, 3);
  flown = from.number();
  due = from.number();
  from.get(moments);
  for (int count = static_cast<int>(from.number()); count > 0; count--) {
    const int bit = static_cast<int>(from.number());
    mode[bit] = static_cast<Mode>(from.number());
    const int flags = static_cast<int>(from.number());
    present[bit] = 1;
    released[bit] = flags / 2;
    north[bit] = flags % 2;
    GrainLanes::Grain grain;
    from.get(&grain, 1);
    grains.put(bit, grain);
  }
  std::vector<GrainPairs::Neck> necks(static_cast<size_t>(from.number()));
  for (GrainPairs::Neck &neck : necks) {
    neck.first = static_cast<int>(from.number());
    neck.second = static_cast<int>(from.number());
  }
  pairs.set_necks(std::move(necks));
}

int Entrainment::packed_size() const
{
  constexpr size_t SINGLE = numbers_of<Quaternion>() + 8, GRAIN = 3 + numbers_of<GrainLanes::Grain>(), NECK = 2;
  const auto here = static_cast<size_t>(std::count(present.begin(), present.end(), 1));
  return static_cast<int>(SINGLE + numbers_of<Moment>() * moments.size() + GRAIN * here + NECK * pairs.necks().size());
}

double Entrainment::memory_usage() const
{
  constexpr size_t GRAIN = 4 * sizeof(char) + sizeof(Mode);
  return sizeof(*this) + double(present.size()) * GRAIN + double(moments.capacity()) * sizeof(Moment) +
         grains.memory_usage() + pairs.memory_usage();
}
