/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "texture_placement.h"

#include "geometry.h"
#include "random_numbers.h"
#include "shell_grid.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace Dust;

namespace {

constexpr double MIN_GAP = 1.0e-3;    // between two grains, of the sum of their radii
constexpr double CUT = 0.01;          // of a size distribution, at either end, by volume
constexpr double JAMMED = 0.547;      // share of the shell of their centres that equal grains cover when no more fit

struct Height {
  double z, s;
  explicit Height(double height) : z(height), s(std::sqrt(std::max(0.0, 1.0 - height * height))) {}
};
struct Azimuth {
  double cosine, sine;
  explicit Azimuth(double phi) : cosine(std::cos(phi)), sine(std::sin(phi)) {}
};

// unit vector there
void point_at(const Height &height, const Azimuth &azimuth, double *n)
{
  n[0] = height.s * azimuth.cosine;
  n[1] = height.s * azimuth.sine;
  n[2] = height.z;
}

/* ----------------------------------------------------------------------
   random sequential placement of grains on the part of a carrier above a height, from large to small
------------------------------------------------------------------------- */

class Placement {
 public:
  // radii from large to small
  Placement(double lowest_z, double carrier_radius, const std::vector<double> &radii, std::mt19937_64 &numbers) :
      zlo(lowest_z), carrier(carrier_radius), least(radii.back()), size(0.0), number(radii.size()),
      cells_for(radii.front()), tries(0), random(numbers)
  {
    grains.reserve(number);
  }

  // places one grain, no larger than the last one; false if there is no room for it
  bool place(double radius)
  {
    if (radius != size) resize(radius);
    if (radius < cells_for) cells.clear();    // smaller ones have room where larger ones have none
    const Cell everywhere = {zlo, 1.0, 0.0, 2.0 * PI};
    if (cells.empty()) {
      // as long as most of the sphere is free, tries anywhere are cheapest
      for (int misses = 0; misses < 2000; misses++)
        if (try_cell(everywhere)) return true;
      cells = {everywhere};
      cells_for = std::max(0.9 * size, least);    // so that they serve the next grains, too
      tries = 0;
    }
    while (true) {
      for (; tries > 0; tries--)
        if (try_cell(cells[static_cast<size_t>(uniform(random) * cells.size())])) {
          tries--;
          return true;
        }
      if (cells_for < size &&
          cells[0].phi1 - cells[0].phi0 < 0.05 * reach(size, size)) {    // room for smaller grains alone
        cells = {everywhere};
        cells_for = size;
      }
      if (!refine()) return false;
      tries = cells.size();
    }
  }

  std::vector<Grain> grains;

 private:
  struct Cell {    // all cells in a list have the same area, as area is dz dphi
    double z0, z1, phi0, phi1;
  };

  double zlo, carrier, least, size;
  size_t number;              // of all grains
  std::vector<Cell> cells;    // where there may be room for a grain of a size; empty as long as nearly anywhere
  double cells_for;           // that size, at most the next grain's
  size_t tries;               // in these cells, until the next refinement
  struct Level {              // grains between a size and half of it
    double largest;           // that size
    double most;              // least_chord2() of the present size and that one, no less
    Neighbourhood near;       // where its grains can be neighbours of the present one
    ShellGrid grid;
  };
  std::vector<Level> levels;
  std::mt19937_64 &random;

  // squared chord that keeps a grain's direction off another's, from the triangle of both centres and the carrier's
  double least_chord2(double a, double b) const
  {
    const double touch = (a + b) * (1.0 + MIN_GAP), step = a - b;
    return (touch * touch - step * step) / ((carrier + a) * (carrier + b));
  }
  double reach(double a, double b) const { return 2.0 * std::asin(std::min(1.0, 0.5 * std::sqrt(least_chord2(a, b)))); }

