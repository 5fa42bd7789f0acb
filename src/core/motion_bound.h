/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_MOTION_BOUND_H
#define DUST_CORE_MOTION_BOUND_H

#include "impulse_record.h"

namespace Dust {

/*! Which grains stay whatever they do in a collision: spares most of them SurfaceMotion
 *
 * With the energy E = |w|^2/2 + |p|^2/5 per grain mass and A the tangential part of -a, the motion of surface_motion.h gives
 * dE/dt = w.A + f.u - s psi.p <= sqrt(2 E) (|A| + sqrt(5/2) s theta_crit), as friction only takes, |w| <= sqrt(2 E) and
 * |p| <= sqrt(5/2) sqrt(2 E). So the velocity stays below
 *
 *   W = integral |A| dt + sqrt(5/2) theta_crit s_max t,    s_max = 2 c (R_12/R_d) (1 + sqrt(1 + a_max/c)),
 *
 * n turns by less than W t/|r_pd|, and F_n/m stays below the largest -a.n + |a| W t/|r_pd| of the collision and W^2/|r_pd|. */
class MotionBound {
 public:
  /*! \param peak            a_max
   *  \param rolling         theta_crit
   *  \param carrier_radius  R_p */
  MotionBound(const ImpulseRecord &record, double peak, double rolling, double carrier_radius);

  struct Bound {
    double turn;           // of n
    double centrifugal;    // W^2/|r_pd|
  };

  /*! \param n      direction of a grain
   *  \param hold   c = F_c/m_d
   *  \param shell  |r_pd| */
  Bound of(const double *n, double hold, double shell) const;

  /*! Whether any grain can leave that has a pull-off force per mass between these two */
  bool any_may_leave(double least_hold, double largest_hold) const;

 private:
  double peak, rolling, carrier_radius;
  double time = 0.0;
  double axis[3] = {0.0, 0.0, 0.0};       // of all impulses together
  double along = 0.0, aside = 0.0;        // sums of what each has along the axis and aside of it

  static constexpr double MARGIN = 1.02;    // for the steps of SurfaceMotion
  double spring(double hold, double shell) const;
};

}    // namespace Dust

#endif
