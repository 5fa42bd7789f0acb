/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "collision.h"

#include "entrainment.h"
#include "geometry.h"
#include "patch_bits.h"
#include "retrospect.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

using namespace Dust;

namespace {

constexpr double ROUND_OFF = 1.0e-12;    // rotation that adds no more to g than this part of it does not count
constexpr double INF = std::numeric_limits<double>::infinity();

// what has held at the peak holds at a part of it, with that part of what is left to c for what comes aside and by spin
bool holds_as_at_peak(const GrainTable &table, const AccelerationHistory &history, const Motion &motion,
                      const Split &part)
{
  if (!(part.lambda >= 0.0 && part.lambda <= 1.0)) return false;
  const double *v = history.peak().spin, shell = table.max_shell();
  const double more = std::sqrt(part.aside2) + shell * spin_difference(motion.spin, v);
  return (1.0 - part.lambda) * (table.min_hold() - shell * dot(v, v)) >= more;
}

void detach(int bit, uint64_t *attached) { attached[bit / PATCH] &= ~(uint64_t(1) << (bit % PATCH)); }

}    // namespace

/* ---------------------------------------------------------------------- */

void Collision::begin(const Quaternion &orientation, const double *spin)
{
  course = Course{};
  course.frame = orientation;
  std::copy_n(spin, 3, course.spin0);
  if (impulses) impulses->clear();
  strong.reset();
}

void Collision::release(Workspace &work)
{
  if (strong) work.spare.push_back(std::move(strong));
}

/* ---------------------------------------------------------------------- */

void Collision::become_strong(const GrainTable &table, Workspace &work)
{
  if (work.spare.empty()) work.spare.push_back(std::make_unique<Strong>());
  strong = std::move(work.spare.back());
  work.spare.pop_back();
  strong->state = {};
  strong->state.now = course.frame;
  strong->state.now.turn_by(course.angle, 1.0);
  strong->start.clear();
  strong->history.clear();
  strong->schedule.clear();
  if (!course.activity.has_begun()) return;
  const bool rotates = table.max_shell() * course.peak.rotation_bound() > ROUND_OFF * std::sqrt(course.peak2);
  strong->history.add(weak_peak(), course.peak2, rotates);
}

/* ---------------------------------------------------------------------- */

bool Collision::step(const GrainTable &table, const Motion &middle, double dt, std::vector<uint64_t> &attached,
                     Workspace &work)
{
  // the rest of the motion is read where it is: what has just been copied cannot be read in other pieces until the copy
  // and all that was written before it have come to the cache
  double spin[3];
  for (int d = 0; d < 3; d++) spin[d] = middle.spin[d] + 0.5 * dt * middle.angular_acceleration[d];
  const Strength strength = strength_of(table, middle, spin);
  if (weak()) {
    if (course.activity.has_begun())
      for (int d = 0; d < 3; d++) course.angle[d] += middle.spin[d] * dt;
    if (!strength.may_move) {
      step_weak(table, middle, spin, strength, dt);
      return false;
    }
    become_strong(table, work);
  } else
    strong->state.now.turn_by(middle.spin, dt);

  Motion motion = middle;
  std::copy_n(spin, 3, motion.spin);
  work.losses.clear();
  step_strong(table, motion, strength, dt, attached, work);
  return !work.losses.empty();
}

void Collision::add(const GrainTable &table, const Motion &motion, const double *spin, double size, double dt,
                    bool lively)
{
  course.activity.add(size, lively);
  course.time += dt;
  for (int d = 0; d < 3; d++) course.impulse[d] += motion.acceleration[d] * dt;
  if (!needs_impulses(table)) return;
  if (!impulses) impulses = std::make_unique<ImpulseRecord>();
  impulses->add(motion.acceleration, spin, dt);
}

/* ---------------------------------------------------------------------- */

void Collision::step_weak(const GrainTable &table, const Motion &motion, const double *spin, const Strength &strength,
                          double dt)
{
  const bool lively = strength.size2 > course.peak2 || !course.activity.has_begun();
  add(table, motion, spin, strength.size, dt, lively);
  if (!lively) return;
  course.peak2 = strength.size2;
  course.peak = motion;
  std::copy_n(spin, 3, course.peak.spin);
  std::copy_n(course.angle, 3, course.peak_angle);
}

/* ---------------------------------------------------------------------- */

