/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "impulse_record.h"

#include <cstring>

using namespace Dust;

void ImpulseRecord::clear()
{
  course.clear();
  steps_per_span = 1;
  steps_of_last = 0;
}

/* ---------------------------------------------------------------------- */

void ImpulseRecord::add(const double *a, const double *spin, double dt)
{
  if (course.empty()) {
    course.reserve(MOST);    // once in the life of a record
    course.push_back({});
  } else if (steps_of_last == steps_per_span) {
    if (course.size() == MOST) merge_neighbours();
    course.push_back({});
    steps_of_last = 0;
  }
  Span &last = course.back();
  last.duration += dt;
  for (int d = 0; d < 3; d++) {
    last.impulse[d] += a[d] * dt;
    last.turn[d] += spin[d] * dt;
  }
  steps_of_last++;
}

/* ---------------------------------------------------------------------- */

void ImpulseRecord::turn_to(const Quaternion &axes)
{
  if (axes.is_none()) return;
  for (Span &span : course) {
    axes.to_body(span.impulse, span.impulse);
    axes.to_body(span.turn, span.turn);
  }
}

/* ---------------------------------------------------------------------- */

void ImpulseRecord::merge_neighbours()
{
  static_assert(MOST % 2 == 0, "spans are merged in pairs");
  for (int k = 0; k < MOST / 2; k++) {
    const Span &b = course[2 * k + 1];
    Span sum = course[2 * k];
    sum.duration += b.duration;
    for (int d = 0; d < 3; d++) {
      sum.impulse[d] += b.impulse[d];
      sum.turn[d] += b.turn[d];
    }
    course[k] = sum;
  }
  course.resize(MOST / 2);
  steps_per_span *= 2;
}

/* ---------------------------------------------------------------------- */

void ImpulseRecord::pack(double *buf) const
{
  if (course.empty()) return;
  *buf++ = steps_per_span;
  *buf++ = steps_of_last;
  std::memcpy(buf, course.data(), course.size() * sizeof(Span));
}

void ImpulseRecord::unpack(const double *buf, int size)
{
  clear();
  if (size == 0) return;
  steps_per_span = static_cast<int>(*buf++);
  steps_of_last = static_cast<int>(*buf++);
  course.reserve(MOST);
  course.resize((size - 2) / SPAN_SIZE);
  std::memcpy(course.data(), buf, course.size() * sizeof(Span));
}
