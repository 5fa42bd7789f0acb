/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_MOTION_H
#define DUST_CORE_MOTION_H

#include "geometry.h"
#include "quaternion.h"

#include <cmath>

namespace Dust {

/*! Largest difference of what two spins add to g on a grain, per |r|: omega x (omega x n) differs by at most
 *  |difference of omega| |sum of omega| */
inline double spin_difference(const double *w, const double *v)
{
  const double difference[3] = {w[0] - v[0], w[1] - v[1], w[2] - v[2]},
               sum[3] = {w[0] + v[0], w[1] + v[1], w[2] + v[2]};
  return std::sqrt(dot(difference, difference) * dot(sum, sum));
}

/*! How a carrier's contacts move it at one moment */
struct Motion {
  double acceleration[3];            //!< a = contact force / mass
  double angular_acceleration[3];    //!< alpha = contact torque / moment of inertia
  double spin[3];                    //!< omega

  /*! The same with its vectors along the axes of a body of this orientation */
  Motion in_body(const Quaternion &orientation) const
  {
    if (orientation.is_identity()) return *this;
    Motion m = {};
    orientation.to_body(acceleration, m.acceleration);
    if (!rotates()) return m;
    orientation.to_body(angular_acceleration, m.angular_acceleration);
    orientation.to_body(spin, m.spin);
    return m;
  }

  /*! Whether all of it is finite: nothing else may ask about a motion that is not */
  bool is_finite() const
  {
    double sum = 0.0;
    for (int d = 0; d < 3; d++) sum += acceleration[d] + angular_acceleration[d] + spin[d];
    return std::isfinite(sum);
  }

  bool rotates() const { return dot(angular_acceleration, angular_acceleration) > 0.0 || dot(spin, spin) > 0.0; }

  /*! |alpha| + omega^2: times |r|, at least what rotation adds to g */
  double rotation_bound() const { return rotation_bound(spin); }
  /*! The same with another spin */
  double rotation_bound(const double *omega) const
  {
    return std::sqrt(dot(angular_acceleration, angular_acceleration)) + dot(omega, omega);
  }

  /*! Inertia force per mass on a grain that moves with its carrier, g = -(a + alpha x r + omega x (omega x r))
   *  \param n      direction of the grain
   *  \param shell  |r| = R_p + R_d */
  void inertia(const double *n, double shell, double *g) const
  {
    double euler[3];
    cross(angular_acceleration, n, euler);
    const double along = dot(spin, n), spin2 = dot(spin, spin);
    for (int d = 0; d < 3; d++) g[d] = -acceleration[d] - shell * (euler[d] + along * spin[d] - spin2 * n[d]);
  }

  /*! Its outward part g.n, in which the angular acceleration has none */
  double lift(const double *n, double shell) const { return shell * centrifugal(n) - dot(acceleration, n); }
  double centrifugal(const double *n) const
  {
    const double along = dot(spin, n);
    return dot(spin, spin) - along * along;
  }
};

}    // namespace Dust

#endif