  void resize(double radius)
  {
    constexpr double ROUND_OFF = 1.0e-9;
    size = radius;
    if (levels.empty() || size < 0.5 * levels.back().largest)
      levels.push_back({size, 0.0, 0.0, ShellGrid(reach(size, size), number - grains.size())});
    for (Level &level : levels) {
      level.most = least_chord2(size, level.largest) * (1.0 + ROUND_OFF);
      level.near = reach(size, level.largest) * (1.0 + ROUND_OFF);
    }
  }

  // whether a grain is nearer to n than the chord that goes with its radius, of those that may be neighbours of one of
  // this size, or a smaller one
  template <typename Chord2> bool any_near(const double *n, Chord2 chord2_of) const
  {
    return std::any_of(levels.begin(), levels.end(), [&](const Level &level) {
      return level.grid.any_near(n, level.near, [&](int id, double chord2) {
        return chord2 < level.most && chord2 < chord2_of(grains[id].radius);
      });
    });
  }

  bool try_cell(const Cell &cell)
  {
    Grain grain;
    grain.radius = size;
    const double z = cell.z0 + uniform(random) * (cell.z1 - cell.z0);
    point_at(Height(z), Azimuth(cell.phi0 + uniform(random) * (cell.phi1 - cell.phi0)), grain.n);
    if (any_near(grain.n, [this](double radius) { return least_chord2(size, radius); })) return false;
    levels.back().grid.insert(static_cast<int>(grains.size()), grain.n);
    grains.push_back(grain);
    return true;
  }

  // true if one grain excludes the whole cell: the cell's farthest points are corners once it is narrower than pi/2
  bool covered(const Height (&z)[2], const Azimuth (&phi)[2], const Height &middle_z, const Azimuth &middle_phi) const
  {
    double middle[3], radius = 0.0;
    point_at(middle_z, middle_phi, middle);
    for (const Height &high : z)
      for (const Azimuth &wide : phi) {
        double corner[3];
        point_at(high, wide, corner);
        radius = std::max(radius, std::sqrt(chord2(middle, corner)));
      }
    return any_near(middle, [&](double other) {
      const double limit = std::sqrt(least_chord2(cells_for, other)) - radius;    // chords obey the triangle inequality
      return limit > 0.0 ? limit * limit : 0.0;
    });
  }

  // appends the quarters of a cell that are not covered; sines and cosines of what they share are taken once
  void quarter(const Cell &c, std::vector<Cell> &finer) const
  {
    const double z[3] = {c.z0, 0.5 * (c.z0 + c.z1), c.z1}, phi[3] = {c.phi0, 0.5 * (c.phi0 + c.phi1), c.phi1};
    const bool wide = phi[1] - phi[0] > 0.5 * PI || phi[2] - phi[1] > 0.5 * PI;
    const Height heights[3] = {Height(z[0]), Height(z[1]), Height(z[2])};
    const Azimuth azimuths[3] = {Azimuth(phi[0]), Azimuth(phi[1]), Azimuth(phi[2])};
    for (int j = 0; j < 2; j++) {
      const Azimuth middle_phi(0.5 * (phi[j] + phi[j + 1]));
      for (int i = 0; i < 2; i++)
        if (wide || !covered({heights[i], heights[i + 1]}, {azimuths[j], azimuths[j + 1]},
                             Height(0.5 * (z[i] + z[i + 1])), middle_phi))
          finer.push_back({z[i], z[i + 1], phi[j], phi[j + 1]});
    }
  }

