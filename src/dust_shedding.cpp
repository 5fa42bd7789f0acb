/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "dust_shedding.h"

#include "core/geometry.h"
#include "dust_atoms.h"
#include "dust_gather.h"

#include "atom.h"
#include "domain.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace LAMMPS_NS;

static double distance2(const double *a, const double *b)
{
  const double e[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return Dust::dot(e, e);
}

DustShedding::DustShedding(LAMMPS *lmp, int emit) : Pointers(lmp), emit(emit) {}

/* ---------------------------------------------------------------------- */

double DustShedding::shed(double steps, const std::function<bool(int)> &carries)
{
  const std::vector<Loss> all = of_all_ranks();
  losses.clear();
  if (all.empty()) return 0.0;
  const std::vector<int> carrier = carriers_of(all, carries);
  std::vector<char> leaves(all.size(), 0);
  if (emit) {
    find_room(all, steps, carrier, leaves);
    MPI_Allreduce(MPI_IN_PLACE, leaves.data(), static_cast<int>(leaves.size()), MPI_CHAR, MPI_MAX, world);
    share_room(all, steps, leaves);
  }
  const double no_room = lighten(all, carrier, leaves);
  if (!emit) return 0.0;
  tagint tag = DustAtoms::highest_tag(lmp);
  DustAtoms atoms(lmp);
  for (size_t k = 0; k < all.size(); k++) {
    if (!leaves[k]) continue;
    double x[3];
    place_of(all[k], steps, x);
    atoms.create(emit, ++tag, x, all[k][LOSS_RADIUS], all[k][LOSS_MASS], &all[k][LOSS_V], &all[k][LOSS_SPIN]);
  }
  atoms.finish();
  return no_room;
}

// on which atom of this rank each was, or -1
std::vector<int> DustShedding::carriers_of(const std::vector<Loss> &all, const std::function<bool(int)> &carries) const
{
  std::vector<int> carrier(all.size(), -1);
  const auto by_carrier = [](const Loss &a, const Loss &b) { return a[CARRIER] < b[CARRIER]; };
  for (int i = 0; i < atom->nlocal; i++) {
    if (!carries(i)) continue;
    Loss key = {};
    key[CARRIER] = double(atom->tag[i]);
    const auto range = std::equal_range(all.begin(), all.end(), key, by_carrier);
    for (auto loss = range.first; loss != range.second; ++loss) carrier[loss - all.begin()] = i;
  }
  return carrier;
}

// takes mass and momentum of what leaves off the carriers of this rank; returns how many grains found no room
double DustShedding::lighten(const std::vector<Loss> &all, const std::vector<int> &carrier,
                             const std::vector<char> &leaves) const
{
  double no_room = 0.0;
  for (size_t first = 0, last; first < all.size(); first = last) {
    const int i = carrier[first];
    double mass = 0.0, momentum[3] = {0.0, 0.0, 0.0};    // of what leaves carrier i
    for (last = first; last < all.size() && all[last][CARRIER] == all[first][CARRIER]; last++) {
      if (i >= 0 && emit && !leaves[last]) no_room += 1.0;
      if (emit && !leaves[last]) continue;
      mass += all[last][LOSS_MASS];
      for (int d = 0; d < 3; d++) momentum[d] += all[last][LOSS_MASS] * all[last][LOSS_V + d];
    }
    if (i < 0) continue;
    const double rest = atom->rmass[i] - mass;
    for (int d = 0; d < 3; d++) atom->v[i][d] = (atom->rmass[i] * atom->v[i][d] - momentum[d]) / rest;
    atom->rmass[i] = rest;
  }
  return no_room;
}

// in free flight since it left, as it leaves its carrier's mass now
void DustShedding::place_of(const Loss &loss, double steps, double *x) const
{
  const double flight = (steps - loss[LOSS_STEP]) * update->dt;
  for (int d = 0; d < 3; d++) x[d] = loss[LOSS_X + d] + flight * loss[LOSS_V + d];
}

// of all ranks and on all, in an order that does not depend on their number
std::vector<DustShedding::Loss> DustShedding::of_all_ranks() const
{
  std::vector<Loss> all = dust_gather(losses, ALL_RANKS, world);
  std::sort(all.begin(), all.end());    // by carrier, then by grain
  return all;
}

/* ----------------------------------------------------------------------
   grains of this rank's carriers that would overlap no other atom and lie in the box; walls are not known here
------------------------------------------------------------------------- */

void DustShedding::find_room(const std::vector<Loss> &all, double steps, const std::vector<int> &carrier,
                             std::vector<char> &leaves) const
{
  // atoms along x, and those that some grain of a carrier could touch
  std::vector<int> along(atom->nlocal + atom->nghost), near;
  std::iota(along.begin(), along.end(), 0);
  std::sort(along.begin(), along.end(), [this](int a, int b) { return atom->x[a][0] < atom->x[b][0]; });
  const double largest = along.empty() ? 0.0 : *std::max_element(atom->radius, atom->radius + along.size());
  for (size_t first = 0, last; first < all.size(); first = last) {
    for (last = first + 1; last < all.size() && carrier[last] == carrier[first]; last++) {
    }
    const int i = carrier[first];
    if (i < 0) continue;

    const double *centre = atom->x[i];
    std::vector<std::array<double, 3>> places(last - first);    // next to the carrier, whose image may have changed
    double reach = 0.0;
    for (size_t k = first; k < last; k++) {
      double x[3], *place = places[k - first].data();
      place_of(all[k], steps, x);
      domain->closest_image(centre, x, place);
      reach = std::max(reach, std::sqrt(distance2(centre, place)) + all[k][LOSS_RADIUS]);
    }
    const auto touches = [&](int j, const double *x, double radius) {
      const double sum = atom->radius[j] + radius;
      return distance2(atom->x[j], x) < sum * sum;
    };
    near.clear();
    const double low = centre[0] - reach - largest, high = centre[0] + reach + largest;
    auto j = std::lower_bound(along.begin(), along.end(), low, [this](int a, double x) { return atom->x[a][0] < x; });
    for (; j != along.end() && atom->x[*j][0] <= high; ++j)
      if (atom->tag[*j] != atom->tag[i] && touches(*j, centre, reach)) near.push_back(*j);

    for (size_t k = first; k < last; k++) {
      const double *x = places[k - first].data();
      const bool room = !DustAtoms::beyond_fixed_border(lmp, x) && std::none_of(near.begin(), near.end(), [&](int j) {
        return touches(j, x, all[k][LOSS_RADIUS]);
      });
      leaves[k] = room;
    }
  }
}

/* ----------------------------------------------------------------------
   of grains that would overlap each other the first stays in the list: the same on all ranks. Neighbours along x.
------------------------------------------------------------------------- */

void DustShedding::share_room(const std::vector<Loss> &all, double steps, std::vector<char> &leaves) const
{
  struct Place {
    double x[3];
    size_t number;
  };
  std::vector<Place> places;
  double largest = 0.0;
  for (size_t k = 0; k < all.size(); k++) {
    if (!leaves[k]) continue;
    Place place;
    place.number = k;
    place_of(all[k], steps, place.x);
    domain->remap(place.x);
    places.push_back(place);
    largest = std::max(largest, all[k][LOSS_RADIUS]);
  }
  std::sort(places.begin(), places.end(), [](const Place &a, const Place &b) { return a.x[0] < b.x[0]; });
  std::vector<std::pair<size_t, size_t>> pairs;    // that overlap, the first first
  for (size_t a = 0; a < places.size(); a++)
    for (size_t b = a + 1; b < places.size() && places[b].x[0] - places[a].x[0] < 2.0 * largest; b++) {
      const size_t i = places[a].number, j = places[b].number;
      const double sum = all[i][LOSS_RADIUS] + all[j][LOSS_RADIUS];
      if (distance2(places[a].x, places[b].x) < sum * sum) pairs.emplace_back(std::minmax(i, j));
    }
  std::sort(pairs.begin(), pairs.end());
  for (const auto &[first, second] : pairs)
    if (leaves[first]) leaves[second] = 0;
}
