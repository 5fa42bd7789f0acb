/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_COLLISION_POOL_H
#define DUST_CORE_COLLISION_POOL_H

#include "collision.h"

#include <memory>
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

  Collision &operator[](int number) { return blocks[number / BLOCK][number % BLOCK]; }
  const Collision &operator[](int number) const { return blocks[number / BLOCK][number % BLOCK]; }

  bool any_taken() const { return spare.size() < made; }
  size_t capacity() const { return made; }
  double memory_usage() const;    //!< bytes

 private:
  // so that more of them move none, and that where one is does not have to be fetched from memory itself
  static constexpr unsigned BLOCK = 32;
  std::vector<std::unique_ptr<Collision[]>> blocks;
  size_t made = 0;           // numbers given out so far
  std::vector<int> spare;    // those that are not taken
};

}    // namespace Dust

#endif
