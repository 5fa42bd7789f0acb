/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_GRAIN_CONTACTS_H
#define DUST_CORE_GRAIN_CONTACTS_H

#include "contact_batch.h"

namespace Dust {

/*! Adhesive contacts of grains: JKR with a neck, Hamaker without, damped by the rate of the overlap, with Mindlin's
 *  friction and rolling by Dominik and Tielens. The damping of ContactBatch is `eta`. */
struct GrainBatch : ContactBatch {
  static constexpr int NECK = 1, SLIDE = 2, ROLL = 4;    // what has changed for good in a contact

  double *kept[SIZE];    // where a contact's neck, its rolling and the rate of its overlap are kept: KEPT values
  static constexpr int KEPT = 7;

  Vectors<SIZE> spin;    // omega_i - omega_j

  // of the materials and of the effective radius
  double hamaker[SIZE], z0[SIZE], range[SIZE];
  double pull_off_force[SIZE], equilibrium_radius[SIZE], breaking_gap[SIZE];
  double effective_radius[SIZE], theta_crit[SIZE];

  // Of the last step, changed. The neck is a/a0, or 0 for none; its sign is that of all that follows.
  double neck[SIZE];
  Vectors<SIZE> rolling;
  double overlap[SIZE], coasting[SIZE], rate[SIZE];

  double events[SIZE];    // a sum of these

  /*! As those of ContactBatch, with what grains keep besides */
  void meet(const Spheres &);
  void meet(const Spheres &, const Planes &);
  void keep() const;

  // from one part of the work to the next: r, overlap, a/a0, force without a neck, Newton's unknown and depth (jkr.h)
  double distance[SIZE], now[SIZE], radius[SIZE], attraction[SIZE], root[SIZE], depth[SIZE];

 private:
  void recall();
};

/*! Forces and torques, and what the contacts remember moved on, in the operations of LAMMPS' `pair_style granular` with
 *  our `jkr/vdw` and `dominik/tielens` and its `mindlin` and `viscoelastic`: the same bits.
 *
 * \param dt    time step
 * \param move  whether contacts remember the step, as they do in all but those that only set up a run */
void compute_forces(GrainBatch &batch, double dt, bool move);

}    // namespace Dust

#endif
