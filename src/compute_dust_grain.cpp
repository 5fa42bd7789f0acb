/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "compute_dust_grain.h"

#include "core/patch_bits.h"
#include "fix_dust_detach.h"

#include "atom.h"
#include "error.h"
#include "modify.h"
#include "update.h"

using namespace LAMMPS_NS;

/* ---------------------------------------------------------------------- */

ComputeDustGrain::ComputeDustGrain(LAMMPS *_lmp, int narg, char **arg) : Compute(_lmp, narg, arg)
{
  if (narg != 4) error->all(FLERR, "Compute dust/grain wants one value, the ID of a fix dust/detach, not {}", narg - 3);
  fix_id = arg[3];
  fix();

  local_flag = 1;
  size_local_rows = 0;
  size_local_cols = GrainRow::SIZE;
}

/* ----------------------------------------------------------------------
   it may have gone since it was last asked for
------------------------------------------------------------------------- */

const FixDustDetach *ComputeDustGrain::fix() const
{
  const auto *found = dynamic_cast<const FixDustDetach *>(modify->get_fix_by_id(fix_id));
  if (!found) error->all(FLERR, "Compute dust/grain: there is no fix dust/detach with the ID {}", fix_id);
  return found;
}

void ComputeDustGrain::init() { fix(); }

/* ---------------------------------------------------------------------- */

void ComputeDustGrain::compute_local()
{
  invoked_local = update->ntimestep;
  const FixDustDetach *dust = fix();
  const bigint grains = count(dust);
  if (grains > MAXSMALLINT)
    error->one(FLERR, "Compute dust/grain: {} grains on one rank, and rows can be {} at most: use a smaller group",
               grains, MAXSMALLINT);

  rows.clear();
  rows.reserve(grains);
  for (int i = 0; i < atom->nlocal; i++)
    if (shows(dust, i)) add_grains(dust, i);
  row_pointers.clear();
  for (auto &row : rows) row_pointers.push_back(row.data());
  array_local = row_pointers.data();
  size_local_rows = static_cast<int>(rows.size());
}

bool ComputeDustGrain::shows(const FixDustDetach *dust, int i) const
{
  return (atom->mask[i] & groupbit) && dust->all_carriers().state[i] != CarrierData::NO_CARRIER;
}

bigint ComputeDustGrain::count(const FixDustDetach *dust) const
{
  bigint grains = 0;
  for (int i = 0; i < atom->nlocal; i++)
    if (shows(dust, i)) grains += static_cast<bigint>(dust->all_carriers().columns[i][DetachAtom::ATTACHED]);
  return grains;
}

/* ----------------------------------------------------------------------
   beside the carrier where LAMMPS has it, across a periodic border, too
------------------------------------------------------------------------- */

void ComputeDustGrain::add_grains(const FixDustDetach *dust, int i)
{
  const DustCoat &coat = dust->coat_of(i);
  const Dust::GrainTable &table = *coat.table;
  const CarrierData &carriers = dust->all_carriers();
  const Dust::Quaternion standing = carriers.standing(i);
  const double lost = carriers.columns[i][DetachAtom::MASS] / (table.grains() * table.mean_mass());
  const double *centre = atom->x[i], radius = carriers.radius[i];
  for (int word = 0; word < table.words(); word++)
    Dust::each_bit(carriers.attached[i][word], [&](int k) {
      const Dust::GrainTable::Site &site = table.site(word * Dust::PATCH + k);
      const double grain_radius = coat.texture->grains[site.grain].radius, shell = radius + grain_radius;
      double n[3];
      standing.to_space(site.n, n);
      rows.push_back({double(atom->tag[i]), site.grain + 1.0, 2.0 * grain_radius, centre[0] + shell * n[0],
                      centre[1] + shell * n[1], centre[2] + shell * n[2], lost, 2.0 * coat.radius});
    });
}

/* ---------------------------------------------------------------------- */

double ComputeDustGrain::memory_usage()
{
  return double(rows.capacity()) * GrainRow::SIZE * sizeof(double) + double(row_pointers.capacity()) * sizeof(double *);
}
