/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifdef GRAN_SUB_MOD_CLASS
// clang-format off
GranSubModStyle(jkr/vdw,GranSubModNormalJKRVdW,NORMAL);
// clang-format on
#else

#ifndef GRAN_SUB_MOD_DUST_NORMAL_H
#define GRAN_SUB_MOD_DUST_NORMAL_H

#include "gran_sub_mod_normal.h"

namespace LAMMPS_NS {
namespace Granular_NS {

  // last step at which any contact of a model changed for good, -1 = none has; each rank knows its own contacts
  struct LastEvents {
    bigint neck = -1;     // formed or broke
    bigint slide = -1;    // friction at its limit
    bigint roll = -1;     // rolling displacement at its limit
  };

  // adhesive contact: full JKR branch while a neck exists, Hamaker's attraction while none does

  class GranSubModNormalJKRVdW : public GranSubModNormal {
   public:
    GranSubModNormalJKRVdW(class GranularModel *, class LAMMPS *);
    void coeffs_to_local() override;
    void mix_coeffs(double *, double *) override;
    bool touch() override;
    double pulloff_distance(double, double) override;
    double calculate_contact_radius() override;
    double calculate_forces() override;
    void set_fncrit() override;

    // of the contact at hand, for models that build on this one
    bool has_neck() const { return neck; }
    double pull_off_force() const { return Fc; }
    double equilibrium_contact_radius() const { return a0; }

    LastEvents last_events;    // slide and roll by the rolling model

    // whether a contact with this history has a neck
    bool keeps_neck(const double *history) const { return history[neck_owner->history_index + neck_place] != 0.0; }

    // another sub-model keeps the neck in its history, at this place of it; see GranSubModRollingDominikTielens
    void keep_neck_in(GranSubMod *, int);

   private:
    double hamaker, z0, range, gamma, modulus;
    double mixed_modulus;    // 0 if the materials are equal
    // what depends on the effective radius alone, of the last one
    double last_Reff, Fc, a0, delta_c;
    void use_radius(double);
    // the contact at hand
    bool neck;
    double x, Fne;    // a/a0; elastic-adhesive force
    GranSubMod *neck_owner;
    int neck_place;
  };

}    // namespace Granular_NS
}    // namespace LAMMPS_NS

#endif
#endif
