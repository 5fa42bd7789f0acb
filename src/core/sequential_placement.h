/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_SEQUENTIAL_PLACEMENT_H
#define DUST_CORE_SEQUENTIAL_PLACEMENT_H

#include "free_area.h"
#include "geometry.h"
#include "random_numbers.h"
#include "shell_grid.h"
#include "texture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <random>
#include <vector>

namespace Dust {

/*! Of a point on the unit sphere, with the sine or cosine that goes with it */
struct Height {
  double z, s;
  explicit Height(double height) : z(height), s(std::sqrt(std::max(0.0, 1.0 - height * height))) {}
};
struct Azimuth {
  double cosine, sine;
  explicit Azimuth(double phi) : cosine(std::cos(phi)), sine(std::sin(phi)) {}
};

/*! The unit vector there */
inline void point_at(const Height &height, const Azimuth &azimuth, double *n)
{
  n[0] = height.s * azimuth.cosine;
  n[1] = height.s * azimuth.sine;
  n[2] = height.z;
}

/*! Random sequential placement of grains on the part of a carrier above a height, from large to small: each where it
 *  finds room first, at places drawn evenly from all, or from cells that are not wholly excluded.
 *
 * The textures of seeds rest on which places are tried. Of many sizes the cells are made anew for each size, which near
 * the limit costs a look at all of them a grain: when patience is at its end, places are drawn from a FreeArea, which
 * makes none anew. */
class SequentialPlacement {
 public:
  static constexpr double MIN_GAP = 1.0e-3;    //!< between two grains, of the sum of their radii

  /*! \param radii     from large to small
   *  \param patience  cells to look at before places are drawn from a FreeArea */
  SequentialPlacement(double lowest_z, double carrier_radius, const std::vector<double> &radii,
                      std::mt19937_64 &numbers, double patience) :
      zlo(lowest_z), carrier(carrier_radius), least(radii.back()), size(0.0), number(radii.size()),
      many_looks(patience), cells_for(radii.front()), tries(0), random(numbers)
  {
    grains.reserve(number);
  }

  /*! Patience that leaves the textures of seeds as they are: half a second, and for each grain twice what any layer
   *  takes that is not nearly full. Cells for equal grains are never made anew */
  static double long_patience(const std::vector<double> &radii)
  {
    constexpr double MANY = 1.0e6, MANY_PER_GRAIN = 200.0;
    return radii.front() == radii.back() ? std::numeric_limits<double>::infinity()
                                         : MANY + MANY_PER_GRAIN * double(radii.size());
  }

  /*! Places one grain, no larger than the last one; false if there is no room for it */
  bool place(double radius)
  {
    if (radius != size) resize(radius);
    if (looks > many_looks) return place_in_free_area();
    if (radius < cells_for) cells.clear();    // smaller ones have room where larger ones have none
    const Cell everywhere = {zlo, 1.0, 0.0, 2.0 * PI};
    if (cells.empty()) {
      // as long as most of the sphere is free, tries anywhere are cheapest
      for (int misses = 0; misses < 2000; misses++)
        if (try_cell(everywhere)) return true;
      cells = {everywhere};
      cells_for = std::max(0.9 * size, least);    // so that they serve the next grains, too
      tries = 0;
    }
    while (true) {
      for (; tries > 0; tries--)
        if (try_cell(cells[static_cast<size_t>(uniform(random) * cells.size())])) {
          tries--;
          return true;
        }
      if (cells_for < size &&
          cells[0].phi1 - cells[0].phi0 < 0.05 * reach(size, size)) {    // room for smaller grains alone
        cells = {everywhere};
        cells_for = size;
      }
      if (looks > many_looks) return place_in_free_area();
      if (!refine()) return false;
      tries = cells.size();
    }
  }

  std::vector<Grain> grains;
  /*! What it has cost so far: places and cells that others have been searched about */
  size_t cost() const { return searches + looks; }

 private:
  using Cell = ShellCell;
  static constexpr double ROUND_OFF = 1.0e-9;

