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

#include "contact_law.h"
#include "core/whereabouts.h"

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
  std::vector<ContactLaw> laws;        // one for each of models_list
  std::vector<ContactLaw *> law_of;    // of two types
  bool laws_known, none_fused, hertz_alone, heats;
  int size_kept;    // of a contact's history, since there is one
  void read_laws();
  bool left_to_parent() const;

  // pairs of the neighbor list that touch or may soon, in its order
  struct ClosePair {
    double *history;
    int i, j, touches;
  };
  std::vector<ClosePair> close;
  std::vector<ContactLaw::Adhesion> adhesions;    // of those of grains
  Dust::Whereabouts then;                         // when they were found
  std::vector<int> types_then;
  double margin, gap;    // up to which surfaces are close: in skins, as it adapts, and a length, when they were found
  bigint found_at;
  bool close_known;
  bool still_close() const;
  void adapt_margin();
  void find_close();
  void change(ClosePair &, bool);

  std::unique_ptr<class ContactQueue> queue;
  template <bool> void gather();
  bool grains_touch(ContactLaw *, const ClosePair &, double, double, double);
  bool compute_model(const ClosePair &, ContactLaw *);
  void compute_waiting();
  double effective_mass(int, int) const;
};

}    // namespace LAMMPS_NS

#endif
#endif
