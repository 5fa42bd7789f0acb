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
#include <functional>

using namespace LAMMPS_NS;

/* ---------------------------------------------------------------------- */

void CreateDust::command(int narg, char **arg)
{
  if (domain->box_exist == 0) error->all(FLERR, "Create_dust before the simulation box is defined");
  if (narg < 3) utils::missing_cmd_args(FLERR, "create_dust", error);
  const int igroup = group->find(arg[0]);
  if (igroup < 0) error->all(FLERR, "Create_dust group {} does not exist", arg[0]);
  DustOptions options(lmp, "Create_dust");
  read(narg, arg, options);

  const std::vector<Carrier> carriers = all_carriers(group->bitmask[igroup], options);
  if (carriers.empty()) error->all(FLERR, "Create_dust group {} has no carriers", arg[0]);
  place(carriers, options);
  check_room(carriers);
  for (const Size &size : sizes) {
    warn_of_crushed_grains(size, carriers, options);
    options.save(size.texture, &size == &sizes.front());
  }
  create(carriers);
}

/* ----------------------------------------------------------------------
   a texture for each size of carriers
------------------------------------------------------------------------- */

void CreateDust::place(const std::vector<Carrier> &carriers, const DustOptions &options)
{
  std::vector<double> radii;
  for (const Carrier &carrier : carriers) radii.push_back(carrier.radius);
  std::sort(radii.begin(), radii.end(), std::greater<>());
  for (const double radius : radii) {
    if (!sizes.empty() && DustOptions::same_size(radius, sizes.back().radius)) continue;
    const auto texture = options.texture(radius);
    sizes.push_back({radius, *texture, sites_of(*texture, options)});
  }
}

const CreateDust::Size &CreateDust::size_of(const Carrier &carrier) const
{
  return *std::find_if(sizes.begin(), sizes.end(),
                       [&](const Size &size) { return DustOptions::same_size(carrier.radius, size.radius); });
}

/* ---------------------------------------------------------------------- */

void CreateDust::read(int narg, char **arg, DustOptions &options)
{
  if (strcmp(arg[1], "type") != 0) error->all(FLERR, "Create_dust wants the word type after the group, not {}", arg[1]);
  first_type = utils::is_integer(arg[2]) ? utils::inumeric(FLERR, arg[2], false, lmp) : 0;
  if (first_type < 1 || first_type > atom->ntypes)
    error->all(FLERR, "Create_dust type {} must be from 1 to {}", arg[2], atom->ntypes);
  if (domain->triclinic) error->all(FLERR, "Create_dust needs an orthogonal box");
  if (!atom->tag_enable || !atom->omega_flag) error->all(FLERR, "Create_dust needs atoms with IDs and spin");

  const auto take_classes = [this](Keywords &words) {
    classes.number = words.whole_number(1, atom->ntypes - first_type + 1, "K");
    classes.low = words.number(Range::above(0.0), "LOW");
    classes.high = words.number(Range::above(classes.low), "HIGH");
  };
  options.read(3, narg, arg, {{"classes", take_classes}});
}

/* ---------------------------------------------------------------------- */

int CreateDust::Classes::of(double factor) const
{
  const double place = number * std::log(factor / low) / std::log(high / low);
  return static_cast<int>(std::clamp(std::floor(place), 0.0, number - 1.0));
}

double CreateDust::Classes::factor(int k) const { return low * std::pow(high / low, (k + 0.5) / number); }

/* ----------------------------------------------------------------------
   where the grains of a texture rest on a carrier
------------------------------------------------------------------------- */

std::vector<CreateDust::Site> CreateDust::sites_of(const Dust::Texture &texture, const DustOptions &options) const
{
  std::vector<Site> sites;
  for (const Dust::Grain &grain : texture.grains) {
    if (grain.adhesion != 1.0 && classes.number == 0)
      error->all(FLERR,
                 "Create_dust needs classes K LOW HIGH for grains with a spread of adhesion: an atom type for each "
                 "class of pull-off forces");
    Site site;
    const int k = classes.number ? classes.of(grain.adhesion) : 0;
    const double gamma = options.surface_energy * (classes.number ? classes.factor(k) : 1.0);
    site.type = first_type + k;
    MathExtra::copy3(grain.n, site.n);
    site.radius = grain.radius;
    site.mass = 4.0 / 3.0 * MathConst::MY_PI * MathSpecial::cube(grain.radius) * options.density;
    const double r12 = Dust::effective_radius(texture.carrier_radius, grain.radius);
    const double a0 = Dust::equilibrium_contact_radius(gamma, r12, options.modulus());
    site.distance = texture.carrier_radius + grain.radius - Dust::equilibrium_overlap(a0, r12);
    sites.push_back(site);
  }
  return sites;
}

