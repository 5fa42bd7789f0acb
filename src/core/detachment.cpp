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
  largest = largest_shell = 0.0;
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
    largest_shell = std::max(largest_shell, site.shell);
    slow2 = std::min(slow2, site.hold * site.shell);
  }

  patches.resize(words());
  for (int p = 0; p < words(); p++) {
    Patch &patch = patches[p];
    patch = {{0.0, 0.0, 0.0}, 0.0, INF};
    const auto grain_at = [&](int k) { return sites[p * PATCH + k].n; };
    each_bit(all[p], [&](int k) {
      for (int d = 0; d < 3; d++) patch.centre[d] += grain_at(k)[d] / __builtin_popcountll(all[p]);
      patch.hold = std::min(patch.hold, sites[p * PATCH + k].hold);
    });
    each_bit(all[p], [&](int k) {
      const double *n = grain_at(k);
      const double r[3] = {n[0] - patch.centre[0], n[1] - patch.centre[1], n[2] - patch.centre[2]};
      patch.radius = std::max(patch.radius, std::sqrt(dot(r, r)));
    });
  }
}

/* ----------------------------------------------------------------------
   sliding and rolling of Eq. 2
------------------------------------------------------------------------- */

DetachmentFunctions::Excess DetachmentFunctions::excess(int bit, const double *g) const
{
  const Site &site = sites[bit];
  const double gn = dot(g, site.n), c = site.hold;
  const double t[3] = {g[0] - gn * site.n[0], g[1] - gn * site.n[1], g[2] - gn * site.n[2]};
  const double gt = std::sqrt(dot(t, t));
  return {gt - friction * std::fabs(2.0 * c - gn), gt - site.lever * std::fabs(c - gn)};
}

/* ---------------------------------------------------------------------- */

void Collision::begin(const double *velocity, const double *spin)
{
  std::copy_n(velocity, 3, v0);
  std::copy_n(spin, 3, spin0);
  time = 0.0;
  nslid = nrolled = 0;
  start.clear();
  history.clear();
  record.clear();
  window.along = -1.0;
  window.width = 1.0e-3;
}

/* ---------------------------------------------------------------------- */

bool Collision::step(const DetachmentFunctions &df, const double *a, const double *spin, double dt, uint64_t *attached,
                     Workspace &work)
{
  time += dt;
  if (df.criteria.tangential == Criteria::INTEGRATE) record.add(a, spin, dt);
  const double size2 = dot(a, a);
  Split s = {INF, INF};
  if (!history.empty() && size2 <= history.peak2()) {
    s = split(a, history.peak(), history.peak2());
    if (is_between(s, history.peak2())) return false;
  }
  const double g[3] = {-a[0], -a[1], -a[2]};
  const size_t before = work.detached.size();
  if (df.criteria.ibrahim)
    check_all(df, g, attached, work);
  else if (size2 > df.least * df.least) {
    const double spare = (1.0 - s.lambda) * df.least;
    if (!(s.lambda >= 0.0 && spare >= 0.0 && s.aside2 <= spare * spare)) lift_off(df, g, attached, work);
  }
  history.add(a, size2);
  return work.detached.size() > before;
}

/* ----------------------------------------------------------------------
   lift-off normal
------------------------------------------------------------------------- */

void Collision::lift_off(const DetachmentFunctions &df, const double *g, uint64_t *attached,
                         Workspace &work)
{
  if (start.empty()) start.assign(attached, attached + df.words());

  work.leaving.clear();
  double along = dot(g, window.axis);
  const double e[3] = {g[0] - along * window.axis[0], g[1] - along * window.axis[1], g[2] - along * window.axis[2]};
  const double aside2 = dot(e, e);
  if (along >= 0.0 && along <= window.along && aside2 <= window.aside * window.aside) {
    window.strayed2 = std::max(window.strayed2, aside2);
  } else {
    // twice as wide as needed so far
    if (window.along >= 0.0 && along <= window.along) window.width *= 2.0;
    else if (window.along >= 0.0) window.width = 2.0 * std::sqrt(window.strayed2) / window.from;
    window.width = std::clamp(window.width, 1.0e-4, 0.1);
    open_window(df, g, attached, work);
    along = dot(g, window.axis);
  }

  const int reached = window.step_of(along);
  for (; window.next < window.candidates.size() && window.candidates[window.next].from <= reached; window.next++)
    window.close.push_back(window.candidates[window.next].bit);
  for (size_t k = 0; k < window.close.size();) {
    const int bit = window.close[k];
    if (df.normal(bit, g) > df.sites[bit].hold) {
      work.leaving.push_back(bit);
      window.close[k] = window.close.back();
      window.close.pop_back();
    } else
      k++;
  }
  // the order of windows must not show, as a restart opens another one
  if (!std::is_sorted(work.leaving.begin(), work.leaving.end())) std::sort(work.leaving.begin(), work.leaving.end());
  for (int bit : work.leaving) leave(df, {bit, NORMAL, {}}, g, attached, work);
}

