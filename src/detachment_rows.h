/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_DETACHMENT_ROWS_H
#define LMP_DUST_DETACHMENT_ROWS_H

#include "detach_columns.h"

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

  // both windows, for a restart file
  const std::vector<Row> &present() const { return under_way; }
  const std::vector<Row> &last() const { return complete; }
  void set(std::vector<Row> present, std::vector<Row> last)
  {
    under_way = std::move(present);
    complete = std::move(last);
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
