/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "texture_placement.h"

#include "geometry.h"
#include "random_numbers.h"
#include "sequential_placement.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace Dust;

namespace {

constexpr double CUT = 0.01;        // of a size distribution, at either end, by volume
constexpr double JAMMED = 0.547;    // share of the shell of their centres that equal grains cover when no more fit

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
  SequentialPlacement placement(-std::cos(bare.half_angle), carrier_radius, radii, random,
                                SequentialPlacement::long_patience(radii));
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
  const double share = JAMMED / ((1.0 + SequentialPlacement::MIN_GAP) * (1.0 + SequentialPlacement::MIN_GAP));
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
