/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "tangential_impulse.h"

#include "geometry.h"
#include "jkr.h"
#include "patch_bits.h"

#include <algorithm>
#include <cmath>

using namespace Dust;

namespace {

constexpr double TO_ROLL = 2.0 / 7.0;    // of the slip of a solid sphere

/* ----------------------------------------------------------------------
   shares of the collision that are over at the phase tau of half a sine
------------------------------------------------------------------------- */

struct Phase {
  double time;        // of Dt
  double sine;        // of the largest acceleration
  double velocity;    // of Dv
  double way;         // of Dt Dv, what that has moved

  explicit Phase(double tau) :
      time(tau / PI), sine(std::sin(tau)), velocity(0.5 * (1.0 - std::cos(tau))), way(0.5 * (tau - std::sin(tau)) / PI)
  {
  }
};

// close enough that one between them would add no grain to a thousand
const std::vector<Phase> PHASES = [] {
  constexpr int EACH = 12;
  std::vector<Phase> phases;
  for (int k = EACH / 4; k <= EACH; k++) phases.emplace_back(PI * k / EACH);
  return phases;
}();

/* ---------------------------------------------------------------------- */

class Impulse {
 public:
  Impulse(const GrainTable &grains, const PastCollision &collision) :
      table(grains), past(collision), speed(std::sqrt(dot(past.dv, past.dv))),
      max_spin2(std::max(dot(past.spin_before, past.spin_before), dot(past.spin_after, past.spin_after))),
      amplitude(std::min(0.5 * PI / past.duration, past.peak / speed)), rings(past.impulses ? table.overshoot() : 0.0),
      way(max_spin2 > 0.0 ? 1.0 : 0.5), drift(max_spin2 > 0.0 ? 0.92 : 0.2916)
  {
  }

  // false only if no grain leaves, or none of a patch
  bool may_release() const { return may_release(speed, speed, table.min_hold()); }
  bool may_release(const GrainTable::Patch &patch) const
  {
    const double dvn = dot(past.dv, patch.centre), change = speed * patch.radius;
    const double min_dvn = std::max(0.0, std::fabs(dvn) - change);
    return may_release(dvn + change, std::sqrt(std::max(0.0, speed * speed - min_dvn * min_dvn)), patch.min_hold);
  }

  // whether a grain leaves and, if that is wanted, where and with which velocity
  bool releases(const GrainTable::Site &site, bool located, Release &release) const
  {
    Slide slide;
    slide.dvn = dot(past.dv, site.n);
    for (int d = 0; d < 3; d++) slide.after[d] = past.dv[d] - slide.dvn * site.n[d];
    double ground[3] = {0.0, 0.0, 0.0};    // velocity at which a grain does not slip that friction has not spun
    if (max_spin2 > 0.0) {
      double turned[3];
      cross(past.spin_before, site.n, slide.before);
      cross(past.spin_after, site.n, turned);
      const double rp = table.carrier_radius();
      for (int d = 0; d < 3; d++) {
        ground[d] = (site.shell - rp) * slide.before[d] + rp * turned[d];
        slide.before[d] *= site.shell;
        slide.after[d] += slide.before[d];
      }
    }
    const double fastest2 =
        std::max({dot(slide.after, slide.after), dot(ground, ground), dot(slide.before, slide.before)});
    const double ringing = rings > 0.0 ? ringing_of(site) : 0.0, hold_at_end = site.hold - ringing;
    if (outward_bound(slide.dvn, std::sqrt(fastest2), site.shell) <= hold_at_end) return false;

    double slip[3];
    for (int d = 0; d < 3; d++) slip[d] = slide.after[d] - ground[d];
    const double part = part_taken(site, slide.dvn, std::sqrt(dot(slip, slip)));
    for (int d = 0; d < 3; d++) slide.after[d] -= part * slip[d];
    const double end2 = dot(slide.after, slide.after), most2 = std::max(end2, dot(slide.before, slide.before));
    if (outward_bound(slide.dvn, std::sqrt(most2), site.shell) <= hold_at_end) return false;
    if (!located && end2 > hold_at_end * site.shell) return true;
    if (may_come_round(slide.dvn, std::sqrt(most2), site.shell))
      for (const Phase &phase : PHASES)
        if (leaves(site, slide, phase, site.hold, release)) return true;
    return leaves(site, slide, PHASES.back(), hold_at_end, release);
  }

 private:
  const GrainTable &table;
  const PastCollision &past;
  const double speed, max_spin2;    // |Dv|; of omega, squared
  const double amplitude;           // of -a, over Dv
  const double rings;               // overshoot, 0 if the contacts do not
  const double way, drift;    // bounds of the share `way` and, times pi/2, of sine times way; with spin, of `time`

  // a grain's velocity relative to the carrier's centre, before the collision and v_t
  struct Slide {
    double dvn, before[3] = {0.0, 0.0, 0.0}, after[3];
  };

