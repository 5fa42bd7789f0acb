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
      drift(speed * (max_spin2 > 0.0 ? 0.92 : 0.2916)), reach(speed * past.duration * (max_spin2 > 0.0 ? 1.0 : 0.5))
  {
  }

  // false only if no grain leaves
  bool may_release() const { return may_release(speed, fastest_of(speed), table.min_hold()); }

  // appends those of a patch that leave
  void releases(int word, uint64_t attached, bool located, std::vector<Release> &released) const
  {
    const GrainTable::Patch &patch = table.patch(word);
    const double dvn = dot(past.dv, patch.centre), change = speed * patch.radius;
    const double min_dvn = std::max(0.0, std::fabs(dvn) - change);
    const double fastest = fastest_of(std::sqrt(std::max(0.0, speed * speed - min_dvn * min_dvn)));
    if (!may_release(dvn + change, fastest, patch.min_hold)) return;
    each_bit(attached, [&](int k) {
      const int bit = word * PATCH + k;
      const GrainTable::Site &site = table.site(bit);
      Slide slide;
      if (!may_leave(site, fastest * fastest, slide)) return;
      if (!located && dot(slide.after, slide.after) > slide.hold_at_end * site.shell) {
        released.push_back({bit, {}, {}, 0.0});
        return;
      }
      Release release = {bit, {}, {}, 0.0};
      if (leaves(site, slide, located, release)) released.push_back(release);
    });
  }

 private:
  const GrainTable &table;
  const PastCollision &past;
  const double speed, max_spin2;    // |Dv|; of omega, squared
  const double amplitude;           // of -a, over Dv
  const double rings;               // overshoot, 0 if the contacts do not
  const double drift, reach;        // bounds, over the velocity of a grain: of what its way adds to F_n, and to Dv.n

  // a grain's velocity relative to the carrier's centre, before the collision and v_t; what holds it at the end
  struct Slide {
    double dvn, before[3] = {0.0, 0.0, 0.0}, after[3], hold_at_end;
  };

  // the velocity of a grain lies between v_t0, what it is carried along with and what that was
  double fastest_of(double max_dvt) const { return max_dvt + table.max_shell() * std::sqrt(max_spin2); }
  // whether grains may leave with a largest Dv.n and velocity, and a least c
  bool may_release(double max_dvn, double fastest, double min_hold) const
  {
    const double ringing = rings * 2.0 / PI * past.peak;    // of a grain that feels the peak until the end
    return !stays(max_dvn, fastest * fastest, table.carrier_radius(), min_hold - ringing);
  }
  // whether a grain that is never faster may come to the side from which inertia lifts it: where not, F_n only grows
  bool may_come_round(double dvn, double fastest2, double shell) const
  {
    return dvn > 0.0 || dvn * dvn * shell * shell < reach * reach * fastest2;
  }
  // whether F_n/m_d does not come to c
  bool stays(double dvn, double fastest2, double shell, double hold) const
  {
    double most = fastest2;    // times |r_pd|
    if (may_come_round(dvn, fastest2, shell))
      most += amplitude * std::max(0.0, dvn) * shell + drift * std::sqrt(fastest2);
    return most <= hold * shell;
  }

  // finds the slide of a grain; false only if it stays
  bool may_leave(const GrainTable::Site &site, double max_fastest2, Slide &slide) const
  {
    slide.dvn = dot(past.dv, site.n);
    slide.hold_at_end = site.hold - (rings > 0.0 ? ringing_of(site) : 0.0);
    if (stays(slide.dvn, max_fastest2, site.shell, slide.hold_at_end)) return false;
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
    const double before2 = dot(slide.before, slide.before);
    const double fastest2 = std::max({dot(slide.after, slide.after), dot(ground, ground), before2});
    if (stays(slide.dvn, fastest2, site.shell, slide.hold_at_end)) return false;

    double slip[3];
    for (int d = 0; d < 3; d++) slip[d] = slide.after[d] - ground[d];
    const double part = part_taken(site, slide.dvn, dot(slip, slip));
    for (int d = 0; d < 3; d++) slide.after[d] -= part * slip[d];
    return !stays(slide.dvn, std::max(dot(slide.after, slide.after), before2), site.shell, slide.hold_at_end);
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
  double part_taken(const GrainTable::Site &site, double dvn, double slip2) const
  {
    const Material &m = table.material();
    const double held = site.hold * past.duration, sliding = m.friction * (2.0 * held - dvn);    // J
    if (!(sliding > 0.0 && slip2 > 0.0)) return 0.0;
    const double slip = std::sqrt(slip2);
    if (sliding <= TO_ROLL * slip) return sliding / slip;
    const double rp = table.carrier_radius();
    const double pivot =
        2.0 * m.rolling * rp * (held + std::sqrt(held * std::max(0.0, held - dvn))) / site.shell;    // K
    const double rolling = TO_ROLL * slip + (1.0 - TO_ROLL) * std::min(slip, pivot);
    return std::min(sliding, rolling) / slip;
  }

  // what F_n at a phase needs of a slide
  struct Course {
    double dvn, dv_before, dv_change;    // Dv along n, the velocity before, and its change
    double before2, both, change2;       // their squares and product

    Course(const double *dv, const Slide &slide) : dvn(slide.dvn)
    {
      double change[3];
      for (int d = 0; d < 3; d++) change[d] = slide.after[d] - slide.before[d];
      dv_before = dot(dv, slide.before);
      dv_change = dot(dv, change);
      before2 = dot(slide.before, slide.before);
      both = dot(slide.before, change);
      change2 = dot(change, change);
    }
  };
  // whether F_n/m_d is above `hold` then
  bool is_lifted(const GrainTable::Site &site, const Course &course, const Phase &phase, double hold) const
  {
    const double w2 = course.before2 + phase.velocity * (2.0 * course.both + phase.velocity * course.change2);
    const double moved = phase.time * course.dv_before + phase.way * course.dv_change;
    const double dvn = course.dvn + past.duration / site.shell * moved;
    return amplitude * phase.sine * dvn + w2 / site.shell > hold;
  }

  // whether it leaves, and when, where and with which velocity
  bool leaves(const GrainTable::Site &site, const Slide &slide, bool located, Release &release) const
  {
    const Course course(past.dv, slide);
    const size_t end = PHASES.size() - 1;
    const double most2 = std::max(dot(slide.after, slide.after), course.before2);
    size_t when = end;
    if (may_come_round(slide.dvn, most2, site.shell)) {
      when = 0;
      while (when < end && !is_lifted(site, course, PHASES[when], site.hold)) when++;
    }
    if (when == end) {
      if (!is_lifted(site, course, PHASES[end], slide.hold_at_end)) return false;
      // F_n has only grown: from when on it could leave
      while (located && when > 0 && is_lifted(site, course, PHASES[when - 1], site.hold)) when--;
    }
    if (located) locate(site, slide, PHASES[when], release);
    return true;
  }
  void locate(const GrainTable::Site &site, const Slide &slide, const Phase &phase, Release &release) const
  {
    double *n = release.direction, *w = release.velocity;
    for (int d = 0; d < 3; d++) {
      const double change = slide.after[d] - slide.before[d];
      w[d] = slide.before[d] + phase.velocity * change;
      n[d] = site.n[d] + past.duration / site.shell * (phase.time * slide.before[d] + phase.way * change);
    }
    // on the sphere
    const double w2 = dot(w, w), inv_size = 1.0 / std::sqrt(dot(n, n));
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
  }
};

/* ---------------------------------------------------------------------- */

bool may_release(const GrainTable &table, const PastCollision &past) { return Impulse(table, past).may_release(); }

void releases(const GrainTable &table, const PastCollision &past, const uint64_t *attached, bool located,
              std::vector<Release> &released)
{
  const Impulse impulse(table, past);
  for (int word = 0; word < table.words(); word++)
    if (attached[word]) impulse.releases(word, attached[word], located, released);
}

}    // namespace

const TangentialLaw Dust::TANGENTIAL_IMPULSE = {false, may_release, releases};
const TangentialLaw Dust::TANGENTIAL_IMPULSE_RINGING = {true, may_release, releases};
