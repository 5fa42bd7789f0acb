/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_QUATERNION_H
#define DUST_CORE_QUATERNION_H

#include <cstdint>

namespace Dust {

/*! Orientation of a body as a unit quaternion w + (x, y, z), held as w x y z: turns its axes into those of space */
struct Quaternion {
  double q[4] = {1.0, 0.0, 0.0, 0.0};

  /*! A vector with components along the body's axes, in space */
  void to_space(const double *body, double *space) const { rotate(q[0], body, space); }

  /*! A vector of space, along the body's axes */
  void to_body(const double *space, double *body) const { rotate(-q[0], space, body); }

  /*! Turns the body for a time dt with the spin (of space, rad/time), which is that of the middle of the step */
  void turn_by(const double *spin, double dt)
  {
    const double x = 0.5 * dt * spin[0], y = 0.5 * dt * spin[1], z = 0.5 * dt * spin[2], a2 = x * x + y * y + z * z;
    if (a2 < 1.0e-40) return;    // not even 1e10 such steps would show
    // cos(a) and sin(a)/a: all but always in a time step this is exact to round-off
    double c = 1.0 - a2 * (0.5 - a2 / 24.0), s = 1.0 - a2 * (1.0 / 6.0 - a2 / 120.0);
    if (a2 > 1.0e-5) large_angle(a2, c, s);
    const double sx = s * x, sy = s * y, sz = s * z, w = q[0], i = q[1], j = q[2], k = q[3];
    q[0] = c * w - sx * i - sy * j - sz * k;
    q[1] = c * i + sx * w + sy * k - sz * j;
    q[2] = c * j - sx * k + sy * w + sz * i;
    q[3] = c * k + sx * j - sy * i + sz * w;
    // 1/|q|, which is 1 but for round-off
    const double part = 1.5 - 0.5 * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (double &component : q) component *= part;
  }

  /*! The same along the body's own axes */
  Quaternion operator*(const Quaternion &first) const;
  bool is_identity() const { return q[1] == 0.0 && q[2] == 0.0 && q[3] == 0.0; }
  Quaternion inverse() const { return {{q[0], -q[1], -q[2], -q[3]}}; }

 private:
  static void large_angle(double a2, double &c, double &s);
  void rotate(double w, const double *v, double *result) const
  {
    // v + 2 w (u x v) + 2 u x (u x v) with u = (x, y, z)
    const double x = q[1], y = q[2], z = q[3];
    const double tx = 2.0 * (y * v[2] - z * v[1]), ty = 2.0 * (z * v[0] - x * v[2]), tz = 2.0 * (x * v[1] - y * v[0]);
    const double r[3] = {v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz,
                         v[2] + w * tz + x * ty - y * tx};
    for (int d = 0; d < 3; d++) result[d] = r[d];
  }
};

/*! An orientation that depends on nothing but the two numbers, all orientations being equally likely (Shoemake,
 *  Graphics Gems III, 1992, p. 124): a carrier has its own wherever it comes from and whoever asks */
Quaternion random_orientation(uint64_t seed, uint64_t number);

}    // namespace Dust

#endif
