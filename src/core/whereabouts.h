/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_WHEREABOUTS_H
#define DUST_CORE_WHEREABOUTS_H

#include <cstddef>
#include <vector>

namespace Dust {

/*! Where spheres were, so that what was found of those that are far apart can be kept until one of them may have come
 *  close: Verlet's list with its skin (Phys. Rev. 159, 98 (1967)), within the list of LAMMPS. */
class Whereabouts {
 public:
  /*! \param x       3n coordinates
   *  \param radius  n of them */
  void note(const double *x, const double *radius, int n);

  /*! Whether the surface of any of the spheres may have moved by more than a distance since: as the centre moves and,
   *  twice, as it grows, as adhesion of the larger one reaches farther. Of another number of spheres it is true. */
  bool left(const double *x, const double *radius, int n, double distance) const;

  double memory_usage() const { return double((x_then.size() + radius_then.size()) * sizeof(double)); }

 private:
  std::vector<double> x_then, radius_then;
};

}    // namespace Dust

#endif
