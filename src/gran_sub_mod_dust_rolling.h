/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifdef GRAN_SUB_MOD_CLASS
// clang-format off
GranSubModStyle(dominik/tielens,GranSubModRollingDominikTielens,ROLLING);
// clang-format on
#else

#ifndef GRAN_SUB_MOD_DUST_ROLLING_H
#define GRAN_SUB_MOD_DUST_ROLLING_H

#include "gran_sub_mod_rolling.h"

namespace LAMMPS_NS {
namespace Granular_NS {

// rolling resistance of an adhesive contact: its pivot lags behind until a critical displacement

class GranSubModRollingDominikTielens : public GranSubModRolling {
 public:
  GranSubModRollingDominikTielens(class GranularModel *, class LAMMPS *);
  void coeffs_to_local() override;
  void init() override;
  void calculate_forces() override;

 private:
  class GranSubModNormalJKRVdW *normal;
  double theta_crit;
  void find_normal_model();
  bool slides() const;
};

}    // namespace Granular_NS
}    // namespace LAMMPS_NS

#endif
#endif
