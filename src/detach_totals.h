/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_DETACH_TOTALS_H
#define LMP_DUST_DETACH_TOTALS_H

#include "core/criteria.h"

#include <mpi.h>

#include <array>
#include <cstring>
#include <numeric>

namespace LAMMPS_NS {

// what a rank has counted since the start, or since it read a restart file; whole numbers but for weight and
// initial_weight, the masses lost and brought, in mean grain masses of the first texture: one for equal grains

struct DetachTotals {
  double initial, modes[Dust::NMODES], weight, collisions;
  double north, sliding, rolling;    // of the collisions that are over
  double no_room;                    // grains that were not emitted
  double initial_weight;             // as weight

  double detached() const { return std::accumulate(modes, modes + Dust::NMODES, 0.0); }

  // to and from numbers, which a restart file keeps
  static constexpr int SIZE = Dust::NMODES + 8;
  std::array<double, SIZE> numbers() const
  {
    std::array<double, SIZE> list;
    std::memcpy(list.data(), this, sizeof(list));
    return list;
  }
  static DetachTotals from(const double *numbers)
  {
    DetachTotals totals;
    std::memcpy(&totals, numbers, sizeof(totals));
    return totals;
  }

  // over all ranks, on each
  DetachTotals sum(MPI_Comm world) const
  {
    auto all = numbers();
    MPI_Allreduce(MPI_IN_PLACE, all.data(), SIZE, MPI_DOUBLE, MPI_SUM, world);
    return from(all.data());
  }
};

static_assert(sizeof(DetachTotals) == DetachTotals::SIZE * sizeof(double), "totals are doubles only");

}    // namespace LAMMPS_NS

#endif
