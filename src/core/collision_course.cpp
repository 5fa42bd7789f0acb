/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "collision_course.h"

#include <algorithm>

using namespace Dust;

std::vector<Substep> Dust::substeps(const PastCollision &past)
{
  const std::vector<ImpulseRecord::Span> &spans = past.impulses->spans();
  // more than one a span in a collision of few time steps
  const int parts = static_cast<int>(ImpulseRecord::MAX_SPANS / 2 / spans.size()) + 1;
  std::vector<Substep> found;
  found.reserve(parts * spans.size());
  double force0[3] = {0.0, 0.0, 0.0}, spin0[3];
  std::copy_n(past.spin_before, 3, spin0);
  for (size_t i = 0; i < spans.size(); i++) {
    const bool last = i + 1 == spans.size();
    const ImpulseRecord::Span &span = spans[i], &next = spans[last ? i : i + 1];
    const double mine = next.duration / (span.duration + next.duration);    // the last span is shorter than others
    for (int k = 1; k <= parts; k++) {
      const double done = static_cast<double>(k) / parts;
      Substep step;
      step.dt = span.duration / parts;
      for (int d = 0; d < 3; d++) {
        step.acceleration[d] = span.impulse[d] / span.duration;
        const double force = last ? 0.0 : mine * step.acceleration[d] + (1.0 - mine) * next.impulse[d] / next.duration;
        const double spin = mine * span.angle[d] / span.duration + (1.0 - mine) * next.angle[d] / next.duration;
        step.acceleration_after[d] = force0[d] + done * (force - force0[d]);
        step.spin_after[d] = spin0[d] + done * (spin - spin0[d]);
      }
      found.push_back(step);
    }
    std::copy_n(found.back().acceleration_after, 3, force0);
    std::copy_n(found.back().spin_after, 3, spin0);
  }
  double rest = 0.0;
  for (auto step = found.rbegin(); step != found.rend(); ++step) {
    step->before_end = rest + 0.5 * step->dt;
    rest += step->dt;
  }
  return found;
}
