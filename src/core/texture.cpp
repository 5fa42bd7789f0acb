/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "texture.h"

#include "geometry.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <istream>
#include <ostream>
#include <random>
#include <sstream>
#include <string>

using namespace Dust;

namespace {

constexpr double MIN_GAP = 1.0e-3;    // between two grains, of the sum of their radii
constexpr double CUT = 0.01;          // of a size distribution, at either end, by volume
constexpr double MOST_GRAINS = 1.0e8;

// squared chord between two unit vectors: exact where the dot product would round small distances away
double chord2(const double *a, const double *b)
{
  const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return dot(d, d);
}

// unit vector at height z and azimuth phi
void point_at(double z, double phi, double *n)
{
  const double s = std::sqrt(std::max(0.0, 1.0 - z * z));
  n[0] = s * std::cos(phi);
  n[1] = s * std::sin(phi);
  n[2] = z;
}

/* ----------------------------------------------------------------------
   which of the points put in so far are near another one: bands of polar angle, each cut into equal bins of azimuth
------------------------------------------------------------------------- */

class ShellGrid {
 public:
  // reach = largest angle at which two points can be neighbours
  explicit ShellGrid(double reach) :
      angle(reach), nbands(std::clamp(static_cast<int>(PI / reach), 1, 4096)), first(nbands + 1, 0)
  {
    for (int b = 0; b < nbands; b++) {
      const double widest = std::max(std::sin(PI * b / nbands), std::sin(PI * (b + 1) / nbands));
      first[b + 1] = first[b] + std::clamp(static_cast<int>(2.0 * PI * widest / reach), 1, 8192);
    }
    bins.resize(first[nbands]);
  }

  void insert(int id, const double *n) { bins[bin(band(n[2]), azimuth(n))].push_back(id); }

  // calls visit(id) for all points within reach, and some beyond, until it returns true; returns whether one did
  template <typename Visit> bool any_near(const double *n, Visit visit) const
  {
    const double theta = std::acos(std::clamp(n[2], -1.0, 1.0));
    const double phi = azimuth(n);
    const int lowest = band_of_angle(theta - angle), highest = band_of_angle(theta + angle);
    const bool at_pole = theta <= angle || theta >= PI - angle;
    const double half = at_pole ? PI : std::asin(std::min(1.0, std::sin(angle) / std::sin(theta)));
    for (int b = lowest; b <= highest; b++) {
      const int nbins = first[b + 1] - first[b];
      int from = static_cast<int>(std::floor((phi - half) / (2.0 * PI) * nbins));
      int count = static_cast<int>(std::floor((phi + half) / (2.0 * PI) * nbins)) - from + 1;
      count = std::min(count, nbins);
      from = ((from % nbins) + nbins) % nbins;
      for (int k = 0; k < count; k++) {
        const int i = from + k < nbins ? from + k : from + k - nbins;
        for (int id : bins[first[b] + i])
          if (visit(id)) return true;
      }
    }
    return false;
  }

 private:
  double angle;
  int nbands;
  std::vector<int> first;    // first bin of each band
  std::vector<std::vector<int>> bins;

  static double azimuth(const double *n)
  {
    const double phi = std::atan2(n[1], n[0]);
    return phi < 0.0 ? phi + 2.0 * PI : phi;
  }
  int band_of_angle(double theta) const { return std::clamp(static_cast<int>(theta / PI * nbands), 0, nbands - 1); }
  int band(double z) const { return band_of_angle(std::acos(std::clamp(z, -1.0, 1.0))); }
  int bin(int b, double phi) const
  {
    const int nbins = first[b + 1] - first[b];
    return first[b] + std::min(static_cast<int>(phi / (2.0 * PI) * nbins), nbins - 1);
  }
};

/* ----------------------------------------------------------------------
   random sequential placement of grains on the part of a carrier above a height, from large to small
------------------------------------------------------------------------- */

class Placement {
 public:
  Placement(double lowest_z, double carrier_radius, double largest, double smallest, std::mt19937_64 &random) :
      zlo(lowest_z), carrier(carrier_radius), least(smallest), size(largest), cells_for(largest), tries(0),
      grid(reach()), random(random)
  {
  }

  // places one grain, no larger than the last one; false if there is no room for it
  bool place(double radius)
  {
    size = radius;
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
      if (cells_for < size && cells[0].phi1 - cells[0].phi0 < 0.05 * reach()) {    // room for smaller grains alone
        cells = {everywhere};
        cells_for = size;
      }
      if (!refine()) return false;
      tries = cells.size();
    }
  }

  std::vector<Grain> grains;

  static double uniform(std::mt19937_64 &random)    // the standard's own distributions differ by library
  {
    return (random() >> 11) * 0x1.0p-53;
  }