  // quarters the cells until most are smaller than a grain's surroundings, and drops those without room
  bool refine()
  {
    const double wide = 0.5 * reach(size, size);
    do {
      if ((cells.empty()) || (cells[0].z1 - cells[0].z0 < 1.0e-12)) return false;
      std::vector<Cell> finer;
      for (const Cell &c : cells) quarter(c, finer);
      cells.swap(finer);
    } while (!cells.empty() && cells[0].phi1 - cells[0].phi0 > wide);
    return !cells.empty();
  }
};

// turns v by the rotation that takes -z to axis
void turn_from_south(const double *axis, double *v)
{
  const double c = -axis[2];
  if (c < -1.0 + 1.0e-12) {    // the other pole: half a turn about x
    v[1] = -v[1];
    v[2] = -v[2];
    return;
  }
  const double k[3] = {axis[1], -axis[0], 0.0};    // (-z) x axis, of length sin
  const double kxv[3] = {k[1] * v[2], -k[0] * v[2], k[0] * v[1] - k[1] * v[0]};
  const double along = (k[0] * v[0] + k[1] * v[1]) / (1.0 + c);
  for (int d = 0; d < 3; d++) v[d] = v[d] * c + kxv[d] + k[d] * along;
  const double length = std::sqrt(dot(v, v));
  for (int d = 0; d < 3; d++) v[d] /= length;
}

void check_coverage(double coverage)
{
  if (!(coverage > 0.0 && std::isfinite(coverage)))
    throw TextureError("coverage " + number_text(coverage) + " is not above 0");
}

// both kinds of impossible textures are refused before any time is spent on them
void check_number(double coverage, double grains)
{
  if (!(grains <= MOST_GRAINS))
    throw TextureError("coverage " + number_text(coverage) + " with these grains is " + number_text(grains) +
                       " of them: it must be at most " + number_text(MOST_GRAINS));
}

// coverage of all the shell of the centres that is outside the bare cap
double room(double carrier_radius, double grain_radius, const BareCap &bare)
{
  const double ratio = 1.0 + grain_radius / carrier_radius;
  return ratio * ratio * 0.5 * (1.0 + std::cos(bare.half_angle));
}

// most = what can be placed on average. Chance and the rim of the cap add to the number of grains that find room, by
// twice its root at most.
void check_room(double coverage, double most, double grains)
{
  const double fit = grains * most / coverage;
  if (grains > 1.01 * fit + 3.0 * std::sqrt(fit) + 1.0)
    throw TextureError("coverage " + number_text(coverage) + " cannot be placed: it must be at most about " +
                       number_text(most) + " with these grains and bare cap");
}

}    // namespace

/* ---------------------------------------------------------------------- */

double Dust::grains_for_coverage(double coverage, double carrier_radius, double grain_radius)
{
  const double ratio = carrier_radius / grain_radius;
  return std::round(4.0 * coverage * ratio * ratio);
}

/* ---------------------------------------------------------------------- */

double SizeDistribution::quantile(double fraction) const
{
  if (kind == RRSB) return x50 * std::pow(-std::log1p(-fraction) / std::log(2.0), 1.0 / spread);
  // where the error function says so, by bisection: the fraction lies within 3 standard deviations
  double low = -3.0, high = 3.0;
  while (high - low > 1.0e-15) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (0.5 * std::erfc(-middle / std::sqrt(2.0)) < fraction ? low : high) = middle;
  }
  return x50 * std::exp(high * std::log(spread));
}

double SizeDistribution::largest() const { return quantile(1.0 - CUT); }

/* ----------------------------------------------------------------------
   by volume between the cuts, taken with the probability (finest/x)^3: by number
------------------------------------------------------------------------- */

static std::vector<double> draw_radii(const SizeDistribution &sizes, double sum_of_squares, std::mt19937_64 &random)
{
  const double finest = sizes.quantile(CUT), coarsest = sizes.largest();
  std::vector<double> radii;
  for (double sum = 0.0; sum < sum_of_squares;) {
    double x;
    if (sizes.kind == SizeDistribution::RRSB) {
      x = sizes.quantile(CUT + (1.0 - 2.0 * CUT) * uniform(random));
    } else {
      x = sizes.x50 * std::pow(sizes.spread, normal_deviate(random));
      if (x < finest || x > coarsest) continue;
    }
    if (uniform(random) > std::pow(finest / x, 3)) continue;
    radii.push_back(0.5 * x);
    sum += 0.25 * x * x;
  }
  std::sort(radii.begin(), radii.end(), std::greater<double>());
  return radii;
}

/* ----------------------------------------------------------------------
   number of grains drawn so on average, until the sum of their radii squared is reached: by means over the volume
------------------------------------------------------------------------- */

