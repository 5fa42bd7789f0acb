/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "impulse_record.h"

using namespace Dust;

void ImpulseRecord::clear()
{
  recorded.clear();
  steps_per_span = 1;
  steps_of_last = 0;
}

/* ---------------------------------------------------------------------- */

void ImpulseRecord::add(const double *a, const double *spin, double dt)
{
  if (recorded.empty()) {
    recorded.reserve(MAX_SPANS);    // once in the life of a record
    recorded.push_back({});
  } else if (steps_of_last == steps_per_span) {
    if (recorded.size() == MAX_SPANS) merge_neighbours();
    recorded.push_back({});
    steps_of_last = 0;
  }
  Span &last = recorded.back();
  last.duration += dt;
  for (int d = 0; d < 3; d++) {
    last.impulse[d] += a[d] * dt;
    last.angle[d] += spin[d] * dt;
  }
  steps_of_last++;
}

/* ---------------------------------------------------------------------- */

void ImpulseRecord::to_body(const Quaternion &orientation)
{
  if (orientation.is_identity()) return;
  for (Span &span : recorded) {
    orientation.to_body(span.impulse, span.impulse);
    orientation.to_body(span.angle, span.angle);
  }
}

/* ---------------------------------------------------------------------- */

void ImpulseRecord::merge_neighbours()
{
  static_assert(MAX_SPANS % 2 == 0, "spans are merged in pairs");
  for (int k = 0; k < MAX_SPANS / 2; k++) {
    const Span &b = recorded[2 * k + 1];
    Span sum = recorded[2 * k];
    sum.duration += b.duration;
    for (int d = 0; d < 3; d++) {
      sum.impulse[d] += b.impulse[d];
      sum.angle[d] += b.angle[d];
    }
    recorded[k] = sum;
  }
  recorded.resize(MAX_SPANS / 2);
  steps_per_span *= 2;
}

/* ---------------------------------------------------------------------- */

void ImpulseRecord::pack(Packer &packer) const
{
  packer.put(steps_per_span);
  packer.put(steps_of_last);
  packer.put(recorded);
}

void ImpulseRecord::unpack(Unpacker &unpacker)
{
  steps_per_span = static_cast<int>(unpacker.number());
  steps_of_last = static_cast<int>(unpacker.number());
  recorded.reserve(MAX_SPANS);
  unpacker.get(recorded);
}
