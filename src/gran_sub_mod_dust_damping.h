/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifdef GRAN_SUB_MOD_CLASS
// clang-format off
GranSubModStyle(coeff_restitution/limited,GranSubModDampingCoeffRestitutionLimited,DAMPING);
// clang-format on
#else

#ifndef GRAN_SUB_MOD_DUST_DAMPING_H
#define GRAN_SUB_MOD_DUST_DAMPING_H

#include "gran_sub_mod_damping.h"

namespace LAMMPS_NS {
namespace Granular_NS {

// realises the normal model's damping coefficient as coefficient of restitution without ever pulling

class GranSubModDampingCoeffRestitutionLimited : public GranSubModDamping {
 public:
  GranSubModDampingCoeffRestitutionLimited(class GranularModel *, class LAMMPS *);
  void init() override;
  double calculate_forces() override;
};

}    // namespace Granular_NS
}    // namespace LAMMPS_NS

#endif
#endif
