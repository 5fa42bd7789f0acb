// The reference case in units si: the defaults of doc/fix_dust_detach.rst, grains of 20 um on carriers of 1.5 mm

#ifndef DUST_TEST_REFERENCE_CASE_H
#define DUST_TEST_REFERENCE_CASE_H

#include "grain_table.h"
#include "hamaker.h"
#include "jkr.h"
#include "texture_placement.h"

#include <cmath>

constexpr double RP = 0.75e-3, RD = 10.0e-6, SHELL = RP + RD;
constexpr double NO_SPIN[3] = {0.0, 0.0, 0.0};
const Dust::Material CALCITE = {2700.0, Dust::surface_energy(std::sqrt(10.1e-20 * 21.2e-20), 0.4e-9),
                                Dust::combined_modulus(75.0e9, 0.3, 210.0e9, 0.3), 0.3, 0.15};
constexpr double GRAIN_MASS = 4.0 / 3.0 * M_PI * RD * RD * RD * 2700.0;
const double HOLD = Dust::pull_off_force(CALCITE.gamma, Dust::effective_radius(RP, RD)) / GRAIN_MASS;

#endif
