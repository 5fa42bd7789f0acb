/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "detachment.h"

#include "geometry.h"
#include "jkr.h"
#include "motion_bound.h"
#include "normal_motion.h"
#include "patch_bits.h"
#include "surface_motion.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <type_traits>

using namespace Dust;

namespace {

constexpr double ROUND_OFF = 1.0e-12;    // turning that adds no more to g than this part of it does not count
constexpr double INF = std::numeric_limits<double>::infinity();

// orders grains so that each run of PATCH is a compact patch: halves the set across its longest side, again and again
void order_in_patches(const std::vector<Grain> &grains, int *first, int *last)
{
  const auto count = last - first;
  if (count <= PATCH) return;
  double lo[3] = {2.0, 2.0, 2.0}, hi[3] = {-2.0, -2.0, -2.0};
  for (int *i = first; i != last; ++i)
    for (int d = 0; d < 3; d++) {
      lo[d] = std::min(lo[d], grains[*i].n[d]);
      hi[d] = std::max(hi[d], grains[*i].n[d]);
    }
  int side = 0;
  for (int d = 1; d < 3; d++)
    if (hi[d] - lo[d] > hi[side] - lo[side]) side = d;
  int *middle = first + (count / PATCH + 1) / 2 * PATCH;
  // ties broken by number: the same order on every machine
  std::nth_element(first, middle, last, [&](int a, int b) {
    const double na = grains[a].n[side], nb = grains[b].n[side];
    return na != nb ? na < nb : a < b;
  });
  order_in_patches(grains, first, middle);
  order_in_patches(grains, middle, last);
}

}    // namespace

/* ---------------------------------------------------------------------- */

DetachmentFunctions::DetachmentFunctions(const Texture &texture, const Material &material, const Criteria &criteria) :
    criteria(criteria), friction(material.friction), rolling(material.rolling), damping(material.damping),
    carrier_radius(texture.carrier_radius), sites(texture.grains.size())
{
  const int n = grains();
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  order_in_patches(texture.grains, order.data(), order.data() + n);
  all.assign((n + PATCH - 1) / PATCH, ~uint64_t(0));
  if (n % PATCH) all.back() = (uint64_t(1) << (n % PATCH)) - 1;

  const auto mass_of = [&](const Grain &g) {
    return 4.0 / 3.0 * PI * g.radius * g.radius * g.radius * material.density;
  };
  // equal grains have exactly the mean mass, whatever the round-off of a sum
  const auto by_radius = [](const Grain &a, const Grain &b) { return a.radius < b.radius; };
  const auto [finest, coarsest] = std::minmax_element(texture.grains.begin(), texture.grains.end(), by_radius);
  mass = 0.0;
  for (const Grain &g : texture.grains) mass += mass_of(g) / n;
  if (finest->radius == coarsest->radius) mass = mass_of(*finest);

  least = slow2 = INF;
  largest = reach = 0.0;
  for (int bit = 0; bit < n; bit++) {
    const Grain &g = texture.grains[order[bit]];
    const double r12 = effective_radius(texture.carrier_radius, g.radius);
    Site &site = sites[bit];
    std::copy_n(g.n, 3, site.n);
    site.hold = pull_off_force(material.gamma, r12) / mass_of(g);
    site.lever = equilibrium_contact_radius(material.gamma, r12, material.modulus) / g.radius;
    site.shell = texture.carrier_radius + g.radius;
    site.weight = mass_of(g) / mass;
    site.grain = order[bit];
    least = std::min(least, site.hold);
    largest = std::max(largest, site.hold);
    reach = std::max(reach, site.shell);
    slow2 = std::min(slow2, site.hold * site.shell);
  }
  // g_t + slope g_n of a given |g| is at most sqrt(1 + slope^2) |g|
  for (Mode mode : {SLIDING, ROLLING}) {
    least_to[mode] = INF;
    for (const Site &site : sites) {
      const auto [factor, slope] = limit(mode, site.lever);
      least_to[mode] = std::min(least_to[mode], factor * slope / std::sqrt(1.0 + slope * slope) * site.hold);
    }
  }
  // all leave that feel c; without friction they roll at some force, too
  moving = std::clamp(least_to[SLIDING], 0.1 * least, least);
  if (criteria.ibrahim) moving = std::min({least_to[SLIDING], least_to[ROLLING], least});
  still2 = moving * moving / 3.0;
  per_arm2 = std::pow(reach / (0.4 * carrier_radius * carrier_radius), 2);

  patches.resize(words());
  for (int p = 0; p < words(); p++) {
    Patch &patch = patches[p];
    patch = {{0.0, 0.0, 0.0}, 0.0, INF, 0.0, INF, 0.0, INF};
    const auto site_at = [&](int k) -> const Site & { return sites[p * PATCH + k]; };
    each_bit(all[p], [&](int k) {
      const Site &site = site_at(k);
      for (int d = 0; d < 3; d++) patch.centre[d] += site.n[d];
      patch.least_hold = std::min(patch.least_hold, site.hold);
      patch.largest_hold = std::max(patch.largest_hold, site.hold);
      patch.least_shell = std::min(patch.least_shell, site.shell);
      patch.least_lever = std::min(patch.least_lever, site.lever);
      patch.largest_lever = std::max(patch.largest_lever, site.lever);
    });
    const double size = std::sqrt(dot(patch.centre, patch.centre));
    for (int d = 0; d < 3; d++) patch.centre[d] = size > 0.0 ? patch.centre[d] / size : site_at(0).n[d];
    each_bit(all[p], [&](int k) {
      const double *n = site_at(k).n;
      const double r[3] = {n[0] - patch.centre[0], n[1] - patch.centre[1], n[2] - patch.centre[2]};
      patch.radius = std::max(patch.radius, std::sqrt(dot(r, r)));
    });
  }
}

