/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "collision_pool.h"

using namespace Dust;

int CollisionPool::take()
{
  if (spare.empty()) {
    if (made % BLOCK == 0) blocks.push_back(std::make_unique<Collision[]>(BLOCK));
    return static_cast<int>(made++);
  }
  const int number = spare.back();
  spare.pop_back();
  return number;
}

void CollisionPool::give_back(int number)
{
  (*this)[number].release(work);
  spare.push_back(number);
}

void CollisionPool::keep_only(const std::vector<bool> &taken)
{
  spare.clear();
  for (size_t k = 0; k < made; k++)
    if (!taken[k]) give_back(static_cast<int>(k));
}

double CollisionPool::memory_usage() const
{
  double bytes = double(blocks.size()) * BLOCK * sizeof(Collision);
  for (size_t k = 0; k < made; k++) bytes += (*this)[static_cast<int>(k)].packed_size() * sizeof(double);
  return bytes;
}
