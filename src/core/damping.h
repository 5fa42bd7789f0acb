/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_DAMPING_H
#define DUST_CORE_DAMPING_H

namespace Dust {

/*! Damping ratio zeta that realises a coefficient of restitution with a contact that never pulls.
 *
 * A contact force F_el(delta) - c sqrt(m_eff F_el/delta) v, cut off at zero, becomes a linear damped oscillator,
 * y'' + 2 zeta y' + y = 0, for the Hookean force (zeta = c/2, y = delta) and for the Hertzian one
 * (zeta = c/sqrt(5), y ~ delta^(5/4)), each with its own clock. The contact ends where the force vanishes:
 *
 *   e = exp(-tan(theta) (pi - 2 theta)),   zeta = sin(theta)      for zeta <= 1
 *   e = exp(-2 eta coth(eta)),             zeta = cosh(eta)       beyond, e < exp(-2)
 *
 * so the relation does not depend on speed, size or material. The end of contact is that of Schwager and Poeschel,
 * Granular Matter 9, 465 (2007); the damping force that of Tsuji et al., Powder Technol. 71, 239 (1992).
 *
 * \param e  coefficient of restitution, 0 < e <= 1
 * \return   damping ratio, to round-off */
double damping_ratio(double e);

/*! Coefficient c of the damping force -c sqrt(m_eff F_el/delta) v_n of a Hertzian contact */
double hertz_damping(double e);

/*! The same for a Hookean contact */
double hooke_damping(double e);

}    // namespace Dust

#endif
