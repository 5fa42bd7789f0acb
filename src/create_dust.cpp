/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "create_dust.h"

#include "core/jkr.h"
#include "dust_options.h"

#include "atom.h"
#include "atom_vec.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "group.h"
#include "math_const.h"
#include "math_extra.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;

/* ---------------------------------------------------------------------- */

void CreateDust::command(int narg, char **arg)
{
  if (domain->box_exist == 0) error->all(FLERR, "Create_dust before the simulation box is defined");
  if (narg < 3) utils::missing_cmd_args(FLERR, "create_dust", error);
  const int igroup = group->find(arg[0]);
  if (igroup < 0) error->all(FLERR, "Create_dust group {} does not exist", arg[0]);
  if (strcmp(arg[1], "type") != 0) error->all(FLERR, "Create_dust wants the word type after the group, not {}", arg[1]);
  const int type = utils::inumeric(FLERR, arg[2], false, lmp);
  if (type < 1 || type > atom->ntypes) error->all(FLERR, "Create_dust type {} must be from 1 to {}", arg[2], atom->ntypes);
  if (domain->triclinic) error->all(FLERR, "Create_dust needs an orthogonal box");
  if (!atom->tag_enable || !atom->omega_flag) error->all(FLERR, "Create_dust needs atoms with IDs and spin");

  DustOptions options(lmp, "Create_dust");
  for (int iarg = 3; iarg < narg;) {
    const int next = options.parse(iarg, narg, arg);
    if (next == iarg)
      error->all(FLERR, "Unknown create_dust keyword {}: use texture, bare, distribution, density, hamaker, surface, elastic, orientation or "
                 "write", arg[iarg]);
    iarg = next;
  }
  options.complete();

  const double carrier_radius = options.carrier_radius(igroup);
  if (carrier_radius == 0.0) error->all(FLERR, "Create_dust group {} has no carriers", arg[0]);
  const Dust::Texture texture = options.texture(carrier_radius);
  const std::vector<Carrier> carriers = all_carriers(group->bitmask[igroup]);

  tagint highest = 0;
  for (int i = 0; i < atom->nlocal; i++) highest = std::max(highest, atom->tag[i]);
  MPI_Allreduce(MPI_IN_PLACE, &highest, 1, MPI_LMP_TAGINT, MPI_MAX, world);
  const double grains = double(texture.grains.size());
  if (double(highest) + grains * carriers.size() >= double(MAXTAGINT))
    error->all(FLERR, "Create_dust makes more atoms than LAMMPS has IDs for");

  if (atom->map_style != Atom::MAP_NONE) atom->map_clear();
  const int before = atom->nlocal;
  tagint tag = highest;
  for (const Carrier &carrier : carriers) {
    const Dust::Quaternion orientation = options.orientation(static_cast<tagint>(carrier.tag));
    for (const Dust::Grain &grain : texture.grains) {
      tag++;    // the same ID on any number of ranks
      const double r12 = Dust::effective_radius(carrier_radius, grain.radius);
      const double a0 = Dust::equilibrium_contact_radius(options.surface_energy, r12, options.modulus());
      const double distance = carrier_radius + grain.radius - Dust::equilibrium_overlap(a0, r12);
      double arm[3], x[3], turning[3];
      orientation.to_space(grain.n, arm);
      MathExtra::scale3(distance, arm);
      MathExtra::add3(carrier.x, arm, x);
      MathExtra::cross3(carrier.omega, arm, turning);
      imageint image = (imageint(IMGMAX) << IMG2BITS) | (imageint(IMGMAX) << IMGBITS) | IMGMAX;
      domain->remap(x, image);
      if (!is_mine(x)) continue;

      atom->avec->create_atom(type, x);
      const int i = atom->nlocal - 1;
      atom->tag[i] = tag;
      atom->image[i] = image;
      atom->radius[i] = grain.radius;
      atom->rmass[i] = 4.0 / 3.0 * MathConst::MY_PI * grain.radius * grain.radius * grain.radius * options.density;
      MathExtra::add3(carrier.v, turning, atom->v[i]);
      MathExtra::copy3(carrier.omega, atom->omega[i]);
    }
  }
  atom->data_fix_compute_variable(before, atom->nlocal);

  bigint made = atom->nlocal - before;
  MPI_Allreduce(MPI_IN_PLACE, &made, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  atom->natoms += made;
  if (atom->map_style != Atom::MAP_NONE) {
    atom->map_init();
    atom->map_set();
  }
  const auto wanted = static_cast<bigint>(grains * carriers.size());
  if (made != wanted)
    error->all(FLERR, "Create_dust: {} of {} grains lie outside the box: a carrier is closer to a border than a grain's "
               "diameter", wanted - made, wanted);
  if (comm->me == 0) utils::logmesg(lmp, "Created {} grains on {} carriers\n", made, carriers.size());
}

/* ----------------------------------------------------------------------
   the carriers of all ranks, by ID
------------------------------------------------------------------------- */

std::vector<CreateDust::Carrier> CreateDust::all_carriers(int groupbit) const
{
  std::vector<Carrier> mine;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & groupbit)) continue;
    Carrier c;
    c.tag = double(atom->tag[i]);
    MathExtra::copy3(atom->x[i], c.x);
    MathExtra::copy3(atom->v[i], c.v);
    MathExtra::copy3(atom->omega[i], c.omega);
    mine.push_back(c);
  }
  constexpr int NDOUBLES = sizeof(Carrier) / sizeof(double);
  const int count = static_cast<int>(mine.size()) * NDOUBLES;
  std::vector<int> counts(comm->nprocs), offsets(comm->nprocs);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  for (int p = 1; p < comm->nprocs; p++) offsets[p] = offsets[p - 1] + counts[p - 1];
  std::vector<Carrier> all((offsets.back() + counts.back()) / NDOUBLES);
  MPI_Allgatherv(mine.data(), count, MPI_DOUBLE, all.data(), counts.data(), offsets.data(), MPI_DOUBLE, world);
  std::sort(all.begin(), all.end(), [](const Carrier &a, const Carrier &b) { return a.tag < b.tag; });
  return all;
}

/* ----------------------------------------------------------------------
   each place of the box belongs to one rank; the upper border of a box that is not periodic to the last one
------------------------------------------------------------------------- */

bool CreateDust::is_mine(const double *x) const
{
  for (int d = 0; d < 3; d++) {
    const bool last = !domain->periodicity[d] && domain->subhi[d] == domain->boxhi[d];
    if (x[d] < domain->sublo[d] || (last ? x[d] > domain->subhi[d] : x[d] >= domain->subhi[d])) return false;
  }
  return true;
}
