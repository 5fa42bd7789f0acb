/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "detachment.h"

#include "geometry.h"
#include "jkr.h"
#include "motion_bound.h"
#include "normal_motion.h"
#include "surface_motion.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <type_traits>

using namespace Dust;

namespace {

constexpr int PATCH = 64;
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

// calls visit(bit) for each set bit of a word
template <typename Visit> void each_bit(uint64_t word, Visit visit)
{
  for (; word; word &= word - 1) visit(__builtin_ctzll(word));
}

}    // namespace

/* ---------------------------------------------------------------------- */

DetachmentFunctions::DetachmentFunctions(const Texture &texture, const Material &material, const Criteria &criteria) :
    criteria(criteria), friction(material.friction), rolling(material.rolling), damping(material.damping),
    carrier_radius(texture.carrier_radius),
    sites(texture.grains.size())
{
  const int n = grains();
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  order_in_patches(texture.grains, order.data(), order.data() + n);
  all.assign((n + PATCH - 1) / PATCH, ~uint64_t(0));
  if (n % PATCH) all.back() = (uint64_t(1) << (n % PATCH)) - 1;

  const auto mass_of = [&](const Grain &g) { return 4.0 / 3.0 * PI * g.radius * g.radius * g.radius * material.density; };
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
    for (double &x : patch.centre) x /= size;
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

double DetachmentFunctions::excess(Mode mode, int bit, const Motion &motion) const
{
  const Site &site = sites[bit];
  const double *a = motion.acceleration;
  double g[3] = {-a[0], -a[1], -a[2]};
  if (motion.turns()) motion.inertia(site.n, site.shell, g);
  const double gn = dot(g, site.n), gt2 = dot(g, g) - gn * gn;
  const auto [factor, slope] = limit(mode, site.lever);
  return std::sqrt(std::max(0.0, gt2)) - slope * std::fabs(factor * site.hold - gn);
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
  course.frame = course.now = orientation;
  std::copy_n(spin, 3, course.spin0);
  course.weak = 1.0;
  start.clear();
  history.clear();
  record.clear();
  window.along = -1.0;
  window.width = 1.0e-3;
  std::fill_n(window.last, 3, 0.0);
  std::fill_n(window.spin, 3, 0.0);
}

/* ---------------------------------------------------------------------- */

bool Collision::step(const DetachmentFunctions &df, const Motion &middle, double dt, uint64_t *attached, Workspace &work)
{
  Course &c = course;
  Motion in_space = middle;
  const bool turns = middle.turns();
  c.time += dt;
  for (int d = 0; d < 3; d++) {
    c.impulse[d] += middle.acceleration[d] * dt;
    in_space.spin[d] += 0.5 * dt * middle.angular_acceleration[d];
  }
  const bool first = c.steps == 0.0;
  c.steps += 1.0;
  if (df.criteria.tangential == Criteria::INTEGRATE) record.add(in_space.acceleration, in_space.spin, dt);
  // after a pause longer than the burst before it, another one begins
  const auto lively = [&c]() {
    if (c.steps - 1.0 - c.lively_end > c.lively_end - c.burst) c.burst = c.steps - 1.0;
    c.lively_end = c.steps;
  };

  const double size2 = dot(in_space.acceleration, in_space.acceleration);
  if (c.weak > 0.0) {
    if (!first)
      for (int d = 0; d < 3; d++) c.turned[d] += middle.spin[d] * dt;
    if (!df.may_move(in_space)) {
      if (first || size2 > c.largest2) {
        c.largest2 = size2;
        c.largest = in_space;
        std::copy_n(c.turned, 3, c.largest_turned);
        lively();
      }
      return false;
    }
    if (!first) history.add(largest_of_weak(), c.largest2);
    c.now.turn_by(c.turned, 1.0);
    c.weak = 0.0;
  } else if (turns)
    c.now.turn_by(middle.spin, dt);

  const Motion m = in_space.along(c.now);
  const double turning = turns ? m.turning() : 0.0;
  const double most = std::sqrt(size2) + df.reach * turning;    // |g| on any grain
  if (most > df.moving || size2 > history.peak2()) {
    lively();
    std::copy_n(in_space.spin, 3, c.spin);
    c.lively = c;
  }

  Split s = {INF, INF};
  if (!history.empty() && size2 <= history.peak2() && (!turns || most > df.least)) {
    const Motion &peak = history.peak();
    s = split(m.acceleration, peak.acceleration, history.peak2());
    if (!turns && !peak.turns() && is_between(s, history.peak2())) return false;
  }
  const size_t before = work.detached.size();
  if (df.criteria.ibrahim)
    check_all(df, m, attached, work);
  else if (most > df.least) {
    const double spare = (1.0 - s.lambda) * df.least - df.reach * turning;
    if (!(s.lambda >= 0.0 && spare >= 0.0 && s.aside2 <= spare * spare)) lift_off(df, m, attached, work);
  }
  history.add(m, size2);
  return work.detached.size() > before;
}

/* ----------------------------------------------------------------------
   lift-off normal
------------------------------------------------------------------------- */

void Collision::lift_off(const DetachmentFunctions &df, const Motion &motion, uint64_t *attached, Workspace &work)
{
  if (start.empty()) start.assign(attached, attached + df.words());

  work.leaving.clear();
  const double *a = motion.acceleration;
  double along = -dot(a, window.axis);
  const double e[3] = {a[0] + along * window.axis[0], a[1] + along * window.axis[1], a[2] + along * window.axis[2]};
  // omega^2 - (omega.n)^2 changes by at most |change of omega| |sum of both|
  const double *w = motion.spin, *v = window.spin;
  const double change[3] = {w[0] - v[0], w[1] - v[1], w[2] - v[2]}, sum = std::sqrt(dot(w, w)) + std::sqrt(dot(v, v));
  const double strayed = std::sqrt(dot(e, e)) + df.reach * std::sqrt(dot(change, change)) * sum;
  double jump2 = 0.0;
  for (int d = 0; d < 3; d++) {
    jump2 += (a[d] - window.last[d]) * (a[d] - window.last[d]);
    window.last[d] = a[d];
  }
  if (along >= 0.0 && along <= window.along && strayed <= window.aside) {
    window.strayed = std::max(window.strayed, strayed);
  } else if (constexpr double WORTH_IT = 2.0; WORTH_IT * WORTH_IT * jump2 > window_length(df, dot(a, a)) * window_length(df, dot(a, a))) {
    // large steps, as in a bed of soft carriers: a window would be left before it pays
    window.along = -1.0;
    scan(df, motion, attached, work);
    return;
  } else {
    // twice as wide as needed so far
    if (window.along >= 0.0 && along <= window.along) window.width *= 2.0;
    else if (window.along >= 0.0) window.width = 2.0 * window.strayed / window.from;
    window.width = std::clamp(window.width, 1.0e-4, 0.1);
    open_window(df, motion, attached, work);
    along = -dot(a, window.axis);
  }

  const int reached = window.step_of(along);
  for (; window.next < window.candidates.size() && window.candidates[window.next].from <= reached; window.next++)
    window.close.push_back(window.candidates[window.next].bit);
  for (size_t k = 0; k < window.close.size();) {
    const int bit = window.close[k];
    if (df.lift(bit, motion) > df.sites[bit].hold) {
      work.leaving.push_back(bit);
      window.close[k] = window.close.back();
      window.close.pop_back();
    } else
      k++;
  }
  // the order of windows must not show, as a restart opens another one
  if (!std::is_sorted(work.leaving.begin(), work.leaving.end())) std::sort(work.leaving.begin(), work.leaving.end());
  for (int bit : work.leaving) leave_place(df, bit, NORMAL, motion, attached, work);
}

// those that leave now, and nothing for later
void Collision::scan(const DetachmentFunctions &df, const Motion &motion, uint64_t *attached, Workspace &work)
{
  const double *a = motion.acceleration, spun = df.reach * dot(motion.spin, motion.spin), size = std::sqrt(dot(a, a));
  for (int p = 0; p < df.words(); p++) {
    const auto &patch = df.patches[p];
    if (!attached[p] || size * patch.radius - dot(a, patch.centre) + spun <= patch.least_hold) continue;
    each_bit(attached[p], [&](int k) {
      const int bit = p * PATCH + k;
      if (df.lift(bit, motion) > df.sites[bit].hold) leave_place(df, bit, NORMAL, motion, attached, work);
    });
  }
}

/* ----------------------------------------------------------------------
   window from g on: about 500 grains of 4500 to come, whatever |g|, as the number that holds goes with 1/|g|; those that
   lift off at g itself are leaving
------------------------------------------------------------------------- */

void Collision::open_window(const DetachmentFunctions &df, const Motion &motion, const uint64_t *attached, Workspace &work)
{
  constexpr double ROUND_OFF = 1.0e-9;
  const double *a = motion.acceleration, size = std::sqrt(dot(a, a)), spun = df.reach * dot(motion.spin, motion.spin);
  for (int d = 0; d < 3; d++) window.axis[d] = size > 0.0 ? -a[d] / size : d == 2;
  window.from = size;
  window.along = size + window_length(df, size * size);
  // well below what holds a grain, or grains that feel no lift at all would be candidates
  window.aside = std::min(size * window.width, 0.3 * df.least);
  window.strayed = 0.0;
  std::copy_n(motion.spin, 3, window.spin);
  window.steps_per_force = Window::STEPS / (window.along - window.from);
  window.close.clear();
  window.next = 0;
  const double most = window.along * (1.0 + ROUND_OFF), aside = window.aside * (1.0 + ROUND_OFF);

  work.found.clear();
  int count[Window::STEPS + 1] = {};
  for (int p = 0; p < df.words(); p++) {
    const auto &patch = df.patches[p];
    if (!attached[p] || most * std::max(0.0, dot(window.axis, patch.centre) + patch.radius) + aside + spun <= patch.least_hold)
      continue;
    each_bit(attached[p], [&](int k) {
      const int bit = p * PATCH + k;
      const auto &site = df.sites[bit];
      const double u = dot(window.axis, site.n), hold = site.hold - site.shell * motion.centrifugal(site.n);    // what is left
      if (most * std::max(0.0, u) <= hold - aside) return;
      if (df.lift(bit, motion) > site.hold) {
        work.leaving.push_back(bit);
        return;
      }
      const int from = hold > aside ? window.step_of((hold - aside) / u * (1.0 - ROUND_OFF)) : 0;
      work.found.push_back({from, bit});
      count[from + 1]++;
    });
  }
  // in the order of steps along the axis
  std::partial_sum(count, count + Window::STEPS + 1, count);
  window.candidates.resize(work.found.size());
  for (const auto &candidate : work.found) window.candidates[count[candidate.from]++] = candidate;
}

/* ---------------------------------------------------------------------- */

double Collision::window_length(const DetachmentFunctions &df, double size2)
{
  return 0.3 * size2 / df.least + 1.0e-3 * df.least;
}

int Collision::Window::step_of(double force) const
{
  return std::clamp(static_cast<int>((force - from) * steps_per_force), 0, STEPS - 1);
}

/* ----------------------------------------------------------------------
   all criteria on every grain: few are left to check soon after the first steps, as rolling needs least
------------------------------------------------------------------------- */

void Collision::check_all(const DetachmentFunctions &df, const Motion &motion, uint64_t *attached, Workspace &work)
{
  if (start.empty()) start.assign(attached, attached + df.words());
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
  leave(df, bit, mode, course.now, site.n, velocity, &motion, attached, work);
}

void Collision::leave(const DetachmentFunctions &df, int bit, Mode mode, const Quaternion &axes, const double *direction,
                      const double *velocity, const Motion *now, uint64_t *attached, Workspace &work)
{
  attached[bit / PATCH] &= ~(uint64_t(1) << (bit % PATCH));
  for (Mode met : {SLIDING, ROLLING})
    if (df.criteria.count) course.count[met] += (now && df.excess(met, bit, *now) > 0.0) || has_met(met, df, bit);
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
  return history.any([&](const Motion &m) { return df.excess(mode, bit, m); }, 1.0 + df.limit(mode, site.lever).slope, site.shell);
}

int Collision::grains_that(Mode mode, const DetachmentFunctions &df, const uint64_t *attached) const
{
  int n = static_cast<int>(course.count[mode]);
  if (!df.criteria.count) return n;
  const bool weak = course.weak > 0.0;
  const Motion peak = weak ? largest_of_weak() : history.peak();
  if (weak && std::sqrt(course.largest2) + df.reach * peak.turning() <= df.least_to[mode]) return n;
  for (int p = 0; p < df.words(); p++) {
    if (!attached[p]) continue;
    const auto [least, largest] = df.excess_in_patch(mode, p, peak);
    if (least > 0.0)
      n += __builtin_popcountll(attached[p]);
    else if (!weak || largest > 0.0)
      each_bit(attached[p], [&](int k) {
        const int bit = p * PATCH + k;
        n += weak ? df.excess(mode, bit, peak) > 0.0 : has_met(mode, df, bit);
      });
  }
  return n;
}

/* ---------------------------------------------------------------------- */

double Collision::peak_acceleration() const
{
  return std::sqrt(course.weak > 0.0 ? course.largest2 : history.peak2());
}

/* ---------------------------------------------------------------------- */

bool Collision::end(const DetachmentFunctions &df, const double *spin, uint64_t *attached, Workspace &work)
{
  Moment last = course.lively;
  if (at_rest()) {
    if (course.weak > 0.0) return false;    // nothing has moved
  } else {
    last = course;
    std::copy_n(spin, 3, last.spin);
  }
  if (course.weak > 0.0) history.add(largest_of_weak(), course.largest2);
  const size_t before = work.detached.size();
  if (df.criteria.tangential == Criteria::INTEGRATE)
    integrate(df, attached, work);
  else if (df.criteria.tangential != Criteria::OFF)
    estimate(df, last, attached, work);
  return work.detached.size() > before;
}

/* ----------------------------------------------------------------------
   Eqs. 3b and 4-6
------------------------------------------------------------------------- */

void Collision::estimate(const DetachmentFunctions &df, const Moment &last, uint64_t *attached, Workspace &work)
{
  double dv[3], spin0[3], spin[3];    // in the frame of first contact
  course.frame.to_body(last.impulse, dv);
  course.frame.to_body(course.spin0, spin0);
  course.frame.to_body(last.spin, spin);
  for (double &x : dv) x = -x;
  const double fastest = std::sqrt(dot(dv, dv)) + df.reach * (std::sqrt(dot(spin0, spin0)) + 2.0 * std::sqrt(dot(spin, spin)));
  if (fastest * fastest <= df.slow2) return;
  if (start.empty()) start.assign(attached, attached + df.words());

  const double mu = df.criteria.tangential == Criteria::ESTIMATE ? df.friction : 0.0;
  size_t hint = 0;
  for (int patch = 0; patch < df.words(); patch++) {
    each_bit(attached[patch], [&](int k) {
      const int bit = patch * PATCH + k;
      const auto &site = df.sites[bit];
      const double *n = site.n, c = site.hold;
      const double dvn = dot(dv, n);
      if (dvn >= 0.0) return;    // not on the north
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
  record.turn_to(course.frame);
  const MotionBound bound(record, spin0, peak_acceleration(), df.rolling, df.carrier_radius);
  if (!(rings ? bound.any_may_ring_off(df.least, df.largest, df.reach) : bound.any_may_leave(df.least, df.largest, df.reach))) return;
  if (start.empty()) start.assign(attached, attached + df.words());

  SurfaceMotion motion(df.friction, df.rolling);
  NormalMotion ringing(df.damping);
  int bits[SurfaceMotion::LANES];
  static_assert(SurfaceMotion::LANES == NormalMotion::LANES, "one grain each");
  const std::vector<Step> followed = steps(spin0);
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
        if (needed >= 0.0 && !history.any(excess, 1.0 + turn, 0.0)) return;
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
  const std::vector<ImpulseRecord::Span> &spans = record.spans();
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
  int lost = 0;
  double impulse[3];
  course.frame.to_body(course.impulse, impulse);
  for (size_t patch = 0; patch < start.size(); patch++)
    each_bit(start[patch] & ~attached[patch], [&](int k) {
      lost += dot(df.sites[static_cast<int>(patch) * PATCH + k].n, impulse) > 0.0;
    });
  return lost;
}

/* ----------------------------------------------------------------------
   sizes, course; then start, history and record. The window is opened anew, which changes no result.
------------------------------------------------------------------------- */

namespace {

constexpr int PACKED_SIZES = 3;
template <typename T> constexpr size_t numbers_of()
{
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0, "travels as doubles");
  return sizeof(T) / sizeof(double);
}

}    // namespace

int Collision::packed_size() const
{
  return static_cast<int>(PACKED_SIZES + numbers_of<Course>() + start.size() + history.kept().size() * numbers_of<Motion>()) +
      record.packed_size();
}

void Collision::pack(double *buf) const
{
  const std::vector<Motion> &motions = history.kept();
  *buf++ = double(start.size());
  *buf++ = double(motions.size());
  *buf++ = record.packed_size();
  const auto put = [&](const void *data, size_t numbers) {
    std::memcpy(buf, data, numbers * sizeof(double));
    buf += numbers;
  };
  put(&course, numbers_of<Course>());
  put(start.data(), start.size());
  put(motions.data(), motions.size() * numbers_of<Motion>());
  record.pack(buf);
}

void Collision::unpack(const double *buf)
{
  const double none[3] = {0.0, 0.0, 0.0};
  begin(Quaternion(), none);
  start.resize(static_cast<size_t>(*buf++));
  std::vector<Motion> motions(static_cast<size_t>(*buf++));
  const int recorded = static_cast<int>(*buf++);
  const auto get = [&](void *data, size_t numbers) {
    std::memcpy(data, buf, numbers * sizeof(double));
    buf += numbers;
  };
  get(&course, numbers_of<Course>());
  get(start.data(), start.size());
  get(motions.data(), motions.size() * numbers_of<Motion>());
  history.assign(motions.data(), motions.size());
  record.unpack(buf, recorded);
}
