/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "compute_dust_carrier.h"

#include "gran_sub_mod_dust_normal.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "fix_neigh_history.h"
#include "force.h"
#include "granular_model.h"
#include "group.h"
#include "memory.h"
#include "modify.h"
#include "neigh_list.h"
#include "pair_granular.h"
#include "update.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace Granular_NS;

/* ---------------------------------------------------------------------- */

ComputeDustCarrier::ComputeDustCarrier(LAMMPS *_lmp, int narg, char **arg) :
    Compute(_lmp, narg, arg), nmax(0), pair(nullptr), history(nullptr)
{
  if (narg != 4) error->all(FLERR, "Compute dust/carrier wants one value, the group of the carriers, not {}", narg - 3);
  const int carriers = group->find(arg[3]);
  if (carriers < 0) error->all(FLERR, "Compute dust/carrier group {} does not exist", arg[3]);
  carrier_bit = group->bitmask[carriers];

  peratom_flag = 1;
  size_peratom_cols = 0;
  scalar_flag = vector_flag = 1;
  extscalar = extvector = 0;
  size_vector = 3;
  comm_forward = comm_reverse = 1;
  vector = new double[size_vector];
}

/* ---------------------------------------------------------------------- */

ComputeDustCarrier::~ComputeDustCarrier()
{
  memory->destroy(vector_atom);
  delete[] vector;
}

/* ---------------------------------------------------------------------- */

void ComputeDustCarrier::init()
{
  pair = dynamic_cast<PairGranular *>(force->pair);
  if (!pair)
    error->all(FLERR, "Compute dust/carrier needs pair_style granular, not {}",
               force->pair_style ? force->pair_style : "none");
  history = nullptr;
  adhesive.resize(pair->nmodels);
  for (int m = 0; m < pair->nmodels; m++)
    adhesive[m] = dynamic_cast<const GranSubModNormalJKRVdW *>(pair->models_list[m]->normal_model);
  if (std::all_of(adhesive.begin(), adhesive.end(), [](const auto *model) { return !model; }))
    error->all(FLERR, "Compute dust/carrier needs a pair_coeff with the normal model jkr/vdw, which knows necks");
}

/* ----------------------------------------------------------------------
   necks tie: each atom takes the highest carrier ID that it or a neighbour of it has, until nothing changes. Chains are
   short, so few rounds do; all ranks make the same number.
------------------------------------------------------------------------- */

void ComputeDustCarrier::compute_peratom()
{
  invoked_peratom = update->ntimestep;
  if (!history)    // made at the pair style's first init, after ours
    for (auto *fix : modify->get_fix_by_style("^NEIGH_HISTORY"))
      if (auto *candidate = dynamic_cast<FixNeighHistory *>(fix))
        if (candidate->pair == pair) history = candidate;
  if (!history || !pair->list) error->all(FLERR, "Compute dust/carrier finds no contact history: it needs a run");

  if (atom->nmax > nmax) {
    nmax = atom->nmax;
    memory->destroy(vector_atom);
    memory->create(vector_atom, nmax, "dust/carrier:vector_atom");
  }
  const int *mask = atom->mask, *type = atom->type;
  for (int i = 0; i < atom->nlocal + atom->nghost; i++)
    vector_atom[i] = (mask[i] & carrier_bit) ? double(atom->tag[i]) : 0.0;

  const NeighList *list = pair->list;
  const int size = pair->get_size_history();
  int changed = 1;
  while (changed) {
    changed = 0;
    for (int ii = 0; ii < list->inum; ii++) {
      const int i = list->ilist[ii];
      for (int jj = 0; jj < list->numneigh[i]; jj++) {
        if (!history->firstflag[i][jj]) continue;
        const int j = list->firstneigh[i][jj] & NEIGHMASK;
        const auto *normal = adhesive[pair->types_indices[type[i]][type[j]]];
        if (!normal || normal->neck_in(history->firstvalue[i] + size * jj) == 0.0) continue;
        double &a = vector_atom[i], &b = vector_atom[j];
        // a carrier keeps its own ID
        if (b > a && !(mask[i] & carrier_bit)) {
          a = b;
          changed = 1;
        }
        if (a > b && !(mask[j] & carrier_bit)) {
          b = a;
          changed = 1;
        }
      }
    }
    // what a ghost has learnt goes to its owner, what the owner knows to all ghosts
    comm->reverse_comm(this);
    comm->forward_comm(this);
    MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPI_INT, MPI_MAX, world);
  }
  for (int i = 0; i < atom->nlocal; i++)
    if (!(mask[i] & groupbit)) vector_atom[i] = 0.0;
}

/* ----------------------------------------------------------------------
   grains of the group that are tied to a carrier
------------------------------------------------------------------------- */

double ComputeDustCarrier::compute_scalar()
{
  invoked_scalar = update->ntimestep;
  if (invoked_peratom != update->ntimestep) compute_peratom();
  bigint tied = 0;
  for (int i = 0; i < atom->nlocal; i++)
    if ((atom->mask[i] & groupbit) && !(atom->mask[i] & carrier_bit) && vector_atom[i] > 0.0) tied++;
  MPI_Allreduce(MPI_IN_PLACE, &tied, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  scalar = double(tied);
  return scalar;
}

/* ----------------------------------------------------------------------
   last steps at which a neck formed or broke, a contact slid or rolled beyond its limit, of all contacts with carriers:
   those of pairs of types of which a carrier has one. What grains do among themselves once they are off does not count.
------------------------------------------------------------------------- */

void ComputeDustCarrier::compute_vector()
{
  invoked_vector = update->ntimestep;
  const int ntypes = atom->ntypes;
  std::vector<int> is_carriers(ntypes + 1, 0);
  for (int i = 0; i < atom->nlocal; i++)
    if (atom->mask[i] & carrier_bit) is_carriers[atom->type[i]] = 1;
  MPI_Allreduce(MPI_IN_PLACE, is_carriers.data(), ntypes + 1, MPI_INT, MPI_MAX, world);

  bigint last[3] = {-1, -1, -1};
  for (int a = 1; a <= ntypes; a++)
    for (int b = a; b <= ntypes; b++) {
      if (!is_carriers[a] && !is_carriers[b]) continue;
      const auto *normal = adhesive[pair->types_indices[a][b]];
      if (!normal) continue;
      const auto &events = normal->last_events;
      const bigint steps[3] = {events.neck, events.slide, events.roll};
      for (int k = 0; k < 3; k++) last[k] = std::max(last[k], steps[k]);
    }
  MPI_Allreduce(MPI_IN_PLACE, last, 3, MPI_LMP_BIGINT, MPI_MAX, world);
  std::copy_n(last, 3, vector);
}

/* ---------------------------------------------------------------------- */

int ComputeDustCarrier::pack_forward_comm(int n, int *list, double *buf, int, int *)
{
  for (int k = 0; k < n; k++) buf[k] = vector_atom[list[k]];
  return n;
}

void ComputeDustCarrier::unpack_forward_comm(int n, int first, double *buf)
{
  std::copy_n(buf, n, vector_atom + first);
}

int ComputeDustCarrier::pack_reverse_comm(int n, int first, double *buf)
{
  std::copy_n(vector_atom + first, n, buf);
  return n;
}

void ComputeDustCarrier::unpack_reverse_comm(int n, int *list, double *buf)
{
  for (int k = 0; k < n; k++) vector_atom[list[k]] = std::max(vector_atom[list[k]], buf[k]);
}

/* ---------------------------------------------------------------------- */

double ComputeDustCarrier::memory_usage() { return double(nmax) * sizeof(double); }
