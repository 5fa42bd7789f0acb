/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_IMPULSE_RECORD_H
#define DUST_CORE_IMPULSE_RECORD_H

#include "quaternion.h"

#include <vector>

namespace Dust {

/*! The course of a collision in bounded memory: impulses per carrier mass, and how far it turned, over spans of time
 *
 * A span takes so many time steps. When there are MOST spans, neighbours become one, and spans are twice as long from
 * there on: a collision is recorded in MOST/2 to MOST of them, or in its time steps if these are fewer. The
 * sums are exact, whatever the number. */
class ImpulseRecord {
 public:
  static constexpr int MOST = 64;

  struct Span {
    double duration;
    double impulse[3];    // contact force/carrier mass, integrated over the time steps
    double turn[3];       // spin, integrated likewise
  };

  void clear();

  /*! One time step */
  void add(const double *acceleration, const double *spin, double dt);

  const std::vector<Span> &spans() const { return course; }

  /*! What came in space, along the axes of a body */
  void turn_to(const Quaternion &axes);

  // transfer to another rank and restart, as numbers
  int packed_size() const { return course.empty() ? 0 : static_cast<int>(2 + SPAN_SIZE * course.size()); }
  void pack(double *buf) const;
  void unpack(const double *buf, int size);

 private:
  static constexpr int SPAN_SIZE = sizeof(Span) / sizeof(double);
  std::vector<Span> course;
  int steps_per_span = 1;
  int steps_of_last = 0;    // in the last span
  void merge_neighbours();
};

}    // namespace Dust

#endif
