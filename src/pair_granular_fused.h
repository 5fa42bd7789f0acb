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

#include "core/geometry.h"
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
  std::vector<class ContactLaw> laws;    // one for each of models_list
  bool laws_known, none_fused;
  int laws_made;
  void read_laws();
  bool left_to_parent() const;

  // contacts in the order of the neighbor list that wait to be computed together
  struct Waiting;
  std::unique_ptr<Waiting> waiting;
  void gather();
  bool model_touches(const class ContactLaw &, int, int, int);
  double effective_mass(int, int) const;
  void add(class ContactLaw &, int, int, const Dust::Vector &, double, double *);
  void compute_model(const class ContactLaw &, int, int, double *, int);
  void set_coefficients(const class ContactLaw &, int);
  void complete();
  void compute_waiting();
  void keep_history();
  void apply_forces();
};

}    // namespace LAMMPS_NS

#endif
#endif
