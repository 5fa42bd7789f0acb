/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "grain_table.h"

#include "geometry.h"
#include "jkr.h"
#include "normal_motion.h"
#include "patch_bits.h"
#include "sticking_criteria.h"
#include "tangential_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace Dust;

namespace {

constexpr double INF = std::numeric_limits<double>::infinity();

// a grain where it is sorted: what is compared lies in a row
struct Place {
  double at;
  int grain;
};

// orders grains so that each run of PATCH is a compact patch: halves the set across its longest side, again and again
void order_in_patches(const std::vector<Grain> &grains, Place *first, Place *last)
{
  const auto count = last - first;
  if (count <= PATCH) return;
  double lo[3] = {2.0, 2.0, 2.0}, hi[3] = {-2.0, -2.0, -2.0};
  for (const Place *i = first; i != last; ++i)
    for (int d = 0; d < 3; d++) {
      lo[d] = std::min(lo[d], grains[i->grain].n[d]);
      hi[d] = std::max(hi[d], grains[i->grain].n[d]);
    }
  int side = 0;
  for (int d = 1; d < 3; d++)
    if (hi[d] - lo[d] > hi[side] - lo[side]) side = d;
  for (Place *i = first; i != last; ++i) i->at = grains[i->grain].n[side];
  Place *middle = first + (count / PATCH + 1) / 2 * PATCH;
  // ties broken by number: the same order on every machine
  std::nth_element(first, middle, last,
                   [](const Place &a, const Place &b) { return a.at != b.at ? a.at < b.at : a.grain < b.grain; });
  order_in_patches(grains, first, middle);
  order_in_patches(grains, middle, last);
}

// in all but its place
bool is_like(const Grain &a, const Grain &b) { return a.radius == b.radius && a.adhesion == b.adhesion; }

// of contacts with a damping ratio: most tables of a process have that of the last one, and finding it takes longest
double overshoot_of(double damping)
{
  if (damping < 0.0) return 0.0;
  thread_local double last = -1.0, overshoot = 0.0;
  if (damping != last) {
    overshoot = Dust::overshoot(damping);
    last = damping;
  }
  return overshoot;
}

}    // namespace

/* ---------------------------------------------------------------------- */

GrainTable::GrainTable(const Texture &texture, const Material &material, const Criteria &criteria) :
    matter(material), asked(criteria), ring(overshoot_of(material.damping)),
    law(tangential_law(criteria.tangential, ring > 0.0)), rp(texture.carrier_radius), sites(texture.grains.size())
{
  const int n = grains();
  all.assign((n + PATCH - 1) / PATCH, ~uint64_t(0));
  if (n % PATCH) all.back() = (uint64_t(1) << (n % PATCH)) - 1;
  fill_sites(texture);
  find_thresholds();
  fill_patches();
}

/* ---------------------------------------------------------------------- */

void GrainTable::fill_sites(const Texture &texture)
{
  const int n = grains();
  std::vector<Place> order(n);
  for (int i = 0; i < n; i++) order[i].grain = i;
  order_in_patches(texture.grains, order.data(), order.data() + n);

  const auto mass_of = [&](const Grain &g) { return 4.0 / 3.0 * PI * g.radius * g.radius * g.radius * matter.density; };
  // equal grains have exactly the mean mass, whatever the round-off of a sum
  const auto by_radius = [](const Grain &a, const Grain &b) { return a.radius < b.radius; };
  const auto [finest, coarsest] = std::minmax_element(texture.grains.begin(), texture.grains.end(), by_radius);
  mass = 0.0;
  for (const Grain &g : texture.grains) mass += mass_of(g) / n;
  if (finest->radius == coarsest->radius) mass = mass_of(*finest);

  for (int bit = 0; bit < n; bit++) {
    const Grain &g = texture.grains[order[bit].grain];
    Site &site = sites[bit];
    if (bit > 0 && is_like(g, texture.grains[order[bit - 1].grain])) {
      site = sites[bit - 1];
    } else {
      const double r12 = effective_radius(rp, g.radius);
      const double gamma = matter.gamma * g.adhesion;    // F_c goes with it, a0 with its cube root
      site.hold = pull_off_force(gamma, r12) / mass_of(g);
      site.lever = equilibrium_contact_radius(gamma, r12, matter.modulus) / g.radius;
      site.shell = rp + g.radius;
      site.weight = mass_of(g) / mass;
    }
    std::copy_n(g.n, 3, site.n);
    site.grain = order[bit].grain;
  }
  const double radius = std::cbrt(mass / (4.0 / 3.0 * PI * matter.density)), r12 = effective_radius(rp, radius);
  const double a0 = equilibrium_contact_radius(matter.gamma, r12, matter.modulus);
  time_of_contact = std::sqrt(mass / (1.2 * matter.modulus * a0));
}

/* ---------------------------------------------------------------------- */

void GrainTable::find_thresholds()
{
  hold_min = velocity2_min = INF;
  hold_max = shell_max = 0.0;
  for (const Site &site : sites) {
    hold_min = std::min(hold_min, site.hold);
    hold_max = std::max(hold_max, site.hold);
    shell_max = std::max(shell_max, site.shell);
    velocity2_min = std::min(velocity2_min, site.hold * site.shell);
  }
  // g_t + slope g_n of a given |g| is at most sqrt(1 + slope^2) |g|
  for (Mode mode : {SLIDING, ROLLING}) {
    force_min[mode] = INF;
    for (const Site &site : sites) {
      const auto [factor, slope] = limit_of(mode, matter.friction, site.lever);
      force_min[mode] = std::min(force_min[mode], factor * slope / std::sqrt(1.0 + slope * slope) * site.hold);
    }
  }
  // all leave that feel c; without friction they roll at some force, too
  moving = std::clamp(force_min[SLIDING], 0.1 * hold_min, hold_min);
  if (asked.ibrahim) moving = std::min({force_min[SLIDING], force_min[ROLLING], hold_min});
  still2 = moving * moving / 3.0;
  inv_arm2 = std::pow(shell_max / (0.4 * rp * rp), 2);
}

/* ---------------------------------------------------------------------- */

void GrainTable::fill_patches()
{
  patches.resize(words());
  for (int p = 0; p < words(); p++) {
    Patch &patch = patches[p];
    patch = {{0.0, 0.0, 0.0}, 0.0, INF, 0.0, INF, 0.0, INF};
    const auto site_at = [&](int k) -> const Site & { return sites[p * PATCH + k]; };
    each_bit(all[p], [&](int k) {
      const Site &site = site_at(k);
      for (int d = 0; d < 3; d++) patch.centre[d] += site.n[d];
      patch.min_hold = std::min(patch.min_hold, site.hold);
      patch.max_hold = std::max(patch.max_hold, site.hold);
      patch.min_shell = std::min(patch.min_shell, site.shell);
      patch.min_lever = std::min(patch.min_lever, site.lever);
      patch.max_lever = std::max(patch.max_lever, site.lever);
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

bool GrainTable::may_move(const Motion &m) const
{
  return std::sqrt(dot(m.acceleration, m.acceleration)) + shell_max * m.rotation_bound() > moving;
}
