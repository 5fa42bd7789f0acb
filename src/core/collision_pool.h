/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_COLLISION_POOL_H
#define DUST_CORE_COLLISION_POOL_H

#include "collision.h"

#include <deque>
#include <vector>

namespace Dust {

/*! The collisions of a rank, and the parts that those which are over leave for others: no memory is asked for in most
 *  steps. A collision keeps its address and its number as long as it is taken. */
class CollisionPool {
 public:
  Workspace work;

  /*! Number of a collision that nobody else has; it must begin() or be unpacked */
  int take();
  /*! It is over, or its carrier gone */
  void give_back(int number);
  /*! Takes back those whose holders are gone
   *  \param taken  by number, which ones still have a holder; at least capacity() of them */
  void keep_only(const std::vector<bool> &taken);

  Collision &operator[](int number) { return collisions[number]; }
  const Collision &operator[](int number) const { return collisions[number]; }

  bool any_taken() const { return spare.size() < collisions.size(); }
  size_t capacity() const { return collisions.size(); }
  double memory_usage() const;    //!< bytes

 private:
  std::deque<Collision> collisions;    // so that more of them move none
  std::vector<int> spare;              // numbers of those that are not taken
};

}    // namespace Dust

#endif
