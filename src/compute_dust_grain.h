/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifdef COMPUTE_CLASS
// clang-format off
ComputeStyle(dust/grain,ComputeDustGrain);
// clang-format on
#else

#ifndef LMP_COMPUTE_DUST_GRAIN_H
#define LMP_COMPUTE_DUST_GRAIN_H

#include "compute.h"

#include "detach_columns.h"

#include <array>
#include <string>
#include <vector>

namespace LAMMPS_NS {

// local rows: every grain that is still attached to a carrier of a fix dust/detach

class ComputeDustGrain : public Compute {
 public:
  ComputeDustGrain(class LAMMPS *, int, char **);
  void init() override;
  void compute_local() override;
  double memory_usage() override;

 private:
  std::string fix_id;
  std::vector<std::array<double, GrainRow::SIZE>> rows;
  std::vector<double *> row_pointers;

  const class FixDustDetach *fix() const;
  bool shows(const class FixDustDetach *, int i) const;
  bigint count(const class FixDustDetach *) const;
  void add_grains(const class FixDustDetach *, int i);
};

}    // namespace LAMMPS_NS

#endif
#endif
