/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "dust_coat.h"

#include "core/jkr.h"

#include "detach_settings.h"
#include "dust_gather.h"

#include "comm.h"
#include "error.h"
#include "fix.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>
#include <utility>

using namespace LAMMPS_NS;

DustCoats::DustCoats(LAMMPS *_lmp, const Fix *_fix, const DetachSettings &_settings) :
    Pointers(_lmp), fix(_fix), settings(_settings), reference(0.0), words(0)
{
}

/* ----------------------------------------------------------------------
   classes are a factor 1 + w apart; one for each radius, rounded to 1e-9 of itself, with w = 0; one for each file
------------------------------------------------------------------------- */

double DustCoats::key_of(double radius) const
{
  if (settings.from_file()) return settings.file_for(radius);
  constexpr double ROUNDING = 1.0e-9;
  const double w = settings.class_width;
  return std::round(w > 0.0 ? std::log(radius / reference) / std::log1p(w) : std::log(radius) / ROUNDING);
}

// where a class's texture is placed: with w = 0 on the largest carrier that is there
double DustCoats::radius_of(double key, double largest) const
{
  if (settings.from_file() || settings.class_width == 0.0) return largest;
  return key == 0.0 ? reference : reference * std::pow(1.0 + settings.class_width, key);
}

/* ---------------------------------------------------------------------- */

void DustCoats::place(const std::vector<double> &radii)
{
  if (reference == 0.0) {
    for (const double radius : radii) reference = std::max(reference, radius);
    MPI_Allreduce(MPI_IN_PLACE, &reference, 1, MPI_DOUBLE, MPI_MAX, world);
    if (reference == 0.0) return;
  }
  struct Class {
    double key, largest;
  };
  std::map<double, double, std::greater<>> missing;    // largest radius, by key
  for (const double radius : radii) {
    const double key = key_of(radius);
    if (numbers.count(key) == 0) missing[key] = std::max(missing[key], radius);
  }
  std::vector<Class> mine;
  for (const auto &[key, largest] : missing) mine.push_back({key, largest});
  for (const Class &one : dust_gather(mine, ALL_RANKS, world))
    missing[one.key] = std::max(missing[one.key], one.largest);
  for (const auto &[key, largest] : missing) {
    add(make(key, radius_of(key, largest)));
    const DustCoat &coat = coats.back();
    settings.save(*coat.texture, coats.size() == 1);
    if (comm->me == 0)
      utils::logmesg(lmp,
                     "Fix dust/detach {}: {} grains a carrier of diameter {:.5g}, mean mass {:.5g}, pull-off "
                     "acceleration {:.5g} to {:.5g}\n",
                     fix->id, coat.table->grains(), 2.0 * coat.radius, coat.table->mean_mass(), coat.table->min_hold(),
                     coat.table->max_hold());
  }
}

/* ----------------------------------------------------------------------
   the last table is kept with its texture: most runs in a process need the same again
------------------------------------------------------------------------- */

namespace {

struct Table {
  std::shared_ptr<const Dust::Texture> texture;
  std::shared_ptr<const Dust::GrainTable> table;
  double checksum;
};

double checksum_of(const Dust::Texture &texture)
{
  double sum = 0.0;
  int i = 0;
  for (const Dust::Grain &g : texture.grains)
    sum +=
        std::cos(++i) * (g.n[0] + 2.0 * g.n[1] + 3.0 * g.n[2] + g.radius / texture.carrier_radius + (g.adhesion - 1.0));
  return sum;
}

Table last_table;
std::mutex last_table_guard;    // LAMMPS instances may run in several threads

Table table_of(const std::shared_ptr<const Dust::Texture> &texture, const Dust::Material &material,
               const Dust::Criteria &criteria)
{
  {
    const std::lock_guard<std::mutex> lock(last_table_guard);
    if (last_table.texture == texture && last_table.table->material() == material &&
        last_table.table->criteria() == criteria)
      return last_table;
  }
  const auto table = std::make_shared<const Dust::GrainTable>(*texture, material, criteria);
  const Table made = {texture, table, checksum_of(*texture)};
  if (DustOptions::may_keep(*texture)) {
    const std::lock_guard<std::mutex> lock(last_table_guard);
    last_table = made;
  }
  return made;
}

Dust::Material material_of(const DetachSettings &settings)
{
  Dust::Material material = {settings.density,  settings.surface_energy, settings.modulus(),
                             settings.friction, settings.rolling,        settings.damping};
  if (settings.criteria.meet) {
    const double modulus = settings.elastic[0], poisson = settings.elastic[1];
    material.grain_modulus = Dust::combined_modulus(modulus, poisson, modulus, poisson);
    material.cohesion = settings.cohesion;
    material.softening = settings.meet_softening;
    material.step = settings.meet_step;
  }
  return material;
}

}    // namespace

DustCoat DustCoats::make(double key, double radius) const
{
  DustCoat coat;
  coat.key = key;
  coat.texture = settings.texture(radius);
  coat.radius = coat.texture->carrier_radius;
  const Table made = table_of(coat.texture, material_of(settings), settings.criteria);
  coat.table = made.table;
  // from about 5 times that on all grains come off, without a message
  if (settings.criteria.meet && settings.meet_step > coat.table->contact_time())
    error->all(
        FLERR,
        "Fix dust/detach {} meet_step {} must be at most {:.3g} for carriers of diameter {:.5g}: twice its default",
        fix->id, settings.meet_step, coat.table->contact_time(), 2.0 * coat.radius);
  coat.checksum = made.checksum;
  coat.mass = empty() ? 1.0 : coat.table->mean_mass() / unit_mass();
  return coat;
}

void DustCoats::add(DustCoat &&coat)
{
  numbers[coat.key] = size();
  words = std::max(words, coat.table->words());
  coats.push_back(std::move(coat));
}

/* ----------------------------------------------------------------------
   carriers name their coat by its number
------------------------------------------------------------------------- */

std::vector<double> DustCoats::numbers_to_keep() const
{
  std::vector<double> list = {settings.class_width, reference, double(size())};
  for (const DustCoat &coat : coats) list.insert(list.end(), {coat.key, coat.radius, coat.checksum});
  return list;
}

const double *DustCoats::restore(const double *list)
{
  const double width = *list++, file_reference = *list++;
  const int number = static_cast<int>(*list++);
  if (number == 0) return list;
  if (width != settings.class_width)
    error->all(FLERR, "Fix dust/detach keyword sizes is not that of the restart file: {}", width);
  std::vector<DustCoat> here;    // placed already
  here.swap(coats);
  numbers.clear();
  words = 0;
  reference = file_reference;
  for (int k = 0; k < number; k++) {
    const double key = *list++, radius = *list++, checksum = *list++;
    const auto same =
        std::find_if(here.begin(), here.end(), [=](const DustCoat &c) { return c && c.radius == radius; });
    DustCoat coat = same == here.end() ? make(key, radius) : std::move(*same);
    if (!(std::fabs(coat.checksum - checksum) <= 1.0e-9 * (1.0 + std::fabs(checksum))))
      error->all(FLERR, "Fix dust/detach texture is not the one of the restart file");
    coat.key = key;
    coat.mass = k == 0 ? 1.0 : coat.table->mean_mass() / unit_mass();
    add(std::move(coat));
  }
  return list;
}