/* ----------------------------------------------------------------------
   window from g on: about 500 grains of 4500 to come, whatever |g|, as the number that holds goes with 1/|g|; those that
   lift off at g itself are leaving
------------------------------------------------------------------------- */

void Collision::open_window(const DetachmentFunctions &df, const double *g, const uint64_t *attached, Workspace &work)
{
  constexpr double ROUND_OFF = 1.0e-9;
  const double size = std::sqrt(dot(g, g));
  for (int d = 0; d < 3; d++) window.axis[d] = g[d] / size;
  window.from = size;
  window.along = size * (1.0 + 0.3 * size / df.least);
  // well below what holds a grain, or grains that feel no lift at all would be candidates
  window.aside = std::min(size * window.width, 0.3 * df.least);
  window.strayed2 = 0.0;
  window.steps_per_force = Window::STEPS / (window.along - window.from);
  window.close.clear();
  window.next = 0;
  const double most = window.along * (1.0 + ROUND_OFF), aside = window.aside * (1.0 + ROUND_OFF);

  work.found.clear();
  int count[Window::STEPS + 1] = {};
  for (int p = 0; p < df.words(); p++) {
    const auto &patch = df.patches[p];
    if (!attached[p] || most * (dot(window.axis, patch.centre) + patch.radius) + aside <= patch.hold)
      continue;
    each_bit(attached[p], [&](int k) {
      const int bit = p * PATCH + k;
      const double u = df.normal(bit, window.axis), hold = df.sites[bit].hold;
      if (most * u <= hold - aside) return;
      if (df.normal(bit, g) > hold) {
        work.leaving.push_back(bit);
        return;
      }
      const int from = window.step_of((hold - aside) / u * (1.0 - ROUND_OFF));
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

int Collision::Window::step_of(double force) const
{
  return std::clamp(static_cast<int>((force - from) * steps_per_force), 0, STEPS - 1);
}

/* ----------------------------------------------------------------------
   all criteria on every grain: few are left to check soon after the first steps, as rolling needs least
------------------------------------------------------------------------- */

void Collision::check_all(const DetachmentFunctions &df, const double *g, uint64_t *attached,
                          Workspace &work)
{
  if (start.empty()) start.assign(attached, attached + df.words());
  for (int p = 0; p < df.words(); p++)
    each_bit(attached[p], [&](int k) {
      const int bit = p * PATCH + k;
      if (df.normal(bit, g) > df.sites[bit].hold)
        leave(df, {bit, NORMAL, {}}, g, attached, work);
      else if (df.excess(bit, g).sliding > 0.0)
        leave(df, {bit, SLIDING, {}}, g, attached, work);
      else if (df.excess(bit, g).rolling > 0.0)
        leave(df, {bit, ROLLING, {}}, g, attached, work);
    });
}

/* ----------------------------------------------------------------------
   g = inertia force of the current step, which the history does not have yet, or null
------------------------------------------------------------------------- */

void Collision::leave(const DetachmentFunctions &df, const Detachment &grain, const double *g, uint64_t *attached,
                      Workspace &work)
{
  const int bit = grain.bit;
  attached[bit / PATCH] &= ~(uint64_t(1) << (bit % PATCH));
  work.detached.push_back(grain);
  const DetachmentFunctions::Excess now = g ? df.excess(bit, g) : DetachmentFunctions::Excess{0.0, 0.0};
  nslid += now.sliding > 0.0 || has_slid(df, bit);
  nrolled += now.rolling > 0.0 || has_rolled(df, bit);
}

/* ---------------------------------------------------------------------- */

bool Collision::has_slid(const DetachmentFunctions &df, int bit) const
{
  const auto excess = [&](const double *a) {
    const double g[3] = {-a[0], -a[1], -a[2]};
    return df.excess(bit, g).sliding;
  };
  return history.any(excess, 1.0 + df.friction);
}

bool Collision::has_rolled(const DetachmentFunctions &df, int bit) const
{
  const auto excess = [&](const double *a) {
    const double g[3] = {-a[0], -a[1], -a[2]};
    return df.excess(bit, g).rolling;
  };
  return history.any(excess, 1.0 + df.sites[bit].lever);
}

/* ---------------------------------------------------------------------- */

int Collision::sliding_grains(const DetachmentFunctions &df, const uint64_t *attached) const
{
  int n = nslid;
  for (int p = 0; p < df.words(); p++)
    each_bit(attached[p], [&](int k) { n += has_slid(df, p * PATCH + k); });
  return n;
}

int Collision::rolling_grains(const DetachmentFunctions &df, const uint64_t *attached) const
{
  int n = nrolled;
  for (int p = 0; p < df.words(); p++)
    each_bit(attached[p], [&](int k) { n += has_rolled(df, p * PATCH + k); });
  return n;
}

/* ---------------------------------------------------------------------- */

double Collision::peak_acceleration() const
{
  return std::sqrt(history.peak2());
}

/* ---------------------------------------------------------------------- */

bool Collision::end(const DetachmentFunctions &df, const double *velocity, uint64_t *attached,
                    Workspace &work)
{
  const size_t before = work.detached.size();
  if (df.criteria.tangential == Criteria::INTEGRATE)
    integrate(df, attached, work);
  else if (df.criteria.tangential != Criteria::OFF)
    estimate(df, velocity, attached, work);
  return work.detached.size() > before;
}

/* ----------------------------------------------------------------------
   Eqs. 3b and 4-6
------------------------------------------------------------------------- */

void Collision::estimate(const DetachmentFunctions &df, const double *velocity, uint64_t *attached, Workspace &work)
{
  const double dv[3] = {v0[0] - velocity[0], v0[1] - velocity[1], v0[2] - velocity[2]};
  if (dot(dv, dv) <= df.slow2) return;
  if (start.empty()) start.assign(attached, attached + df.words());

  const double mu = df.criteria.tangential == Criteria::ESTIMATE ? df.friction : 0.0;
  size_t hint = 0;
  for (int patch = 0; patch < df.words(); patch++) {
    each_bit(attached[patch], [&](int k) {
      const int bit = patch * PATCH + k;
      const double *n = df.sites[bit].n;
      const double dvn = dot(dv, n);
      if (dvn >= 0.0) return;    // not on the north
      const double c = df.sites[bit].hold;
      const double needed = c * df.sites[bit].shell;    // square of the velocity from which the grain is not held: Eq. 3b
      double vt[3];
      for (int d = 0; d < 3; d++) vt[d] = dv[d] - dvn * n[d];    // Eq. 4
      const double vt2 = dot(vt, vt);
      if (vt2 <= needed) return;
      // 2 E_fr/m_d = brake (2 c + largest a.n) by Eq. 6, as |2 c - g_n| = 2 c + a.n for a grain that has not lifted off
      const double speed = std::sqrt(vt2);
      const double brake = 0.5 * mu * speed * time;
      const auto left = [&](double largest) { return vt2 - brake * (2.0 * c + largest); };    // Eq. 5, squared
      if (left(dot(history.peak(), n)) <= needed) return;    // spares most grains that stay the whole history
      const double vt2_left = left(history.largest_along(n, hint));
      if (vt2_left <= needed) return;
      const double kept = std::sqrt(vt2_left) / speed;
      leave(df, {bit, TANGENTIAL, {kept * vt[0], kept * vt[1], kept * vt[2]}}, nullptr, attached, work);
    });
  }
}

/* ----------------------------------------------------------------------
   each grain's own motion over the collision, so many at a time
------------------------------------------------------------------------- */

void Collision::integrate(const DetachmentFunctions &df, uint64_t *attached, Workspace &work)
{
  const bool rings = df.damping >= 0.0;
  const MotionBound bound(record, spin0, peak_acceleration(), df.rolling, df.carrier_radius);
  if (!rings && !bound.any_may_leave(df.least, df.largest, df.largest_shell)) return;
  if (start.empty()) start.assign(attached, attached + df.words());

  SurfaceMotion motion(df.friction, df.rolling);
  NormalMotion ringing(df.damping);
  int bits[SurfaceMotion::LANES];
  static_assert(SurfaceMotion::LANES == NormalMotion::LANES, "one grain each");
  const std::vector<Step> course = steps();
  const auto run = [&]() {
    double load[SurfaceMotion::LANES];
    for (const Step &step : course) {
      motion.advance(step.acceleration, step.spin, step.dt);
      if (!rings) continue;
      for (int k = 0; k < motion.grains(); k++) load[k] = motion.outward_force(k, step.after) / df.sites[bits[k]].hold;
      ringing.advance(load, step.dt);
    }
    motion.release();
    ringing.ring_out();
    for (int k = 0; k < motion.grains(); k++)
      if (!motion.attached(k) || (rings && !ringing.attached(k)))
        leave(df, {bits[k], TANGENTIAL, {motion.velocity(k, 0), motion.velocity(k, 1), motion.velocity(k, 2)}}, nullptr, attached,
              work);
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
        const auto excess = [&, turn = turn](const double *a) { return turn * std::sqrt(dot(a, a)) - dot(a, site.n) - needed; };
        if (needed >= 0.0 && !history.any(excess, 1.0 + turn)) return;
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

std::vector<Collision::Step> Collision::steps() const
{
  const std::vector<ImpulseRecord::Span> &spans = record.spans();
  const int parts = static_cast<int>(ImpulseRecord::MOST / 2 / spans.size()) + 1;    // a collision of few time steps
  std::vector<Step> course;
  course.reserve(parts * spans.size());
  double force0[3] = {0.0, 0.0, 0.0}, turn0[3];
  std::copy_n(spin0, 3, turn0);
  for (size_t i = 0; i < spans.size(); i++) {
    const bool last = i + 1 == spans.size();
    const ImpulseRecord::Span &span = spans[i], &next = spans[last ? i : i + 1];
    for (int k = 1; k <= parts; k++) {
      const double done = static_cast<double>(k) / parts;
      Step step;
      step.dt = span.duration / parts;
      for (int d = 0; d < 3; d++) {
        step.acceleration[d] = span.impulse[d] / span.duration;
        const double force = last ? 0.0 : 0.5 * (step.acceleration[d] + next.impulse[d] / next.duration);
        const double turn = 0.5 * (span.turn[d] / span.duration + next.turn[d] / next.duration);
        step.after[d] = force0[d] + done * (force - force0[d]);
        step.spin[d] = turn0[d] + done * (turn - turn0[d]);
      }
      course.push_back(step);
    }
    std::copy_n(course.back().after, 3, force0);
    std::copy_n(course.back().spin, 3, turn0);
  }
  return course;
}

/* ---------------------------------------------------------------------- */

int Collision::lost_north(const DetachmentFunctions &df, const double *velocity, const uint64_t *attached) const
{
  const double dv[3] = {velocity[0] - v0[0], velocity[1] - v0[1], velocity[2] - v0[2]};
  int lost = 0;
  for (size_t patch = 0; patch < start.size(); patch++)
    each_bit(start[patch] & ~attached[patch], [&](int k) {
      const int bit = static_cast<int>(patch) * PATCH + k;
      if (df.normal(bit, dv) > 0.0) lost++;
    });
  return lost;
}

/* ----------------------------------------------------------------------
   v0, spin0, time, counts, sizes; then start, history and record. The window is opened anew, which changes no result.
------------------------------------------------------------------------- */

static constexpr int PACKED_SCALARS = 12;

int Collision::packed_size() const
{
  return static_cast<int>(PACKED_SCALARS + start.size() + history.numbers().size()) + record.packed_size();
}

void Collision::pack(double *buf) const
{
  const std::vector<double> &numbers = history.numbers();
  for (double x : {v0[0], v0[1], v0[2], spin0[0], spin0[1], spin0[2], time, double(nslid), double(nrolled),
                   double(start.size()), double(numbers.size()), double(record.packed_size())})
    *buf++ = x;
  std::memcpy(buf, start.data(), start.size() * sizeof(uint64_t));
  record.pack(std::copy(numbers.begin(), numbers.end(), buf + start.size()));
}

void Collision::unpack(const double *buf)
{
  begin(buf, buf + 3);
  time = buf[6];
  nslid = static_cast<int>(buf[7]);
  nrolled = static_cast<int>(buf[8]);
  start.resize(static_cast<size_t>(buf[9]));
  std::memcpy(start.data(), buf + PACKED_SCALARS, start.size() * sizeof(uint64_t));
  const double *p = buf + PACKED_SCALARS + start.size();
  history.assign(p, p + static_cast<size_t>(buf[10]));
  record.unpack(p + static_cast<size_t>(buf[10]), static_cast<int>(buf[11]));
}
