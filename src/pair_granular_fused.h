/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifdef PAIR_CLASS
// clang-format off
PairStyle(granular,PairGranularFused);
// clang-format on
#else

#ifndef LMP_PAIR_GRANULAR_FUSED_H
#define LMP_PAIR_GRANULAR_FUSED_H

#include "pair_granular.h"

#include <memory>
#include <vector>

namespace LAMMPS_NS {

/* ----------------------------------------------------------------------
   LAMMPS' pair style granular under its own name, with the same bits: the laws of carriers and of grains are computed
   for many contacts at once, all others as the parent does it
------------------------------------------------------------------------- */

class PairGranularFused : public PairGranular {
 public:
  PairGranularFused(class LAMMPS *);
  ~PairGranularFused() override;
  void compute(int, int) override;
  void coeff(int, char **) override;
  void init_style() override;
  void reset_dt() override;
  double memory_usage() override;

 private:
  std::vector<class ContactLaw> laws;        // one for each of models_list
  std::vector<class ContactLaw *> law_of;    // of two types
  bool laws_known, none_fused, hertz_alone, heats;
  int laws_made;
  int size_kept;    // of a contact's history, since there is one
  void read_laws();
  bool left_to_parent() const;

  // contacts in the order of the neighbor list that wait to be computed together
  struct Contact;
  struct Waiting;
  std::unique_ptr<Waiting> waiting;
  template <bool> void gather();
  bool compute_model(Contact &, bool);
  void forget(double *);
  double effective_mass(int, int) const;
  void compute_waiting(int);
  void complete();
  void take_place(Contact &);
  void set_coefficients(const class ContactLaw &, int);
  void keep_history();
  void apply_forces();
};

}    // namespace LAMMPS_NS

#endif
#endif