 private:
  struct Cell {    // all cells in a list have the same area, as area is dz dphi
    double z0, z1, phi0, phi1;
  };

  double zlo, carrier, least, size;
  std::vector<Cell> cells;    // where there may be room for a grain of a size; empty as long as nearly anywhere
  double cells_for;           // that size, at most the next grain's
  size_t tries;               // in these cells, until the next refinement
  ShellGrid grid;
  std::mt19937_64 &random;

  // squared chord that keeps a grain's direction off another's, from the triangle of both centres and the carrier's
  double least_chord2(double a, double b) const
  {
    const double touch = (a + b) * (1.0 + MIN_GAP), step = a - b;
    return (touch * touch - step * step) / ((carrier + a) * (carrier + b));
  }
  double reach() const { return 2.0 * std::asin(std::min(1.0, 0.5 * std::sqrt(least_chord2(size, size)))); }

  bool try_cell(const Cell &cell)
  {
    Grain grain;
    grain.radius = size;
    const double z = cell.z0 + uniform(random) * (cell.z1 - cell.z0);
    point_at(z, cell.phi0 + uniform(random) * (cell.phi1 - cell.phi0), grain.n);
    if (grid.any_near(grain.n,
                      [&](int id) { return chord2(grain.n, grains[id].n) < least_chord2(size, grains[id].radius); }))
      return false;
    grid.insert(static_cast<int>(grains.size()), grain.n);
    grains.push_back(grain);
    return true;
  }

  // true if one grain excludes the whole cell: the cell's farthest points are corners once it is narrower than pi/2
  bool covered(const Cell &cell) const
  {
    if (cell.phi1 - cell.phi0 > 0.5 * PI) return false;
    double middle[3], corner[4][3];
    point_at(0.5 * (cell.z0 + cell.z1), 0.5 * (cell.phi0 + cell.phi1), middle);
    point_at(cell.z0, cell.phi0, corner[0]);
    point_at(cell.z0, cell.phi1, corner[1]);
    point_at(cell.z1, cell.phi0, corner[2]);
    point_at(cell.z1, cell.phi1, corner[3]);
    double radius = 0.0;
    for (auto &c : corner) radius = std::max(radius, std::sqrt(chord2(middle, c)));
    return grid.any_near(middle, [&](int id) {
      const double limit =
          std::sqrt(least_chord2(cells_for, grains[id].radius)) - radius;    // chords obey the triangle inequality
      return limit > 0.0 && chord2(middle, grains[id].n) < limit * limit;
    });
  }