  double zlo, carrier, least, size;
  size_t number;    // of all grains
  double many_looks;
  size_t searches = 0, looks = 0;    // about places, and about cells
  std::vector<Cell> cells;    // where there may be room for a grain of a size; empty as long as nearly anywhere; all of
                              // the same area
  double cells_for;           // that size, at most the next grain's
  size_t tries;               // in these cells, until the next refinement
  struct Level {              // grains between a size and half of it
    double largest;           // that size
    double most;              // least_chord2() of the present size and that one, no less
    Neighbourhood near;       // where its grains can be neighbours of the present one
    ShellGrid grid;
  };
  std::vector<Level> levels;
  std::optional<FreeArea> free_area;
  std::mt19937_64 &random;

  // squared chord that keeps a grain's direction off another's, from the triangle of both centres and the carrier's
  double least_chord2(double a, double b) const
  {
    const double touch = (a + b) * (1.0 + MIN_GAP), step = a - b;
    return (touch * touch - step * step) / ((carrier + a) * (carrier + b));
  }
  double reach(double a, double b) const { return 2.0 * std::asin(std::min(1.0, 0.5 * std::sqrt(least_chord2(a, b)))); }

  void resize(double radius)
  {
    size = radius;
    if (levels.empty() || size < 0.5 * levels.back().largest)
      levels.push_back({size, 0.0, 0.0, ShellGrid(reach(size, size), number - grains.size())});
    for (Level &level : levels) {
      level.most = least_chord2(size, level.largest) * (1.0 + ROUND_OFF);
      level.near = reach(size, level.largest) * (1.0 + ROUND_OFF);
    }
  }

  // whether a grain is nearer to n than the chord that goes with its radius, of those that may be neighbours of one of
  // this size, or a smaller one
  template <typename Chord2> bool any_near(const double *n, Chord2 chord2_of) const
  {
    return std::any_of(levels.begin(), levels.end(), [&](const Level &level) {
      return level.grid.any_near(n, level.near, [&](int id, double chord2) {
        return chord2 < level.most && chord2 < chord2_of(grains[id].radius);
      });
    });
  }

  bool try_cell(const Cell &cell)
  {
    Grain grain;
    grain.radius = size;
    searches++;
    const double z = cell.z0 + uniform(random) * (cell.z1 - cell.z0);
    point_at(Height(z), Azimuth(cell.phi0 + uniform(random) * (cell.phi1 - cell.phi0)), grain.n);
    if (any_near(grain.n, [this](double radius) { return least_chord2(size, radius); })) return false;
    levels.back().grid.insert(static_cast<int>(grains.size()), grain.n);
    grains.push_back(grain);
    return true;
  }

  // the largest chord from the middle of a cell to a point of it: to a corner, once it is narrower than pi/2
  static double radius_of(const Height (&z)[2], const Azimuth (&phi)[2], const double *middle)
  {
    double farthest = 0.0;
    for (const Height &high : z)
      for (const Azimuth &wide : phi) {
        double corner[3];
        point_at(high, wide, corner);
        farthest = std::max(farthest, chord2(middle, corner));
      }
    return std::sqrt(farthest);
  }

  // true if one grain excludes the whole cell
  bool covered(const Height (&z)[2], const Azimuth (&phi)[2], const Height &middle_z, const Azimuth &middle_phi) const
  {
    double middle[3];
    point_at(middle_z, middle_phi, middle);
    const double radius = radius_of(z, phi, middle);
    const auto limit = [&](double other) {    // chords obey the triangle inequality
      return std::max(0.0, std::sqrt(least_chord2(cells_for, other)) - radius);
    };
    return std::any_of(levels.begin(), levels.end(), [&](const Level &level) {
      const double most = std::pow(limit(level.largest), 2) * (1.0 + ROUND_OFF);
      if (most == 0.0) return false;
      return level.grid.any_near(middle, Neighbourhood::within(most), [&](int id, double chord2) {
        return chord2 < most && chord2 < std::pow(limit(grains[id].radius), 2);
      });
    });
  }

