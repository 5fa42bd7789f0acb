/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_NORMAL_MOTION_H
#define DUST_CORE_NORMAL_MOTION_H

namespace Dust {

/*! Grains that ring in their contacts while the carrier's collision squeezes them and lets them go
 *
 * Along its normal a grain moves in the JKR contact under the outward force F_n, here given:
 *
 *   m d^2 delta/dt^2 = -F_n - F(delta) - 2 zeta sqrt(k0 m) (a/a0) d delta/dt,    k0 = (6/5) E* a0
 *
 * with F and delta of the whole stable branch (jkr.h), the damping being that of the resolved contact laws. The grain
 * is off where the branch ends, delta = -delta_c.
 *
 * In units of F_c and delta_c, times of sqrt(delta_c/c), c = F_c/m, and with y = sqrt(a/a0), D = delta/delta_c:
 *
 *   D = 6^(1/3) (2 y^4 - (4/3) y),    D'' = -F_n - 4 (y^6 - y^3) - 2 zeta' y^2 D',    zeta' = zeta sqrt(k0 delta_c/F_c)
 *
 * Steps are those of a leapfrog, as short as the stiffest contact needs; y follows D by Newton's method. */
class NormalMotion {
 public:
  static constexpr int LANES = 32;    // side by side, for the compiler's vectors

  /*! \param zeta  damping ratio at the equilibrium overlap */
  explicit NormalMotion(double zeta);

  /*! Takes away all grains */
  void clear();

  int grains() const { return count; }

  /*! One more grain, at rest in its contact
   *  \param hold          c = F_c/m_d
   *  \param breaking_gap  delta_c
   *  \param load          F_n/F_c, below 1 */
  void add(double hold, double breaking_gap, double load);

  /*! A step of the time dt in which the load F_n/F_c of each grain comes to load[grain], evenly */
  void advance(const double *load, double dt);

  /*! The same at the loads that there are */
  void advance(double dt) { advance(G, dt); }

  /*! Longest period of small swings of those that are attached */
  double longest_period() const;

  bool attached(int grain) const { return here[grain] > 0.0; }

  double overlap(int grain) const { return gap[grain] * D[grain]; }
  double speed(int grain) const { return gap[grain] * rate[grain] * U[grain]; }    //!< of the overlap, half a step ago

 private:
  double damping;    // zeta'
  int count;
  // by grain
  double here[LANES];                                   // 1 as long as it is attached, then 0
  double rate[LANES], gap[LANES];                       // sqrt(c/delta_c), delta_c
  double G[LANES];                                      // F_n/F_c
  double D[LANES], U[LANES], y[LANES], slope[LANES];    // U = D' half a step ago; slope = dy/dD

  void advance(const double *load, double dt, int steps);
};

/*! Overshoot C of a contact whose load has grown evenly and then stays
 *
 * The grain moves outward when the load stops, and rings. At a load G = F_n/F_c it breaks its contact if the load has
 * grown by more than (1 - G)/C in the time sqrt(delta_c/c): for G from 0.1 to 0.95 the slope from which it does so is
 * that of a straight line within 10 % if zeta is at most 0.2. C is its value at G = 1/2, found by following grains; a
 * linear oscillator of the frequency of small swings without damping would have 1. */
double overshoot(double zeta);

}    // namespace Dust

#endif
