/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_FREE_AREA_H
#define DUST_CORE_FREE_AREA_H

#include "geometry.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <queue>
#include <vector>

namespace Dust {

/*! Part of a sphere above a height, in z and azimuth: area is dz dphi */
struct ShellCell {
  double z0, z1, phi0, phi1;
};

/*! Where on the part of a sphere above a height there may still be room, for grains that come from large to small
 *
 * Cells that no grain excludes entirely. One in which a grain found no room is quartered, and of its quarters only
 * those are kept that have room: so what is looked at is what is near a miss, whatever the number of grains. A cell
 * that has room for smaller grains only waits until they come. Drawn with a probability that goes with its area, a cell
 * and then a place in it are uniform over a region that contains all that is free, so the first place with room is
 * uniform over what is free (the idea of Wang, Int. J. Mod. Phys. C 5, 707 (1994), for a sphere and many sizes). */
class FreeArea {
 public:
  explicit FreeArea(double lowest_z) : zlo(lowest_z), levels(DEEPEST + 1) {}

  /*! All that there is, in cells no wider than an angle
   *  \param size       radius of the next grain
   *  \param least      that of the smallest grain to come
   *  \param largest_in  of a ShellCell: the radius above which no grain finds room in it, or more */
  template <typename LargestIn> void begin(double size, double least, double angle, LargestIn largest_in)
  {
    fill({0, 0, 0}, size, least, angle, largest_in);
  }

  /*! Grains are no larger than this from now on */
  void wake(double size)
  {
    for (; !waiting.empty() && waiting.top().largest >= size; waiting.pop()) keep(waiting.top().cell);
  }

  /*! Nowhere is room for a grain of this size */
  bool full() const
  {
    return std::all_of(levels.begin(), levels.end(), [](const auto &cells) { return cells.empty(); });
  }

  /*! One of its cells: the next call of quarter() is about it
   *  \param u  a random number from 0 up to 1 */
  ShellCell draw(double u)
  {
    double sum = 0.0;
    for (int k = 0; k <= DEEPEST; k++) sum += std::ldexp(double(levels[k].size()), -2 * k);
    double left = u * sum;
    for (int k = 0; k <= DEEPEST; k++) {
      const double share = std::ldexp(double(levels[k].size()), -2 * k);
      if (levels[k].empty()) continue;
      level = k;
      at = std::min(static_cast<size_t>(std::ldexp(left, 2 * k)), levels[k].size() - 1);
      if (left < share) break;
      left -= share;
    }
    return shape_of({level, levels[level][at].i, levels[level][at].j});
  }

  /*! Puts its quarters into the place of the last cell drawn, in which there was no room */
  template <typename LargestIn> void quarter(double size, double least, LargestIn largest_in)
  {
    const Cell cell = {level, levels[level][at].i, levels[level][at].j};
    levels[level][at] = levels[level].back();
    levels[level].pop_back();
    each_quarter(cell, [&](const Cell &q) { fill(q, size, least, 2.0 * PI, largest_in); });
  }

 private:
  static constexpr int DEEPEST = 31;    // quarterings: what is smaller, 1e-9 of the sphere across, has no room
  struct Cell {
    int level;
    uint32_t i, j;    // number along z and azimuth, of 2^level
  };
  struct Place {
    uint32_t i, j;
  };
  struct Waiting {
    double largest;
    Cell cell;
    bool operator<(const Waiting &other) const { return largest < other.largest; }
  };
  double zlo;
  std::vector<std::vector<Place>> levels;    // cells that may have room for the present size
  std::priority_queue<Waiting> waiting;      // for smaller sizes only
  int level = 0;
  size_t at = 0;

  ShellCell shape_of(const Cell &c) const
  {
    const double dz = std::ldexp(1.0 - zlo, -c.level), dphi = std::ldexp(2.0 * PI, -c.level);
    return {zlo + c.i * dz, zlo + (c.i + 1.0) * dz, c.j * dphi, (c.j + 1.0) * dphi};
  }
  void keep(const Cell &c) { levels[c.level].push_back({c.i, c.j}); }

  template <typename Visit> static void each_quarter(const Cell &c, Visit visit)
  {
    if (c.level == DEEPEST) return;
    for (uint32_t i : {0, 1})
      for (uint32_t j : {0, 1}) visit(Cell{c.level + 1, 2 * c.i + i, 2 * c.j + j});
  }

  template <typename LargestIn>
  void fill(const Cell &cell, double size, double least, double angle, LargestIn &largest_in)
  {
    const ShellCell shape = shape_of(cell);
    const double largest = largest_in(shape);
    if (largest < least) return;
    if (largest < size)
      waiting.push({largest, cell});
    else if (shape.phi1 - shape.phi0 > angle)
      each_quarter(cell, [&](const Cell &q) { fill(q, size, least, angle, largest_in); });
    else
      keep(cell);
  }
};

}    // namespace Dust

#endif
