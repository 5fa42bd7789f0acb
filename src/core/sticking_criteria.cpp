/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "sticking_criteria.h"

#include "geometry.h"
#include "patch_bits.h"

#include <algorithm>
#include <cmath>

using namespace Dust;

Load Dust::load_on(const GrainTable::Site &site, const Motion &motion)
{
  const double *a = motion.acceleration;
  double g[3] = {-a[0], -a[1], -a[2]};
  if (motion.rotates()) motion.inertia(site.n, site.shell, g);
  const double gn = dot(g, site.n), gt2 = dot(g, g) - gn * gn;
  return {gn, std::sqrt(std::max(0.0, gt2))};
}

/* ---------------------------------------------------------------------- */

double Dust::excess(const GrainTable &table, Mode mode, int bit, const Load &load)
{
  const GrainTable::Site &site = table.site(bit);
  const auto [factor, slope] = limit_of(mode, table.material().friction, site.lever);
  return load.tangential - slope * std::fabs(factor * site.hold - load.normal);
}

/* ----------------------------------------------------------------------
   from the value at the centre: a chord r changes g by at most |r_pd| (|alpha| + 3 omega^2) r, g_n and g_t by |g| r
   more
------------------------------------------------------------------------- */

Range Dust::excess_in_patch(const GrainTable &table, Mode mode, int word, const Motion &motion)
{
  const GrainTable::Patch &patch = table.patch(word);
  const double *a = motion.acceleration, shell = table.max_shell();
  double g[3] = {-a[0], -a[1], -a[2]}, rotation = 0.0;
  if (motion.rotates()) {
    motion.inertia(patch.centre, shell, g);
    rotation = (3.0 * shell * patch.radius + shell - patch.min_shell) * motion.rotation_bound();
  }
  const double gn = dot(g, patch.centre), size2 = dot(g, g), gt = std::sqrt(std::max(0.0, size2 - gn * gn));
  const double change = std::sqrt(size2) * patch.radius + rotation, friction = table.material().friction;
  const Limit steep = limit_of(mode, friction, patch.max_lever), flat = limit_of(mode, friction, patch.min_lever);
  const double below = steep.factor * patch.min_hold - gn, above = steep.factor * patch.max_hold - gn;
  const double far = std::max(std::fabs(below), std::fabs(above)), close = std::max({0.0, below, -above});
  constexpr double ROUND_OFF = 1.0e-9;
  const double margin = (1.0 + steep.slope) * change + ROUND_OFF * (gt + steep.slope * far);
  return {gt - steep.slope * far - margin, gt - flat.slope * close + margin};
}

/* ----------------------------------------------------------------------
   every grain is asked: few are left soon after the first steps, as rolling needs least
------------------------------------------------------------------------- */

void Dust::find_losses(const GrainTable &table, const Motion &motion, const uint64_t *attached,
                       std::vector<Loss> &losses)
{
  for (int word = 0; word < table.words(); word++)
    each_bit(attached[word], [&](int k) {
      const int bit = word * PATCH + k;
      const GrainTable::Site &site = table.site(bit);
      if (motion.lift(site.n, site.shell) > site.hold)
        losses.push_back({bit, NORMAL});
      else if (excess(table, SLIDING, bit, motion) > 0.0)
        losses.push_back({bit, SLIDING});
      else if (excess(table, ROLLING, bit, motion) > 0.0)
        losses.push_back({bit, ROLLING});
    });
}