/* ---------------------------------------------------------------------- */

bool DetachmentFunctions::may_move(const Motion &m) const
{
  return std::sqrt(dot(m.acceleration, m.acceleration)) + reach * m.turning() > moving;
}

/* ----------------------------------------------------------------------
   sliding and rolling of Eq. 2
------------------------------------------------------------------------- */

DetachmentFunctions::Load DetachmentFunctions::load(int bit, const Motion &motion) const
{
  const Site &site = sites[bit];
  const double *a = motion.acceleration;
  double g[3] = {-a[0], -a[1], -a[2]};
  if (motion.turns()) motion.inertia(site.n, site.shell, g);
  const double gn = dot(g, site.n), gt2 = dot(g, g) - gn * gn;
  return {gn, std::sqrt(std::max(0.0, gt2))};
}

double DetachmentFunctions::excess(Mode mode, int bit, const Load &load) const
{
  const auto [factor, slope] = limit(mode, sites[bit].lever);
  return load.gt - slope * std::fabs(factor * sites[bit].hold - load.gn);
}

// from the value at the centre: a chord r changes g by at most |r_pd| (|alpha| + 3 omega^2) r, g_n and g_t by |g| r more
DetachmentFunctions::Range DetachmentFunctions::excess_in_patch(Mode mode, int p, const Motion &motion) const
{
  const Patch &patch = patches[p];
  const double *a = motion.acceleration;
  double g[3] = {-a[0], -a[1], -a[2]}, turned = 0.0;
  if (motion.turns()) {
    motion.inertia(patch.centre, reach, g);
    turned = (3.0 * reach * patch.radius + reach - patch.least_shell) * motion.turning();
  }
  const double gn = dot(g, patch.centre), size2 = dot(g, g), gt = std::sqrt(std::max(0.0, size2 - gn * gn));
  const double change = std::sqrt(size2) * patch.radius + turned;
  const Limit most = limit(mode, patch.largest_lever), least = limit(mode, patch.least_lever);
  const double below = most.factor * patch.least_hold - gn, above = most.factor * patch.largest_hold - gn;
  const double far = std::max(std::fabs(below), std::fabs(above)), close = std::max({0.0, below, -above});
  constexpr double ROUND_OFF = 1.0e-9;
  const double margin = (1.0 + most.slope) * change + ROUND_OFF * (gt + most.slope * far);
  return {gt - most.slope * far - margin, gt - least.slope * close + margin};
}

/* ---------------------------------------------------------------------- */

void Collision::begin(const Quaternion &orientation, const double *spin)
{
  course = Course{};
  course.frame = orientation;
  std::copy_n(spin, 3, course.spin0);
  if (record) record->clear();
  strong.reset();
}

void Collision::release(Workspace &work)
{
  if (strong) work.idle.push_back(std::move(strong));
}

/* ---------------------------------------------------------------------- */

