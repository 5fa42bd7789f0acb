/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "tangential_estimate.h"

#include "geometry.h"
#include "patch_bits.h"

#include <algorithm>
#include <cmath>

using namespace Dust;

namespace {

bool may_release(const GrainTable &table, const PastCollision &past)
{
  const double *dv = past.dv, *spin0 = past.spin_before, *spin = past.spin_after;
  const double fastest =
      std::sqrt(dot(dv, dv)) + table.max_shell() * (std::sqrt(dot(spin0, spin0)) + 2.0 * std::sqrt(dot(spin, spin)));
  return !(fastest * fastest <= table.min_critical_velocity2());
}

// a grain's slip over the surface, and the velocity of the surface below the grain's centre
struct Slip {
  double s[3], surface[3];
  double s2, size, surface2;

  Slip(const GrainTable::Site &site, const PastCollision &past, double dvn)
  {
    const double *n = site.n;
    double rotation[3];
    cross(past.spin_before, n, rotation);
    cross(past.spin_after, n, surface);
    for (int d = 0; d < 3; d++) {
      surface[d] *= site.shell;
      s[d] = past.dv[d] - dvn * n[d] + site.shell * rotation[d] - surface[d];    // Eq. 4
    }
    s2 = dot(s, s);
    size = std::sqrt(s2);
    surface2 = dot(surface, surface);
  }
  // v_t^2 with a part of the slip left
  double square(double part) const { return part * part * s2 + 2.0 * part * dot(s, surface) + surface2; }
};

struct Estimate {
  const PastCollision &past;
  const double friction;
  const double max_push;    // on any grain
  const bool located;
  size_t hint = 0;

  // whether a grain leaves, and with which part of its slip
  bool leaves(const GrainTable::Site &site, const Slip &slip, double &part)
  {
    const AccelerationHistory &history = *past.history;
    const double *n = site.n, c = site.hold;
    const double needed = c * site.shell;    // square of the velocity from which the grain is not held: Eq. 3b
    const double fastest = slip.size + std::sqrt(slip.surface2);
    if (fastest * fastest <= needed) return false;
    // 2 E_fr/m_d = brake (2 c + largest -g.n) by Eq. 6, as |2 c - g_n| = 2 c - g_n for a grain that has not lifted off
    const double brake = 0.5 * friction * slip.size * past.duration;
    const auto part_left = [&](double push) {    // of the slip, Eq. 5
      return slip.size > 0.0 ? std::sqrt(std::max(0.0, slip.s2 - brake * (2.0 * c + push))) / slip.size : 0.0;
    };
    // spares most grains that stay the whole history: it is convex in the part that is left
    if (slip.surface2 <= needed && slip.square(part_left(-history.peak().lift(n, site.shell))) <= needed) return false;
    // most of the others leave whatever the push was, which then matters to their velocity only
    if (!located && slip.surface2 <= needed && slip.square(part_left(max_push)) > needed) return true;
    part = part_left(history.max_push(n, site.shell, hint));
    return slip.square(part) > needed;
  }
};

void releases(const GrainTable &table, const PastCollision &past, const uint64_t *attached, bool located,
              double friction, std::vector<Release> &released)
{
  Estimate estimate = {past, friction, past.peak, located};
  for (int word = 0; word < table.words(); word++)
    each_bit(attached[word], [&](int k) {
      const int bit = word * PATCH + k;
      const GrainTable::Site &site = table.site(bit);
      const double dvn = dot(past.dv, site.n);
      if (dvn >= 0.0) return;    // not on the north
      const Slip slip(site, past, dvn);
      double part = 0.0;
      if (!estimate.leaves(site, slip, part)) return;
      Release release = {bit, {site.n[0], site.n[1], site.n[2]}, {}, 0.0};
      for (int d = 0; d < 3; d++) release.velocity[d] = part * slip.s[d] + slip.surface[d];
      released.push_back(release);
    });
}

void with_friction(const GrainTable &table, const PastCollision &past, const uint64_t *attached, bool located,
                   std::vector<Release> &released)
{
  releases(table, past, attached, located, table.material().friction, released);
}

void without_friction(const GrainTable &table, const PastCollision &past, const uint64_t *attached, bool located,
                      std::vector<Release> &released)
{
  releases(table, past, attached, located, 0.0, released);
}

}    // namespace

const TangentialLaw Dust::TANGENTIAL_ESTIMATE = {false, may_release, with_friction};
const TangentialLaw Dust::TANGENTIAL_FRICTIONLESS = {false, may_release, without_friction};
