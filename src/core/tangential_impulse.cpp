/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "tangential_impulse.h"

#include "geometry.h"
#include "patch_bits.h"

#include <algorithm>
#include <cmath>

using namespace Dust;

namespace {

constexpr double TO_ROLL = 2.0 / 7.0;    // of the slip of a solid sphere

// v_t lies between v_t0 and what rolls along with a surface that no friction has slowed, both below this
bool may_release(const GrainTable &table, const PastCollision &past)
{
  const double *dv = past.dv, *spin0 = past.spin_before, *spin = past.spin_after;
  const double max_spin = std::sqrt(std::max(dot(spin0, spin0), dot(spin, spin)));
  const double fastest = std::sqrt(dot(dv, dv)) + table.max_shell() * max_spin;
  return !(fastest * fastest <= table.min_critical_velocity2());
}

class Impulse {
 public:
  Impulse(const GrainTable &grains, const PastCollision &collision) :
      past(collision), friction(grains.material().friction), theta_crit(grains.material().rolling),
      rp(grains.carrier_radius()),
      spins(dot(past.spin_before, past.spin_before) > 0.0 || dot(past.spin_after, past.spin_after) > 0.0)
  {
  }

  // whether a grain leaves, and then with which velocity
  bool releases(const GrainTable::Site &site, double *velocity) const
  {
    const double *n = site.n, c = site.hold, needed = c * site.shell;
    const double dvn = dot(past.dv, n);
    double ground[3] = {0.0, 0.0, 0.0};    // velocity at which a grain does not slip that friction does not spin
    for (int d = 0; d < 3; d++) velocity[d] = past.dv[d] - dvn * n[d];
    if (spins) {
      double before[3], after[3];
      cross(past.spin_before, n, before);
      cross(past.spin_after, n, after);
      for (int d = 0; d < 3; d++) {
        velocity[d] += site.shell * before[d];
        ground[d] = (site.shell - rp) * before[d] + rp * after[d];
      }
    }
    if (std::max(dot(velocity, velocity), dot(ground, ground)) <= needed) return false;

    double slip[3];
    for (int d = 0; d < 3; d++) slip[d] = velocity[d] - ground[d];
    const double part = part_taken(site, dvn, std::sqrt(dot(slip, slip)));
    for (int d = 0; d < 3; d++) velocity[d] -= part * slip[d];
    return dot(velocity, velocity) > needed;
  }

 private:
  const PastCollision &past;
  const double friction, theta_crit, rp;
  const bool spins;

  // of the slip, by friction
  double part_taken(const GrainTable::Site &site, double dvn, double slip) const
  {
    const double held = site.hold * past.duration, sliding = friction * (2.0 * held - dvn);    // J
    if (!(sliding > 0.0)) return 0.0;
    if (sliding <= TO_ROLL * slip) return sliding / slip;
    const double pivot =
        2.0 * theta_crit * rp / site.shell * (held + std::sqrt(held * std::max(0.0, held - dvn)));    // K
    const double rolling = TO_ROLL * slip + (1.0 - TO_ROLL) * std::min(slip, pivot);
    return slip > 0.0 ? std::min(sliding, rolling) / slip : 0.0;
  }
};

void releases(const GrainTable &table, const PastCollision &past, const uint64_t *attached, bool /*located*/,
              std::vector<Release> &released)
{
  const Impulse impulse(table, past);
  for (int word = 0; word < table.words(); word++)
    each_bit(attached[word], [&](int k) {
      const int bit = word * PATCH + k;
      const GrainTable::Site &site = table.site(bit);
      double velocity[3];
      if (!impulse.releases(site, velocity)) return;
      released.push_back({bit, {site.n[0], site.n[1], site.n[2]}, {velocity[0], velocity[1], velocity[2]}});
    });
}

}    // namespace

const TangentialLaw Dust::TANGENTIAL_IMPULSE = {false, may_release, releases};
