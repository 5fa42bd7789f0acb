/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_COAT_H
#define LMP_DUST_COAT_H

#include "core/grain_table.h"
#include "core/texture.h"
#include "detach_settings.h"

#include <cmath>
#include <memory>

namespace LAMMPS_NS {

// the texture that all carriers of a fix share, made ready once their size is known

struct DustCoat {
  double radius = 0.0;    // of the carriers, 0 until then
  Dust::Texture texture;
  std::unique_ptr<Dust::GrainTable> table;
  double checksum = 0.0;    // tells this texture from another one in a restart file

  explicit operator bool() const { return table != nullptr; }

  // on all ranks at once, for a radius that is set
  void make(const DetachSettings &settings)
  {
    texture = settings.texture(radius);
    const Dust::Material material = {settings.density,  settings.surface_energy, settings.modulus(),
                                     settings.friction, settings.rolling,        settings.damping};
    table = std::make_unique<Dust::GrainTable>(texture, material, settings.criteria);
    checksum = 0.0;
    int i = 0;
    for (const Dust::Grain &g : texture.grains)
      checksum += std::cos(++i) * (g.n[0] + 2.0 * g.n[1] + 3.0 * g.n[2] + g.radius / radius + (g.adhesion - 1.0));
  }

  bool is_that_of(double file_checksum) const
  {
    return std::fabs(file_checksum - checksum) <= 1.0e-9 * (1.0 + std::fabs(file_checksum));
  }
};

}    // namespace LAMMPS_NS

#endif
