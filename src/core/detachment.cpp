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
constexpr double INF = std::numeric_limits<double>::infinity();
constexpr double PI = 3.14159265358979323846;

double dot(const double *a, const double *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// p = lambda q + e with e normal to q, q2 = |q|^2; returns lambda and |e|^2
struct Split {
  double lambda, aside2;
};
Split split(const double *p, const double *q, double q2)
{
  const double lambda = dot(p, q) / q2;
  const double e[3] = {p[0] - lambda * q[0], p[1] - lambda * q[1], p[2] - lambda * q[2]};
  return {lambda, dot(e, e)};
}

// true if p lies between the origin and q, to round-off: q is then at least as large in every direction
bool is_between(const Split &s, double q2)
{
  constexpr double ROUND_OFF2 = 1.0e-24;
  return s.lambda >= 0.0 && s.lambda <= 1.0 && s.aside2 <= ROUND_OFF2 * q2;
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

DetachmentFunctions::DetachmentFunctions(const Texture &texture, const Material &material, const Criteria &criteria) :
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

  least = slow2 = INF;
  largest = 0.0;
  for (int bit = 0; bit < n; bit++) {
    const Grain &g = texture.grains[grain_of[bit]];
    const double r12 = effective_radius(texture.carrier_radius, g.radius);
    nx[bit] = g.n[0];
    ny[bit] = g.n[1];
    nz[bit] = g.n[2];
    hold[bit] = pull_off_force(material.gamma, r12) / mass_of(g);
    lever[bit] = equilibrium_contact_radius(material.gamma, r12, material.modulus) / g.radius;
    shell[bit] = texture.carrier_radius + g.radius;
    relative_mass[bit] = mass_of(g) / mass;
    least = std::min(least, hold[bit]);
    largest = std::max(largest, hold[bit]);
    slow2 = std::min(slow2, hold[bit] * shell[bit]);
  }

  patches.resize(words());
  for (int p = 0; p < words(); p++) {
    Patch &patch = patches[p];
    patch = {{0.0, 0.0, 0.0}, 0.0, INF};
    const auto grain_at = [&](int k) { return texture.grains[grain_of[p * PATCH + k]].n; };
    each_bit(all[p], [&](int k) {
      for (int d = 0; d < 3; d++) patch.centre[d] += grain_at(k)[d] / __builtin_popcountll(all[p]);
      patch.hold = std::min(patch.hold, hold[p * PATCH + k]);
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

static double tangential(const double *g, double gn, double nx, double ny, double nz)
{
  const double t[3] = {g[0] - gn * nx, g[1] - gn * ny, g[2] - gn * nz};
  return std::sqrt(dot(t, t));
}

bool DetachmentFunctions::slides(int bit, const double *g) const
{
  const double gn = normal(bit, g);
  return tangential(g, gn, nx[bit], ny[bit], nz[bit]) > friction * std::fabs(2.0 * hold[bit] - gn);
}

bool DetachmentFunctions::rolls(int bit, const double *g) const
{
  const double gn = normal(bit, g);
  return tangential(g, gn, nx[bit], ny[bit], nz[bit]) > lever[bit] * std::fabs(hold[bit] - gn);
}

/* ---------------------------------------------------------------------- */

void Collision::begin(const double *velocity)
{
  std::copy_n(velocity, 3, v0);
  time = 0.0;
  nslid = nrolled = 0;
  start.clear();
  extreme.clear();
  peak = -1;
  peak2 = 0.0;
  window.along = -1.0;
  window.width = 1.0e-3;
}

/* ---------------------------------------------------------------------- */

bool Collision::step(const DetachmentFunctions &df, const double *a, double dt, uint64_t *attached,
                     std::vector<Detachment> &detached)
{
  time += dt;
  const double size2 = dot(a, a);
  Split s = {INF, INF};
  if (peak >= 0 && size2 <= peak2) {
    s = split(a, &extreme[3 * peak], peak2);
    if (is_between(s, peak2)) return false;
  }
  const double g[3] = {-a[0], -a[1], -a[2]};
  const size_t before = detached.size();
  if (df.criteria.ibrahim)
    check_all(df, g, attached, detached);
  else if (size2 > df.least * df.least) {
    const double spare = (1.0 - s.lambda) * df.least;
    if (!(s.lambda >= 0.0 && spare >= 0.0 && s.aside2 <= spare * spare)) lift_off(df, g, attached, detached);
  }
  remember(a, size2);
  return detached.size() > before;
}

/* ----------------------------------------------------------------------
   lift-off normal
------------------------------------------------------------------------- */

void Collision::lift_off(const DetachmentFunctions &df, const double *g, uint64_t *attached,
                         std::vector<Detachment> &detached)
{
  if (start.empty()) start.assign(attached, attached + df.words());

  double along = dot(g, window.axis);
  const double e[3] = {g[0] - along * window.axis[0], g[1] - along * window.axis[1], g[2] - along * window.axis[2]};
  if (!(along >= 0.0 && along <= window.along && dot(e, e) <= window.aside * window.aside)) {
    const bool sidewards = window.along >= 0.0 && along <= window.along;
    window.width = std::clamp(window.width * (sidewards ? 2.0 : 0.5), 1.0e-4, 0.1);
    open_window(df, g, attached);
    along = dot(g, window.axis);
  }

  const int reached = window.step_of(along);
  for (; window.next < window.candidates.size() && window.candidates[window.next].from <= reached; window.next++)
    window.close.push_back(window.candidates[window.next].bit);
  const auto before = detached.size();
  for (size_t k = 0; k < window.close.size();) {
    const int bit = window.close[k];
    if (df.normal(bit, g) > df.hold[bit]) {
      leave(df, {bit, NORMAL, {}}, g, attached, detached);
      window.close[k] = window.close.back();
      window.close.pop_back();
    } else
      k++;
  }
  // the order of windows must not show, as a restart opens another one
  std::sort(detached.begin() + before, detached.end(), [](const Detachment &a, const Detachment &b) { return a.bit < b.bit; });
}

/* ----------------------------------------------------------------------
   window from g on: about 500 grains of 4500 to come, whatever |g|, as the number that holds goes with 1/|g|
------------------------------------------------------------------------- */

void Collision::open_window(const DetachmentFunctions &df, const double *g, const uint64_t *attached)
{
  constexpr double ROUND_OFF = 1.0e-9;
  const double size = std::sqrt(dot(g, g));
  for (int d = 0; d < 3; d++) window.axis[d] = g[d] / size;
  window.from = size;
  window.along = size * (1.0 + 0.3 * size / df.least);
  window.aside = size * window.width;
  window.close.clear();
  window.next = 0;
  const double most = window.along * (1.0 + ROUND_OFF), aside = window.aside * (1.0 + ROUND_OFF);

  window.found.clear();
  int count[Window::STEPS + 1] = {};
  for (int p = 0; p < df.words(); p++) {
    const auto &patch = df.patches[p];
    if (!attached[p] || std::max(0.0, most * (dot(window.axis, patch.centre) + patch.radius)) + aside <= patch.hold)
      continue;
    each_bit(attached[p], [&](int k) {
      const int bit = p * PATCH + k;
      const double u = df.normal(bit, window.axis), short_of = df.hold[bit] - aside;
      if (std::max(0.0, most * u) <= short_of) return;
      const int from = short_of > 0.0 ? window.step_of(short_of / u * (1.0 - ROUND_OFF)) : 0;
      window.found.push_back({from, bit});
      count[from + 1]++;
    });
  }
  // in the order of steps along the axis
  std::partial_sum(count, count + Window::STEPS + 1, count);
  window.candidates.resize(window.found.size());
  for (const auto &candidate : window.found) window.candidates[count[candidate.from]++] = candidate;
}

/* ---------------------------------------------------------------------- */

int Collision::Window::step_of(double force) const
{
  return std::clamp(static_cast<int>((force - from) / (along - from) * STEPS), 0, STEPS - 1);
}

/* ----------------------------------------------------------------------
   all criteria on every grain: few are left to check soon after the first steps, as rolling needs least
------------------------------------------------------------------------- */

void Collision::check_all(const DetachmentFunctions &df, const double *g, uint64_t *attached,
                          std::vector<Detachment> &detached)
{
  if (start.empty()) start.assign(attached, attached + df.words());
  for (int p = 0; p < df.words(); p++)
    each_bit(attached[p], [&](int k) {
      const int bit = p * PATCH + k;
      if (df.normal(bit, g) > df.hold[bit])
        leave(df, {bit, NORMAL, {}}, g, attached, detached);
      else if (df.slides(bit, g))
        leave(df, {bit, SLIDING, {}}, g, attached, detached);
      else if (df.rolls(bit, g))
        leave(df, {bit, ROLLING, {}}, g, attached, detached);
    });
}

/* ----------------------------------------------------------------------
   g = inertia force of the current step, which remember() has not seen yet, or null
------------------------------------------------------------------------- */

void Collision::leave(const DetachmentFunctions &df, const Detachment &grain, const double *g, uint64_t *attached,
                      std::vector<Detachment> &detached)
{
  const int bit = grain.bit;
  attached[bit / PATCH] &= ~(uint64_t(1) << (bit % PATCH));
  detached.push_back(grain);
  nslid += (g && df.slides(bit, g)) || once([&](const double *earlier) { return df.slides(bit, earlier); });
  nrolled += (g && df.rolls(bit, g)) || once([&](const double *earlier) { return df.rolls(bit, earlier); });
}

/* ----------------------------------------------------------------------
   true if the inertia force of any step so far passes a test that is convex in it
------------------------------------------------------------------------- */

template <typename Test> bool Collision::once(Test test) const
{
  for (size_t i = extreme.size(); i > 0; i -= 3) {
    const double g[3] = {-extreme[i - 3], -extreme[i - 2], -extreme[i - 1]};
    if (test(g)) return true;
  }
  return false;
}

/* ---------------------------------------------------------------------- */

int Collision::sliding_grains(const DetachmentFunctions &df, const uint64_t *attached) const
{
  int n = nslid;
  for (int p = 0; p < df.words(); p++)
    each_bit(attached[p], [&](int k) { n += once([&](const double *g) { return df.slides(p * PATCH + k, g); }); });
  return n;
}

int Collision::rolling_grains(const DetachmentFunctions &df, const uint64_t *attached) const
{
  int n = nrolled;
  for (int p = 0; p < df.words(); p++)
    each_bit(attached[p], [&](int k) { n += once([&](const double *g) { return df.rolls(p * PATCH + k, g); }); });
  return n;
}

/* ----------------------------------------------------------------------
   keeps accelerations that no other one exceeds in every direction; straight impacts and steady sliding keep one
------------------------------------------------------------------------- */

void Collision::remember(const double *a, double size2)
{
  int n = static_cast<int>(extreme.size() / 3);
  const auto covers = [](const double *q, double q2, const double *p) { return is_between(split(p, q, q2), q2); };
  if (n > peak + 1) {    // step() has compared a with the peak
    const double *last = &extreme[3 * (n - 1)];
    if (covers(last, dot(last, last), a)) return;
  }
  while (n && covers(a, size2, &extreme[3 * (n - 1)])) n--;
  extreme.resize(3 * (n + 1));
  std::copy_n(a, 3, &extreme[3 * n]);
  if (size2 > peak2 || peak >= n) {
    peak = n;
    peak2 = size2;
  }
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
  return std::sqrt(peak2);
}

/* ---------------------------------------------------------------------- */

bool Collision::end(const DetachmentFunctions &df, const double *velocity, uint64_t *attached,
                    std::vector<Detachment> &detached)
{
  const double dv[3] = {v0[0] - velocity[0], v0[1] - velocity[1], v0[2] - velocity[2]};
  if (df.criteria.tangential == Criteria::OFF || dot(dv, dv) <= df.slow2) return false;
  if (start.empty()) start.assign(attached, attached + df.words());

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
      leave(df, {bit, TANGENTIAL, {kept * vt[0], kept * vt[1], kept * vt[2]}}, nullptr, attached, detached);
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
   v0, time, counts, peak, sizes; then start and extreme. The window is opened anew, which changes no result.
------------------------------------------------------------------------- */

static constexpr int PACKED_SCALARS = 9;

int Collision::packed_size() const
{
  return static_cast<int>(PACKED_SCALARS + start.size() + extreme.size());
}

void Collision::pack(double *buf) const
{
  for (double x : {v0[0], v0[1], v0[2], time, double(nslid), double(nrolled), double(peak), double(start.size()),
                   double(extreme.size())})
    *buf++ = x;
  std::memcpy(buf, start.data(), start.size() * sizeof(uint64_t));
  std::copy(extreme.begin(), extreme.end(), buf + start.size());
}

void Collision::unpack(const double *buf)
{
  begin(buf);
  time = buf[3];
  nslid = static_cast<int>(buf[4]);
  nrolled = static_cast<int>(buf[5]);
  peak = static_cast<int>(buf[6]);
  start.resize(static_cast<size_t>(buf[7]));
  std::memcpy(start.data(), buf + PACKED_SCALARS, start.size() * sizeof(uint64_t));
  const double *p = buf + PACKED_SCALARS + start.size();
  extreme.assign(p, p + static_cast<size_t>(buf[8]));
  if (peak >= 0) peak2 = dot(&extreme[3 * peak], &extreme[3 * peak]);
}
