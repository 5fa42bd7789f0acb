/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_HAMAKER_H
#define DUST_CORE_HAMAKER_H

#include "geometry.h"

namespace Dust {

/*! Surface energy at which the JKR pull-off force equals the van der Waals force at the least distance z0:
 *  gamma = A/(18 pi z0^2), from 3 pi gamma R = A R/(6 z0^2) (Hamaker, Physica 4, 1058 (1937)).
 *
 * \param hamaker  Hamaker constant A of the two materials, energy
 * \param z0       least distance of the surfaces, length
 * \return         gamma, energy/area; the work of adhesion is 2 gamma */
inline double surface_energy(double hamaker, double z0) { return hamaker / (18.0 * PI * z0 * z0); }

/*! Van der Waals force of two spheres without a neck, A R/(6 (z0 + h)^2) at the gap h >= 0, positive = attraction.
 *  (The paper prints R^2, which is no force.)
 *
 * \param r12  effective radius, the sphere's against a flat wall */
inline double hamaker_force(double hamaker, double z0, double r12, double gap)
{
  const double z = z0 + gap;
  return hamaker * r12 / (6.0 * z * z);
}

}    // namespace Dust

#endif
