/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "dust_shedding.h"

#include "dust_atoms.h"
#include "dust_gather.h"
#include "dust_room.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "memory.h"
#include "modify.h"
#include "neighbor.h"

#include <algorithm>
#include <cmath>
#include <utility>

using namespace LAMMPS_NS;

DustShedding::DustShedding(LAMMPS *_lmp, Fix *_fix, int _emit) :
    Pointers(_lmp), fix(_fix), emit(_emit), clock(0.0), changed(false), highest(0), waiting(nullptr), unseen(nullptr)
{
  if (emit && !atom->tag_enable) error->all(FLERR, "Fix dust/detach emit {} needs atom IDs: atom_modify id yes", emit);
}

DustShedding::~DustShedding()
{
  memory->destroy(waiting);
  memory->destroy(unseen);
}

/* ----------------------------------------------------------------------
   new atoms take the places of ghosts, whose contacts with their history LAMMPS must have put away by then
------------------------------------------------------------------------- */

void DustShedding::check_deck() const
{
  if (!emit) return;
  if (domain->triclinic)
    error->all(FLERR, "Fix dust/detach {} emit {} needs an orthogonal box: it is triclinic now", fix->id, emit);
  bool after = false;
  for (const auto &other : modify->get_fix_list()) {
    if (other == fix) after = true;
    if (after && utils::strmatch(other->style, "^NEIGH_HISTORY"))
      error->all(FLERR, "The pair_style command must stand before fix {} (dust/detach) with emit", fix->id);
  }
}

/* ---------------------------------------------------------------------- */

void DustShedding::take_off(int i, double mass, const double *momentum)
{
  const double before = atom->rmass[i], after = before - mass;
  for (int d = 0; d < 3; d++) atom->v[i][d] = (before * atom->v[i][d] - momentum[d]) / after;
  atom->rmass[i] = after;
  changed = true;
}

void DustShedding::wait(int i, const Grain &grain) { list_of(i).grains.push_back(grain); }

bool DustShedding::masses_changed()
{
  int any = changed;
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, world);
  changed = false;
  return any;
}

/* ---------------------------------------------------------------------- */

double DustShedding::emit_grains(const std::function<bool(int)> &ready)
{
  const std::vector<Candidate> all = gather(ready);
  if (all.empty()) return 0.0;
  std::vector<DustRoom::Sphere> spheres;
  for (const Candidate &c : all)
    spheres.push_back({{c.x[0], c.x[1], c.x[2]}, {c.from[0], c.from[1], c.from[2]}, c.radius, tagint(c.carrier)});
  const std::vector<int> room = DustRoom(lmp, std::move(spheres)).find();
  const double back = send_back(all, room);
  if (std::count(room.begin(), room.end(), 1)) create(all, room);
  return back;
}

/* ----------------------------------------------------------------------
   Nothing moves, so the forces stay as they are, and so must the atoms' places in memory and on the ranks: they do not
   change ranks here. The next step has to see to that.
------------------------------------------------------------------------- */

double DustShedding::emit_all()
{
  const bigint before = atom->natoms;
  const double back = emit_grains([](int) { return true; });
  if (atom->natoms == before) return back;
  comm->borders();
  modify->pre_neighbor();
  neighbor->build(1);
  modify->post_neighbor();
  return back;
}

/* ----------------------------------------------------------------------
   of all ranks and on all, where they are now, in an order that does not depend on the number of ranks
------------------------------------------------------------------------- */

std::vector<DustShedding::Candidate> DustShedding::gather(const std::function<bool(int)> &ready)
{
  std::vector<Candidate> mine;
  for (int i = 0; i < atom->nlocal; i++) {
    if (waiting[i] < 0 || !ready(i)) continue;
    for (const Grain &g : lists[waiting[i]].grains) {
      Candidate c = {double(atom->tag[i]), g.number, double(comm->me), double(i), g.mass, g.radius, {}, {}, {}, {}};
      std::copy_n(g.x, 3, c.from);
      for (int d = 0; d < 3; d++) c.x[d] = g.x[d] + (clock - g.time) * g.v[d];
      std::copy_n(g.v, 3, c.v);
      std::copy_n(g.spin, 3, c.spin);
      mine.push_back(c);
    }
    drop(waiting[i]);
    waiting[i] = NOBODY;
  }
  std::vector<Candidate> all = dust_gather(mine, ALL_RANKS, world);
  std::sort(all.begin(), all.end(), [](const Candidate &a, const Candidate &b) {
    return a.carrier != b.carrier ? a.carrier < b.carrier : a.number < b.number;
  });
  return all;
}

// those without room, to the carriers; returns how many of this rank
double DustShedding::send_back(const std::vector<Candidate> &all, const std::vector<int> &room)
{
  double back = 0.0;
  for (size_t k = 0; k < all.size(); k++) {
    if (room[k] || all[k].rank != comm->me) continue;
    const double momentum[3] = {-all[k].mass * all[k].v[0], -all[k].mass * all[k].v[1], -all[k].mass * all[k].v[2]};
    take_off(int(all[k].index), -all[k].mass, momentum);
    back += 1.0;
  }
  return back;
}