void Collision::become_strong(const DetachmentFunctions &df, Workspace &work)
{
  if (work.idle.empty()) work.idle.push_back(std::make_unique<Strong>());
  strong = std::move(work.idle.back());
  work.idle.pop_back();
  strong->state = {};
  strong->state.now = course.frame;
  strong->state.now.turn_by(course.turned, 1.0);
  strong->start.clear();
  strong->history.clear();
  strong->window.close();
  if (course.steps == 0.0) return;
  const bool turns = df.reach * course.largest.turning() > ROUND_OFF * std::sqrt(course.largest2);
  strong->history.add(largest_of_weak(), course.largest2, turns);
}

/* ---------------------------------------------------------------------- */

bool Collision::step(const DetachmentFunctions &df, const Motion &middle, double dt, uint64_t *attached,
                     Workspace &work)
{
  Course &c = course;
  Motion motion = middle;
  for (int d = 0; d < 3; d++) motion.spin[d] += 0.5 * dt * middle.angular_acceleration[d];
  const double size2 = dot(motion.acceleration, motion.acceleration), size = std::sqrt(size2);
  const double turning = df.reach * motion.turning();
  const bool may_move = size + turning > df.moving, first = c.steps == 0.0;

  if (weak()) {
    if (!first)
      for (int d = 0; d < 3; d++) c.turned[d] += middle.spin[d] * dt;
    if (!may_move) {
      add(df, motion, dt);
      if (!first && size2 <= c.largest2) return false;
      c.largest2 = size2;
      c.largest = motion;
      std::copy_n(c.turned, 3, c.largest_turned);
      mark_lively();
      return false;
    }
    become_strong(df, work);
  } else
    strong->state.now.turn_by(middle.spin, dt);

  Strong &s = *strong;
  const AccelerationHistory &history = s.history;
  const bool lively = may_move || size2 > history.peak2();
  if (!lively && c.lively_end == c.steps) {
    s.state.lively.time = c.time;
    std::copy_n(c.impulse, 3, s.state.lively.impulse);
  }
  add(df, motion, dt);
  if (lively) {
    mark_lively();
    std::copy_n(motion.spin, 3, s.state.lively.spin);
  }

  const bool turns = turning > ROUND_OFF * size;
  const Motion m = motion.along(s.state.now);
  const double *w = m.spin, spun = turns ? df.reach * dot(w, w) : 0.0;
  const bool may_lift = size + spun > df.least;
  Split part = {INF, INF};
  if (!history.empty() && size2 <= history.peak2() && (may_lift || !turns))
    part = split(m.acceleration, history.peak().acceleration, history.peak2());
  // between none and the peak no grain meets any criterion that has met none at the peak
  if (!turns && is_between(part, history.peak2()) && !(history.any_turns() && history.peak().turns())) return false;

  // what has held at the peak holds at a part of it, with that part of the room up to c for what comes aside and by spin
  const auto holds = [&]() {
    const double *v = history.peak().spin, more = std::sqrt(part.aside2) + df.reach * spin_difference(w, v);
    return (1.0 - part.lambda) * (df.least - df.reach * dot(v, v)) >= more;
  };
  const size_t before = work.detached.size();
  if (df.criteria.ibrahim)
    check_all(df, m, attached, work);
  else if (may_lift && !(part.lambda >= 0.0 && part.lambda <= 1.0 && holds()))
    lift_off(df, m, attached, work);
  s.history.add(m, size2, turns);
  return work.detached.size() > before;
}

void Collision::add(const DetachmentFunctions &df, const Motion &motion, double dt)
{
  course.steps += 1.0;
  course.time += dt;
  for (int d = 0; d < 3; d++) course.impulse[d] += motion.acceleration[d] * dt;
  if (df.criteria.tangential != Criteria::INTEGRATE) return;
  if (!record) record = std::make_unique<ImpulseRecord>();
  record->add(motion.acceleration, motion.spin, dt);
}

// after a pause longer than the burst before it, another one begins
void Collision::mark_lively()
{
  const double before = course.steps - 1.0;
  if (before - course.lively_end > course.lively_end - course.burst) course.burst = before;
  course.lively_end = course.steps;
}

/* ----------------------------------------------------------------------
   lift-off normal
------------------------------------------------------------------------- */

