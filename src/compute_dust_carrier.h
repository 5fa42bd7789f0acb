/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifdef COMPUTE_CLASS
// clang-format off
ComputeStyle(dust/carrier,ComputeDustCarrier);
// clang-format on
#else

#ifndef LMP_COMPUTE_DUST_CARRIER_H
#define LMP_COMPUTE_DUST_CARRIER_H

#include "compute.h"

#include <vector>

namespace LAMMPS_NS {

namespace Granular_NS {
class GranSubModNormalJKRVdW;
}

// per grain: ID of the carrier it is tied to by a chain of necks, 0 = detached; when contacts last changed

class ComputeDustCarrier : public Compute {
 public:
  ComputeDustCarrier(class LAMMPS *, int, char **);
  ~ComputeDustCarrier() override;
  void init() override;
  void compute_peratom() override;
  double compute_scalar() override;
  void compute_vector() override;
  int pack_forward_comm(int, int *, double *, int, int *) override;
  void unpack_forward_comm(int, int, double *) override;
  int pack_reverse_comm(int, int, double *) override;
  void unpack_reverse_comm(int, int *, double *) override;
  double memory_usage() override;

 private:
  int carrier_bit;
  int nmax;
  class PairGranular *pair;
  class FixNeighHistory *history;
  std::vector<const Granular_NS::GranSubModNormalJKRVdW *>
      adhesive;    // by model of the pair style, nullptr = knows no necks
};

}    // namespace LAMMPS_NS

#endif
#endif