  // whether grains may leave with a largest Dv.n and [Dv]_t, and a least c
  bool may_release(double max_dvn, double max_dvt, double min_hold) const
  {
    // the velocity of a grain lies between v_t0, what it is carried along with and what that was
    const double fastest = max_dvt + table.max_shell() * std::sqrt(max_spin2);
    const double ringing = rings * 2.0 / PI * past.peak;    // of a grain that feels the peak until the end
    return !(outward_bound(max_dvn, fastest, table.carrier_radius()) + ringing <= min_hold);
  }
  // whether a grain that is never faster may come to the side from which inertia lifts it: where not, F_n only grows
  bool may_come_round(double dvn, double fastest, double shell) const
  {
    return dvn + way * past.duration * speed * fastest / shell > 0.0;
  }
  // F_n/m_d is at most this
  double outward_bound(double dvn, double fastest, double shell) const
  {
    const double centrifugal = fastest * fastest / shell;
    if (!may_come_round(dvn, fastest, shell)) return centrifugal;
    return amplitude * std::max(0.0, dvn) + drift * speed * fastest / shell + centrifugal;
  }

  // what a contact that overshoots adds to F_n/m_d at the end: the load comes to its own in the last half period
  double ringing_of(const GrainTable::Site &site) const
  {
    const double radius = site.shell - table.carrier_radius(), r12 = effective_radius(table.carrier_radius(), radius);
    const double unit = std::sqrt(breaking_gap(site.lever * radius, r12) / site.hold), window = PI * unit;
    const std::vector<ImpulseRecord::Span> &spans = past.impulses->spans();
    double left = window, change = 0.0;
    for (auto span = spans.rbegin(); span != spans.rend() && left > 0.0; ++span) {
      change += std::min(1.0, left / span->duration) * dot(span->impulse, site.n);
      left -= span->duration;
    }
    return rings * unit * std::max(0.0, 2.0 * change / (window * window));
  }

  // of the slip, by friction
  double part_taken(const GrainTable::Site &site, double dvn, double slip) const
  {
    const Material &m = table.material();
    const double held = site.hold * past.duration, sliding = m.friction * (2.0 * held - dvn);    // J
    if (!(sliding > 0.0)) return 0.0;
    if (sliding <= TO_ROLL * slip) return sliding / slip;
    const double lever = 2.0 * m.rolling * table.carrier_radius() / site.shell;
    const double pivot = lever * (held + std::sqrt(held * std::max(0.0, held - dvn)));    // K
    const double rolling = TO_ROLL * slip + (1.0 - TO_ROLL) * std::min(slip, pivot);
    return slip > 0.0 ? std::min(sliding, rolling) / slip : 0.0;
  }

  bool leaves(const GrainTable::Site &site, const Slide &slide, const Phase &phase, double hold, Release &release) const
  {
    double *n = release.direction, *w = release.velocity;
    for (int d = 0; d < 3; d++) {
      const double change = slide.after[d] - slide.before[d];
      w[d] = slide.before[d] + phase.velocity * change;
      n[d] = site.n[d] + past.duration / site.shell * (phase.time * slide.before[d] + phase.way * change);
    }
    const double w2 = dot(w, w);
    if (amplitude * phase.sine * dot(past.dv, n) + w2 / site.shell <= hold) return false;
    // on the sphere
    const double inv_size = 1.0 / std::sqrt(dot(n, n));
    for (int d = 0; d < 3; d++) n[d] *= inv_size;
    const double along = dot(w, n), left = w2 - along * along, longer = left > 0.0 ? std::sqrt(w2 / left) : 0.0;
    // what is left of Dv then, and of the way
    const double time = past.duration * (1.0 - phase.time), way_left = time - past.duration * (0.5 - phase.way);
    release.before_end = time;
    for (int d = 0; d < 3; d++) {
      w[d] = longer * (w[d] - along * n[d]);
      release.carrier_velocity[d] = (1.0 - phase.velocity) * past.dv[d];
      release.carrier_place[d] = -way_left * past.dv[d];
    }
    return true;
  }
};

/* ---------------------------------------------------------------------- */

bool may_release(const GrainTable &table, const PastCollision &past) { return Impulse(table, past).may_release(); }

void releases(const GrainTable &table, const PastCollision &past, const uint64_t *attached, bool located,
              std::vector<Release> &released)
{
  const Impulse impulse(table, past);
  for (int word = 0; word < table.words(); word++) {
    if (!attached[word] || !impulse.may_release(table.patch(word))) continue;
    each_bit(attached[word], [&](int k) {
      Release release;
      release.bit = word * PATCH + k;
      if (impulse.releases(table.site(release.bit), located, release)) released.push_back(release);
    });
  }
}

}    // namespace

const TangentialLaw Dust::TANGENTIAL_IMPULSE = {false, may_release, releases};
const TangentialLaw Dust::TANGENTIAL_IMPULSE_RINGING = {true, may_release, releases};
