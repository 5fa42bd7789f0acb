/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_DETACHMENT_ROWS_H
#define LMP_DUST_DETACHMENT_ROWS_H

#include "detach_columns.h"
#include "dust_gather.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

// a row for each detachment on this rank: of the window under way, and of the last complete one, which LAMMPS is shown

class DetachmentRows {
 public:
  using Row = std::array<double, DetachRow::SIZE>;

  void add(const Row &row) { under_way.push_back(row); }
  // something came off: this window is to be closed, and the next one to show that nothing more came
  void open() { windows_to_close = 2; }
  bool is_open() const { return windows_to_close > 0; }
  void close()
  {
    windows_to_close--;
    complete.swap(under_way);
    under_way.clear();
    show();
  }

  // of the last complete window, as LAMMPS wants them
  double **pointers() { return row_pointers.data(); }
  int size() const { return static_cast<int>(complete.size()); }

  // appends those of all ranks to what rank 0 writes into a restart file; false if they are too many and left out
  bool save(std::vector<double> &list, MPI_Comm world) const
  {
    constexpr double MOST = 2.0e9;    // LAMMPS counts the bytes of a fix's restart data as int
    double bytes = double(under_way.size() + complete.size()) * sizeof(Row);
    MPI_Allreduce(MPI_IN_PLACE, &bytes, 1, MPI_DOUBLE, MPI_SUM, world);
    for (const auto *window : {&under_way, &complete}) {
      const auto all = bytes < MOST ? dust_gather(*window, 0, world) : std::vector<Row>();
      list.push_back(double(all.size()));
      for (const Row &row : all) list.insert(list.end(), row.begin(), row.end());
    }
    return bytes < MOST;
  }
  // takes them if they are to be this rank's
  void restore(const double *list, bool mine)
  {
    for (auto *window : {&under_way, &complete}) {
      window->resize(mine ? static_cast<size_t>(*list++) : 0);
      for (Row &row : *window) {
        std::copy_n(list, row.size(), row.begin());
        list += row.size();
      }
    }
    show();
  }

  double memory_usage() const { return double(under_way.capacity() + complete.capacity()) * sizeof(Row); }

 private:
  std::vector<Row> under_way, complete;
  std::vector<double *> row_pointers;
  int windows_to_close = 0;

  // rows that are there are to be replaced by those of the next windows
  void show()
  {
    row_pointers.clear();
    for (Row &row : complete) row_pointers.push_back(row.data());
    if (!complete.empty() || !under_way.empty())
      windows_to_close = std::max(windows_to_close, under_way.empty() ? 1 : 2);
  }
};

}    // namespace LAMMPS_NS

#endif
