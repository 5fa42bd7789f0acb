/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "dust_options.h"

#include "core/hamaker.h"
#include "core/jkr.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "group.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

using namespace LAMMPS_NS;

static constexpr double UNSET = -1.0;

/* ---------------------------------------------------------------------- */

DustOptions::DustOptions(LAMMPS *lmp, const std::string &command) :
    Pointers(lmp), density(UNSET), surface_energy(UNSET), elastic{UNSET, UNSET, UNSET, UNSET}, command(command),
    diameter(0.0), coverage(UNSET), distributed(false), sizes{}, seed(0), bare_given(false), orientation_seed(0)
{
  if (!atom->radius_flag || !atom->rmass_flag)
    error->all(FLERR, "{} needs atoms with radius and mass of their own, such as atom_style sphere", command);
  if (domain->dimension != 3) error->all(FLERR, "{} needs dimension 3", command);
  // elsewhere LAMMPS' own granular models do not convert, nor does set density
  if (force->ftm2v != 1.0 || force->mvv2e != 1.0 || force->nktv2p != 1.0 || force->mv2d != 1.0)
    error->all(FLERR,
               "{} works with units si, cgs, lj, micro or nano, not with units {}, in which force is not mass times "
               "acceleration",
               command, update->unit_style);
}

/* ---------------------------------------------------------------------- */

void DustOptions::need(int iarg, int n, int narg, char **arg) const
{
  if (iarg + n >= narg) utils::missing_cmd_args(FLERR, fmt::format("{} {}", command, arg[iarg]), error);
}

double DustOptions::number(int iarg, int k, char **arg) const
{
  check(iarg, k, arg, utils::is_double(arg[iarg + k]), "a number");
  return utils::numeric(FLERR, arg[iarg + k], false, lmp);
}

int DustOptions::whole_number(int iarg, int k, char **arg) const
{
  check(iarg, k, arg, utils::is_integer(arg[iarg + k]), "a whole number");
  return utils::inumeric(FLERR, arg[iarg + k], false, lmp);
}

void DustOptions::check(int iarg, int k, char **arg, bool ok, const char *range) const
{
  if (!ok) error->all(FLERR, "{} {} value {} must be {}", command, arg[iarg], arg[iarg + k], range);
}

double DustOptions::positive(int iarg, int k, char **arg) const
{
  const double value = number(iarg, k, arg);
  check(iarg, k, arg, value > 0.0 && std::isfinite(value), "above 0");
  return value;
}

int DustOptions::parse(int iarg, int narg, char **arg)
{
  const std::string key = arg[iarg];
  if (key == "texture") return parse_texture(iarg, narg, arg);
  if (key == "bare") {
    need(iarg, 1, narg, arg);
    bare.half_angle = number(iarg, 1, arg);
    check(iarg, 1, arg, bare.half_angle >= 0.0 && bare.half_angle < 3.14159265358979, "at least 0 and below pi");
    bare_given = true;
    if (iarg + 2 >= narg || !utils::is_double(arg[iarg + 2])) return iarg + 2;
    need(iarg, 4, narg, arg);
    double *axis = bare.axis;
    for (int d = 0; d < 3; d++) axis[d] = number(iarg, d + 2, arg);
    const double length = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    if (!(length > 0.0 && std::isfinite(length))) error->all(FLERR, "{} bare axis must not be 0 0 0", command);
    for (int d = 0; d < 3; d++) axis[d] /= length;
    return iarg + 5;
  }
  if (key == "density") {
    need(iarg, 1, narg, arg);
    density = positive(iarg, 1, arg);
    return iarg + 2;
  }
  if ((key == "hamaker" || key == "surface") && surface_energy != UNSET)
    error->all(FLERR, "{} {}: the adhesion is given twice", command, key);
  if (key == "hamaker") {
    need(iarg, 2, narg, arg);
    surface_energy = Dust::surface_energy(positive(iarg, 1, arg), positive(iarg, 2, arg));
    return iarg + 3;
  }
  if (key == "surface") {
    need(iarg, 1, narg, arg);
    surface_energy = positive(iarg, 1, arg);
    return iarg + 2;
  }
  if (key == "elastic") {
    need(iarg, 4, narg, arg);
    for (int k = 0; k < 4; k += 2) {
      elastic[k] = positive(iarg, k + 1, arg);
      elastic[k + 1] = number(iarg, k + 2, arg);
      check(iarg, k + 2, arg, elastic[k + 1] > -1.0 && elastic[k + 1] <= 0.5, "above -1 and at most 0.5");
    }
    return iarg + 5;
  }
  if (key == "write") {
    need(iarg, 1, narg, arg);
    write = arg[iarg + 1];
    return iarg + 2;
  }
  if (key == "orientation") {
    need(iarg, 1, narg, arg);
    const std::string value = arg[iarg + 1];
    check(iarg, 1, arg, value == "same" || value == "random", "same or random SEED");
    orientation_seed = 0;
    if (value == "same") return iarg + 2;
    need(iarg, 2, narg, arg);
    orientation_seed = whole_number(iarg, 2, arg);
    if (orientation_seed <= 0)
      error->all(FLERR, "{} orientation random seed {} must be above 0", command, arg[iarg + 2]);
    return iarg + 3;
  }
  if (key == "distribution") {
    need(iarg, 3, narg, arg);
    if (distributed) error->all(FLERR, "{} distribution is given twice", command);
    const std::string kind = arg[iarg + 1];
    if (kind != "lognormal" && kind != "rrsb")
      error->all(FLERR, "{} distribution {} must be lognormal or rrsb", command, kind);
    sizes.kind = kind == "rrsb" ? Dust::SizeDistribution::RRSB : Dust::SizeDistribution::LOGNORMAL;
    sizes.x50 = positive(iarg, 2, arg);
    sizes.spread = number(iarg, 3, arg);
    const bool lognormal = kind == "lognormal";
    check(iarg, 3, arg, sizes.spread > (lognormal ? 1.0 : 0.0) && std::isfinite(sizes.spread),
          lognormal ? "above 1" : "above 0");
    distributed = true;
    return iarg + 4;
  }
  return iarg;
}

