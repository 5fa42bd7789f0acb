// Contacts of grains computed many at once: each as if it were alone, and what a single one must be. That the bits are
// LAMMPS' own stands in unittest/styles/test_pair_granular_fused.cpp.

#include "grain_contacts.h"
#include "hamaker.h"
#include "jkr.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace {

using Dust::GrainBatch;
using Dust::Vector;

const double HAMAKER = 14.633e-20, Z0 = 0.4e-9, MODULUS = 6.073e10, CARRIER = 0.75e-3, GRAIN = 10e-6;
const double GAMMA = Dust::surface_energy(HAMAKER, Z0), R = Dust::effective_radius(CARRIER, GRAIN);
const double FC = Dust::pull_off_force(GAMMA, R), A0 = Dust::equilibrium_contact_radius(GAMMA, R, MODULUS);

struct Contact {
  double overlap;
  double neck;
  Vector direction, velocity, turning, spin, shear, rolling;
};

void add(GrainBatch &b, const Contact &c, bool synchronized = false)
{
  const int k = b.count++;
  const Vector dx = (CARRIER + GRAIN - c.overlap) * c.direction;
  b.dx.set(k, dx);
  b.rsq[k] = dot(dx, dx);
  b.radius_i[k] = CARRIER;
  b.radius_j[k] = GRAIN;
  b.effective_radius[k] = R;
  b.velocity.set(k, c.velocity);
  b.turning.set(k, c.turning);
  b.spin.set(k, c.spin);
  b.shear.set(k, c.shear);
  b.rolling.set(k, c.rolling);
  b.neck[k] = c.neck;
  b.overlap[k] = std::copysign(c.overlap, c.neck);
  b.coasting[k] = b.rate[k] = 0.0;
  b.mass[k] = 1.131e-11;
  b.half[k] = synchronized ? 5e-10 : 0.0;
  b.synchronized |= synchronized;
  b.damping[k] = 1e13;
  b.shear_stiffness[k] = 1e11;
  b.shear_damping[k] = 0.0;
  b.friction[k] = 0.3;
  b.hamaker[k] = HAMAKER;
  b.z0[k] = Z0;
  b.range[k] = 9.0 * Z0;
  b.pull_off_force[k] = FC;
  b.equilibrium_radius[k] = A0;
  b.breaking_gap[k] = Dust::breaking_gap(A0, R);
  b.theta_crit[k] = 0.15;
}

std::vector<double> result(const GrainBatch &b, int k)
{
  std::vector<double> all = {b.neck[k], b.overlap[k], b.coasting[k], b.rate[k], b.events[k]};
  for (const auto *v : {&b.force, &b.torque_i, &b.torque_j, &b.shear, &b.rolling})
    for (const double x : {v->x[k], v->y[k], v->z[k]}) all.push_back(x);
  return all;
}

// some with a neck, of either sign, some about to touch or to break
std::vector<Contact> at_random()
{
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const auto vector = [&](double size) { return Vector{size * u(engine), size * u(engine), size * u(engine)}; };
  std::vector<Contact> contacts;
  for (int k = 0; k < GrainBatch::COUNT; k++) {
    const Vector n = vector(1.0);
    const double neck = k % 3 ? std::copysign(0.7 + 0.3 * u(engine), u(engine)) : 0.0;
    contacts.push_back({0.4e-9 * u(engine), neck, (1.0 / std::sqrt(dot(n, n))) * n, vector(1.0), vector(1.0),
                        vector(1e4), vector(1e-9), vector(1e-7)});
  }
  return contacts;
}

}    // namespace

TEST(GrainContacts, EachAsIfItWereAlone)
{
  for (const bool synchronized : {false, true})
    for (const bool move : {false, true}) {
      const std::vector<Contact> contacts = at_random();
      GrainBatch all = {}, one = {};
      for (const Contact &c : contacts) add(all, c, synchronized);
      Dust::compute_forces(all, 1e-9, move);
      for (int k = 0; k < GrainBatch::COUNT; k++) {
        one = {};
        add(one, contacts[k], synchronized);
        Dust::compute_forces(one, 1e-9, move);
        const std::vector<double> a = result(all, k), b = result(one, 0);
        EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)), 0) << k;
      }
    }
}

// the neck forms at contact, holds to the end of the branch, and breaks there; Hamaker's attraction without one
TEST(GrainContacts, Neck)
{
  const Vector up = {0.0, 0.0, 1.0}, none = {0.0, 0.0, 0.0};
  const double end = Dust::breaking_gap(A0, R);
  const Contact touching = {0.0, 0.0, up, none, none, none, none, none};
  Contact held = touching, broken = touching, free = touching;
  held.neck = broken.neck = -0.5;
  held.overlap = -0.9 * end;
  broken.overlap = -1.01 * end;
  free.overlap = -0.2e-9;
  GrainBatch b = {};
  for (const Contact &c : {touching, held, broken, free}) add(b, c);
  Dust::compute_forces(b, 1e-9, true);
  EXPECT_NEAR(b.force.z[0], -8.0 / 9.0 * FC, 1e-6 * FC);    // physics.md, the check point at an overlap of 0
  EXPECT_NEAR(b.neck[0], std::pow(2.0 / 3.0, 2.0 / 3.0), 1e-6);
  EXPECT_NEAR(b.neck[1], -Dust::jkr_contact_radius(-0.9), 1e-6);
  EXPECT_EQ(b.neck[2], 0.0);
  EXPECT_NEAR(b.force.z[2], -Dust::hamaker_force(HAMAKER, Z0, R, 1.01 * end), 1e-3 * FC);
  EXPECT_NEAR(b.force.z[3], -Dust::hamaker_force(HAMAKER, Z0, R, 0.2e-9), 1e-3 * FC);
  EXPECT_EQ(b.events[0], GrainBatch::NECK);
  EXPECT_EQ(b.events[1], 0.0);
  EXPECT_EQ(b.events[2], GrainBatch::NECK);
  EXPECT_EQ(b.events[3], 0.0);
}
