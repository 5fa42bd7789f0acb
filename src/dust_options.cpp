/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "dust_options.h"

#include "core/hamaker.h"
#include "core/jkr.h"
#include "core/texture_file.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "group.h"
#include "math_const.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

using namespace LAMMPS_NS;

static constexpr double UNSET = -1.0;

/* ----------------------------------------------------------------------
   what no grain and no carrier is made of is a slip of units. Units lj have no scale.
------------------------------------------------------------------------- */

namespace {

struct Dimension {    // powers of mass, length and time
  int mass, length, time;
};
constexpr Dimension LENGTH = {0, 1, 0}, DENSITY = {1, -3, 0}, ENERGY = {1, 2, -2}, SURFACE_ENERGY = {1, 0, -2},
                    PRESSURE = {1, -1, -2}, ACCELERATION = {0, 1, -2};

struct UnitStyle {    // how many of its units are one of SI
  const char *name;
  double mass, length, time;
};
constexpr UnitStyle UNIT_STYLES[] = {{"si", 1.0, 1.0, 1.0},
                                     {"cgs", 1e3, 1e2, 1.0},
                                     {"micro", 1e15, 1e6, 1e6},
                                     {"nano", 1e21, 1e9, 1e9}};

// a quantity of SI in the units of the deck; 0 with units lj
double from_si(double value, const Dimension &of, const std::string &units)
{
  for (const UnitStyle &style : UNIT_STYLES)
    if (units == style.name)
      return value * std::pow(style.mass, of.mass) * std::pow(style.length, of.length) * std::pow(style.time, of.time);
  return 0.0;
}

Range plausible(double low, double high, const Dimension &of, const std::string &units)
{
  const double lowest = from_si(low, of, units), highest = from_si(high, of, units);
  if (highest == 0.0) return Range::above(0.0);
  return (low > 0.0 ? Range::from_to(lowest, highest) : Range::above(0.0).at_most(highest)).in("with units " + units);
}

}    // namespace

/* ---------------------------------------------------------------------- */

DustOptions::DustOptions(LAMMPS *_lmp, const std::string &_command) :
    Pointers(_lmp), density(UNSET), surface_energy(UNSET), elastic{UNSET, UNSET, UNSET, UNSET}, command(_command),
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

std::vector<Keyword> DustOptions::keywords()
{
  return {
      {"texture", [this](Keywords &words) { take_texture(words); }},
      {"coverage", [this](Keywords &words) { coverage = words.number(Range::above(0.0)); }},
      {"seed", [this](Keywords &words) { seed = words.whole_number(1, MAXSMALLINT); }},
      {"bare", [this](Keywords &words) { take_bare(words); }},
      {"distribution", [this](Keywords &words) { take_distribution(words); }},
      {"density",
       [this](Keywords &words) { density = words.number(plausible(10.0, 3e4, DENSITY, update->unit_style)); }},
      {"hamaker", [this](Keywords &words) { take_hamaker(words); }},
      {"surface",
       [this](Keywords &words) {
         if (surface_energy != UNSET) words.refuse("and hamaker: the adhesion is given twice");
         surface_energy = words.number(surface_energies());
       }},
      {"elastic", [this](Keywords &words) { take_elastic(words); }},
      {"orientation",
       [this](Keywords &words) {
         const bool random = words.one_of({"same", "random"}) == 1;
         orientation_seed = random ? words.whole_number(1, MAXSMALLINT, "SEED") : 0;
       }},
      {"write", [this](Keywords &words) { write = words.word("the name of a file"); }},
  };
}

/* ---------------------------------------------------------------------- */

void DustOptions::take_texture(Keywords &words)
{
  if (words.one_of({"file", "monolayer"}, "SOURCE") == 0)
    read_file(words.word("the name of a file"));
  else
    diameter = words.number(Range::above(0.0), "DIAMETER");
}

/* ---------------------------------------------------------------------- */