void Collision::step_strong(const GrainTable &table, const Motion &motion, const Strength &strength, double dt,
                            std::vector<uint64_t> &attached, Workspace &work)
{
  Strong &s = *strong;
  const AccelerationHistory &history = s.history;
  const bool lively = strength.may_move || strength.size2 > history.peak2();
  if (!lively && course.activity.is_lively()) {
    s.state.lively.time = course.time;
    std::copy_n(course.impulse, 3, s.state.lively.impulse);
  }
  add(table, motion, motion.spin, strength.size, dt, lively);
  if (lively) std::copy_n(motion.spin, 3, s.state.lively.spin);

  const bool rotates = strength.rotation > ROUND_OFF * strength.size;
  const Motion m = motion.in_body(s.state.now);
  const double spun = rotates ? table.max_shell() * dot(m.spin, m.spin) : 0.0;
  const bool may_lift = strength.size + spun > table.min_hold();
  Split part = {INF, INF};    // of the peak
  if (!history.empty() && strength.size2 <= history.peak2() && (may_lift || !rotates))
    part = split(m.acceleration, history.peak().acceleration, history.peak2());
  // between none and the peak no grain meets any criterion that has met none at the peak
  if (!rotates && is_between(part, history.peak2()) && !(history.any_rotates() && history.peak().rotates())) return;

  if (table.criteria().ibrahim || (may_lift && !holds_as_at_peak(table, history, m, part)))
    find_losses(table, m, attached.data(), work);
  for (const Loss &loss : work.losses) lose(table, loss, m, attached.data(), work);
  s.history.add(m, strength.size2, rotates);
}

/* ---------------------------------------------------------------------- */

void Collision::find_losses(const GrainTable &table, const Motion &motion, const uint64_t *attached, Workspace &work)
{
  keep_start(table, attached);
  std::vector<Loss> &losses = work.losses;
  if (table.criteria().ibrahim) {
    Dust::find_losses(table, motion, attached, losses);
    return;
  }
  strong->schedule.look(table, motion, attached, losses);
  // the order of the schedule must not show, as a restart begins another one
  const auto by_bit = [](const Loss &a, const Loss &b) { return a.bit < b.bit; };
  if (!std::is_sorted(losses.begin(), losses.end(), by_bit)) std::sort(losses.begin(), losses.end(), by_bit);
}

void Collision::keep_start(const GrainTable &table, const uint64_t *attached)
{
  if (strong->start.empty()) strong->start.assign(attached, attached + table.words());
}

/* ----------------------------------------------------------------------
   from where it stuck, at a motion that the history does not have yet
------------------------------------------------------------------------- */

void Collision::lose(const GrainTable &table, const Loss &loss, const Motion &motion, uint64_t *attached,
                     Workspace &work)
{
  const GrainTable::Site &site = table.site(loss.bit);
  detach(loss.bit, attached);
  if (table.criteria().count) {
    const Load load = load_on(site, motion);
    for (Mode met : {SLIDING, ROLLING})
      strong->state.count[met] += excess(table, met, loss.bit, load) > 0.0 || has_met(met, table, loss.bit);
  }
  work.detached.push_back({loss.bit, loss.mode, {}, {}, 0.0, {}, {}});
  if (!work.locate) return;
  Detachment &detached = work.detached.back();
  double velocity[3];
  cross(motion.spin, site.n, velocity);
  for (double &x : velocity) x *= site.shell;
  strong->state.now.to_space(site.n, detached.direction);
  strong->state.now.to_space(velocity, detached.velocity);
}

/* ----------------------------------------------------------------------
   along the surface
------------------------------------------------------------------------- */

void Collision::let_go(const GrainTable &table, const Release &release, uint64_t *attached, Workspace &work)
{
  detach(release.bit, attached);
  if (table.criteria().count)
    for (Mode met : {SLIDING, ROLLING}) strong->state.count[met] += has_met(met, table, release.bit);
  work.detached.push_back({release.bit, TANGENTIAL, {}, {}, release.before_end, {}, {}});
  if (!work.locate) return;
  course.frame.to_space(release.direction, work.detached.back().direction);
  course.frame.to_space(release.velocity, work.detached.back().velocity);
  course.frame.to_space(release.carrier_velocity, work.detached.back().carrier_velocity);
  course.frame.to_space(release.carrier_place, work.detached.back().carrier_place);
}

// where the carrier was when grains left, by the record; the impulses are along the axes of the frame by now
void Collision::locate_in_past(std::vector<Detachment> &detached, size_t first) const
{
  const Retrospect carrier(*impulses);
  for (size_t k = first; k < detached.size(); k++) {
    Detachment &d = detached[k];
    if (d.before_end <= 0.0) continue;
    carrier.at(d.before_end, d.carrier_velocity, d.carrier_place);
    course.frame.to_space(d.carrier_velocity, d.carrier_velocity);
    course.frame.to_space(d.carrier_place, d.carrier_place);
  }
}

/* ---------------------------------------------------------------------- */

Motion Collision::weak_peak() const
{
  Quaternion then = course.frame;
  then.turn_by(course.peak_angle, 1.0);
  return course.peak.in_body(then);
}

bool Collision::has_met(Mode mode, const GrainTable &table, int bit) const
{
  const GrainTable::Site &site = table.site(bit);
  const double slope = limit_of(mode, table.material().friction, site.lever).slope;
  return strong->history.any([&](const Motion &m) { return excess(table, mode, bit, m); }, 1.0 + slope, site.shell);
}

