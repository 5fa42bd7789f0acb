/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "lift_off_schedule.h"

#include "patch_bits.h"

#include <algorithm>
#include <cmath>
#include <utility>

using namespace Dust;

namespace {

// of g: along an axis, and the most that can come aside of it and by the spin
struct Change {
  double along, aside;
};

Change change(const Motion &from, const Motion &to, const double *axis, double shell)
{
  const double *a = to.acceleration, *b = from.acceleration;
  const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]}, along = dot(d, axis);
  const double e[3] = {d[0] - along * axis[0], d[1] - along * axis[1], d[2] - along * axis[2]};
  return {std::fabs(along), std::sqrt(dot(e, e)) + shell * spin_difference(to.spin, from.spin)};
}

}    // namespace

/* ---------------------------------------------------------------------- */

void LiftOffSchedule::look(const GrainTable &table, const Motion &motion, const uint64_t *attached,
                           std::vector<Loss> &losses)
{
  if (!open) {
    begin(table, motion, attached, losses);
    return;
  }
  const Change moved = change(last, motion, axis, table.max_shell());
  clock += moved.along + moved.aside / ratio;
  if (clock > horizon) {
    begin(table, motion, attached, losses);
    return;
  }
  last = motion;
  const int now = tick_of(clock);
  for (; tick <= now; tick++)
    for (int k = std::exchange(first[tick], NONE), next; k != NONE; k = next) {
      next = entries[k].next;
      const int bit = entries[k].bit;
      const GrainTable::Site &site = table.site(bit);
      const double missing = site.hold - motion.lift(site.n, site.shell);
      if (missing < 0.0)
        losses.push_back({bit, NORMAL});
      else if (const double due = clock + wait(missing, dot(axis, site.n)); due <= horizon)
        put(k, std::max(tick_of(due), now));
    }
  tick = now;
}

/* ----------------------------------------------------------------------
   the calendar takes about 500 grains of 4500 to come while g grows, whatever |g|, as the number that holds goes with
   1/|g|
------------------------------------------------------------------------- */

void LiftOffSchedule::begin(const GrainTable &table, const Motion &motion, const uint64_t *attached,
                            std::vector<Loss> &losses)
{
  const double *a = motion.acceleration, size = std::sqrt(dot(a, a)),
               spun = table.max_shell() * dot(motion.spin, motion.spin);
  for (int d = 0; d < 3; d++) axis[d] = size > 0.0 ? -a[d] / size : d == 2;
  const Change step = change(last, motion, axis, table.max_shell());
  last = motion;
  ratio = step.along > 0.0 ? std::clamp(step.aside / step.along, 1.0e-4, 1.0) : 1.0;
  const double length =
      std::min({size, 0.3 * size * size / table.min_hold() + 1.0e-3 * table.min_hold(), 0.2 * size / ratio});
  // large steps, as in a bed of soft carriers: it would end before it pays
  constexpr double WORTH_IT = 2.0;
  const bool pays = length > WORTH_IT * (step.along + step.aside / ratio);
  clock = 0.0;
  open = pays;
  horizon = pays ? length : 0.0;
  tick = 0;
  entries.clear();
  if (pays) first.assign(TICKS, NONE);

  constexpr double ROUND_OFF = 1.0e-11;
  margin = ROUND_OFF * (size + spun);
  const auto is_late = [&](double missing, double u) {
    return missing - margin > horizon * std::max(std::fabs(u), ratio);
  };
  for (int p = 0; p < table.words(); p++) {
    const GrainTable::Patch &patch = table.patch(p);
    if (!attached[p]) continue;
    // the first grain to lift off is at the fore end of the patch along the axis, as the horizon is size at most
    const double fore = dot(axis, patch.centre) + patch.radius;
    if (is_late(patch.min_hold - spun - size * fore, fore)) continue;
    each_bit(attached[p], [&](int k) {
      const int bit = p * PATCH + k;
      const GrainTable::Site &site = table.site(bit);
      const double along = dot(axis, site.n);
      if (is_late(site.hold - spun - size * along, along)) return;
      const double missing = site.hold - motion.lift(site.n, site.shell);
      if (missing < 0.0) {
        losses.push_back({bit, NORMAL});
      } else if (const double due = wait(missing, along); pays && due <= horizon) {
        entries.push_back({bit, NONE});
        put(static_cast<int>(entries.size()) - 1, tick_of(due));
      }
    });
  }
}

double LiftOffSchedule::wait(double missing, double u) const
{
  return (missing - margin) / std::max(std::fabs(u), ratio);
}

int LiftOffSchedule::tick_of(double time) const
{
  // in this order also of what is not a number
  return static_cast<int>(std::max(0.0, std::min(TICKS - 1.0, time / horizon * TICKS)));
}
