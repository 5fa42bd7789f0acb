/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_RETROSPECT_H
#define DUST_CORE_RETROSPECT_H

#include "impulse_record.h"

namespace Dust {

/*! How a carrier moved before the end of its collision, from the impulses that it had still to get then.
 *
 * With the velocity v and the place x at the end, and the contact acceleration a, a time s before it
 *
 *   velocity = v + u,        u = -integral a dt over that time
 *   place    = x - s v + r,  dr/ds = -u
 *
 * Forces that are not contact forces, such as gravity, do not count. */
class Retrospect {
 public:
  explicit Retrospect(const ImpulseRecord &impulses);

  /*! u and r, along the axes of the record
   *  \param before_end  s; what is more than the time of the record counts as that time */
  void at(double before_end, double *u, double *r) const;

 private:
  const ImpulseRecord &record;
  // at the start of each span
  struct Start {
    double before_end, u[3], r[3];
  };
  Start starts[ImpulseRecord::MAX_SPANS];
};

}    // namespace Dust

#endif