void DustOptions::take_bare(Keywords &words)
{
  bare.half_angle = words.number(Range::at_least(0.0).below(3.14159265358979), "THETA");
  bare_given = true;
  if (!words.number_follows()) return;
  double *axis = bare.axis;
  const char *names[] = {"nx", "ny", "nz"};
  for (int d = 0; d < 3; d++) axis[d] = words.number(Range::any(), names[d]);
  const double length = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  if (!(length > 0.0 && std::isfinite(length))) words.refuse("nx ny nz must be a direction, not 0 0 0");
  for (int d = 0; d < 3; d++) axis[d] /= length;
}

/* ---------------------------------------------------------------------- */

Range DustOptions::surface_energies() const { return plausible(0.0, 10.0, SURFACE_ENERGY, update->unit_style); }

void DustOptions::take_hamaker(Keywords &words)
{
  if (surface_energy != UNSET) words.refuse("and surface: the adhesion is given twice");
  const double A = words.number(plausible(1e-22, 1e-17, ENERGY, update->unit_style), "A");
  const double z0 = words.number(plausible(1e-11, 1e-7, LENGTH, update->unit_style), "z0");
  surface_energy = Dust::surface_energy(A, z0);
  if (!surface_energies().holds(surface_energy))
    words.refuse(
        fmt::format("A and z0 give the surface energy {:g}: it must be {}", surface_energy, surface_energies().text()));
}

/* ---------------------------------------------------------------------- */

void DustOptions::take_elastic(Keywords &words)
{
  const char *names[] = {"E", "nu", "E_carrier", "nu_carrier"};
  for (int k = 0; k < 4; k++)
    elastic[k] =
        words.number(k % 2 ? Range::above(-1.0).at_most(0.5) : plausible(1e6, 1e13, PRESSURE, update->unit_style),
                     names[k]);
}

/* ---------------------------------------------------------------------- */

void DustOptions::take_distribution(Keywords &words)
{
  const bool rrsb = words.one_of({"lognormal", "rrsb"}) == 1;
  sizes.kind = rrsb ? Dust::SizeDistribution::RRSB : Dust::SizeDistribution::LOGNORMAL;
  sizes.x50 = words.number(Range::above(0.0), "X50");
  sizes.spread = words.number(Range::above(rrsb ? 0.0 : 1.0), rrsb ? "N" : "SIGMA_G");
  distributed = true;
}

/* ---------------------------------------------------------------------- */

void DustOptions::read(int first, int narg, char **arg)
{
  Keywords(lmp, command, narg, arg).read(keywords(), first);
  complete();
}

/* ----------------------------------------------------------------------
   rank 0 does it; all stop if it fails
------------------------------------------------------------------------- */

template <typename Action> void DustOptions::on_one_rank(const std::string &what, Action action) const
{
  std::string wrong;
  if (comm->me == 0) {
    try {
      action();
    } catch (const Dust::TextureError &e) {
      wrong = e.what();
    } catch (const std::bad_alloc &) {
      wrong = "not enough memory for its grains";
    }
  }
  int size = static_cast<int>(wrong.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, world);
  wrong.resize(size);
  MPI_Bcast(wrong.data(), size, MPI_CHAR, 0, world);
  if (size) error->all(FLERR, "{} {}: {}", command, what, wrong);
}

// from rank 0 to all
void DustOptions::share(Dust::Texture &texture) const
{
  MPI_Bcast(&texture.carrier_radius, 1, MPI_DOUBLE, 0, world);
  MPI_Bcast(&texture.bare.half_angle, 1, MPI_DOUBLE, 0, world);
  MPI_Bcast(texture.bare.axis, 3, MPI_DOUBLE, 0, world);
  int number = static_cast<int>(texture.grains.size());
  MPI_Bcast(&number, 1, MPI_INT, 0, world);
  texture.grains.resize(number);
  static_assert(sizeof(Dust::Grain) == 4 * sizeof(double), "grains are sent as numbers");
  MPI_Bcast(texture.grains.data(), 4 * number, MPI_DOUBLE, 0, world);
}