  // appends the quarters of a cell that are not covered; sines and cosines of what they share are taken once
  void quarter(const Cell &c, std::vector<Cell> &finer) const
  {
    const double z[3] = {c.z0, 0.5 * (c.z0 + c.z1), c.z1}, phi[3] = {c.phi0, 0.5 * (c.phi0 + c.phi1), c.phi1};
    const bool wide = phi[1] - phi[0] > 0.5 * PI || phi[2] - phi[1] > 0.5 * PI;
    const Height heights[3] = {Height(z[0]), Height(z[1]), Height(z[2])};
    const Azimuth azimuths[3] = {Azimuth(phi[0]), Azimuth(phi[1]), Azimuth(phi[2])};
    for (int j = 0; j < 2; j++) {
      const Azimuth middle_phi(0.5 * (phi[j] + phi[j + 1]));
      for (int i = 0; i < 2; i++)
        if (wide || !covered({heights[i], heights[i + 1]}, {azimuths[j], azimuths[j + 1]},
                             Height(0.5 * (z[i] + z[i + 1])), middle_phi))
          finer.push_back({z[i], z[i + 1], phi[j], phi[j + 1]});
    }
  }

  // quarters the cells until most are smaller than a grain's surroundings, and drops those without room
  bool refine()
  {
    const double wide = 0.5 * reach(size, size);
    do {
      if ((cells.empty()) || (cells[0].z1 - cells[0].z0 < 1.0e-12)) return false;
      std::vector<Cell> finer;
      for (const Cell &c : cells) quarter(c, finer);
      looks += 4 * cells.size();
      cells.swap(finer);
    } while (!cells.empty() && cells[0].phi1 - cells[0].phi0 > wide);
    return !cells.empty();
  }

  // radius of the largest grain, up to the present size, that one of radius b does not exclude from all places within a
  // chord c of its own: least_chord2(a, b) = c^2
  double largest_beside(double b, double c2) const
  {
    constexpr double G2 = (1.0 + MIN_GAP) * (1.0 + MIN_GAP);
    const double square = G2 - 1.0, linear = 2.0 * (G2 + 1.0) * b - c2 * (carrier + b);
    const double rest = square * b * b - c2 * carrier * (carrier + b);
    return -2.0 * rest / (linear + std::sqrt(linear * linear - 4.0 * square * rest));
  }

  // the largest grain that may find room in a cell: infinitely large, if one of the present size may
  double largest_in(const Cell &c) const
  {
    constexpr double ANY = std::numeric_limits<double>::infinity();
    if (c.phi1 - c.phi0 > 0.5 * PI) return ANY;
    double middle[3];
    point_at(Height(0.5 * (c.z0 + c.z1)), Azimuth(0.5 * (c.phi0 + c.phi1)), middle);
    const double radius = radius_of({Height(c.z0), Height(c.z1)}, {Azimuth(c.phi0), Azimuth(c.phi1)}, middle);
    double largest = ANY;
    for (const Level &level : levels)
      level.grid.any_near(middle, level.near, [&](int id, double chord2) {
        if (chord2 >= level.most) return false;
        const double b = grains[id].radius, c2 = std::pow(std::sqrt(chord2) + radius, 2);
        if (c2 >= least_chord2(size, b)) return false;
        largest = std::min(largest, c2 < least_chord2(least, b) ? 0.0 : largest_beside(b, c2) * (1.0 + ROUND_OFF));
        return largest < least;
      });
    return largest;
  }

  bool place_in_free_area()
  {
    const auto largest = [this](const Cell &c) { return largest_in(c); };
    if (!free_area) {
      free_area.emplace(zlo);
      free_area->begin(size, least, 0.5 * reach(size, size), largest);
      cells = {};
    }
    free_area->wake(size);
    while (!free_area->full()) {
      if (try_cell(free_area->draw(uniform(random)))) return true;
      free_area->quarter(size, least, largest);
      looks += 4;
    }
    return false;
  }
};

}    // namespace Dust

#endif