void Collision::lift_off(const DetachmentFunctions &df, const Motion &motion, uint64_t *attached, Workspace &work)
{
  if (strong->start.empty()) strong->start.assign(attached, attached + df.words());
  work.leaving.clear();
  strong->window.look(df, motion, attached, work.leaving);
  // the order of windows must not show, as a restart opens another one
  if (!std::is_sorted(work.leaving.begin(), work.leaving.end())) std::sort(work.leaving.begin(), work.leaving.end());
  for (int bit : work.leaving) leave_place(df, bit, NORMAL, motion, attached, work);
}

/* ----------------------------------------------------------------------
   all criteria on every grain: few are left to check soon after the first steps, as rolling needs least
------------------------------------------------------------------------- */

void Collision::check_all(const DetachmentFunctions &df, const Motion &motion, uint64_t *attached, Workspace &work)
{
  if (strong->start.empty()) strong->start.assign(attached, attached + df.words());
  for (int p = 0; p < df.words(); p++)
    each_bit(attached[p], [&](int k) {
      const int bit = p * PATCH + k;
      if (df.lift(bit, motion) > df.sites[bit].hold)
        leave_place(df, bit, NORMAL, motion, attached, work);
      else if (df.excess(SLIDING, bit, motion) > 0.0)
        leave_place(df, bit, SLIDING, motion, attached, work);
      else if (df.excess(ROLLING, bit, motion) > 0.0)
        leave_place(df, bit, ROLLING, motion, attached, work);
    });
}

/* ----------------------------------------------------------------------
   at a motion, `now`, which the history does not have yet; or along the surface. Direction and velocity along some axes.
------------------------------------------------------------------------- */

void Collision::leave_place(const DetachmentFunctions &df, int bit, Mode mode, const Motion &motion, uint64_t *attached,
                            Workspace &work)
{
  const auto &site = df.sites[bit];
  double velocity[3] = {};
  if (work.locate) {
    cross(motion.spin, site.n, velocity);
    for (double &x : velocity) x *= site.shell;
  }
  leave(df, bit, mode, strong->state.now, site.n, velocity, &motion, attached, work);
}

void Collision::leave(const DetachmentFunctions &df, int bit, Mode mode, const Quaternion &axes,
                      const double *direction, const double *velocity, const Motion *now, uint64_t *attached,
                      Workspace &work)
{
  attached[bit / PATCH] &= ~(uint64_t(1) << (bit % PATCH));
  if (df.criteria.count) {
    const DetachmentFunctions::Load load = now ? df.load(bit, *now) : DetachmentFunctions::Load{0.0, 0.0};
    for (Mode met : {SLIDING, ROLLING})
      strong->state.count[met] += (now && df.excess(met, bit, load) > 0.0) || has_met(met, df, bit);
  }
  work.detached.push_back({bit, mode, {}, {}});
  if (!work.locate) return;
  axes.to_space(direction, work.detached.back().direction);
  axes.to_space(velocity, work.detached.back().velocity);
}

/* ---------------------------------------------------------------------- */

Motion Collision::largest_of_weak() const
{
  Quaternion then = course.frame;
  then.turn_by(course.largest_turned, 1.0);
  return course.largest.along(then);
}

bool Collision::has_met(Mode mode, const DetachmentFunctions &df, int bit) const
{
  const auto &site = df.sites[bit];
  return strong->history.any([&](const Motion &m) { return df.excess(mode, bit, m); },
                             1.0 + df.limit(mode, site.lever).slope, site.shell);
}

int Collision::grains_that(Mode mode, const DetachmentFunctions &df, const uint64_t *attached) const
{
  if (!df.criteria.count) return 0;
  int n = strong ? static_cast<int>(strong->state.count[mode]) : 0;
  const Motion peak = strong ? strong->history.peak() : largest_of_weak();
  if (!strong && std::sqrt(course.largest2) + df.reach * peak.turning() <= df.least_to[mode]) return n;
  for (int p = 0; p < df.words(); p++) {
    if (!attached[p]) continue;
    const auto [least, largest] = df.excess_in_patch(mode, p, peak);
    if (least > 0.0)
      n += __builtin_popcountll(attached[p]);
    else if (strong || largest > 0.0)
      each_bit(attached[p], [&](int k) {
        const int bit = p * PATCH + k;
        n += strong ? has_met(mode, df, bit) : df.excess(mode, bit, peak) > 0.0;
      });
  }
  return n;
}