int Collision::grains_that(Mode mode, const GrainTable &table, const uint64_t *attached) const
{
  if (!table.criteria().count) return 0;
  int n = strong ? static_cast<int>(strong->state.count[mode]) : 0;
  const Motion peak = strong ? strong->history.peak() : weak_peak();
  if (!strong && std::sqrt(course.peak2) + table.max_shell() * peak.rotation_bound() <= table.min_force_to(mode))
    return n;
  for (int word = 0; word < table.words(); word++) {
    if (!attached[word]) continue;
    const auto [min, max] = excess_in_patch(table, mode, word, peak);
    if (min > 0.0)
      n += __builtin_popcountll(attached[word]);
    else if (strong || max > 0.0)
      each_bit(attached[word], [&](int k) {
        const int bit = word * PATCH + k;
        n += strong ? has_met(mode, table, bit) : excess(table, mode, bit, peak) > 0.0;
      });
  }
  return n;
}

/* ---------------------------------------------------------------------- */

double Collision::peak_acceleration() const { return std::sqrt(strong ? strong->history.peak2() : course.peak2); }

/* ---------------------------------------------------------------------- */

bool Collision::end(const GrainTable &table, const double *spin, uint64_t *attached, Workspace &work)
{
  if (weak() && at_rest()) return false;    // nothing has moved
  const TangentialLaw *law = table.tangential();
  if (!law) return false;
  if (impulses) impulses->to_body(course.frame);
  PastCollision past = past_at(spin);
  if (!law->may_release(table, past)) return false;
  if (weak()) become_strong(table, work);
  keep_start(table, attached);
  past.history = &strong->history;
  work.released.clear();
  law->releases(table, past, attached, work.locate, work.released);
  const size_t first = work.detached.size();
  for (const Release &release : work.released) let_go(table, release, attached, work);
  if (work.locate && impulses) locate_in_past(work.detached, first);
  return !work.released.empty();
}

void Collision::hand_over(const GrainTable &table, const double *spin, const std::vector<Detachment> &late,
                          uint64_t *attached, Entrainment &together) const
{
  // those that have lifted off before, where they sat
  std::vector<Detachment> alone;
  std::vector<uint64_t> start = strong->start;    // empty if none has
  if (start.empty()) start.assign(attached, attached + table.words());
  for (size_t word = 0; word < start.size(); word++)
    each_bit(start[word] & ~attached[word],
             [&](int k) { alone.push_back({static_cast<int>(word) * PATCH + k, NORMAL, {}, {}, 0.0, {}, {}}); });
  alone.insert(alone.end(), late.begin(), late.end());
  std::copy(start.begin(), start.end(), attached);
  together.follow(past_at(spin), course.frame, start.data(), alone);
}

// the velocities and the time are those of the last lively step if it has come to rest
PastCollision Collision::past_at(const double *spin) const
{
  PastCollision past;
  const bool rests = at_rest();
  const double *impulse = rests ? strong->state.lively.impulse : course.impulse;
  course.frame.to_body(impulse, past.dv);
  for (double &x : past.dv) x = -x;
  past.duration = rests ? strong->state.lively.time : course.time;
  course.frame.to_body(course.spin0, past.spin_before);
  course.frame.to_body(rests ? strong->state.lively.spin : spin, past.spin_after);
  past.peak = peak_acceleration();
  past.weak_peak = std::sqrt(course.peak2);
  past.impulses = impulses.get();
  past.history = nullptr;
  return past;
}

/* ---------------------------------------------------------------------- */

int Collision::lost_north(const GrainTable &table, const uint64_t *attached) const
{
  if (weak()) return 0;
  int lost = 0;
  double impulse[3];
  const std::vector<uint64_t> &start = strong->start;
  course.frame.to_body(course.impulse, impulse);
  for (size_t word = 0; word < start.size(); word++)
    each_bit(start[word] & ~attached[word],
             [&](int k) { lost += dot(table.site(static_cast<int>(word) * PATCH + k).n, impulse) > 0.0; });
  return lost;
}

/* ---------------------------------------------------------------------- */

int Collision::packed_size() const
{
  Packer counter;
  pack(counter);
  return counter.size();
}

void Collision::pack(Packer &packer) const
{
  packer.put(strong != nullptr);
  packer.put(impulses != nullptr);
  packer.put(&course, 1);
  if (impulses) impulses->pack(packer);
  if (!strong) return;
  packer.put(&strong->state, 1);
  packer.put(strong->start);
  strong->history.pack(packer);
}

void Collision::unpack(Unpacker &unpacker)
{
  const bool was_strong = unpacker.number() != 0.0, recorded = unpacker.number() != 0.0;
  unpacker.get(&course, 1);
  impulses.reset();
  if (recorded) {
    impulses = std::make_unique<ImpulseRecord>();
    impulses->unpack(unpacker);
  }
  strong.reset();
  if (!was_strong) return;
  strong = std::make_unique<Strong>();
  unpacker.get(&strong->state, 1);
  unpacker.get(strong->start);
  strong->history.unpack(unpacker);
}
