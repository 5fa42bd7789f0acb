/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_ACCELERATION_HISTORY_H
#define DUST_CORE_ACCELERATION_HISTORY_H

#include "motion.h"
#include "pack.h"

#include <cstddef>
#include <vector>

namespace Dust {

/*! p = lambda q + e with e normal to q, q2 = |q|^2; lambda and |e|^2 */
struct Split {
  double lambda, aside2;
};
inline Split split(const double *p, const double *q, double q2)
{
  const double lambda = dot(p, q) / q2;
  const double e[3] = {p[0] - lambda * q[0], p[1] - lambda * q[1], p[2] - lambda * q[2]};
  return {lambda, dot(e, e)};
}

/*! True if p lies between the origin and q, to round-off: q is then at least as large in every direction */
inline bool is_between(const Split &s, double q2)
{
  constexpr double ROUND_OFF2 = 1.0e-24;
  return s.lambda >= 0.0 && s.lambda <= 1.0 && s.aside2 <= ROUND_OFF2 * q2;
}

/*! The motions of a collision, along the carrier's own axes, as far as any of them can matter most to some grain
 *
 * Straight impacts and steady sliding leave one. Where the acceleration changes its direction or the carrier rotates,
 * all of them stay, in a tree of bounding spheres, so that a question about them looks at few. */
class AccelerationHistory {
 public:
  void clear();

  /*! Adds a motion
   *  \param size2    square of its acceleration
   *  \param rotates  whether its angular acceleration or spin matter */
  void add(const Motion &motion, double size2, bool rotates);

  bool empty() const { return motions.empty(); }
  /*! The motion of the largest acceleration; there must be one */
  const Motion &peak() const { return motions[peak_at]; }
  double peak2() const { return size2_of_peak; }    //!< square of its acceleration
  bool any_rotates() const { return any_rotated; }
  /*! Has what add() compares with brought from memory into the cache */
  __attribute__((always_inline)) void fetch() const
  {
    __builtin_prefetch(motions.data() + peak_at);
    if (!motions.empty()) __builtin_prefetch(&motions.back(), 1);
  }

  /*! Largest push on a grain, a.n less the centrifugal acceleration; there must be a motion
   *  \param hint  0 at first; keeps the answer's place, which is near that for a similar direction */
  double max_push(const double *n, double shell, size_t &hint) const;

  /*! Whether excess(motion) > 0 for any motion
   *  \param slope  by how much excess changes at most per change of the acceleration, or of what alpha and omega add to
   *                it at the distance `shell` */
  template <typename Excess> bool any(Excess excess, double slope, double shell) const
  {
    if (motions.empty()) return false;
    if (excess(peak()) > 0.0) return true;
    return search([&](const Sphere &s) { return excess(s.centre) + slope * s.size(shell) > 0.0; },
                  [&](size_t i) { return excess(motions[i]) > 0.0; });
  }

  const std::vector<Motion> &kept() const { return motions; }

  // transfer to another rank and restart; with the peak as it was: to round-off, accelerations are as large in other
  // axes
  void pack(Packer &packer) const;
  void unpack(Unpacker &unpacker);

 private:
  static constexpr size_t BRANCH = 8;
  // g on a grain at the distance r differs by at most radius + r rotation from that of the centre
  struct Sphere {
    Motion centre;
    double radius, rotation;
    double size(double shell) const { return radius + shell * rotation; }
  };
  std::vector<Motion> motions;
  // each of BRANCH of the level below, the first of BRANCH motions; brought up to date when a question is asked
  mutable std::vector<std::vector<Sphere>> levels;
  mutable size_t in_tree = 0;    // the first motions: as they were when the tree was last up to date
  size_t peak_at = 0;
  bool any_rotated = false;    // whether any motion rotated that was kept for a while
  double size2_of_peak = 0.0;

  Sphere member(size_t level, size_t i) const;
  Sphere around(size_t level, size_t first) const;    // BRANCH members
  void update_tree() const;
  size_t count(size_t level) const { return level < levels.size() ? levels[level].size() : 0; }

  // calls visit(motion) for all motions of spheres that may hold what is sought, until it returns true
  template <typename May, typename Visit> bool search(May may, Visit visit) const
  {
    update_tree();
    // what is in no sphere of the next level yet
    for (size_t i = count(0) * BRANCH; i < motions.size(); i++)
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

}    // namespace Dust

#endif