// from the carrier's centre to the grain's
void CreateDust::arm_of(const Carrier &carrier, const Site &site, double *arm)
{
  carrier.orientation.to_space(site.n, arm);
  MathExtra::scale3(site.distance, arm);
}

/* ----------------------------------------------------------------------
   before the first grain is made: all of them can be, or there are none
------------------------------------------------------------------------- */

void CreateDust::check_room(const std::vector<Carrier> &carriers) const
{
  double wanted = 0.0;
  for (const Carrier &carrier : carriers) wanted += double(size_of(carrier).sites.size());
  if (double(DustAtoms::highest_tag(lmp)) + wanted >= double(MAXTAGINT))
    error->all(FLERR, "Create_dust makes more atoms than LAMMPS has IDs for");
  bigint outside = 0;
  for (const Carrier &carrier : carriers)
    for (const Site &site : size_of(carrier).sites) {
      double x[3];
      arm_of(carrier, site, x);
      MathExtra::add3(carrier.x, x, x);
      if (DustAtoms::beyond_fixed_border(lmp, x)) outside++;
    }
  if (outside)
    error->all(FLERR,
               "Create_dust: {} of {} grains would lie outside the box: a carrier is closer to a border than a grain's "
               "diameter",
               outside, static_cast<bigint>(wanted));
}

/* ---------------------------------------------------------------------- */

void CreateDust::create(const std::vector<Carrier> &carriers)
{
  tagint tag = DustAtoms::highest_tag(lmp);
  DustAtoms atoms(lmp);
  for (const Carrier &carrier : carriers)
    for (const Site &site : size_of(carrier).sites) {
      tag++;    // the same ID on any number of ranks
      double arm[3], x[3], v[3];
      arm_of(carrier, site, arm);
      MathExtra::add3(carrier.x, arm, x);
      MathExtra::cross3(carrier.omega, arm, v);
      MathExtra::add3(carrier.v, v, v);
      atoms.create(site.type, tag, x, site.radius, site.mass, v, carrier.omega);
    }
  const bigint made = atoms.finish();
  if (comm->me == 0) utils::logmesg(lmp, "Created {} grains on {} carriers\n", made, carriers.size());
}

/* ----------------------------------------------------------------------
   the carriers of all ranks, by ID
------------------------------------------------------------------------- */

std::vector<CreateDust::Carrier> CreateDust::all_carriers(int groupbit, const DustOptions &options) const
{
  struct Numbers {
    double tag, x[3], v[3], omega[3], radius, mass;
  };
  std::vector<Numbers> mine;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & groupbit)) continue;
    Numbers n;
    n.tag = double(atom->tag[i]);
    MathExtra::copy3(atom->x[i], n.x);
    MathExtra::copy3(atom->v[i], n.v);
    MathExtra::copy3(atom->omega[i], n.omega);
    n.radius = options.carrier_radius(i);
    n.mass = atom->rmass[i];
    mine.push_back(n);
  }
  std::vector<Numbers> all = dust_gather(mine, ALL_RANKS, world);
  std::sort(all.begin(), all.end(), [](const Numbers &a, const Numbers &b) { return a.tag < b.tag; });
  std::vector<Carrier> carriers;
  for (const Numbers &n : all) {
    Carrier carrier = {{}, {}, {}, n.radius, n.mass, options.orientation(static_cast<tagint>(n.tag))};
    MathExtra::copy3(n.x, carrier.x);
    MathExtra::copy3(n.v, carrier.v);
    MathExtra::copy3(n.omega, carrier.omega);
    carriers.push_back(carrier);
  }
  return carriers;
}

/* ----------------------------------------------------------------------
   of a carrier that meets a wall of its material with the middle of its bare cap, as fast as it moves that way now: no
   grain may reach the wall before the carrier's largest overlap, as it would brake the carrier. Which side that is is
   not known where textures lie at random.
------------------------------------------------------------------------- */

void CreateDust::warn_of_crushed_grains(const Size &size, const std::vector<Carrier> &carriers,
                                        const DustOptions &options) const
{
  if (!options.same_orientation()) return;
  const Dust::Texture &texture = size.texture;
  const double R = texture.carrier_radius, E = options.elastic[2], nu = options.elastic[3];
  const double *axis = texture.bare.axis;
  double speed = 0.0, mass = 0.0;
  for (const Carrier &carrier : carriers) {
    if (&size_of(carrier) != &size) continue;
    speed = std::max(speed, MathExtra::dot3(carrier.v, axis));
    mass = std::max(mass, carrier.mass);
  }
  const double overlap = Dust::hertz_overlap(Dust::combined_modulus(E, nu, E, nu), R, mass, speed);

  int crushed = 0;
  double widest = 0.0;    // half-angle of the cap that would be needed
  for (const Dust::Grain &grain : texture.grains) {
    const double level = std::max(-1.0, (R - overlap - grain.radius) / (R + grain.radius));
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
