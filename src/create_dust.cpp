/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "create_dust.h"

#include "core/hertz.h"
#include "core/jkr.h"
#include "dust_atoms.h"
#include "dust_gather.h"
#include "dust_options.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "group.h"
#include "math_const.h"
#include "math_extra.h"
#include "math_special.h"

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
  const int type = utils::is_integer(arg[2]) ? utils::inumeric(FLERR, arg[2], false, lmp) : 0;
  if (type < 1 || type > atom->ntypes)
    error->all(FLERR, "Create_dust type {} must be from 1 to {}", arg[2], atom->ntypes);
  if (domain->triclinic) error->all(FLERR, "Create_dust needs an orthogonal box");
  if (!atom->tag_enable || !atom->omega_flag) error->all(FLERR, "Create_dust needs atoms with IDs and spin");

  DustOptions options(lmp, "Create_dust");
  options.read(3, narg, arg);

  const double carrier_radius = options.carrier_radius(igroup);
  if (carrier_radius == 0.0) error->all(FLERR, "Create_dust group {} has no carriers", arg[0]);
  const Dust::Texture texture = options.texture(carrier_radius);
  const std::vector<Carrier> carriers = all_carriers(group->bitmask[igroup]);
  warn_of_crushed_grains(texture, carriers, options, group->bitmask[igroup]);

  const tagint highest = DustAtoms::highest_tag(lmp);
  const double grains = double(texture.grains.size());
  if (double(highest) + grains * carriers.size() >= double(MAXTAGINT))
    error->all(FLERR, "Create_dust makes more atoms than LAMMPS has IDs for");

  DustAtoms atoms(lmp);
  tagint tag = highest;
  for (const Carrier &carrier : carriers) {
    const Dust::Quaternion orientation = options.orientation(static_cast<tagint>(carrier.tag));
    for (const Dust::Grain &grain : texture.grains) {
      tag++;    // the same ID on any number of ranks
      const double r12 = Dust::effective_radius(carrier_radius, grain.radius);
      const double a0 = Dust::equilibrium_contact_radius(options.surface_energy, r12, options.modulus());
      const double distance = carrier_radius + grain.radius - Dust::equilibrium_overlap(a0, r12);
      double arm[3], x[3], v[3];
      orientation.to_space(grain.n, arm);
      MathExtra::scale3(distance, arm);
      MathExtra::add3(carrier.x, arm, x);
      MathExtra::cross3(carrier.omega, arm, v);
      MathExtra::add3(carrier.v, v, v);
      atoms.create(type, tag, x, grain.radius,
                   4.0 / 3.0 * MathConst::MY_PI * MathSpecial::cube(grain.radius) * options.density, v, carrier.omega);
    }
  }
  const bigint made = atoms.finish();
  const auto wanted = static_cast<bigint>(grains * carriers.size());
  if (made != wanted)
    error->all(FLERR,
               "Create_dust: {} of {} grains lie outside the box: a carrier is closer to a border than a grain's "
               "diameter",
               wanted - made, wanted);
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
  std::vector<Carrier> all = dust_gather(mine, ALL_RANKS, world);
  std::sort(all.begin(), all.end(), [](const Carrier &a, const Carrier &b) { return a.tag < b.tag; });
  return all;
}

/* ----------------------------------------------------------------------
   of a carrier that meets a wall of its material with the middle of its bare cap, as fast as it moves that way now: no
   grain may reach the wall before the carrier's largest overlap, as it would brake the carrier
------------------------------------------------------------------------- */

void CreateDust::warn_of_crushed_grains(const Dust::Texture &texture, const std::vector<Carrier> &carriers,
                                        const DustOptions &options, int groupbit) const
{
  const double R = texture.carrier_radius, E = options.elastic[2], nu = options.elastic[3];
  const double *axis = texture.bare.axis;
  double speed = 0.0;
  for (const Carrier &c : carriers)
    speed = std::max(speed, options.same_orientation() ? MathExtra::dot3(c.v, axis) : MathExtra::len3(c.v));
  double mass = 0.0;
  for (int i = 0; i < atom->nlocal; i++)
    if (atom->mask[i] & groupbit) mass = std::max(mass, atom->rmass[i]);
  MPI_Allreduce(MPI_IN_PLACE, &mass, 1, MPI_DOUBLE, MPI_MAX, world);
  const double overlap = Dust::hertz_overlap(Dust::combined_modulus(E, nu, E, nu), R, mass, speed);

  int crushed = 0;
  double widest = 0.0;    // half-angle of the cap that would be needed
  for (const Dust::Grain &grain : texture.grains) {
    const double level = (R - overlap - grain.radius) / (R + grain.radius);
    if (MathExtra::dot3(grain.n, axis) <= level) continue;
    crushed++;
    widest = std::max(widest, std::acos(level));
  }
  if (crushed && comm->me == 0)
    error->warning(
        FLERR,
        "Create_dust: {} grains of a carrier reach a wall before the carrier has reached its largest overlap, "
        "are crushed there and brake it: use bare {:.2f}",
        crushed, std::ceil(100.0 * widest) / 100.0);
}
