/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "whereabouts.h"

#include "lanes.h"

#include <cstdint>

using namespace Dust;

/* ---------------------------------------------------------------------- */

void Whereabouts::note(const double *x, const double *radius, int n)
{
  x_then.assign(x, x + std::size_t(3) * n);
  radius_then.assign(radius, radius + n);
}

/* ----------------------------------------------------------------------
   a coordinate that is no number has left, too
------------------------------------------------------------------------- */

DUST_LANES static std::int64_t count_left(const double *x, const double *x_then, const double *radius,
                                          const double *radius_then, int n, double distance)
{
  std::int64_t left = 0;
  for (int i = 0; i < n; i++) {
    const double dx = x[3 * i] - x_then[3 * i], dy = x[3 * i + 1] - x_then[3 * i + 1];
    const double dz = x[3 * i + 2] - x_then[3 * i + 2], grown = radius[i] - radius_then[i];
    const double may = distance - (grown > 0.0 ? 2.0 * grown : 0.0);
    const bool stays = (may >= 0.0) & (dx * dx + dy * dy + dz * dz <= may * may);
    left += !stays;
  }
  return left;
}

bool Whereabouts::left(const double *x, const double *radius, int n, double distance) const
{
  if (radius_then.size() != std::size_t(n)) return true;
  return count_left(x, x_then.data(), radius, radius_then.data(), n, distance) != 0;
}
