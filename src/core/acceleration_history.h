/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_ACCELERATION_HISTORY_H
#define DUST_CORE_ACCELERATION_HISTORY_H

#include <cmath>
#include <vector>

namespace Dust {

/*! The accelerations of a collision, as far as any of them can be largest in some direction
 *
 * Straight impacts and steady sliding leave one. Where the acceleration turns, all of them stay, in a tree of bounding
 * spheres, so that a question about them looks at few. */
class AccelerationHistory {
 public:
  void clear();

  /*! Adds an acceleration; size2 = its square */
  void add(const double *a, double size2);

  bool empty() const { return points.empty(); }
  /*! The largest; there must be one */
  const double *peak() const { return &points[3 * largest]; }
  double peak2() const { return size2_of_peak; }

  /*! Largest a.n of all accelerations, for a direction in which some have a positive one
   *  \param hint  0 at first; keeps the answer's place, which is near that for a similar direction */
  double largest_along(const double *n, size_t &hint) const;

  /*! Whether excess(a) > 0 for any acceleration a
   *  \param slope  by how much excess changes at most per change of its argument */
  template <typename Excess> bool any(Excess excess, double slope) const
  {
    if (points.empty()) return false;
    if (excess(peak()) > 0.0) return true;
    return search([&](const Sphere &s) { return excess(s.centre) + slope * s.radius > 0.0; },
                  [&](size_t i) { return excess(&points[3 * i]) > 0.0; });
  }

  /*! Its points, for transfer to another rank and restart */
  const std::vector<double> &numbers() const { return points; }
  void assign(const double *first, const double *last);

 private:
  static constexpr size_t BRANCH = 16;
  struct Sphere {
    double centre[3], radius;
  };
  std::vector<double> points;                  // x y z of each
  std::vector<std::vector<Sphere>> levels;     // each of BRANCH of the level below, the first of BRANCH points
  size_t largest = 0;
  double size2_of_peak = 0.0;

  void update_tree();
  size_t count(size_t level) const { return level < levels.size() ? levels[level].size() : 0; }

  // calls visit(point) for all points of spheres that may hold what is sought, until it returns true
  template <typename May, typename Visit> bool search(May may, Visit visit) const
  {
    // what is in no sphere of the next level yet
    for (size_t i = count(0) * BRANCH; i < points.size() / 3; i++)
      if (visit(i)) return true;
    for (size_t level = 0; level < levels.size(); level++)
      for (size_t k = count(level + 1) * BRANCH; k < levels[level].size(); k++)
        if (search_in(level, k, may, visit)) return true;
    return false;
  }
  template <typename May, typename Visit> bool search_in(size_t level, size_t k, May &may, Visit &visit) const
  {
    if (!may(levels[level][k])) return false;
    for (size_t i = k * BRANCH; i < (k + 1) * BRANCH; i++)
      if (level == 0 ? visit(i) : search_in(level - 1, i, may, visit)) return true;
    return false;
  }
};

/*! p = lambda q + e with e normal to q, q2 = |q|^2; lambda and |e|^2 */
struct Split {
  double lambda, aside2;
};
Split split(const double *p, const double *q, double q2);

/*! True if p lies between the origin and q, to round-off: q is then at least as large in every direction */
bool is_between(const Split &s, double q2);

}    // namespace Dust

#endif
