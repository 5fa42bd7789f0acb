/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "detachment.h"

#include "jkr.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

using namespace Dust;

namespace {

constexpr int PATCH = 64;
constexpr double NEVER = std::numeric_limits<double>::infinity();
constexpr double PI = 3.14159265358979323846;

double dot(const double *a, const double *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// distance of p from the segment between the origin and q
double distance_to_segment(const double *p, const double *q)
{
  const double qq = dot(q, q);
  const double along = qq > 0.0 ? std::clamp(dot(p, q) / qq, 0.0, 1.0) : 0.0;
  const double r[3] = {p[0] - along * q[0], p[1] - along * q[1], p[2] - along * q[2]};
  return std::sqrt(dot(r, r));
}

// true if p lies between the origin and q, to round-off: q is then at least as large in every direction
bool is_between(const double *p, const double *q)
{
  constexpr double ROUND_OFF = 1.0e-12;
  return distance_to_segment(p, q) <= ROUND_OFF * std::sqrt(dot(q, q));
}

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

DetachmentFunctions::DetachmentFunctions(const Texture &texture, const Material &material, const Criteria &criteria,
                                         double acceleration_unit) :
    criteria(criteria), friction(material.friction), grain_of(texture.grains.size())
{
  std::iota(grain_of.begin(), grain_of.end(), 0);
  order_in_patches(texture.grains, grain_of.data(), grain_of.data() + grain_of.size());

  const int n = grains();
  const int padded = (n + PATCH - 1) / PATCH * PATCH;
  all.assign(padded / PATCH, ~uint64_t(0));
  if (n % PATCH) all.back() = (uint64_t(1) << (n % PATCH)) - 1;
  for (auto *array : {&nx, &ny, &nz, &hold, &lever, &shell, &relative_mass}) array->assign(padded, 0.0);

  const auto mass_of = [&](const Grain &g) { return 4.0 / 3.0 * PI * g.radius * g.radius * g.radius * material.density; };
  // equal grains have exactly the mean mass, whatever the round-off of a sum
  const auto by_radius = [](const Grain &a, const Grain &b) { return a.radius < b.radius; };
  const auto [finest, coarsest] = std::minmax_element(texture.grains.begin(), texture.grains.end(), by_radius);
  mass = 0.0;
  for (const Grain &g : texture.grains) mass += mass_of(g) / n;
  if (finest->radius == coarsest->radius) mass = mass_of(*finest);

  least = slow2 = quiet = NEVER;
  largest = 0.0;
  for (int bit = 0; bit < n; bit++) {
    const Grain &g = texture.grains[grain_of[bit]];
    const double r12 = effective_radius(texture.carrier_radius, g.radius);
    nx[bit] = g.n[0];
    ny[bit] = g.n[1];
    nz[bit] = g.n[2];
    hold[bit] = acceleration_unit * pull_off_force(material.gamma, r12) / mass_of(g);
    lever[bit] = equilibrium_contact_radius(material.gamma, r12, material.modulus) / g.radius;
    shell[bit] = texture.carrier_radius + g.radius;
    relative_mass[bit] = mass_of(g) / mass;
    least = std::min(least, hold[bit]);
    largest = std::max(largest, hold[bit]);
    slow2 = std::min(slow2, hold[bit] * shell[bit]);
    quiet = std::min(quiet, margin_at_rest(bit));
  }
}

/* ----------------------------------------------------------------------
   each criterion's margin is linear in |g| for a direction of g, and changes by at most 1 (lift-off) or
   sqrt(1 + k^2) (g_t against k times a function of g_n) per change of g
------------------------------------------------------------------------- */

double DetachmentFunctions::margin_at_rest(int bit) const
{
  const double slide = 2.0 * friction / std::sqrt(1.0 + friction * friction);
  const double roll = lever[bit] / std::sqrt(1.0 + lever[bit] * lever[bit]);
  return hold[bit] * std::min({1.0, slide, roll});
}

/* ---------------------------------------------------------------------- */

void Collision::begin(const DetachmentFunctions &functions, const double *velocity)
{
  std::copy_n(velocity, 3, v0);
  time = path = 0.0;
  nslid = nrolled = 0;
  std::fill_n(seen, 3, 0.0);
  next_due = functions.quiet;
  start.clear();
  extreme.clear();
  peak = -1;
}

/* ---------------------------------------------------------------------- */

void Collision::wake(const DetachmentFunctions &functions, const uint64_t *attached)
{
  start.assign(attached, attached + functions.words());
  slid.assign(functions.words(), 0);
  rolled.assign(functions.words(), 0);
  due.assign(functions.words(), functions.quiet);
}

/* ---------------------------------------------------------------------- */

bool Collision::step(const DetachmentFunctions &functions, const double *acceleration, double dt, uint64_t *attached,
                     std::vector<Detachment> &detached)
{
  time += dt;
  remember(acceleration);

  const double g[3] = {-acceleration[0], -acceleration[1], -acceleration[2]};
  const double beyond = distance_to_segment(g, seen);
  if (path + beyond < next_due) return false;
  if (start.empty()) wake(functions, attached);

  // [0, g] lies within beyond of what has been seen, as distance from a segment is convex
  path += beyond;
  std::copy_n(g, 3, seen);
  const size_t before = detached.size();
  next_due = NEVER;
  for (int patch = 0; patch < functions.words(); patch++) {
    if (due[patch] <= path) look(functions, patch, g, attached[patch], detached);
    next_due = std::min(next_due, due[patch]);
  }
  return detached.size() > before;
}

/* ----------------------------------------------------------------------
   Eq. 2 and lift-off normal for one patch
------------------------------------------------------------------------- */

void Collision::look(const DetachmentFunctions &df, int patch, const double *g, uint64_t &attached,
                     std::vector<Detachment> &detached)
{
  if (!attached) {
    due[patch] = NEVER;
    return;
  }
  const int base = patch * PATCH;
  const double *nx = &df.nx[base], *ny = &df.ny[base], *nz = &df.nz[base];
  double gn[PATCH], gt[PATCH];
  for (int k = 0; k < PATCH; k++) gn[k] = g[0] * nx[k] + g[1] * ny[k] + g[2] * nz[k];

  const double mu = df.friction;
  const uint64_t here = attached;
  const uint64_t still = here & ~(slid[patch] & rolled[patch]);    // grains that have something to meet but lift-off
  if (still) {
    for (int k = 0; k < PATCH; k++) {
      const double tx = g[0] - gn[k] * nx[k], ty = g[1] - gn[k] * ny[k], tz = g[2] - gn[k] * nz[k];
      gt[k] = std::sqrt(tx * tx + ty * ty + tz * tz);
    }
    each_bit(still, [&](int k) {
      const uint64_t bit = uint64_t(1) << k;
      const double c = df.hold[base + k];
      if (!(slid[patch] & bit) && gt[k] > mu * std::fabs(2.0 * c - gn[k])) {
        slid[patch] |= bit;
        nslid++;
      }
      if (!(rolled[patch] & bit) && gt[k] > df.lever[base + k] * std::fabs(c - gn[k])) {
        rolled[patch] |= bit;
        nrolled++;
      }
    });
  }

  double margin = NEVER;
  each_bit(here, [&](int k) {
    const uint64_t bit = uint64_t(1) << k;
    const double c = df.hold[base + k];
    Mode mode = NMODES;
    if (gn[k] > c)
      mode = NORMAL;
    else if (df.criteria.ibrahim && (slid[patch] & bit))
      mode = SLIDING;
    else if (df.criteria.ibrahim && (rolled[patch] & bit))
      mode = ROLLING;
    if (mode != NMODES) {
      attached &= ~bit;
      detached.push_back({base + k, mode, {0.0, 0.0, 0.0}});
      return;
    }
    // least margin on [0, g]: that at g or that at rest
    margin = std::min({margin, c, c - gn[k]});
    if (!(slid[patch] & bit))
      margin = std::min(margin, std::min(2.0 * mu * c, mu * (2.0 * c - gn[k]) - gt[k]) / std::sqrt(1.0 + mu * mu));
    if (!(rolled[patch] & bit)) {
      const double lever = df.lever[base + k];
      margin = std::min(margin, std::min(lever * c, lever * (c - gn[k]) - gt[k]) / std::sqrt(1.0 + lever * lever));
    }
  });
  constexpr double SAFETY = 1.0 - 1.0e-9;    // against round-off in path and margin
  due[patch] = path + SAFETY * margin;
}

/* ----------------------------------------------------------------------
   keeps accelerations that no other one exceeds in every direction; straight impacts and steady sliding keep one
------------------------------------------------------------------------- */

void Collision::remember(const double *a)
{
  int n = static_cast<int>(extreme.size() / 3);
  if (n && (is_between(a, &extreme[3 * peak]) || is_between(a, &extreme[3 * (n - 1)]))) return;
  for (; n && is_between(&extreme[3 * (n - 1)], a); n--) extreme.resize(3 * (n - 1));
  extreme.insert(extreme.end(), a, a + 3);
  if (peak < 0 || peak >= n || dot(a, a) > dot(&extreme[3 * peak], &extreme[3 * peak])) peak = n;
}

/* ---------------------------------------------------------------------- */

double Collision::largest_along(const double *n) const
{
  double largest = 0.0;
  for (size_t i = 0; i < extreme.size(); i += 3) largest = std::max(largest, dot(&extreme[i], n));
  return largest;
}

/* ---------------------------------------------------------------------- */

double Collision::peak_acceleration() const
{
  return peak < 0 ? 0.0 : std::sqrt(dot(&extreme[3 * peak], &extreme[3 * peak]));
}

/* ---------------------------------------------------------------------- */

bool Collision::end(const DetachmentFunctions &df, const double *velocity, uint64_t *attached,
                    std::vector<Detachment> &detached)
{
  const double dv[3] = {v0[0] - velocity[0], v0[1] - velocity[1], v0[2] - velocity[2]};
  if (df.criteria.tangential == Criteria::OFF || dot(dv, dv) <= df.slow2) return false;
  if (start.empty()) wake(df, attached);

  const double mu = df.criteria.tangential == Criteria::ESTIMATE ? df.friction : 0.0;
  const size_t before = detached.size();
  for (int patch = 0; patch < df.words(); patch++) {
    each_bit(attached[patch], [&](int k) {
      const int bit = patch * PATCH + k;
      const double n[3] = {df.nx[bit], df.ny[bit], df.nz[bit]};
      const double dvn = dot(dv, n);
      if (dvn >= 0.0) return;    // not on the north
      const double c = df.hold[bit];
      const double needed = c * df.shell[bit];    // square of the velocity from which the grain is not held: Eq. 3b
      double vt[3];
      for (int d = 0; d < 3; d++) vt[d] = dv[d] - dvn * n[d];    // Eq. 4
      const double vt2 = dot(vt, vt);
      if (vt2 <= needed) return;
      // 2 E_fr/m_d = brake (2 c + largest a.n) by Eq. 6, as |2 c - g_n| = 2 c + a.n for a grain that has not lifted off
      const double speed = std::sqrt(vt2);
      const double brake = 0.5 * mu * speed * time;
      const auto left = [&](double largest) { return vt2 - brake * (2.0 * c + largest); };    // Eq. 5, squared
      if (left(dot(&extreme[3 * peak], n)) <= needed) return;    // spares most grains that stay the whole history
      const double vt2_left = left(largest_along(n));
      if (vt2_left <= needed) return;
      const double kept = std::sqrt(vt2_left) / speed;
      attached[patch] &= ~(uint64_t(1) << k);
      detached.push_back({bit, TANGENTIAL, {kept * vt[0], kept * vt[1], kept * vt[2]}});
    });
  }
  return detached.size() > before;
}

/* ---------------------------------------------------------------------- */

int Collision::lost_north(const DetachmentFunctions &df, const double *velocity, const uint64_t *attached) const
{
  const double dv[3] = {velocity[0] - v0[0], velocity[1] - v0[1], velocity[2] - v0[2]};
  int lost = 0;
  for (size_t patch = 0; patch < start.size(); patch++)
    each_bit(start[patch] & ~attached[patch], [&](int k) {
      const int bit = static_cast<int>(patch) * PATCH + k;
      if (df.nx[bit] * dv[0] + df.ny[bit] * dv[1] + df.nz[bit] * dv[2] > 0.0) lost++;
    });
  return lost;
}

/* ----------------------------------------------------------------------
   v0, time, counts, seen, path, next_due, peak, sizes; then masks and due of each patch; then extreme
------------------------------------------------------------------------- */

static constexpr int PACKED_SCALARS = 14;

int Collision::packed_size() const
{
  return static_cast<int>(PACKED_SCALARS + 4 * start.size() + extreme.size());
}

void Collision::pack(double *buf) const
{
  for (double x : {v0[0], v0[1], v0[2], time, double(nslid), double(nrolled), seen[0], seen[1], seen[2], path, next_due,
                   double(peak), double(start.size()), double(extreme.size())})
    *buf++ = x;
  if (!start.empty()) {
    for (const auto *mask : {&start, &slid, &rolled}) {
      std::memcpy(buf, mask->data(), mask->size() * sizeof(uint64_t));
      buf += mask->size();
    }
    buf = std::copy(due.begin(), due.end(), buf);
  }
  std::copy(extreme.begin(), extreme.end(), buf);
}

int Collision::unpack(const DetachmentFunctions &functions, const double *buf)
{
  const double *p = buf;
  for (double &x : v0) x = *p++;
  time = *p++;
  nslid = static_cast<int>(*p++);
  nrolled = static_cast<int>(*p++);
  for (double &x : seen) x = *p++;
  path = *p++;
  next_due = *p++;
  peak = static_cast<int>(*p++);
  const bool awake = *p++ > 0.0;
  const auto nextreme = static_cast<size_t>(*p++);
  start.clear();
  if (awake) {
    const size_t words = functions.words();
    for (auto *mask : {&start, &slid, &rolled}) {
      mask->resize(words);
      std::memcpy(mask->data(), p, words * sizeof(uint64_t));
      p += words;
    }
    due.assign(p, p + words);
    p += words;
  }
  extreme.assign(p, p + nextreme);
  return static_cast<int>(p + nextreme - buf);
}
