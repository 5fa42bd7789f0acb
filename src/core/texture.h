/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_TEXTURE_H
#define DUST_CORE_TEXTURE_H

#include <stdexcept>
#include <string>
#include <vector>

namespace Dust {

/*! A texture that cannot be made, read or used; what() names the cause in one line */
class TextureError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/*! The part of a carrier that holds no grains: all centres closer than half_angle (rad) to axis (unit vector) */
struct BareCap {
  double half_angle = 0.33;
  double axis[3] = {0.0, 0.0, -1.0};
};

/*! Half-angle (rad) of the cap that a carrier of steel needs so that no grain reaches a wall of steel before the
 *  carrier's largest overlap delta, up to an impact at 20 m/s: cos(half_angle) = (R_p - R_d - delta)/(R_p + R_d),
 *  rounded up to hundredths. delta/R_p is the same for all sizes, so radii may have any unit; 0.33 for 20 um on
 *  1.5 mm */
double bare_half_angle(double carrier_radius, double largest_grain_radius);

/*! One grain: unit vector from the carrier's centre to the grain's, and the grain's radius (length) */
struct Grain {
  double n[3];
  double radius;
};

/*! The grains that adhere to a carrier, as they touch it: centres at carrier_radius + radius */
struct Texture {
  double carrier_radius;
  BareCap bare;
  std::vector<Grain> grains;
};

/*! More grains than this are not handled: they would need gigabytes and minutes */
constexpr double MOST_GRAINS = 5.0e7;

/*! A number as messages print it */
std::string number_text(double);

/*! Throws TextureError if the radii (length) or the cap cannot be those of a texture */
void check_sizes(double carrier_radius, double grain_radius, const BareCap &bare);

/*! No grain inside the bare cap, wider than the carrier or overlapping another; throws TextureError naming the grains
 *
 * \param lines  of a file in which the grains stand, to be named in their place; or none */
void check_texture(const Texture &texture, const std::vector<int> &lines = {});

}    // namespace Dust

#endif
