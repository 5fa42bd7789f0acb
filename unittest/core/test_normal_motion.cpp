// Grains that ring in their contacts, against closed forms and a reference in tiny steps.

#include "normal_motion.h"

#include "hamaker.h"
#include "jkr.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

using namespace Dust;

namespace {

constexpr double RP = 0.75e-3, RD = 10.0e-6, MASS = 4.0 / 3.0 * M_PI * RD * RD * RD * 2700.0;
const double GAMMA = surface_energy(std::sqrt(10.1e-20 * 21.2e-20), 0.4e-9), MODULUS = combined_modulus(75.0e9, 0.3, 210.0e9, 0.3);
const double R12 = effective_radius(RP, RD), FC = pull_off_force(GAMMA, R12), HOLD = FC / MASS;
const double A0 = equilibrium_contact_radius(GAMMA, R12, MODULUS), D0 = equilibrium_overlap(A0, R12), DC = breaking_gap(A0, R12);
const double FREQUENCY = std::sqrt(1.2 * MODULUS * A0 / MASS);    // of small swings

struct Alone {
  NormalMotion motion;
  explicit Alone(double damping, double load = 0.0) : motion(damping) { motion.add(HOLD, DC, load); }
  void advance(double load, double time, int steps = 1)
  {
    for (int k = 0; k < steps; k++) motion.advance(&load, time / steps);
  }
  // a kick that leaves no time to move
  void kick(double speed)
  {
    const double time = 1.0e-6 / FREQUENCY, load = -speed / (HOLD * time);
    advance(load, 0.0);
    advance(load, time);
    advance(0.0, 0.0);
  }
};

}    // namespace
