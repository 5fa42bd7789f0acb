/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "dust_atoms.h"

#include "atom.h"
#include "atom_vec.h"
#include "domain.h"

#include <algorithm>

using namespace LAMMPS_NS;

DustAtoms::DustAtoms(LAMMPS *_lmp) : Pointers(_lmp), before(atom->nlocal)
{
  if (atom->map_style != Atom::MAP_NONE) atom->map_clear();
  atom->nghost = 0;    // new atoms take their places
  atom->avec->clear_bonus();
}

/* ---------------------------------------------------------------------- */

bool DustAtoms::beyond_fixed_border(LAMMPS *lmp, const double *x)
{
  constexpr int FIXED = 1;
  const Domain *domain = lmp->domain;
  for (int d = 0; d < 3; d++) {
    if (domain->boundary[d][0] == FIXED && x[d] < domain->boxlo[d]) return true;
    if (domain->boundary[d][1] == FIXED && x[d] > domain->boxhi[d]) return true;
  }
  return false;
}

/* ---------------------------------------------------------------------- */

tagint DustAtoms::highest_tag(LAMMPS *lmp)
{
  tagint highest = 0;
  for (int i = 0; i < lmp->atom->nlocal; i++) highest = std::max(highest, lmp->atom->tag[i]);
  MPI_Allreduce(MPI_IN_PLACE, &highest, 1, MPI_LMP_TAGINT, MPI_MAX, lmp->world);
  return highest;
}

/* ---------------------------------------------------------------------- */

void DustAtoms::create(int type, tagint tag, const double *place, double radius, double mass, const double *v,
                       const double *omega)
{
  double x[3] = {place[0], place[1], place[2]};
  imageint image = (imageint(IMGMAX) << IMG2BITS) | (imageint(IMGMAX) << IMGBITS) | IMGMAX;
  domain->remap(x, image);
  if (!is_mine(x)) return;

  atom->avec->create_atom(type, x);
  const int i = atom->nlocal - 1;
  atom->tag[i] = tag;
  atom->image[i] = image;
  atom->radius[i] = radius;
  atom->rmass[i] = mass;
  std::copy_n(v, 3, atom->v[i]);
  std::copy_n(omega, 3, atom->omega[i]);
  // a run may go on from here without computing forces first
  std::fill_n(atom->f[i], 3, 0.0);
  if (atom->torque_flag) std::fill_n(atom->torque[i], 3, 0.0);
}

/* ---------------------------------------------------------------------- */

bigint DustAtoms::finish()
{
  atom->data_fix_compute_variable(before, atom->nlocal);
  bigint made = atom->nlocal - before;
  MPI_Allreduce(MPI_IN_PLACE, &made, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  atom->natoms += made;
  if (atom->map_style != Atom::MAP_NONE) {
    atom->map_init();
    atom->map_set();
  }
  return made;
}

/* ----------------------------------------------------------------------
   each place of the box belongs to one rank. The ranks at a border that is not periodic also have what lies on it, and
   beyond it if it moves with the atoms.
------------------------------------------------------------------------- */

bool DustAtoms::is_mine(const double *x) const
{
  if (beyond_fixed_border(lmp, x)) return false;
  for (int d = 0; d < 3; d++) {
    const bool first = !domain->periodicity[d] && domain->sublo[d] == domain->boxlo[d];
    const bool last = !domain->periodicity[d] && domain->subhi[d] == domain->boxhi[d];
    if ((x[d] < domain->sublo[d] && !first) || (x[d] >= domain->subhi[d] && !last)) return false;
  }
  return true;
}
