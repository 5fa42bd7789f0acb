/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_TANGENTIAL_LAW_H
#define DUST_CORE_TANGENTIAL_LAW_H

#include "acceleration_history.h"
#include "grain_table.h"
#include "impulse_record.h"

#include <cstdint>
#include <vector>

namespace Dust {

/*! A collision that is over, as a law of tangential lift-off sees it; vectors along the carrier's axes at first
 *  contact, which do not turn with it later */
struct PastCollision {
  double dv[3];                            //!< Dv = v_contact - v_rebound
  double duration;                         //!< Dt from first contact to rebound
  double spin_before[3], spin_after[3];    //!< omega_contact, omega_rebound
  double peak;                             //!< largest |a|
  double weak_peak;                        //!< the same of the time before inertia could make a grain slide
  const ImpulseRecord *impulses;           //!< its course if the law `needs_impulses`, or null
  const AccelerationHistory *history;      //!< for releases() only: motions that matter most to some grain
};

/*! A grain that a law lets go */
struct Release {
  int bit;
  double direction[3];    //!< n, along the same axes
  double velocity[3];     //!< relative to the carrier's centre
  double before_end;      //!< when it left: so long before the end of the collision
  //! how the carrier moved until then, u and r of retrospect.h, if no record of the collision tells
  double carrier_velocity[3] = {0.0, 0.0, 0.0}, carrier_place[3] = {0.0, 0.0, 0.0};
};

/*! A law of tangential lift-off: which grains leave, asked once at the end of a collision.
 *
 * Laws are pure: they read the table, the bits of the grains that are still attached and the collision, and change none
 * of them. One grain's leaving does not enter another's test. To add one: a file with its two functions, its word in
 * Criteria::Tangential, and its line in tangential_law.cpp. */
struct TangentialLaw {
  bool needs_impulses;    //!< whether the course of each collision is to be recorded (4 kB)
  /*! False only if no grain can leave: spares most collisions of a bed the rest */
  bool (*may_release)(const GrainTable &, const PastCollision &);
  /*! Appends the grains that leave, in the order of their bits
   *  \param located  whether directions and velocities are wanted */
  void (*releases)(const GrainTable &, const PastCollision &, const uint64_t *attached, bool located,
                   std::vector<Release> &);
};

/*! The law of this name; null for OFF
 *  \param rings  whether the grains' contacts are to ring, in a law that can tell */
const TangentialLaw *tangential_law(Criteria::Tangential name, bool rings);

}    // namespace Dust

#endif