/* ---------------------------------------------------------------------- */

int DustOptions::parse_texture(int iarg, int narg, char **arg)
{
  if (diameter != 0.0 || !file.empty()) error->all(FLERR, "{} texture is given twice", command);
  need(iarg, 2, narg, arg);
  const std::string source = arg[iarg + 1];
  if (source == "file") {
    read(arg[iarg + 2]);
    return iarg + 3;
  }
  if (source != "monolayer") error->all(FLERR, "{} texture source {} must be file or monolayer", command, source);
  diameter = number(iarg, 2, arg);
  if (!(diameter > 0.0 && std::isfinite(diameter)))
    error->all(FLERR, "{} texture monolayer diameter {} must be above 0", command, arg[iarg + 2]);

  for (iarg += 3; iarg < narg; iarg += 2) {
    const std::string key = arg[iarg];
    if (key != "coverage" && key != "seed") break;
    need(iarg, 1, narg, arg);
    if (key == "coverage" ? coverage != UNSET : seed != 0) error->all(FLERR, "{} {} is given twice", command, key);
    if (key == "coverage") {
      coverage = number(iarg, 1, arg);
      if (!(coverage > 0.0 && std::isfinite(coverage)))
        error->all(FLERR, "{} coverage {} must be above 0", command, arg[iarg + 1]);
    } else {
      seed = whole_number(iarg, 1, arg);
      if (seed <= 0) error->all(FLERR, "{} seed {} must be above 0", command, arg[iarg + 1]);
    }
  }
  if (coverage == UNSET) error->all(FLERR, "{} texture monolayer needs coverage", command);
  if (seed == 0) error->all(FLERR, "{} texture monolayer needs seed", command);
  return iarg;
}

/* ----------------------------------------------------------------------
   rank 0 reads, all parse the same text
------------------------------------------------------------------------- */

void DustOptions::read(const std::string &name)
{
  file = name;
  std::string text;
  int size = -1;
  if (comm->me == 0) {
    std::ifstream in(file);
    std::ostringstream all;
    if (in && all << in.rdbuf()) {
      text = all.str();
      size = static_cast<int>(text.size());
    }
  }
  MPI_Bcast(&size, 1, MPI_INT, 0, world);
  if (size < 0) error->all(FLERR, "{} cannot read texture file {}", command, file);
  text.resize(size);
  MPI_Bcast(&text[0], size, MPI_CHAR, 0, world);
  try {
    std::istringstream in(text);
    from_file = Dust::read_texture(in);
  } catch (Dust::TextureError &e) {
    error->all(FLERR, "{} texture file {}: {}", command, file, e.what());
  }
}