static double expected_grains(const SizeDistribution &sizes, double sum_of_squares)
{
  constexpr int INTERVALS = 2000;    // of the logarithm of the fraction, as fine grains count most
  double number = 0.0, squares = 0.0;
  for (int k = 0; k < INTERVALS; k++) {
    const double fraction = CUT * std::pow((1.0 - CUT) / CUT, (k + 0.5) / INTERVALS);
    const double radius = 0.5 * sizes.quantile(fraction);
    number += fraction / (radius * radius * radius);
    squares += fraction / radius;
  }
  return sum_of_squares * number / squares;
}

/* ---------------------------------------------------------------------- */

static Texture place(double carrier_radius, const std::vector<double> &radii, double coverage, const BareCap &bare,
                     std::mt19937_64 &random)
{
  Placement placement(-std::cos(bare.half_angle), carrier_radius, radii, random);
  double sum = 0.0;
  for (const double radius : radii) {
    if (!placement.place(radius))
      throw TextureError("coverage " + number_text(coverage) + " cannot be placed: the monolayer is full at " +
                         number_text(0.25 * sum / (carrier_radius * carrier_radius)) + " (" +
                         std::to_string(placement.grains.size()) + " of " + std::to_string(radii.size()) + " grains)");
    sum += radius * radius;
  }
  for (Grain &grain : placement.grains) turn_from_south(bare.axis, grain.n);
  return {carrier_radius, bare, std::move(placement.grains)};
}

/* ---------------------------------------------------------------------- */

Texture Dust::place_monolayer(double carrier_radius, double grain_radius, double coverage, const BareCap &bare,
                              uint64_t seed)
{
  check_sizes(carrier_radius, grain_radius, bare);
  check_coverage(coverage);
  const double wanted = grains_for_coverage(coverage, carrier_radius, grain_radius);
  if (wanted < 1.0) throw TextureError("coverage " + number_text(coverage) + " is less than one grain");
  check_number(coverage, wanted);
  const double share = JAMMED / ((1.0 + MIN_GAP) * (1.0 + MIN_GAP));
  check_room(coverage, share * room(carrier_radius, grain_radius, bare), wanted);
  std::mt19937_64 random(seed);
  return place(carrier_radius, std::vector<double>(static_cast<size_t>(wanted), grain_radius), coverage, bare, random);
}

/* ---------------------------------------------------------------------- */

Texture Dust::place_monolayer(double carrier_radius, const SizeDistribution &sizes, double coverage,
                              const BareCap &bare, uint64_t seed)
{
  if (!(sizes.x50 > 0.0 && std::isfinite(sizes.x50)))
    throw TextureError("median diameter " + number_text(sizes.x50) + " is not above 0");
  const bool lognormal = sizes.kind == SizeDistribution::LOGNORMAL;
  if (!(sizes.spread > (lognormal ? 1.0 : 0.0) && std::isfinite(sizes.spread)))
    throw TextureError(lognormal ? "geometric standard deviation " + number_text(sizes.spread) + " is not above 1"
                                 : "exponent " + number_text(sizes.spread) + " is not above 0");
  const double largest = 0.5 * sizes.largest();
  if (!(2.0 * largest < carrier_radius))
    throw TextureError("the coarsest grains of this distribution have diameter " + number_text(2.0 * largest) +
                       ", not below the carrier's radius, " + number_text(carrier_radius));
  check_sizes(carrier_radius, largest, bare);
  check_coverage(coverage);
  const double wanted = expected_grains(sizes, 4.0 * coverage * carrier_radius * carrier_radius);
  check_number(coverage, wanted);
  check_room(coverage, room(carrier_radius, largest, bare), wanted);    // fine ones may fill what coarse ones leave
  std::mt19937_64 random(seed);
  return place(carrier_radius, draw_radii(sizes, 4.0 * coverage * carrier_radius * carrier_radius, random), coverage,
               bare, random);
}
