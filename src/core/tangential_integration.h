/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_TANGENTIAL_INTEGRATION_H
#define DUST_CORE_TANGENTIAL_INTEGRATION_H

#include "tangential_law.h"

namespace Dust {

/*! Each grain's own slide and roll over the whole collision, F_n > F_c at any time of it (surface_motion.h); with a
 *  damping ratio its ringing along n as well (normal_motion.h). Grains on either side are asked. */
extern const TangentialLaw TANGENTIAL_INTEGRATION;

}    // namespace Dust

#endif
