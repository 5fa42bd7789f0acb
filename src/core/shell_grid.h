/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_SHELL_GRID_H
#define DUST_CORE_SHELL_GRID_H

#include "geometry.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace Dust {

/*! Squared chord between two unit vectors: exact where the dot product would round small distances away */
inline double chord2(const double *a, const double *b)
{
  const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return dot(d, d);
}

/*! Neighbours are closer than an angle (rad) to a point: what a search needs of it */
struct Neighbourhood {
  Neighbourhood(double angle) : cosine(std::cos(std::min(angle, PI))), sine(std::sin(std::min(angle, PI))) {}
  //! the same by the square of the chord, at most 4, that goes with the angle
  static Neighbourhood within(double chord2)
  {
    Neighbourhood near(0.0);
    near.cosine = 1.0 - 0.5 * chord2;
    near.sine = std::sqrt(chord2 * (1.0 - 0.25 * chord2));
    return near;
  }
  double cosine, sine;
};

/*! Which of the points on a unit sphere put in so far are near another one: bands of equal height, each cut into equal
 *  bins of azimuth. Bins are about as wide as the reach of the points, but no narrower than makes sense for their
 *  number: memory goes with that, however small the reach. A search takes no sine or cosine: placement is made of
 *  little else. */
class ShellGrid {
 public:
  //! reach = largest angle (rad) at which two points are neighbours; number = of all points to come, roughly
  ShellGrid(double reach, size_t number)
  {
    constexpr double BINS_PER_POINT = 4.0;
    const double width = std::max(reach, std::sqrt(4.0 * PI / (BINS_PER_POINT * (double(number) + 16.0))));
    nbands = std::max(1, static_cast<int>(2.0 / width));
    first.assign(nbands + 1, 0);
    for (int b = 0; b < nbands; b++) {
      const double low = -1.0 + 2.0 * b / nbands, high = -1.0 + 2.0 * (b + 1) / nbands;
      const double widest = low < 0.0 && high > 0.0 ? 1.0 : std::sqrt(1.0 - std::min(low * low, high * high));
      first[b + 1] = first[b] + std::max(1, static_cast<int>(2.0 * PI * widest / width));
    }
    latest.assign(first[nbands], NONE);
    points.reserve(number);
  }

  void insert(int id, const double *n)
  {
    const int b = band(n[2]), nbins = first[b + 1] - first[b];
    int &head = latest[first[b] + std::min(static_cast<int>(azimuth(n) * nbins), nbins - 1)];
    points.push_back({{n[0], n[1], n[2]}, id, head});
    head = static_cast<int>(points.size()) - 1;
  }

  //! calls visit(id, squared chord) for all neighbours of a point, and some beyond, until one is true; returns whether
  //! one was
  template <typename Visit> bool any_near(const double *n, const Neighbourhood &near, Visit visit) const
  {
    constexpr double ROUND_OFF = 1.0e-14;
    const double z = n[2], s = std::sqrt(n[0] * n[0] + n[1] * n[1]);
    const bool north = z + ROUND_OFF >= near.cosine, south = ROUND_OFF - z >= near.cosine;    // poles among them
    const int lowest = south ? 0 : band(z * near.cosine - s * near.sine - ROUND_OFF);
    const int highest = north ? nbands - 1 : band(z * near.cosine + s * near.sine + ROUND_OFF);
    const double half = north || south ? 1.0 : STEEPEST / (2.0 * PI) * above_asin(near.sine / s) + ROUND_OFF;
    const double from = azimuth(n) - half, width = 2.0 * half;
    for (int b = lowest; b <= highest; b++) {
      const int *heads = latest.data() + first[b], nbins = first[b + 1] - first[b];
      // + 1: of what is positive, the whole part needs no call of floor()
      int i = static_cast<int>((from + 1.0) * nbins);
      const int count = std::min(nbins, static_cast<int>((from + 1.0 + width) * nbins) - i + 1);
      while (i >= nbins) i -= nbins;
      // most bins are empty, which no processor foresees: those that are not are told without a branch
      for (int done = 0; done < count;) {
        constexpr int ROOM = 8;
        int filled[ROOM], number = 0;
        for (const int end = std::min(count, done + ROOM); done < end; done++) {
          filled[number] = heads[i];
          number += heads[i] != NONE;
          i = i + 1 == nbins ? 0 : i + 1;
        }
        for (int k = 0; k < number; k++)
          for (int p = filled[k]; p != NONE; p = points[p].earlier)
            if (visit(points[p].id, chord2(n, points[p].n))) return true;
      }
    }
    return false;
  }

 private:
  static constexpr int NONE = -1;
  struct Point {
    double n[3];
    int id, earlier;    // the one before it in its bin
  };
  int nbands;
  std::vector<int> first;     // first bin of each band
  std::vector<int> latest;    // point of each bin
  std::vector<Point> points;

  int band(double z) const { return std::clamp(static_cast<int>(0.5 * (z + 1.0) * nbands), 0, nbands - 1); }

  // grows with the azimuth from 0 to 1 in a turn, nearly evenly, and takes no arc tangent
  static constexpr double STEEPEST = 1.06;    // at most, of an even growth
  static double azimuth(const double *n)
  {
    const double x = std::fabs(n[0]), y = std::fabs(n[1]), longer = std::max(x, y);
    if (longer == 0.0) return 0.0;
    const double t = std::min(x, y) / longer;
    // of a turn, and exact at 0 and 1: the slope is 0.97 to 1.06 of that of the arc tangent
    const double eighth = t * (0.125 + 0.0434 * (1.0 - t));
    const double quarter = x > y ? eighth : 0.25 - eighth;
    const double upper = n[0] < 0.0 ? 0.5 - quarter : quarter;
    return n[1] < 0.0 ? 1.0 - upper : upper;
  }

  // at least asin(x) for x from 0 to 1, and exact at both ends
  static double above_asin(double x) { return x + (0.5 * PI - 1.0) * x * x * x; }
};

}    // namespace Dust

#endif
