/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_GATHER_H
#define LMP_DUST_GATHER_H

#include <mpi.h>

#include <numeric>
#include <type_traits>
#include <vector>

namespace LAMMPS_NS {

constexpr int ALL_RANKS = -1;

// the records of all ranks, in the order of ranks, on one rank or on all; records are made of doubles
template <typename Record> std::vector<Record> dust_gather(const std::vector<Record> &mine, int root, MPI_Comm world)
{
  static_assert(std::is_trivially_copyable_v<Record> && sizeof(Record) % sizeof(double) == 0,
                "records are made of doubles");
  constexpr int SIZE = sizeof(Record) / sizeof(double);
  int me, nprocs;
  MPI_Comm_rank(world, &me);
  MPI_Comm_size(world, &nprocs);
  const int count = static_cast<int>(mine.size()) * SIZE;
  std::vector<int> counts(nprocs), offsets(nprocs);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  std::partial_sum(counts.begin(), counts.end() - 1, offsets.begin() + 1);
  std::vector<Record> all(root == ALL_RANKS || root == me ? (offsets.back() + counts.back()) / SIZE : 0);
  if (root == ALL_RANKS)
    MPI_Allgatherv(mine.data(), count, MPI_DOUBLE, all.data(), counts.data(), offsets.data(), MPI_DOUBLE, world);
  else
    MPI_Gatherv(mine.data(), count, MPI_DOUBLE, all.data(), counts.data(), offsets.data(), MPI_DOUBLE, root, world);
  return all;
}

}    // namespace LAMMPS_NS

#endif
