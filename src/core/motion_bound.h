/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_MOTION_BOUND_H
#define DUST_CORE_MOTION_BOUND_H

#include "impulse_record.h"

namespace Dust {

/*! Which grains stay whatever they do in a collision: spares most of them SurfaceMotion
 *
 * In the terms of surface_motion.h, with the energy E = |v|^2/2 + |p|^2/5 per grain mass, A the tangential part of -a
 * and alpha = domega/dt, the motion over the surface gives
 *
 *   dE/dt = v.A + f.u - s psi.p - v.(|r_pd| alpha x n) - (2/5) p.(R_d alpha x n) - |r_pd| (omega.n) v.omega
 *         <= sqrt(2 E) (|A| + sqrt(5/2) s theta_crit + l |alpha| + |r_pd| |omega|^2/2),
 *   l^2 = |r_pd|^2 + (2/5) R_d^2,
 *
 * as friction only takes, |v| <= sqrt(2 E) and |p| <= sqrt(5/2) sqrt(2 E). The last term is what is left of
 * (omega.n) n x w: the part with v does no work. So |v| stays below
 *
 *   V = integral |A| + l |alpha| dt + (sqrt(5/2) theta_crit s_max + |r_pd| omega_max^2/2) t,
 *   s_max = 2 c (R_12/R_d) (1 + sqrt(1 + a_max/c)),
 *
 * |w| below W = V + |r_pd| omega_max, n turns by less than V t/|r_pd| + omega_max t, and F_n/m stays below the largest
 * -a.n + |a| angle of the collision and W^2/|r_pd|. */
class MotionBound {
 public:
  /*! \param spin  of the carrier before the collision
   *  \param rp    R_p */
  MotionBound(const ImpulseRecord &record, const double *spin, double a_max, double theta_crit, double rp);

  struct Bound {
    double angle;          // by which n turns
    double centrifugal;    // W^2/|r_pd|
  };

  /*! \param n      direction of a grain
   *  \param hold   c = F_c/m_d
   *  \param shell  |r_pd| */
  Bound of(const double *n, double hold, double shell) const;

  /*! Whether any grain can leave that has a pull-off force per mass between these two, and |r_pd| up to the third */
  bool any_may_leave(double min_hold, double max_hold, double max_shell) const;

  /*! Whether any grain can then ring so that its contact breaks, whatever damps it (normal_motion.h)
   *
   * An energy e above that of rest in the contact grows by no more than |dF_n/dt| times the distance from there, which
   * is below 1.963 sqrt(e) (F_c = delta_c = 1) up to the end of the branch, as long as |F_n| < 0.3. At e = 0.9267, for
   * F_n = 0.3, the contact breaks: F_n must have changed by 0.98 in all. */
  bool any_may_ring_off(double min_hold, double max_hold, double max_shell) const;

 private:
  double peak, rolling, carrier_radius;
  double time = 0.0;
  double axis[3] = {0.0, 0.0, 0.0};    // of all impulses together
  double along = 0.0, aside = 0.0;     // sums of what each has along the axis and aside of it
  double max_spin = 0.0;               // omega_max
  double spin_changes = 0.0;           // integral |alpha| dt
  double force_changes = 0.0;          // integral |da/dt| dt, from 0 to 0

  static constexpr double MARGIN = 1.02;    // for the steps of SurfaceMotion
  struct Max {
    double outward, angle, centrifugal;    // F_n/m_d is below the first
  };
  Max of_any(double max_hold, double max_shell) const;
  // the terms of V
  double spring(double hold, double shell) const;
  double spin(double shell) const;
};

}    // namespace Dust

#endif