/* ---------------------------------------------------------------------- */

double Collision::peak_acceleration() const { return std::sqrt(strong ? strong->history.peak2() : course.largest2); }

/* ---------------------------------------------------------------------- */

bool Collision::end(const DetachmentFunctions &df, const double *spin, uint64_t *attached, Workspace &work)
{
  if (weak() && at_rest()) return false;    // nothing has moved
  const size_t before = work.detached.size();
  if (df.criteria.tangential == Criteria::INTEGRATE) {
    integrate(df, attached, work);
  } else if (df.criteria.tangential != Criteria::OFF) {
    Strong::Moment last;
    if (at_rest()) {
      last = strong->state.lively;
    } else {
      last.time = course.time;
      std::copy_n(course.impulse, 3, last.impulse);
      std::copy_n(spin, 3, last.spin);
    }
    estimate(df, last, attached, work);
  }
  return work.detached.size() > before;
}

/* ----------------------------------------------------------------------
   Eqs. 3b and 4-6
------------------------------------------------------------------------- */

void Collision::estimate(const DetachmentFunctions &df, const Strong::Moment &last, uint64_t *attached, Workspace &work)
{
  double dv[3], spin0[3], spin[3];    // in the frame of first contact
  course.frame.to_body(last.impulse, dv);
  course.frame.to_body(course.spin0, spin0);
  course.frame.to_body(last.spin, spin);
  for (double &x : dv) x = -x;
  const double fastest =
      std::sqrt(dot(dv, dv)) + df.reach * (std::sqrt(dot(spin0, spin0)) + 2.0 * std::sqrt(dot(spin, spin)));
  if (fastest * fastest <= df.slow2) return;
  if (weak()) become_strong(df, work);
  if (strong->start.empty()) strong->start.assign(attached, attached + df.words());

  const AccelerationHistory &history = strong->history;
  const double mu = df.criteria.tangential == Criteria::ESTIMATE ? df.friction : 0.0;
  const double largest_push = std::sqrt(history.peak2());    // on any grain
  size_t hint = 0;
  for (int patch = 0; patch < df.words(); patch++) {
    each_bit(attached[patch], [&](int k) {
      const int bit = patch * PATCH + k;
      const auto &site = df.sites[bit];
      const double *n = site.n, c = site.hold;
      const double dvn = dot(dv, n);
      if (dvn >= 0.0) return;                  // not on the north
      const double needed = c * site.shell;    // square of the velocity from which the grain is not held: Eq. 3b
      // slip over the surface, and the velocity of the surface below the grain's centre
      double slip[3], surface[3], turned[3];
      cross(spin0, n, turned);
      cross(spin, n, surface);
      for (int d = 0; d < 3; d++) {
        surface[d] *= site.shell;
        slip[d] = dv[d] - dvn * n[d] + site.shell * turned[d] - surface[d];    // Eq. 4
      }
      const double slip2 = dot(slip, slip), size = std::sqrt(slip2), surface2 = dot(surface, surface);
      const double fastest = size + std::sqrt(surface2);
      if (fastest * fastest <= needed) return;
      // 2 E_fr/m_d = brake (2 c + largest -g.n) by Eq. 6, as |2 c - g_n| = 2 c - g_n for a grain that has not lifted off
      const double brake = 0.5 * mu * size * last.time;
      const auto part_left = [&](double largest) {    // of the slip, Eq. 5
        return size > 0.0 ? std::sqrt(std::max(0.0, slip2 - brake * (2.0 * c + largest))) / size : 0.0;
      };
      const auto square = [&](double part) { return part * part * slip2 + 2.0 * part * dot(slip, surface) + surface2; };
      // spares most grains that stay the whole history: it is convex in the part that is left
      if (surface2 <= needed && square(part_left(-history.peak().lift(n, site.shell))) <= needed) return;
      // most of the others leave whatever the push was, which then matters to their velocity only
      const bool leaves = surface2 <= needed && square(part_left(largest_push)) > needed;
      if (leaves && !work.locate) {
        leave(df, bit, TANGENTIAL, course.frame, n, surface, nullptr, attached, work);
        return;
      }
      const double part = part_left(history.largest_push(n, site.shell, hint));
      if (square(part) <= needed) return;
      double v[3];
      for (int d = 0; d < 3; d++) v[d] = part * slip[d] + surface[d];
      leave(df, bit, TANGENTIAL, course.frame, n, v, nullptr, attached, work);
    });
  }
}

