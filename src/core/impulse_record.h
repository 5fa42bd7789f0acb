/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_IMPULSE_RECORD_H
#define DUST_CORE_IMPULSE_RECORD_H

#include "pack.h"
#include "quaternion.h"

#include <vector>

namespace Dust {

/*! The course of a collision in bounded memory: impulses per carrier mass, and angles of turning, over spans of time
 *
 * A span takes so many time steps. When there are MAX_SPANS spans, neighbours become one, and spans are twice as long
 * from there on: a collision is recorded in MAX_SPANS/2 to MAX_SPANS of them, or in its time steps if these are fewer.
 * The sums are exact, whatever the number. */
class ImpulseRecord {
 public:
  static constexpr int MAX_SPANS = 64;

  struct Span {
    double duration;
    double impulse[3];    // contact force/carrier mass, integrated over the time steps
    double angle[3];      // spin, integrated likewise
  };

  void clear();

  /*! One time step */
  void add(const double *acceleration, const double *spin, double dt);

  const std::vector<Span> &spans() const { return recorded; }

  /*! Resolves what came in space along the axes of a body */
  void to_body(const Quaternion &orientation);

  // transfer to another rank and restart
  void pack(Packer &packer) const;
  void unpack(Unpacker &unpacker);

 private:
  std::vector<Span> recorded;
  int steps_per_span = 1;
  int steps_of_last = 0;    // in the last span
  void merge_neighbours();
};

}    // namespace Dust

#endif