  // quarters the cells until most are smaller than a grain's surroundings, and drops those without room
  bool refine()
  {
    const double wide = 0.5 * reach();
    do {
      if ((cells.empty()) || (cells[0].z1 - cells[0].z0 < 1.0e-12)) return false;
      std::vector<Cell> finer;
      for (const Cell &c : cells) {
        const double z = 0.5 * (c.z0 + c.z1), phi = 0.5 * (c.phi0 + c.phi1);
        for (const Cell &quarter : {Cell{c.z0, z, c.phi0, phi}, Cell{z, c.z1, c.phi0, phi}, Cell{c.z0, z, phi, c.phi1},
                                    Cell{z, c.z1, phi, c.phi1}})
          if (!covered(quarter)) finer.push_back(quarter);
      }
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

[[noreturn]] void fail(const std::string &what) { throw TextureError(what); }

std::string text(double x)
{
  char buf[32];
  std::snprintf(buf, sizeof(buf), "%.6g", x);
  return buf;
}

void check_sizes(double carrier_radius, double grain_radius, const BareCap &bare)
{
  if (!(carrier_radius > 0.0 && std::isfinite(carrier_radius)))
    fail("carrier diameter " + text(2.0 * carrier_radius) + " is not above 0");
  if (!(grain_radius > 0.0 && std::isfinite(grain_radius)))
    fail("grain diameter " + text(2.0 * grain_radius) + " is not above 0");
  if (grain_radius >= carrier_radius)
    fail("grain diameter " + text(2.0 * grain_radius) + " is not below the carrier's " + text(2.0 * carrier_radius));
  if (!(bare.half_angle >= 0.0 && bare.half_angle < PI))
    fail("bare half-angle " + text(bare.half_angle) + " is not between 0 and pi");
}

void check_coverage(double coverage)
{
  if (!(coverage > 0.0 && std::isfinite(coverage))) fail("coverage " + text(coverage) + " is not above 0");
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

/* ----------------------------------------------------------------------
   by volume between the cuts, taken with the probability (finest/x)^3: by number
------------------------------------------------------------------------- */

static std::vector<double> draw_radii(const SizeDistribution &sizes, double sum_of_squares, std::mt19937_64 &random)
{
  const double finest = sizes.quantile(CUT), coarsest = sizes.quantile(1.0 - CUT);
  std::vector<double> radii;
  for (double sum = 0.0; sum < sum_of_squares;) {
    double x;
    if (sizes.kind == SizeDistribution::RRSB) {
      x = sizes.quantile(CUT + (1.0 - 2.0 * CUT) * Placement::uniform(random));
    } else {    // Box and Muller
      const double r = std::sqrt(-2.0 * std::log1p(-Placement::uniform(random)));
      x = sizes.x50 * std::pow(sizes.spread, r * std::cos(2.0 * PI * Placement::uniform(random)));
      if (x < finest || x > coarsest) continue;
    }
    if (Placement::uniform(random) > std::pow(finest / x, 3)) continue;
    radii.push_back(0.5 * x);
    sum += 0.25 * x * x;
    if (radii.size() > MOST_GRAINS) fail("coverage with these grain sizes is more than 1e8 grains");
  }
  std::sort(radii.begin(), radii.end(), std::greater<double>());
  return radii;
}

/* ---------------------------------------------------------------------- */

static Texture place(double carrier_radius, const std::vector<double> &radii, double coverage, const BareCap &bare,
                     std::mt19937_64 &random)
{
  Placement placement(-std::cos(bare.half_angle), carrier_radius, radii.front(), radii.back(), random);
  double sum = 0.0;
  for (const double radius : radii) {
    if (!placement.place(radius))
      fail("coverage " + text(coverage) + " cannot be placed: the monolayer is full at " +
           text(0.25 * sum / (carrier_radius * carrier_radius)) + " (" + std::to_string(placement.grains.size()) +
           " of " + std::to_string(radii.size()) + " grains)");
    sum += radius * radius;
  }
  for (Grain &grain : placement.grains) turn_from_south(bare.axis, grain.n);
  return {carrier_radius, bare, placement.grains};
}

/* ---------------------------------------------------------------------- */

Texture Dust::place_monolayer(double carrier_radius, double grain_radius, double coverage, const BareCap &bare,
                              uint64_t seed)
{
  check_sizes(carrier_radius, grain_radius, bare);
  check_coverage(coverage);
  const double wanted = grains_for_coverage(coverage, carrier_radius, grain_radius);
  if (wanted < 1.0) fail("coverage " + text(coverage) + " is less than one grain");
  if (wanted > MOST_GRAINS) fail("coverage " + text(coverage) + " with this grain diameter is more than 1e8 grains");
  std::mt19937_64 random(seed);
  return place(carrier_radius, std::vector<double>(static_cast<size_t>(wanted), grain_radius), coverage, bare, random);
}

/* ---------------------------------------------------------------------- */

Texture Dust::place_monolayer(double carrier_radius, const SizeDistribution &sizes, double coverage,
                              const BareCap &bare, uint64_t seed)
{
  if (!(sizes.x50 > 0.0 && std::isfinite(sizes.x50))) fail("median diameter " + text(sizes.x50) + " is not above 0");
  const bool lognormal = sizes.kind == SizeDistribution::LOGNORMAL;
  if (!(sizes.spread > (lognormal ? 1.0 : 0.0) && std::isfinite(sizes.spread)))
    fail(lognormal ? "geometric standard deviation " + text(sizes.spread) + " is not above 1"
                   : "exponent " + text(sizes.spread) + " is not above 0");
  check_sizes(carrier_radius, 0.5 * sizes.quantile(1.0 - CUT), bare);
  check_coverage(coverage);
  std::mt19937_64 random(seed);
  return place(carrier_radius, draw_radii(sizes, 4.0 * coverage * carrier_radius * carrier_radius, random), coverage,
               bare, random);
}

/* ---------------------------------------------------------------------- */

void Dust::check_texture(const Texture &texture)
{
  double largest = 0.0;
  for (const Grain &grain : texture.grains) {
    check_sizes(texture.carrier_radius, grain.radius, texture.bare);
    largest = std::max(largest, grain.radius);
  }
  if (texture.grains.empty()) fail("there is no grain");

  const double tolerance = 1.0e-9;    // round-off of the text, of the grain's size or of 1 rad
  const double cos_cap = std::cos(std::max(0.0, texture.bare.half_angle - tolerance));
  ShellGrid grid(2.0 * std::asin(largest / (texture.carrier_radius + largest)));
  for (size_t i = 0; i < texture.grains.size(); i++) {
    const Grain &a = texture.grains[i];
    if (texture.bare.half_angle > 0.0 && dot(a.n, texture.bare.axis) > cos_cap)
      fail("grain " + std::to_string(i + 1) + " lies in the bare cap");
    size_t other = 0;
    const double ra = texture.carrier_radius + a.radius;
    const bool overlap = grid.any_near(a.n, [&](int id) {
      const Grain &b = texture.grains[id];
      const double rb = texture.carrier_radius + b.radius;
      other = id;
      const double distance2 = (ra - rb) * (ra - rb) + ra * rb * chord2(a.n, b.n);
      const double touch = (a.radius + b.radius) * (1.0 - tolerance);
      return distance2 < touch * touch;
    });
    if (overlap) fail("grains " + std::to_string(other + 1) + " and " + std::to_string(i + 1) + " overlap");
    grid.insert(static_cast<int>(i), a.n);
  }
}

/* ---------------------------------------------------------------------- */

void Dust::write_texture(const Texture &texture, std::ostream &out)
{
  char line[160];
  const BareCap &bare = texture.bare;
  out << "# dust texture 1\n";
  std::snprintf(line, sizeof(line), "carrier_diameter %.17g\nbare %.17g %.17g %.17g %.17g\n",
                2.0 * texture.carrier_radius, bare.half_angle, bare.axis[0], bare.axis[1], bare.axis[2]);
  out << line << "grains " << texture.grains.size() << "\n# nx ny nz diameter\n";
  for (const Grain &g : texture.grains) {
    std::snprintf(line, sizeof(line), "%.17g %.17g %.17g %.17g\n", g.n[0], g.n[1], g.n[2], 2.0 * g.radius);
    out << line;
  }
  out << "end\n";
}

/* ---------------------------------------------------------------------- */

Texture Dust::read_texture(std::istream &in)
{
  Texture texture;
  std::string line;
  int lineno = 0;
  const auto fail_here = [&](const std::string &what) { fail("line " + std::to_string(lineno) + ": " + what); };

  const auto next_line = [&](const std::string &expected) {
    do {
      lineno++;
      if (!std::getline(in, line)) fail_here("the file ends where " + expected + " should be: it is cut off");
      if (!line.empty() && line.back() == '\r') line.pop_back();
    } while (lineno > 1 && (line.empty() || line[0] == '#'));
  };
  // the numbers of a line after the word it starts with; each must be finite
  const auto numbers = [&](const std::string &word, size_t n) {
    next_line(word.empty() ? "a grain" : "'" + word + "'");
    std::istringstream words(line);
    std::string token;
    if (!word.empty() && (!(words >> token) || token != word))
      fail_here("'" + word + "' should be here, not '" + line + "'");
    std::vector<double> values;
    while (words >> token) {
      char *rest;
      const double value = std::strtod(token.c_str(), &rest);
      if (*rest || !std::isfinite(value)) fail_here("'" + token + "' is not a finite number");
      values.push_back(value);
    }
    if (values.size() != n)
      fail_here(std::to_string(n) + " numbers should be here, not " + std::to_string(values.size()));
    return values;
  };
  // unit vector, as written if it is one to round-off, so that a texture survives being written and read
  const auto unit_vector = [&](const double *v, double *n) {
    const double length = std::sqrt(dot(v, v));
    if (std::fabs(length - 1.0) > 1.0e-3) fail_here("the direction has length " + text(length) + ", not 1");
    const double scale = std::fabs(length - 1.0) < 1.0e-12 ? 1.0 : 1.0 / length;
    for (int d = 0; d < 3; d++) n[d] = v[d] * scale;
  };

  next_line("'# dust texture 1'");
  if (line != "# dust texture 1") fail_here("a texture file starts with '# dust texture 1'");
  texture.carrier_radius = 0.5 * numbers("carrier_diameter", 1)[0];
  const std::vector<double> bare = numbers("bare", 4);
  texture.bare.half_angle = bare[0];
  unit_vector(&bare[1], texture.bare.axis);
  const double n = numbers("grains", 1)[0];
  if (n < 1.0 || n > 1.0e8 || n != std::floor(n)) fail_here("the number of grains is not between 1 and 1e8");
  for (int i = 0; i < static_cast<int>(n); i++) {
    const std::vector<double> v = numbers("", 4);
    Grain grain;
    unit_vector(v.data(), grain.n);
    grain.radius = 0.5 * v[3];
    if (!(grain.radius > 0.0)) fail_here("grain diameter " + text(v[3]) + " is not above 0");
    texture.grains.push_back(grain);
  }
  next_line("'end'");
  if (line != "end") fail_here("'end' should be here, after " + std::to_string(texture.grains.size()) + " grains");
  while (lineno++, std::getline(in, line))
    if (!line.empty() && line != "\r" && line[0] != '#') fail_here("nothing but comments may follow 'end'");
  check_texture(texture);
  return texture;
}
