/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_TANGENTIAL_IMPULSE_H
#define DUST_CORE_TANGENTIAL_IMPULSE_H

#include "tangential_law.h"

namespace Dust {

/*! Friction takes a momentum, and rolling is its limit
 *
 * While a grain slides, friction mu_f (2 F_c - F_n) acts against its slip, with F_n/m_d = -a.n. Over the collision, in
 * which n hardly changes, that is the impulse per grain mass
 *
 *   J = mu_f integral (2 c + a.n) dt = mu_f (2 c Dt - Dv.n), at least 0,    Dv = v_contact - v_rebound
 *
 * An impulse q against the slip takes q from the velocity w relative to the carrier's centre and gives a solid sphere,
 * (2/5) m R_d^2, the rolling velocity 5/2 q: of the slip w - R_d Omega x n - R_p omega x n it takes 7/2 q. At 2/7 of
 * the slip none is left: the grain rolls, and friction only keeps it rolling, against the moment of the pivots
 * 2 F_c (1 + sqrt(1 - F_n/F_c)) R_12 theta_crit (surface_motion.h). That takes 5/7 of the impulse
 *
 *   K = (R_12/R_d) theta_crit integral 2 c (1 + sqrt(1 + a.n/c)) dt
 *     = 2 (R_12/R_d) theta_crit (c Dt + sqrt(c Dt (c Dt - Dv.n)))
 *
 * with the root of the mean for the mean of the root (up to 5 % more in a pulse), as long as it rolls. With v_t0 and s0
 * those at the end without friction,
 *
 *   v_t0 = [Dv + omega_contact x r_pd]_t,    s0 = v_t0 - (R_d omega_contact + R_p omega_rebound) x n
 *   v_t = v_t0 - q s0/|s0|,    q = min(J, 2/7 |s0| + 5/7 min(K, |s0|)),    and a grain leaves if v_t^2/|r_pd| > c.
 *
 * A grain that slides or rolls towards the contact comes to the side from which inertia lifts it, or is fast there, and
 * leaves before the end: grains from just beyond those that lift off where they sit. For them the acceleration is taken
 * to go as half a sine along Dv, with the largest |a| at most, and the velocity as that: at tau = 0 to pi, with
 * w0 = omega_contact x r_pd,
 *
 *   -a = min(pi/(2 Dt), |a|_max/|Dv|) sin(tau) Dv,    w = w0 + (1 - cos(tau))/2 (v_t - w0),
 *   n + Dt/(pi |r_pd|) (tau w0 + (tau - sin(tau))/2 (v_t - w0)) for n,    and a grain leaves if -a.n + w^2/|r_pd| > c.
 *
 * At tau = pi that is the test above.
 *
 * While a keeps its direction, slip and J grow together, so that their values at the end tell whether the grain rolled
 * all the time. Left out: that it rolls with less friction than J while a is small (0.5 % of v_t), the centrifugal part
 * of F_n and the motion along n. */
extern const TangentialLaw TANGENTIAL_IMPULSE;

/*! The same with grains that ring: while the collision ends the load -a.n grows to 0, and a grain that its contact has
 *  followed outward overshoots. It leaves if
 *
 *    v_t^2/|r_pd| + C sqrt(delta_c/c) |d(a.n)/dt| > c,    north,    C = overshoot(zeta) (normal_motion.h)
 *
 *  with the slope of the last half period of its swings, in which a goes to 0 evenly: twice its impulse over the square
 *  of its time. */
extern const TangentialLaw TANGENTIAL_IMPULSE_RINGING;

}    // namespace Dust

#endif