void DustOptions::read_file(const std::string &name)
{
  file = name;
  on_one_rank("texture file " + file, [this]() { from_file = Dust::read_texture_file(file); });
  share(from_file);
}

/* ----------------------------------------------------------------------
   the reference case, calcium carbonate on stainless steel, is known in SI units only
------------------------------------------------------------------------- */

void DustOptions::complete()
{
  if (file.empty()) {
    if (diameter == 0.0) error->all(FLERR, "{} needs keyword texture", command);
    if (coverage == UNSET) error->all(FLERR, "{} texture monolayer needs coverage", command);
    if (seed == 0) error->all(FLERR, "{} texture monolayer needs seed", command);
  } else {
    const char *extra = coverage != UNSET ? "coverage" : seed ? "seed" : bare_given ? "bare" : "distribution";
    if (coverage != UNSET || seed || bare_given || distributed)
      error->all(FLERR, "{} {} goes with texture monolayer: a texture file has its own grains", command, extra);
  }
  if (orientation_seed && !atom->tag_enable)
    error->all(FLERR, "{} orientation random needs atom IDs: atom_modify id yes", command);

  const auto absent = [&](double value, const char *key) {
    if (value == UNSET && !reference_units())
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

bool DustOptions::reference_units() const { return strcmp(update->unit_style, "si") == 0; }

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

/* ----------------------------------------------------------------------
   as given, or as wide as these grains need it; a carrier that meets the wall with any side has no use for a side
   without grains
------------------------------------------------------------------------- */

Dust::BareCap DustOptions::bare_cap(double radius) const
{
  Dust::BareCap cap = bare;
  if (bare_given) return cap;
  const double largest = 0.5 * (distributed ? sizes.largest() : diameter);
  cap.half_angle = orientation_seed ? 0.0 : Dust::bare_half_angle(radius, largest);
  return cap;
}

/* ---------------------------------------------------------------------- */

Dust::Texture DustOptions::texture(double radius) const
{
  Dust::Texture made = from_file;
  if (file.empty()) {
    const Dust::BareCap cap = bare_cap(radius);
    on_one_rank("texture", [&]() {
      made = distributed ? Dust::place_monolayer(radius, sizes, coverage, cap, seed)
                         : Dust::place_monolayer(radius, 0.5 * diameter, coverage, cap, seed);
    });
    share(made);
  }
  if (!same_size(made.carrier_radius, radius))
    error->all(FLERR, "{} texture file {} is for carriers of diameter {}, not {}", command, file,
               2.0 * made.carrier_radius, 2.0 * radius);
  check_plausible(made);
  return made;
}

/* ----------------------------------------------------------------------
   grains that could not be there show that something was given in other units
------------------------------------------------------------------------- */

void DustOptions::check_plausible(const Dust::Texture &texture) const
{
  const std::string units = update->unit_style;
  const double gravity = from_si(9.81, ACCELERATION, units);
  if (gravity == 0.0) return;
  double largest = 0.0;
  for (const Dust::Grain &grain : texture.grains) largest = std::max(largest, grain.radius);
  const double pull_off = Dust::pull_off_force(surface_energy, Dust::effective_radius(texture.carrier_radius, largest));
  const double held = pull_off / (4.0 / 3.0 * MathConst::MY_PI * largest * largest * largest * density);
  if (held < gravity)
    error
        ->all(FLERR,
              "{} has grains of diameter {:g} that are held up to an acceleration of {:g}: it must be at least that of "
              "gravity, {:g} with units {}",
              command, 2.0 * largest, held, gravity, units);
}

/* ---------------------------------------------------------------------- */

void DustOptions::save(const Dust::Texture &texture) const
{
  if (!write.empty()) on_one_rank("write " + write, [&]() { Dust::write_texture_file(texture, write); });
}
