/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "dust_room.h"

#include "dust_atoms.h"
#include "dust_walls.h"

#include "atom.h"
#include "domain.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

using namespace LAMMPS_NS;

// a grain touches its carrier when it leaves: less than this part of their distance is no overlap
static constexpr double TOUCH = 1.0e-6;

DustRoom::DustRoom(LAMMPS *_lmp, std::vector<Sphere> list) :
    Pointers(_lmp), spheres(std::move(list)), along(spheres.size()), axis(0), largest(0.0)
{
  for (int d = 1; d < 3; d++)
    if (domain->prd[d] > domain->prd[axis]) axis = d;
  for (Sphere &sphere : spheres) {
    domain->remap(sphere.x);
    domain->remap(sphere.from);
    largest = std::max(largest, sphere.radius);
  }
  std::iota(along.begin(), along.end(), 0);
  std::sort(along.begin(), along.end(), [this](int a, int b) { return spheres[a].x[axis] < spheres[b].x[axis]; });
}

/* ---------------------------------------------------------------------- */

std::vector<int> DustRoom::find() const
{
  std::vector<int> room(spheres.size());
  const DustWalls walls(lmp);
  for (size_t k = 0; k < room.size(); k++)
    room[k] = !DustAtoms::beyond_fixed_border(lmp, spheres[k].x) &&
              !walls.stop(spheres[k].from, spheres[k].x, spheres[k].radius);
  clear_of_atoms(room);
  clear_of_each_other(room);
  return room;
}

/* ----------------------------------------------------------------------
   each rank looks at its own atoms, which need not be near its part of the box
------------------------------------------------------------------------- */

void DustRoom::clear_of_atoms(std::vector<int> &room) const
{
  std::vector<int> taken(room.size(), 0);
  for (int i = 0; i < atom->nlocal; i++)
    each_near(atom->x[i], atom->radius[i] + largest, [&](int k) {
      const double sum = atom->radius[i] + spheres[k].radius;
      const double least = atom->tag[i] == spheres[k].carrier ? (1.0 - TOUCH) * sum : sum;
      if (distance2(atom->x[i], spheres[k].x) < least * least) taken[k] = 1;
    });
  MPI_Allreduce(MPI_IN_PLACE, taken.data(), static_cast<int>(taken.size()), MPI_INT, MPI_MAX, world);
  for (size_t k = 0; k < room.size(); k++) room[k] = room[k] && !taken[k];
}

/* ----------------------------------------------------------------------
   of those that would overlap each other the first has the room
------------------------------------------------------------------------- */

void DustRoom::clear_of_each_other(std::vector<int> &room) const
{
  std::vector<std::pair<int, int>> pairs;
  for (int k = 0; k < static_cast<int>(spheres.size()); k++) {
    if (!room[k]) continue;
    each_near(spheres[k].x, spheres[k].radius + largest, [&](int other) {
      const double sum = spheres[k].radius + spheres[other].radius;
      if (other > k && room[other] && distance2(spheres[k].x, spheres[other].x) < sum * sum)
        pairs.emplace_back(k, other);
    });
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto &[first, second] : pairs)
    if (room[first]) room[second] = 0;
}

/* ----------------------------------------------------------------------
   the spheres within reach of x along the axis, in any periodic image; some more than once if the box is that small
------------------------------------------------------------------------- */

template <typename Visit> void DustRoom::each_near(const double *x, double reach, Visit visit) const
{
  const auto below = [this](int k, double value) { return spheres[k].x[axis] < value; };
  double place[3] = {x[0], x[1], x[2]};
  domain->remap(place);
  const int images = domain->periodicity[axis] ? 1 : 0;
  for (int image = -images; image <= images; image++) {
    const double middle = place[axis] + image * domain->prd[axis];
    auto k = std::lower_bound(along.begin(), along.end(), middle - reach, below);
    for (; k != along.end() && spheres[*k].x[axis] <= middle + reach; ++k) visit(*k);
  }
}

double DustRoom::distance2(const double *a, const double *b) const
{
  double sum = 0.0;
  for (int d = 0; d < 3; d++) {
    double e = a[d] - b[d];
    if (domain->periodicity[d]) e -= domain->prd[d] * std::round(e / domain->prd[d]);
    sum += e * e;
  }
  return sum;
}
