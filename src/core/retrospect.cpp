/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "retrospect.h"

#include <algorithm>

using namespace Dust;

namespace {

// from u and r at the end of a span to those a time s earlier in it
void go_back(const ImpulseRecord::Span &span, double s, double *u, double *r)
{
  for (int d = 0; d < 3; d++) {
    const double a = span.impulse[d] / span.duration;
    r[d] += s * (0.5 * s * a - u[d]);
    u[d] -= s * a;
  }
}

}    // namespace

Retrospect::Retrospect(const ImpulseRecord &impulses) : record(impulses)
{
  Start start = {};
  for (size_t k = record.spans().size(); k-- > 0;) {
    const ImpulseRecord::Span &span = record.spans()[k];
    go_back(span, span.duration, start.u, start.r);
    start.before_end += span.duration;
    starts[k] = start;
  }
}

void Retrospect::at(double before_end, double *u, double *r) const
{
  const auto &spans = record.spans();
  // the last span that begins no later than then
  size_t k = spans.size();
  while (k > 0 && before_end > (k < spans.size() ? starts[k].before_end : 0.0)) k--;
  const Start end = k + 1 < spans.size() ? starts[k + 1] : Start{};
  std::copy_n(end.u, 3, u);
  std::copy_n(end.r, 3, r);
  if (k < spans.size()) go_back(spans[k], std::min(before_end - end.before_end, spans[k].duration), u, r);
}
