/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "tangential_integration.h"

#include "collision_course.h"
#include "geometry.h"
#include "jkr.h"
#include "motion_bound.h"
#include "normal_motion.h"
#include "patch_bits.h"
#include "surface_motion.h"

#include <algorithm>
#include <cmath>

using namespace Dust;

namespace {

bool rings(const GrainTable &table) { return table.material().damping >= 0.0; }

MotionBound bound_of(const GrainTable &table, const PastCollision &past)
{
  return MotionBound(*past.impulses, past.spin_before, past.peak, table.material().rolling, table.carrier_radius());
}

bool may_release(const GrainTable &table, const PastCollision &past)
{
  if (!past.impulses) return false;    // no step since a restart from a run with another law
  const MotionBound bound = bound_of(table, past);
  const double min = table.min_hold(), max = table.max_hold(), shell = table.max_shell();
  return rings(table) ? bound.any_may_ring_off(min, max, shell) : bound.any_may_leave(min, max, shell);
}

/* ----------------------------------------------------------------------
   follows so many grains at a time
------------------------------------------------------------------------- */

class Follower {
 public:
  Follower(const GrainTable &grains, const PastCollision &collision, std::vector<Release> &leaving) :
      table(grains), past(collision), released(leaving), steps(substeps(collision)), rings(::rings(grains)),
      motion(grains.material().friction, grains.material().rolling, ::rings(grains)), ringing(grains.material().damping)
  {
  }

  void add(int bit)
  {
    const GrainTable::Site &site = table.site(bit);
    const double rp = table.carrier_radius(), radius = site.shell - rp;
    const int lane = motion.grains();
    releases[lane] = {bit, {}, {}, 0.0};
    attached[lane] = true;
    motion.add(site.n, site.hold, radius, rp, past.spin_before);
    if (rings) {
      constexpr double NONE[3] = {0.0, 0.0, 0.0};
      const double r12 = effective_radius(rp, radius);
      ringing.add(site.hold, breaking_gap(site.lever * radius, r12), motion.outward_force(lane, NONE) / site.hold);
    }
    if (motion.full()) run();
  }

  // those that are still to be followed
  void run()
  {
    for (const Substep &step : steps) {
      advance(step.acceleration, step.acceleration_after, step.spin_after, step.dt);
      note_releases(step.before_end);
    }
    note_motion();    // those that leave later do so with what they have at the end
    if (rings)
      ring_out();
    else
      motion.release();
    for (int k = 0; k < motion.grains(); k++)
      if (!motion.attached(k)) released.push_back(releases[k]);
    motion.clear();
    ringing.clear();
  }

 private:
  const GrainTable &table;
  const PastCollision &past;
  std::vector<Release> &released;
  const std::vector<Substep> steps;
  const bool rings;
  SurfaceMotion motion;
  NormalMotion ringing;
  Release releases[SurfaceMotion::LANES];
  bool attached[SurfaceMotion::LANES];
  double load[SurfaceMotion::LANES];    // F_n/F_c, if they ring

  // a grain that rings leaves where its contact breaks, not before
  void advance(const double *acceleration, const double *after, const double *spin, double dt)
  {
    motion.advance(acceleration, spin, dt);
    if (!rings) return;
    for (int k = 0; k < motion.grains(); k++)
      load[k] = motion.outward_force(k, after) / table.site(releases[k].bit).hold;
    ringing.advance(load, dt);
    for (int k = 0; k < motion.grains(); k++)
      if (motion.attached(k) && !ringing.attached(k)) motion.let_go(k);
  }

  // after the collision: some periods, and more as long as a contact is drawn out by more than it can hold but damped
  void ring_out()
  {
    constexpr int PARTS = 4, PERIODS = 3, MAX_PERIODS = 31;
    constexpr double NONE[3] = {0.0, 0.0, 0.0};
    const double period = ringing.longest_period();
    for (int k = 0; k < PARTS * MAX_PERIODS && (k < PARTS * PERIODS || any_opens()); k++)
      advance(NONE, NONE, past.spin_after, period / PARTS);
  }
  bool any_opens() const
  {
    for (int k = 0; k < motion.grains(); k++)
      if (motion.attached(k) && load[k] > 1.0) return true;
    return false;
  }
  static_assert(SurfaceMotion::LANES == NormalMotion::LANES, "one grain each");

  // those that have just left, as they do
  void note_releases(double before_end)
  {
    for (int k = 0; k < motion.grains(); k++) {
      if (!attached[k] || motion.attached(k)) continue;
      attached[k] = false;
      releases[k].before_end = before_end;
      note_motion(k);
    }
  }
  // all others
  void note_motion()
  {
    for (int k = 0; k < motion.grains(); k++)
      if (attached[k]) note_motion(k);
  }
  void note_motion(int k)
  {
    for (int d = 0; d < 3; d++) {
      releases[k].direction[d] = motion.direction(k, d);
      releases[k].velocity[d] = motion.velocity(k, d);
    }
  }
};

/* ---------------------------------------------------------------------- */

void releases(const GrainTable &table, const PastCollision &past, const uint64_t *attached, bool /*located*/,
              std::vector<Release> &released)
{
  const MotionBound bound = bound_of(table, past);
  Follower follower(table, past, released);
  // a grain that does not ring is followed only if it could come near lift-off
  const auto may_leave = [&](const GrainTable::Site &site) {
    const auto [angle, centrifugal] = bound.of(site.n, site.hold, site.shell);
    const double needed = site.hold - centrifugal;
    const auto excess = [&, angle = angle](const Motion &m) {
      const double *a = m.acceleration;
      return angle * std::sqrt(dot(a, a)) - dot(a, site.n) - needed;
    };
    // of the weak time the history has the largest motion only
    return !(needed >= past.weak_peak * (1.0 + angle)) || past.history->any(excess, 1.0 + angle, 0.0);
  };
  for (int word = 0; word < table.words(); word++)
    each_bit(attached[word], [&](int k) {
      const int bit = word * PATCH + k;
      if (rings(table) || may_leave(table.site(bit))) follower.add(bit);
    });
  follower.run();
}

}    // namespace

const TangentialLaw Dust::TANGENTIAL_INTEGRATION = {true, may_release, releases};
