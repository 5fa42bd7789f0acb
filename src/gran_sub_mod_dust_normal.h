/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifdef GRAN_SUB_MOD_CLASS
// clang-format off
GranSubModStyle(jkr/vdw,GranSubModNormalJKRVdW,NORMAL);
GranSubModStyle(jkr/vdw/cut,GranSubModNormalJKRVdWCut,NORMAL);
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
  void init() override;
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

  // what a contact's law has of the materials, and of the effective radius
  struct Adhesion {
    double hamaker, z0, range;
    double pull_off_force, equilibrium_radius, breaking_gap, reach;
  };
  Adhesion adhesion(double Reff);
  // where a contact's history keeps its neck, three values of rolling and three of the overlap's rate; makes LAMMPS
  // copy all of them when i and j change places
  int place_in_history();

  LastEvents last_events;    // slide and roll by the rolling model

  // of a contact with this history: 0 without a neck, else a/a0 or -a/a0; LAMMPS negates all history when i and j
  // change places
  double neck_in(const double *history) const { return history[neck_place()]; }
  // three values that a rolling model may keep in this history
  double *rolling_in(double *history) const;

 private:
  double hamaker, z0, z_cut, range, gamma, modulus;
  double mixed_modulus;    // 0 if the materials are equal
  // what depends on the effective radius alone, of the last one
  double last_Reff, Fc, a0, delta_c, largest_gap;
  bool warned;
  void use_radius(double);
  void check_skin(double);
  // the contact at hand
  bool neck;
  double x, Fne;    // a/a0; elastic-adhesive force
  // where the history keeps the neck
  int laid_out;
  int neck_place() const;
  void lay_out_history();
  void use_overlap_rate(bool);
};

// the same with the end of the attraction as a coefficient

class GranSubModNormalJKRVdWCut : public GranSubModNormalJKRVdW {
 public:
  GranSubModNormalJKRVdWCut(class GranularModel *, class LAMMPS *);
};

}    // namespace Granular_NS
}    // namespace LAMMPS_NS

#endif
#endif
