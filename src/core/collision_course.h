/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_COLLISION_COURSE_H
#define DUST_CORE_COLLISION_COURSE_H

#include "tangential_law.h"

#include <vector>

namespace Dust {

/*! A short time of a collision, along the carrier's axes at first contact */
struct Substep {
  double dt, acceleration[3];    //!< mean
  double before_end;             //!< of the collision, in the middle
  double acceleration_after[3], spin_after[3];
};

/*! The course of a collision in steps small enough to follow grains; it must have been recorded. What is at the end of
 *  a span lies between the means of this span and the next; contact forces end at 0 */
std::vector<Substep> substeps(const PastCollision &past);

}    // namespace Dust

#endif
