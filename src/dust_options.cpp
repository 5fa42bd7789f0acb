/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "dust_options.h"

#include "core/adhesion_spread.h"
#include "core/hamaker.h"
#include "core/jkr.h"
#include "core/texture_file.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "math_const.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <new>
#include <utility>

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
    Pointers(_lmp), density(UNSET), surface_energy(UNSET), elastic{UNSET, UNSET, UNSET, UNSET}, class_width(0.0),
    command(_command), diameter(0.0), coverage(UNSET), distributed(false), sizes{}, spread(1.0), seed(0),
    bare_given(false), orientation_seed(0)
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
      {"texture", [this](Keywords &words) { take_texture(words); }, true},
      {"coverage", [this](Keywords &words) { coverage = words.number(Range::above(0.0)); }},
      {"seed", [this](Keywords &words) { seed = words.whole_number(1, MAXSMALLINT); }},
      {"bare", [this](Keywords &words) { take_bare(words); }},
      {"distribution", [this](Keywords &words) { take_distribution(words); }},
      {"spread", [this](Keywords &words) { spread = words.number(Range::from_to(1.0, Dust::MOST_SPREAD)); }},
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
  const bool again = from_file() || diameter != 0.0, is_file = words.one_of({"file", "monolayer"}, "SOURCE") == 0;
  if (again && !(is_file && from_file())) words.refuse("is given twice: only texture file may be, for a size each");
  if (is_file)
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

void DustOptions::read(int first, int narg, char **arg, const std::vector<Keyword> &own)
{
  std::vector<Keyword> table = keywords();
  table.insert(table.end(), own.begin(), own.end());
  Keywords(lmp, command, narg, arg).read(table, first);
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
  constexpr int EACH = sizeof(Dust::Grain) / sizeof(double);
  static_assert(sizeof(Dust::Grain) == EACH * sizeof(double), "grains are sent as numbers");
  MPI_Bcast(texture.grains.data(), EACH * number, MPI_DOUBLE, 0, world);
}

void DustOptions::read_file(const std::string &name)
{
  Dust::Texture read;
  on_one_rank("texture file " + name, [&]() { read = Dust::read_texture_file(name); });
  share(read);
  for (const File &other : files)
    if (same_size(other.texture->carrier_radius, read.carrier_radius))
      error->all(FLERR, "{} texture files {} and {} are both for carriers of diameter {}", command, other.name, name,
                 2.0 * read.carrier_radius);
  files.push_back({name, std::make_shared<const Dust::Texture>(std::move(read))});
}

/* ----------------------------------------------------------------------
   the reference case, calcium carbonate on stainless steel, is known in SI units only
------------------------------------------------------------------------- */

void DustOptions::complete()
{
  if (!from_file()) {
    if (diameter == 0.0) error->all(FLERR, "{} needs keyword texture", command);
    if (coverage == UNSET) error->all(FLERR, "{} texture monolayer needs coverage", command);
    if (seed == 0) error->all(FLERR, "{} texture monolayer needs seed", command);
  } else {
    const char *extra = coverage != UNSET ? "coverage"
                        : seed            ? "seed"
                        : bare_given      ? "bare"
                        : distributed     ? "distribution"
                                          : "spread";
    if (coverage != UNSET || seed || bare_given || distributed || spread != 1.0)
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

double DustOptions::carrier_radius(int i) const
{
  if ((atom->tri && atom->tri[i] >= 0) || (atom->line && atom->line[i] >= 0))
    error->one(FLERR, "{} carriers must be spheres, and atom {} is a triangle or line: use a group without those",
               command, atom->tag[i]);
  const double radius = atom->radius[i];
  if (!(radius > 0.0))
    error->one(FLERR, "{} carrier {} has radius {}: it must be above 0", command, atom->tag[i], radius);
  return radius;
}

/* ----------------------------------------------------------------------
   the nearest in ln R
------------------------------------------------------------------------- */

int DustOptions::file_for(double radius) const
{
  const auto distance = [=](const File &file) { return std::fabs(std::log(file.texture->carrier_radius / radius)); };
  const auto nearest = std::min_element(files.begin(), files.end(),
                                        [&](const File &a, const File &b) { return distance(a) < distance(b); });
  const double size = nearest->texture->carrier_radius;
  if (!same_size(size, radius) && distance(*nearest) > std::log1p(class_width))
    error->one(FLERR, "{} texture file {} is for carriers of diameter {}, not {}", command, nearest->name, 2.0 * size,
               2.0 * radius);
  return static_cast<int>(nearest - files.begin());
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

std::shared_ptr<const Dust::Texture> DustOptions::texture(double radius) const
{
  const auto texture = from_file() ? files[file_for(radius)].texture : monolayer(radius);
  check_plausible(*texture);
  return texture;
}

/* ----------------------------------------------------------------------
   programs run one impact after another in a process, most of them with the texture of the last one, which takes longer
   to make than the impact
------------------------------------------------------------------------- */

namespace {

struct LastMonolayer {
  std::vector<double> source;    // all that it depends on
  std::shared_ptr<const Dust::Texture> texture;
};
LastMonolayer last_monolayer;
std::mutex last_monolayer_guard;    // LAMMPS instances may run in several threads

std::shared_ptr<const Dust::Texture> kept_monolayer(const std::vector<double> &source)
{
  const std::lock_guard<std::mutex> lock(last_monolayer_guard);
  return last_monolayer.source == source ? last_monolayer.texture : nullptr;
}

void keep_monolayer(LastMonolayer made)
{
  if (!DustOptions::may_keep(*made.texture)) made = {};
  const std::lock_guard<std::mutex> lock(last_monolayer_guard);
  last_monolayer = std::move(made);
}

}    // namespace

std::shared_ptr<const Dust::Texture> DustOptions::monolayer(double radius) const
{
  const Dust::BareCap cap = bare_cap(radius);
  const double *axis = cap.axis;
  const std::vector<double> source = {radius,    double(distributed), diameter, double(sizes.kind),
                                      sizes.x50, sizes.spread,        coverage, double(seed),
                                      spread,    cap.half_angle,      axis[0],  axis[1],
                                      axis[2]};
  auto texture = kept_monolayer(source);
  int kept = texture != nullptr;    // other ranks may have run other instances
  MPI_Allreduce(MPI_IN_PLACE, &kept, 1, MPI_INT, MPI_MIN, world);
  if (kept) return texture;

  Dust::Texture made;
  on_one_rank("texture", [&]() {
    made = distributed ? Dust::place_monolayer(radius, sizes, coverage, cap, seed)
                       : Dust::place_monolayer(radius, 0.5 * diameter, coverage, cap, seed);
    Dust::spread_adhesion(made, spread, seed);
  });
  share(made);
  texture = std::make_shared<const Dust::Texture>(std::move(made));
  keep_monolayer({source, texture});
  return texture;
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

void DustOptions::save(const Dust::Texture &texture, bool first) const
{
  if (write.empty()) return;
  std::string name = write;
  const size_t star = name.find('*');
  if (star != std::string::npos)
    name.replace(star, 1, fmt::format("{:.9g}", 2.0 * texture.carrier_radius));
  else if (!first)
    error->all(FLERR, "{} write {} needs a * where the diameter goes: there are carriers of several sizes", command,
               write);
  on_one_rank("write " + name, [&]() { Dust::write_texture_file(texture, name); });
}
