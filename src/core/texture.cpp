/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "texture.h"

#include "geometry.h"
#include "shell_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace Dust;

/* ---------------------------------------------------------------------- */

std::string Dust::number_text(double x)
{
  char buf[32];
  std::snprintf(buf, sizeof(buf), "%.6g", x);
  return buf;
}

/* ---------------------------------------------------------------------- */

double Dust::bare_half_angle(double carrier_radius, double largest_grain_radius)
{
  // (15/16 (4/3) pi rho v^2/E*)^(2/5) with rho = 7700 kg/m3, v = 20 m/s and E* = 1.154e11 Pa (hertz.h)
  constexpr double OVERLAP = 0.025597;
  const double level =
      ((1.0 - OVERLAP) * carrier_radius - largest_grain_radius) / (carrier_radius + largest_grain_radius);
  return std::ceil(100.0 * std::acos(level)) / 100.0;
}

/* ---------------------------------------------------------------------- */

void Dust::check_sizes(double carrier_radius, double grain_radius, const BareCap &bare)
{
  if (!(carrier_radius > 0.0 && std::isfinite(carrier_radius)))
    throw TextureError("carrier diameter " + number_text(2.0 * carrier_radius) + " is not above 0");
  if (!(grain_radius > 0.0 && std::isfinite(grain_radius)))
    throw TextureError("grain diameter " + number_text(2.0 * grain_radius) + " is not above 0");
  if (2.0 * grain_radius >= carrier_radius)
    throw TextureError("grain diameter " + number_text(2.0 * grain_radius) + " is not below the carrier's radius, " +
                       number_text(carrier_radius));
  if (!(bare.half_angle >= 0.0 && bare.half_angle < PI))
    throw TextureError("bare half-angle " + number_text(bare.half_angle) + " is not between 0 and pi");
}

/* ---------------------------------------------------------------------- */

void Dust::check_texture(const Texture &texture, const std::vector<int> &lines)
{
  const auto name = [&](size_t grain) {
    return lines.empty() ? "grain " + std::to_string(grain + 1) : "line " + std::to_string(lines[grain]);
  };
  double largest = 0.0;
  for (const Grain &grain : texture.grains) {
    check_sizes(texture.carrier_radius, grain.radius, texture.bare);
    largest = std::max(largest, grain.radius);
  }
  if (texture.grains.empty()) throw TextureError("there is no grain");

  const double tolerance = 1.0e-9;    // round-off of the text, of the grain's size or of 1 rad
  const double cos_cap = std::cos(std::max(0.0, texture.bare.half_angle - tolerance));
  const double reach = 2.0 * std::asin(largest / (texture.carrier_radius + largest));
  const Neighbourhood near(reach);
  ShellGrid grid(reach, texture.grains.size());
  for (size_t i = 0; i < texture.grains.size(); i++) {
    const Grain &a = texture.grains[i];
    if (texture.bare.half_angle > 0.0 && dot(a.n, texture.bare.axis) > cos_cap)
      throw TextureError(name(i) + ": the grain lies in the bare cap, " +
                         number_text(std::acos(std::min(1.0, dot(a.n, texture.bare.axis)))) +
                         " rad from its axis: it must be " + number_text(texture.bare.half_angle) + " at least");
    size_t other = 0;
    const double ra = texture.carrier_radius + a.radius;
    const bool overlap = grid.any_near(a.n, near, [&](int id, double chord2) {
      const Grain &b = texture.grains[id];
      const double rb = texture.carrier_radius + b.radius;
      other = id;
      const double distance2 = (ra - rb) * (ra - rb) + ra * rb * chord2;
      const double touch = (a.radius + b.radius) * (1.0 - tolerance);
      return distance2 < touch * touch;
    });
    if (overlap) throw TextureError(name(i) + ": the grain overlaps that of " + name(other));
    grid.insert(static_cast<int>(i), a.n);
  }
}