/* ----------------------------------------------------------------------
   the reference case, calcium carbonate on stainless steel, is known in SI units only
------------------------------------------------------------------------- */

void DustOptions::complete()
{
  if (diameter == 0.0 && file.empty()) error->all(FLERR, "{} needs keyword texture", command);
  if (!file.empty() && bare_given)
    error->all(FLERR, "{} bare goes with texture monolayer: a texture file has its own bare cap", command);

  if (!file.empty() && distributed)
    error->all(FLERR, "{} distribution goes with texture monolayer: a texture file has its own diameters", command);
  // a carrier that meets the wall with any side has no use for a side without grains
  if (orientation_seed && !bare_given) bare.half_angle = 0.0;

  const bool si = strcmp(update->unit_style, "si") == 0;
  const auto absent = [&](double value, const char *key) {
    if (value == UNSET && !si)
      error->all(FLERR, "{} needs keyword {} (it has a default with units si only)", command, key);
    return value == UNSET;
  };
  if (absent(density, "density")) density = 2700.0;
  if (absent(surface_energy, "hamaker or surface"))
    surface_energy = Dust::surface_energy(std::sqrt(10.1e-20 * 21.2e-20), 0.4e-9);
  if (absent(elastic[0], "elastic")) {
    const double reference[4] = {75.0e9, 0.3, 210.0e9, 0.3};
    std::copy_n(reference, 4, elastic);
  }
}

/* ---------------------------------------------------------------------- */

Dust::Quaternion DustOptions::orientation(tagint tag) const
{
  return orientation_seed ? Dust::random_orientation(orientation_seed, tag) : Dust::Quaternion();
}

/* ---------------------------------------------------------------------- */

double DustOptions::modulus() const { return Dust::combined_modulus(elastic[0], elastic[1], elastic[2], elastic[3]); }

/* ---------------------------------------------------------------------- */

bool DustOptions::same_size(double radius, double other) { return std::fabs(radius - other) <= 1.0e-6 * other; }

/* ---------------------------------------------------------------------- */

double DustOptions::carrier_radius(int igroup) const
{
  double extremes[2] = {0.0, 0.0};    // of radius and 1/radius: absent carriers change neither
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & group->bitmask[igroup])) continue;
    const double radius = atom->radius[i];
    if (!(radius > 0.0))
      error->one(FLERR, "{} carrier {} has radius {}: it must be above 0", command, atom->tag[i], radius);
    extremes[0] = std::max(extremes[0], radius);
    extremes[1] = std::max(extremes[1], 1.0 / radius);
  }
  MPI_Allreduce(MPI_IN_PLACE, extremes, 2, MPI_DOUBLE, MPI_MAX, world);
  if (extremes[0] == 0.0) return 0.0;
  const double largest = extremes[0], least = 1.0 / extremes[1];
  if (!same_size(least, largest))
    error->all(FLERR,
               "{} group {} has carriers of diameter {} to {}: one texture serves one size, use a group and a command "
               "for each",
               command, group->names[igroup], 2.0 * least, 2.0 * largest);
  return largest;
}

/* ---------------------------------------------------------------------- */

Dust::Texture DustOptions::texture(double radius) const
{
  Dust::Texture made;
  try {
    if (!file.empty())
      made = from_file;
    else if (distributed)
      made = Dust::place_monolayer(radius, sizes, coverage, bare, seed);
    else
      made = Dust::place_monolayer(radius, 0.5 * diameter, coverage, bare, seed);
  } catch (Dust::TextureError &e) {
    error->all(FLERR, "{} texture: {}", command, e.what());
  }
  if (!same_size(made.carrier_radius, radius))
    error->all(FLERR, "{} texture file {} is for carriers of diameter {}, not {}", command, file,
               2.0 * made.carrier_radius, 2.0 * radius);
  if (!write.empty()) {
    int written = 1;
    if (comm->me == 0) {
      std::ofstream out(write);
      Dust::write_texture(made, out);
      out.close();
      written = out ? 1 : 0;
    }
    MPI_Bcast(&written, 1, MPI_INT, 0, world);
    if (!written) error->all(FLERR, "{} cannot write texture file {}", command, write);
  }
  return made;
}
