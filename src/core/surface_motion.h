/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_SURFACE_MOTION_H
#define DUST_CORE_SURFACE_MOTION_H

namespace Dust {

/*! Grains that slide and roll over their carrier in a collision
 *
 * A grain sits at the direction n and moves with w, tangential, relative to the carrier's centre. It spins with Omega,
 * and its contact is displaced by the rolling displacement xi. The carrier has the acceleration a and the spin omega;
 * |r_pd| = R_p + R_d; axes do not turn:
 *
 *   outward force    F_n = -m a.n + m |w|^2/|r_pd|                        the grain leaves when F_n > F_c
 *   friction         |f| <= mu_f |2 F_c - F_n|, against the slip u or what would start it
 *   slip             u = w - R_d Omega x n - R_p omega x n
 *   along surface    m dw/dt = -m (a - (a.n) n) + f,    dn/dt = w/|r_pd|
 *   spin             (2/5) m R_d^2 dOmega/dt = -R_d n x f - k n x xi
 *   rolling          dxi/dt = R_12 (Omega - omega) x n, |xi| held at R_12 theta_crit
 *   its stiffness    k = 4 F_c (a/a0)^(3/2) = 2 F_c (1 + sqrt(1 - F_n/F_c))
 *
 * There is no normal motion: the contact follows its load at once (normal_motion.h follows it as it rings). Dominik &
 * Tielens, Philos. Mag. A 72, 783 (1995) for rolling; the limit of friction is that of the detachment functions.
 *
 * Here all forces are per grain mass, c = F_c/m. In place of w, Omega and xi stand what a grain that turns with its
 * carrier has not: the velocity v = w - |r_pd| omega x n over the surface, the velocity p = R_d (Omega - omega) x n at
 * which the rolling contact moves over the grain, and the angle psi = xi/R_12:
 *
 *   u = v - p,    dn/dt = v/|r_pd| + omega x n,    dpsi/dt = p/R_d,    s = (R_12/R_d) k/m
 *   dv/dt = -(a - (a.n) n) + f - |r_pd| (domega/dt) x n - (omega.n) n x w
 *   dp/dt = -(5/2) (f + s psi) - R_d (domega/dt) x n
 *
 * The last term of dv/dt is what (omega x n) itself changes by as n moves; dp/dt has none, as about n a grain is taken
 * to spin with its carrier.
 *
 * A step is a leapfrog: half of dn and dpsi, all of dv and dp with the forces there, the other half. Friction is the
 * one that ends the slip within the step, or its limit: it sticks without a spring, at any step. */
class SurfaceMotion {
 public:
  static constexpr int LANES = 32;    // side by side, for the compiler's vectors

  /*! \param holds  whether grains stay where F_n > F_c: then others say when they leave */
  SurfaceMotion(double mu_f, double theta_crit, bool holds = false);

  /*! Takes away all grains */
  void clear();

  int grains() const { return count; }
  bool full() const { return count == LANES; }

  /*! One more grain, at rest on its carrier
   *  \param direction  n
   *  \param hold       c = F_c/m_d
   *  \param grain_radius, carrier_radius  R_d, R_p
   *  \param spin       of the carrier now, the same for all grains */
  void add(const double *direction, double hold, double grain_radius, double carrier_radius, const double *spin);

  /*! A step of the carrier's motion: its mean acceleration over the time dt, its spin at the end */
  void advance(const double *acceleration, const double *spin, double dt);

  /*! The end of the contact: only its motion lifts a grain */
  void release();

  /*! A grain leaves as it moves now */
  void let_go(int grain);

  bool attached(int grain) const { return here[grain] > 0.0; }

  /*! F_n/m_d at an acceleration of the carrier */
  double outward_force(int grain, const double *a) const
  {
    double w2 = 0.0, an = 0.0;
    for (int d = 0; d < 3; d++) {
      w2 += velocity(grain, d) * velocity(grain, d);
      an += a[d] * n[d][grain];
    }
    return w2 * inv_shell[grain] - an;
  }

  // the motion of a grain, at last when it left; vectors of the surface
  double direction(int grain, int d) const { return n[d][grain]; }
  double velocity(int grain, int d) const { return v[d][grain] + carried(grain, d) * shell[grain]; }    //!< w
  //! R_d Omega x n
  double rolling_velocity(int grain, int d) const { return p[d][grain] + carried(grain, d) * radius[grain]; }
  double rolling_angle(int grain, int d) const { return psi[d][grain]; }    //!< xi/R_12

 private:
  double friction, rolling2, holds;    // 1 if grains stay where F_n > F_c, else 0
  int count;
  // by grain
  double here[LANES];                                                         // 1 as long as it is attached, then 0
  double hold[LANES], inv_hold[LANES], stiffness[LANES];                      // c, 1/c, 2 c R_12/R_d
  double shell[LANES], inv_shell[LANES], radius[LANES], inv_radius[LANES];    // |r_pd|, R_d
  double n[3][LANES], psi[3][LANES];
  double v[3][LANES], p[3][LANES];    // of a grain that left: w and R_d Omega x n
  double omega[3];                    // of the carrier now

  // omega x n while it is attached
  double carried(int i, int d) const
  {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    return here[i] * (omega[e] * n[f][i] - omega[f] * n[e][i]);
  }
};

}    // namespace Dust

#endif