/* ----------------------------------------------------------------------
   each grain's own motion over the collision, so many at a time
------------------------------------------------------------------------- */

void Collision::integrate(const DetachmentFunctions &df, uint64_t *attached, Workspace &work)
{
  const bool rings = df.damping >= 0.0;
  double spin0[3];
  course.frame.to_body(course.spin0, spin0);
  if (!record) return;    // no step since a restart from a run without INTEGRATE
  record->turn_to(course.frame);
  const MotionBound bound(*record, spin0, peak_acceleration(), df.rolling, df.carrier_radius);
  if (!(rings ? bound.any_may_ring_off(df.least, df.largest, df.reach)
              : bound.any_may_leave(df.least, df.largest, df.reach)))
    return;
  if (weak()) become_strong(df, work);
  if (strong->start.empty()) strong->start.assign(attached, attached + df.words());

  const AccelerationHistory &history = strong->history;
  SurfaceMotion motion(df.friction, df.rolling);
  NormalMotion ringing(df.damping);
  int bits[SurfaceMotion::LANES];
  static_assert(SurfaceMotion::LANES == NormalMotion::LANES, "one grain each");
  const std::vector<Step> followed = steps(spin0);
  const double weak = std::sqrt(course.largest2);
  const auto run = [&]() {
    double load[SurfaceMotion::LANES];
    for (const Step &step : followed) {
      motion.advance(step.acceleration, step.spin, step.dt);
      if (!rings) continue;
      for (int k = 0; k < motion.grains(); k++) load[k] = motion.outward_force(k, step.after) / df.sites[bits[k]].hold;
      ringing.advance(load, step.dt);
    }
    motion.release();
    ringing.ring_out();
    for (int k = 0; k < motion.grains(); k++) {
      if (motion.attached(k) && !(rings && !ringing.attached(k))) continue;
      double n[3], w[3];
      for (int d = 0; d < 3; d++) {
        n[d] = motion.direction(k, d);
        w[d] = motion.velocity(k, d);
      }
      leave(df, bits[k], TANGENTIAL, course.frame, n, w, nullptr, attached, work);
    }
    motion.clear();
    ringing.clear();
  };

  for (int patch = 0; patch < df.words(); patch++)
    each_bit(attached[patch], [&](int k) {
      const int bit = patch * PATCH + k;
      const DetachmentFunctions::Site &site = df.sites[bit];
      if (!rings) {
        const auto [turn, centrifugal] = bound.of(site.n, site.hold, site.shell);
        const double needed = site.hold - centrifugal;
        const auto excess = [&, turn = turn](const Motion &m) {
          const double *a = m.acceleration;
          return turn * std::sqrt(dot(a, a)) - dot(a, site.n) - needed;
        };
        // of the weak time the history has the largest motion only
        if (needed >= weak * (1.0 + turn) && !history.any(excess, 1.0 + turn, 0.0)) return;
      }
      const double radius = site.shell - df.carrier_radius;
      const int lane = motion.grains();
      bits[lane] = bit;
      motion.add(site.n, site.hold, radius, df.carrier_radius, spin0);
      if (rings) {
        constexpr double NONE[3] = {0.0, 0.0, 0.0};
        const double r12 = effective_radius(df.carrier_radius, radius);
        ringing.add(site.hold, breaking_gap(site.lever * radius, r12), motion.outward_force(lane, NONE) / site.hold);
      }
      if (motion.full()) run();
    });
  run();
}

/* ----------------------------------------------------------------------
   the course of the collision in steps small enough to follow grains. What is at the end of a span lies between the
   means of this span and the next; contact forces end at 0
------------------------------------------------------------------------- */

