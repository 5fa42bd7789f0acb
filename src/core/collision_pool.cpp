/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "collision_pool.h"

using namespace Dust;

int CollisionPool::take()
{
  if (spare.empty()) {
    collisions.emplace_back();
    return static_cast<int>(collisions.size()) - 1;
  }
  const int number = spare.back();
  spare.pop_back();
  return number;
}

void CollisionPool::give_back(int number)
{
  collisions[number].release(work);
  spare.push_back(number);
}

void CollisionPool::keep_only(const std::vector<bool> &taken)
{
  spare.clear();
  for (size_t k = 0; k < collisions.size(); k++)
    if (!taken[k]) give_back(static_cast<int>(k));
}

double CollisionPool::memory_usage() const
{
  double bytes = 0.0;
  for (const Collision &collision : collisions) bytes += sizeof(collision) + collision.packed_size() * sizeof(double);
  return bytes;
}
