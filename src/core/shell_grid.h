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

/*! Which of the points on a unit sphere put in so far are near another one: bands of polar angle, each cut into equal
 *  bins of azimuth. Bins are as wide as the reach of the points, but no narrower than makes sense for their number:
 *  memory goes with that, however small the reach. */
class ShellGrid {
 public:
  //! reach = largest angle (rad) at which two points are neighbours; number = of all points to come, roughly
  ShellGrid(double reach, size_t number)
  {
    constexpr double BINS_PER_POINT = 4.0;
    const double width = std::max(reach, std::sqrt(4.0 * PI / (BINS_PER_POINT * (double(number) + 16.0))));
    nbands = std::max(1, static_cast<int>(PI / width));
    first.assign(nbands + 1, 0);
    for (int b = 0; b < nbands; b++) {
      const double widest = std::max(std::sin(PI * b / nbands), std::sin(PI * (b + 1) / nbands));
      first[b + 1] = first[b] + std::max(1, static_cast<int>(2.0 * PI * widest / width));
    }
    latest.assign(first[nbands], NONE);
  }

  void insert(int id, const double *n)
  {
    int &head = latest[bin(band(n[2]), azimuth(n))];
    points.push_back({id, head});
    head = static_cast<int>(points.size()) - 1;
  }

  //! calls visit(id) for all points within an angle (rad), and some beyond, until one is true; returns whether one was
  template <typename Visit> bool any_near(const double *n, double angle, Visit visit) const
  {
    const double theta = std::acos(std::clamp(n[2], -1.0, 1.0));
    const double phi = azimuth(n);
    const int lowest = band_of_angle(theta - angle), highest = band_of_angle(theta + angle);
    const bool at_pole = theta <= angle || theta >= PI - angle;
    const double half = at_pole ? PI : std::asin(std::min(1.0, std::sin(angle) / std::sin(theta)));
    for (int b = lowest; b <= highest; b++) {
      const int nbins = first[b + 1] - first[b];
      int from = static_cast<int>(std::floor((phi - half) / (2.0 * PI) * nbins));
      int count = static_cast<int>(std::floor((phi + half) / (2.0 * PI) * nbins)) - from + 1;
      count = std::min(count, nbins);
      from = ((from % nbins) + nbins) % nbins;
      for (int k = 0; k < count; k++) {
        const int i = from + k < nbins ? from + k : from + k - nbins;
        for (int p = latest[first[b] + i]; p != NONE; p = points[p].earlier)
          if (visit(points[p].id)) return true;
      }
    }
    return false;
  }

 private:
  static constexpr int NONE = -1;
  struct Point {
    int id, earlier;    // the one before it in its bin
  };
  int nbands;
  std::vector<int> first;     // first bin of each band
  std::vector<int> latest;    // point of each bin
  std::vector<Point> points;

  static double azimuth(const double *n)
  {
    const double phi = std::atan2(n[1], n[0]);
    return phi < 0.0 ? phi + 2.0 * PI : phi;
  }
  int band_of_angle(double theta) const { return std::clamp(static_cast<int>(theta / PI * nbands), 0, nbands - 1); }
  int band(double z) const { return band_of_angle(std::acos(std::clamp(z, -1.0, 1.0))); }
  int bin(int b, double phi) const
  {
    const int nbins = first[b + 1] - first[b];
    return first[b] + std::min(static_cast<int>(phi / (2.0 * PI) * nbins), nbins - 1);
  }
};

}    // namespace Dust

#endif
