/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_HERTZ_CONTACTS_H
#define DUST_CORE_HERTZ_CONTACTS_H

#include "contact_batch.h"

namespace Dust {

/*! Hertzian contacts of carriers that never pull (damping.h), with Mindlin's and Coulomb's friction. */
struct HertzBatch : ContactBatch {
  double stiffness[SIZE];    // 4/3 E*
};

/*! Forces and torques, and the displacements moved on, in the operations of LAMMPS' `pair_style granular` with
 *  `hertz/material`, `mindlin` and our `coeff_restitution/limited`: the same bits.
 *
 * \param dt    time step
 * \param move  whether displacements grow, as they do in all steps but those that only set up a run */
void compute_forces(HertzBatch &batch, double dt, bool move);

}    // namespace Dust

#endif
