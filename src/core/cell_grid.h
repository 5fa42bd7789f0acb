/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_CELL_GRID_H
#define DUST_CORE_CELL_GRID_H

#include <algorithm>
#include <cstddef>
#include <vector>

namespace Dust {

/*! Points in space by cubic cells, to find those near a place. Most cells are empty, as grains sit on a sphere: what is
 *  emptied is only what was filled. */
class CellGrid {
 public:
  /*! Empties it
   *  \param reach   half of the side of the cube that all points are in, about the origin; others count as at its walls
   *  \param size    of a cell, or as large as a cube of 128 cells a side needs */
  void clear(double reach, double size)
  {
    constexpr int MOST = 128;
    const int wanted = std::clamp(static_cast<int>(2.0 * reach / size), 1, MOST);
    for (int c : filled) latest[c] = NONE;
    filled.clear();
    points.clear();
    if (wanted != side) latest.assign(size_t(wanted) * wanted * wanted, NONE);
    side = wanted;
    origin = -reach;
    per_length = side / (2.0 * reach);
  }

  void insert(int id, const double *x)
  {
    const int c = (index(x[0]) * side + index(x[1])) * side + index(x[2]);
    if (latest[c] == NONE) filled.push_back(c);
    points.push_back({id, latest[c]});
    latest[c] = static_cast<int>(points.size()) - 1;
  }

  /*! Calls visit(id) for all points in a cube of this half side about a place, and some beyond */
  template <typename Visit> void each_near(const double *x, double reach, Visit visit) const
  {
    int low[3], high[3];
    for (int d = 0; d < 3; d++) {
      low[d] = index(x[d] - reach);
      high[d] = index(x[d] + reach);
    }
    for (int i = low[0]; i <= high[0]; i++)
      for (int j = low[1]; j <= high[1]; j++)
        for (int k = low[2]; k <= high[2]; k++)
          for (int p = latest[(i * side + j) * side + k]; p != NONE; p = points[p].earlier) visit(points[p].id);
  }

 private:
  static constexpr int NONE = -1;
  struct Point {
    int id, earlier;    // the one before it in its cell
  };
  int side = 0;
  double origin = 0.0, per_length = 0.0;
  std::vector<int> latest, filled;    // point of each cell; cells that have one
  std::vector<Point> points;
  int index(double x) const { return std::clamp(static_cast<int>((x - origin) * per_length), 0, side - 1); }
};

}    // namespace Dust

#endif
