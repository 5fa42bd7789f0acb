/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_TANGENTIAL_ESTIMATE_H
#define DUST_CORE_TANGENTIAL_ESTIMATE_H

#include "tangential_law.h"

namespace Dust {

/*! Eqs. 3b and 4-6 of the paper as vectors and with rotation: a grain on the north, Dv.n < 0, leaves if
 *  v_t^2/|r_pd| > c, with all forces per grain mass and
 *
 *    v_t0 = [Dv + omega_contact x r_pd]_t,   s0 = v_t0 - omega_rebound x r_pd                            (Eq. 4)
 *    s^2 = s0^2 - 2 E_fr/m_d,                v_t = s s0/|s0| + omega_rebound x r_pd                      (Eq. 5)
 *    E_fr/m_d = (1/2 mu_f max |2 c - g_n|) (1/2 |s0| Dt)                                                 (Eq. 6) */
extern const TangentialLaw TANGENTIAL_ESTIMATE;

/*! The same without E_fr */
extern const TangentialLaw TANGENTIAL_FRICTIONLESS;

}    // namespace Dust

#endif