std::vector<Collision::Step> Collision::steps(const double *spin0) const
{
  const std::vector<ImpulseRecord::Span> &spans = record->spans();
  const int parts = static_cast<int>(ImpulseRecord::MOST / 2 / spans.size()) + 1;    // a collision of few time steps
  std::vector<Step> found;
  found.reserve(parts * spans.size());
  double force0[3] = {0.0, 0.0, 0.0}, turn0[3];
  std::copy_n(spin0, 3, turn0);
  for (size_t i = 0; i < spans.size(); i++) {
    const bool last = i + 1 == spans.size();
    const ImpulseRecord::Span &span = spans[i], &next = spans[last ? i : i + 1];
    const double mine = next.duration / (span.duration + next.duration);    // the last span is shorter than others
    for (int k = 1; k <= parts; k++) {
      const double done = static_cast<double>(k) / parts;
      Step step;
      step.dt = span.duration / parts;
      for (int d = 0; d < 3; d++) {
        step.acceleration[d] = span.impulse[d] / span.duration;
        const double force = last ? 0.0 : mine * step.acceleration[d] + (1.0 - mine) * next.impulse[d] / next.duration;
        const double turn = mine * span.turn[d] / span.duration + (1.0 - mine) * next.turn[d] / next.duration;
        step.after[d] = force0[d] + done * (force - force0[d]);
        step.spin[d] = turn0[d] + done * (turn - turn0[d]);
      }
      found.push_back(step);
    }
    std::copy_n(found.back().after, 3, force0);
    std::copy_n(found.back().spin, 3, turn0);
  }
  return found;
}

/* ---------------------------------------------------------------------- */

int Collision::lost_north(const DetachmentFunctions &df, const uint64_t *attached) const
{
  if (weak()) return 0;
  int lost = 0;
  double impulse[3];
  const std::vector<uint64_t> &start = strong->start;
  course.frame.to_body(course.impulse, impulse);
  for (size_t patch = 0; patch < start.size(); patch++)
    each_bit(start[patch] & ~attached[patch],
             [&](int k) { lost += dot(df.sites[static_cast<int>(patch) * PATCH + k].n, impulse) > 0.0; });
  return lost;
}

/* ----------------------------------------------------------------------
   sizes, course and record; then the same of what a strong one has. The window is opened anew, which changes no result.
------------------------------------------------------------------------- */

namespace {

constexpr int SIZES = 2, STRONG_SIZES = 4;
template <typename T> constexpr size_t numbers_of()
{
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0, "travels as doubles");
  return sizeof(T) / sizeof(double);
}

template <typename T> double *put(double *buf, const T *data, size_t count)
{
  if (count) std::memcpy(buf, data, count * sizeof(T));
  return buf + count * numbers_of<T>();
}

template <typename T> const double *get(const double *buf, T *data, size_t count)
{
  if (count) std::memcpy(static_cast<void *>(data), buf, count * sizeof(T));
  return buf + count * numbers_of<T>();
}

}    // namespace

int Collision::packed_size() const
{
  size_t size = SIZES + numbers_of<Course>() + (record ? record->packed_size() : 0);
  if (strong)
    size += STRONG_SIZES + numbers_of<Strong::State>() + strong->start.size() +
            strong->history.kept().size() * numbers_of<Motion>();
  return static_cast<int>(size);
}

void Collision::pack(double *buf) const
{
  *buf++ = strong != nullptr;
  *buf++ = record ? record->packed_size() : 0.0;
  buf = put(buf, &course, 1);
  if (record) {
    record->pack(buf);
    buf += record->packed_size();
  }
  if (!strong) return;
  const std::vector<Motion> &motions = strong->history.kept();
  *buf++ = double(strong->start.size());
  *buf++ = double(motions.size());
  *buf++ = double(strong->history.peak_index());
  *buf++ = strong->history.peak2();
  buf = put(buf, &strong->state, 1);
  buf = put(buf, strong->start.data(), strong->start.size());
  put(buf, motions.data(), motions.size());
}

void Collision::unpack(const double *buf)
{
  const bool was_strong = *buf++ != 0.0;
  const int recorded = static_cast<int>(*buf++);
  buf = get(buf, &course, 1);
  record.reset();
  if (recorded) {
    record = std::make_unique<ImpulseRecord>();
    record->unpack(buf, recorded);
    buf += recorded;
  }
  strong.reset();
  if (!was_strong) return;
  strong = std::make_unique<Strong>();
  strong->start.resize(static_cast<size_t>(*buf++));
  std::vector<Motion> motions(static_cast<size_t>(*buf++));
  const auto peak_index = static_cast<size_t>(*buf++);
  const double peak2 = *buf++;
  buf = get(buf, &strong->state, 1);
  buf = get(buf, strong->start.data(), strong->start.size());
  get(buf, motions.data(), motions.size());
  strong->history.assign(motions.data(), motions.size(), peak_index, peak2);
}
