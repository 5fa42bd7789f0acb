/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "grain_pairs.h"

#include "cell_grid.h"
#include "geometry.h"
#include "jkr.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace Dust;

GrainPairs::GrainPairs(const GrainTable &grains, double zeta, double softening) :
    table(grains), gamma(table.material().cohesion * table.material().gamma),
    modulus(table.material().grain_modulus / softening), damping(zeta * std::pow(softening, -0.6)),
    hard_modulus(table.material().grain_modulus), hard_share(std::cbrt(1.0 / softening))
{
  double sum = 0.0;
  for (int bit = 0; bit < table.grains(); bit++) sum += table.site(bit).shell - table.carrier_radius();
  const double mean = sum / table.grains();
  // neighbours within a mean diameter: some steps pass until a grain that flies has come half as far
  skin = 2.0 * mean;
  cell = 2.0 * mean + skin;
  const double largest =
      effective_radius(table.max_shell() - table.carrier_radius(), table.max_shell() - table.carrier_radius());
  longest_neck = breaking_gap(equilibrium_contact_radius(gamma, largest, modulus), largest);
  far = 2.0 * table.max_shell() - table.carrier_radius();
  travelled = skin;
}

/* ---------------------------------------------------------------------- */

void GrainPairs::find(const GrainLanes &grains, const std::vector<char> &present)
{
  // a workspace of the rank: nothing is left in it
  static thread_local CellGrid cells;
  const int n = table.grains();
  cells.clear(far, cell);
  for (int i = 0; i < n; i++)
    if (present[i]) cells.insert(i, grains.place(i));
  pairs.clear();
  for (int i = 0; i < n; i++) {
    if (!present[i]) continue;
    const double *x = grains.place(i), radius = x[3];
    // each grain finds those that are smaller: it need not look further than its own size
    cells.each_near(x, 2.0 * radius + skin, [&](int j) {
      const double *y = grains.place(j), other = y[3];
      if (other > radius || (other == radius && j >= i)) return;
      const double r[3] = {y[0] - x[0], y[1] - x[1], y[2] - x[2]}, reach = radius + other + skin;
      if (dot(r, r) > reach * reach) return;
      const double range = radius + other + longest_neck;
      pairs.emplace_back(std::min(i, j), std::max(i, j),
                         std::nextafter(float(range * range), std::numeric_limits<float>::infinity()));
    });
  }
  const auto before = [](const auto &a, const auto &b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  };
  std::sort(pairs.begin(), pairs.end(), before);
  auto pair = pairs.begin();
  for (const Neck &neck : joined) {
    while (pair != pairs.end() && before(*pair, neck)) ++pair;
    if (pair != pairs.end() && !before(neck, *pair)) pair->neck = true;
  }
}

/* ---------------------------------------------------------------------- */

void GrainPairs::push(GrainLanes &grains, const std::vector<char> &present, double h)
{
  if (2.0 * travelled >= skin) {
    grains.compact();
    find(grains, present);
    travelled = 0.0;
  }
  joined.clear();
  for (Pair &pair : pairs) {
    const double *a = grains.place(pair.first), *b = grains.place(pair.second);
    const double r[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, d2 = dot(r, r);
    pair.neck = d2 <= pair.reach2 && present[pair.first] && present[pair.second] && touch(grains, pair, r, d2, h);
    if (pair.neck) joined.push_back({pair.first, pair.second});
  }
}

// false if they do not touch
bool GrainPairs::touch(GrainLanes &grains, const Pair &pair, const double *r, double d2, double h) const
{
  const int i = pair.first, j = pair.second;
  const double ri = grains.place(i)[3], rj = grains.place(j)[3], distance = std::sqrt(d2);
  const double overlap = ri + rj - distance;
  if (overlap < 0.0 && !pair.neck) return false;
  const double r12 = effective_radius(ri, rj), a0 = equilibrium_contact_radius(gamma, r12, modulus);
  const double gap = breaking_gap(a0, r12), hold = pull_off_force(gamma, r12);
  if (overlap < -gap) return false;
  if (!grains.awake(i) && !grains.awake(j)) return true;

  const double mi = mass(i), mj = mass(j), me = mi * mj / (mi + mj);
  // they touch in the middle of the overlap, by the share of their radii: no angular momentum comes from nowhere
  const double share = distance / (ri + rj), lever_i = share * ri, lever_j = share * rj;
  double n[3], vi[3], vj[3], wi[3], wj[3], spin[3], u[3];    // u: slip of i over j
  grains.velocity(i, vi);
  grains.velocity(j, vj);
  grains.spin(i, wi);
  grains.spin(j, wj);
  for (int d = 0; d < 3; d++) {
    n[d] = r[d] / distance;
    spin[d] = lever_i * wi[d] + lever_j * wj[d];
  }
  cross(spin, n, u);
  for (int d = 0; d < 3; d++) u[d] += vi[d] - vj[d];
  const double closing = dot(u, n);
  for (int d = 0; d < 3; d++) u[d] -= closing * n[d];

  const double part = overlap / gap,
               x = jkr_contact_radius(part, part > 0.0 ? std::sqrt(part / (2.0 * ROOT_6)) + 0.5 : 0.7),
               y3 = x * std::sqrt(x), force = hold * jkr_force(x);
  constexpr double LEAST = 0.1;    // the slope of the branch has no bound at its end, nor its sign a meaning there
  const double slope = (24.0 * y3 - 12.0) * x / (ROOT_6 * std::max(8.0 * y3 - 4.0 / 3.0, LEAST));
  const double stiffness = hold / gap * std::max(slope, LEAST);
  const double hard_a0 = a0 * hard_share;
  const double eta = 2.0 * damping * std::sqrt(1.2 * hard_modulus * hard_a0 / me) / hard_a0;
  const double c = std::min(eta * me * x * a0, 2.0 * std::sqrt(stiffness * me));
  const double normal = (force + c * closing) / (1.0 + (0.5 * c * h + 0.25 * stiffness * h * h) / me);
  const double slip = std::sqrt(dot(u, u)),
               most = std::min(table.material().friction * std::fabs(force + 2.0 * hold), me * slip / (7.0 * h));
  const double rub = slip > 0.0 ? most / slip : 0.0;

  double f[3], torque[3];    // on i; the torque per lever, the same on both
  for (int d = 0; d < 3; d++) f[d] = -normal * n[d] - rub * u[d];
  cross(n, f, torque);
  grains.push(i, f, 1.0 / mi, torque, lever_i / (0.4 * mi * ri * ri));
  grains.push(j, f, -1.0 / mj, torque, lever_j / (0.4 * mj * rj * rj));
  return true;
}