void DustShedding::create(const std::vector<Candidate> &all, const std::vector<int> &room)
{
  const bigint wanted = std::count(room.begin(), room.end(), 1);
  tagint tag = DustAtoms::highest_tag(lmp);
  if (tag > MAXTAGINT - wanted) error->all(FLERR, "Fix dust/detach: no atom IDs are left for {} grains", wanted);
  const int before = atom->nlocal;
  DustAtoms atoms(lmp);
  for (size_t k = 0; k < all.size(); k++)
    if (room[k]) atoms.create(emit, ++tag, all[k].x, all[k].radius, all[k].mass, all[k].v, all[k].spin);
  const bigint made = atoms.finish();
  if (made != wanted) error->all(FLERR, "Fix dust/detach has emitted {} of {} grains only", made, wanted);
  for (int i = before; i < atom->nlocal; i++) set_seen(i);
  highest = tag;
}

/* ----------------------------------------------------------------------
   fix pour and fix deposit may count IDs on from where they began: what comes now can have one that was given here
------------------------------------------------------------------------- */

void DustShedding::check_new_ids()
{
  std::vector<double> mine;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!unseen[i]) continue;
    unseen[i] = 0;
    if (atom->tag[i] <= highest) mine.push_back(double(atom->tag[i]));
  }
  if (highest == 0) return;
  std::vector<double> suspects = dust_gather(mine, ALL_RANKS, world);
  if (suspects.empty()) return;
  std::sort(suspects.begin(), suspects.end());
  std::vector<int> found(suspects.size(), 0);
  for (int i = 0; i < atom->nlocal; i++) {
    const auto at = std::lower_bound(suspects.begin(), suspects.end(), double(atom->tag[i]));
    if (at != suspects.end() && *at == double(atom->tag[i])) found[at - suspects.begin()]++;
  }
  MPI_Allreduce(MPI_IN_PLACE, found.data(), static_cast<int>(found.size()), MPI_INT, MPI_SUM, world);
  const auto twice = std::find_if(found.begin(), found.end(), [](int n) { return n > 1; });
  if (twice != found.end())
    error->all(
        FLERR,
        "Fix dust/detach emit: a new atom has the ID {} of an emitted grain: use keyword id max with fix pour and "
        "fix deposit",
        tagint(suspects[twice - found.begin()]));
}

/* ----------------------------------------------------------------------
   per-atom data
------------------------------------------------------------------------- */

void DustShedding::grow(int nmax)
{
  memory->grow(waiting, nmax, "dust/detach:waiting");
  memory->grow(unseen, nmax, "dust/detach:unseen");
}

DustShedding::List &DustShedding::list_of(int i)
{
  if (waiting[i] >= 0) return lists[waiting[i]];
  if (idle.empty()) {
    idle.push_back(static_cast<int>(lists.size()));
    lists.emplace_back();
  }
  waiting[i] = idle.back();
  idle.pop_back();
  return lists[waiting[i]];
}

void DustShedding::drop(int number)
{
  lists[number].grains.clear();
  lists[number].from_file = false;
  idle.push_back(number);
}

void DustShedding::drop_lost()
{
  if (idle.size() == lists.size()) return;
  std::vector<bool> used(lists.size(), false);
  for (int i = 0; i < atom->nlocal; i++)
    if (waiting[i] >= 0) used[waiting[i]] = true;
  idle.clear();
  for (size_t k = 0; k < used.size(); k++)
    if (!used[k]) drop(static_cast<int>(k));
}

/* ----------------------------------------------------------------------
   layout: number of waiting grains; if any, whether they come from a restart file, their carrier's place then, they
------------------------------------------------------------------------- */

void DustShedding::pack(int i, bool for_file, Dust::Packer &to) const
{
  if (waiting[i] < 0) {
    to.put(0.0);
    return;
  }
  const List &list = lists[waiting[i]];
  to.put(double(list.grains.size()));
  to.put(list.from_file || for_file);
  double place[3] = {list.carrier[0], list.carrier[1], list.carrier[2]};
  if (for_file && !list.from_file) unwrapped(i, place);
  to.put(place, 3);
  to.put(list.grains.data(), list.grains.size());
}

void DustShedding::unpack(int i, Dust::Unpacker &from)
{
  waiting[i] = NOBODY;
  const auto n = static_cast<size_t>(from.number());
  if (n == 0) return;
  if (!emit)
    error->one(FLERR, "Fix dust/detach emit none: the restart file has {} grains of carrier {} that wait to be emitted",
               n, atom->tag[i]);
  List &list = list_of(i);
  list.from_file = from.number() != 0.0;
  from.get(list.carrier, 3);
  list.grains.resize(n);
  from.get(list.grains.data(), n);
}

/* ---------------------------------------------------------------------- */

void DustShedding::follow_displaced()
{
  constexpr double ROUND_OFF = 1.0e-9;    // of the carrier's radius: other periodic images
  for (int i = 0; i < atom->nlocal; i++) {
    if (waiting[i] < 0 || !lists[waiting[i]].from_file) continue;
    List &list = lists[waiting[i]];
    list.from_file = false;
    double now[3];
    unwrapped(i, now);
    for (int d = 0; d < 3; d++) {
      const double shift = now[d] - list.carrier[d];
      if (std::fabs(shift) < ROUND_OFF * atom->radius[i]) continue;
      for (Grain &grain : list.grains) grain.x[d] += shift;
    }
  }
}

void DustShedding::unwrapped(int i, double *x) const { domain->unmap(atom->x[i], atom->image[i], x); }

/* ---------------------------------------------------------------------- */

void DustShedding::set(const double *numbers)
{
  clock = numbers[0];
  highest = static_cast<tagint>(numbers[1]);
}

double DustShedding::memory_usage() const
{
  double bytes = double(atom->nmax) * 2 * sizeof(int);
  for (const List &list : lists) bytes += sizeof(List) + double(list.grains.capacity()) * sizeof(Grain);
  return bytes;
}
