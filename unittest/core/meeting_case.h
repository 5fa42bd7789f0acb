// Grains at given places of the reference carrier, that may meet each other

#ifndef DUST_TEST_MEETING_CASE_H
#define DUST_TEST_MEETING_CASE_H

#include "grain_table.h"
#include "reference_case.h"

#include <cmath>
#include <vector>

// calcite grains with the softening of the contacts among them
inline Dust::Material meeting(double softening = 100.0)
{
  Dust::Material m = CALCITE;
  m.cohesion = 10.1 / 14.633;
  m.grain_modulus = Dust::combined_modulus(75.0e9, 0.3, 75.0e9, 0.3);
  m.softening = softening;
  m.step = 10.0e-9;
  return m;
}

inline Dust::Criteria meeting_criteria()
{
  Dust::Criteria criteria;
  criteria.tangential = Dust::Criteria::INTEGRATE;
  criteria.meet = true;
  return criteria;
}

// grains on the great circle in the plane of x and z, at these angles from z
inline Dust::Texture on_circle(const std::vector<double> &angles, const std::vector<double> &radii)
{
  Dust::Texture texture;
  texture.carrier_radius = RP;
  for (size_t k = 0; k < angles.size(); k++) {
    Dust::Grain grain = {};
    grain.n[0] = std::sin(angles[k]);
    grain.n[2] = std::cos(angles[k]);
    grain.radius = radii[k];
    grain.adhesion = 1.0;
    texture.grains.push_back(grain);
  }
  return texture;
}

// the bit of a grain of the texture
inline int bit_of(const Dust::GrainTable &table, int grain)
{
  int bit = 0;
  while (table.grain(bit) != grain) bit++;
  return bit;
}

#endif
