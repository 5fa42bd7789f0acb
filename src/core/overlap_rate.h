/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_OVERLAP_RATE_H
#define DUST_CORE_OVERLAP_RATE_H

namespace Dust {

/*! Rate of a contact's overlap at each step of velocity Verlet, for a damping force -decay m_eff times that rate.
 *
 * Two overlaps give the mean rate u of the step between them, which is the rate in its middle. Half a step later it has
 * changed by the damping itself and by all other forces, o a step:
 *
 *   rate = u + (o - decay dt rate)/2,   o = u - (u - decay dt rate of the step before)
 *
 * The damping is implicit, so that it is stable however large decay dt, and the others are taken from the step before:
 * second order in dt. Velocity Verlet itself offers the velocity of the middle with the normal of the end, whose
 * product is of first order: it lags by half a step, and on a path of radius r with the speed w it has an outward part
 * w^2 dt/(2 r). */
struct OverlapRate {
  double overlap;     // at the last step, length
  double coasting;    // mean rate of the step to come if only the damping acted, length/time
  double rate;        // at the last step, length/time

  /*! The first step of a contact.
   *  \param first  overlap, length
   *  \param mean   rate in the middle of the step before, by other means, length/time
   *  \param decay  damping force over m_eff and rate, 1/time
   *  \param dt     time step */
  void begin(double first, double mean, double decay, double dt) { step_on(first, mean, 0.0, decay * dt); }

  /*! Each further step. \param next overlap, length */
  void advance(double next, double decay, double dt)
  {
    const double mean = (next - overlap) / dt;
    step_on(next, mean, mean - coasting, decay * dt);
  }

  /*! What both are.
   *  \param mean    u
   *  \param others  o, 0 in the first step
   *  \param damped  decay dt */
  void step_on(double next, double mean, double others, double damped)
  {
    overlap = next;
    rate = (mean + 0.5 * others) / (1.0 + 0.5 * damped);
    coasting = mean - damped * rate;
  }
};

}    // namespace Dust

#endif
