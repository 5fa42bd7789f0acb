// Contacts of carriers computed many at once: each as if it were alone, and what a single one must be. That the bits
// are LAMMPS' own stands in unittest/styles/test_pair_granular_fused.cpp.

#include "damping.h"
#include "hertz_contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace {

using Dust::HertzBatch;
using Dust::Vector;

struct Contact {
  Vector dx, velocity, turning, shear;
  double radius_i, radius_j, mass, half, damping, shear_damping, friction;
};

void add(HertzBatch &b, const Contact &c)
{
  const int k = b.count++;
  b.dx.set(k, c.dx);
  b.velocity.set(k, c.velocity);
  b.turning.set(k, c.turning);
  b.shear.set(k, c.shear);
  b.rsq[k] = dot(c.dx, c.dx);
  b.radius_i[k] = c.radius_i;
  b.radius_j[k] = c.radius_j;
  b.mass[k] = c.mass;
  b.half[k] = c.half;
  b.damping[k] = c.damping;
  b.stiffness[k] = 1.5e8;
  b.shear_stiffness[k] = 1.0e8;
  b.shear_damping[k] = c.shear_damping;
  b.friction[k] = c.friction;
  b.synchronized |= c.half > 0.0;
  b.shear_damped |= c.shear_damping > 0.0;
}

std::vector<double> result(const HertzBatch &b, int k)
{
  std::vector<double> all;
  for (const auto *v : {&b.force, &b.torque_i, &b.torque_j, &b.shear})
    for (const double x : {v->x[k], v->y[k], v->z[k]}) all.push_back(x);
  return all;
}

std::vector<Contact> at_random(bool synchronized)
{
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const auto vector = [&](double size) { return Vector{size * u(engine), size * u(engine), size * u(engine)}; };
  std::vector<Contact> contacts;
  for (int k = 0; k < HertzBatch::COUNT; k++) {
    Contact c = {vector(1.0),
                 vector(1.0),
                 vector(1.0),
                 vector(1e-6),
                 0.7e-3 + 1e-4 * u(engine),
                 0.7e-3,
                 7e-6,
                 synchronized && k % 3 ? 5e-7 : 0.0,
                 0.3,
                 k % 2 ? 0.2 : 0.0,
                 k % 5 ? 0.3 : 0.0};
    const double overlap = 1e-5 * (1.0 + u(engine));
    c.dx = ((c.radius_i + c.radius_j - overlap) / std::sqrt(dot(c.dx, c.dx))) * c.dx;
    contacts.push_back(c);
  }
  return contacts;
}

}    // namespace

TEST(HertzContacts, EachAsIfItWereAlone)
{
  for (const bool synchronized : {false, true})
    for (const bool move : {false, true}) {
      const std::vector<Contact> contacts = at_random(synchronized);
      HertzBatch all = {}, one = {};
      for (const Contact &c : contacts) add(all, c);
      Dust::compute_forces(all, 1e-6, move);
      for (int k = 0; k < HertzBatch::COUNT; k++) {
        one = {};
        add(one, contacts[k]);
        Dust::compute_forces(one, 1e-6, move);
        const std::vector<double> a = result(all, k), b = result(one, 0);
        EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)), 0) << k;
      }
    }
}

// F = 4/3 E* sqrt(R) delta^(3/2), and no pull however fast the spheres part
TEST(HertzContacts, HeadOn)
{
  HertzBatch b = {};
  Contact c = {{0.0, 0.0, 1.39e-3},
               {0.0, 0.0, 0.0},
               {0.0, 0.0, 0.0},
               {0.0, 0.0, 0.0},
               0.7e-3,
               0.7e-3,
               7e-6,
               0.0,
               Dust::hertz_damping(0.5),
               0.0,
               0.3};
  add(b, c);
  c.velocity.z = 100.0;
  add(b, c);
  Dust::compute_forces(b, 1e-6, true);
  EXPECT_NEAR(b.force.z[0], 1.5e8 * std::sqrt(0.35e-3) * std::pow(1e-5, 1.5), 1e-9);
  EXPECT_EQ(b.force.z[1], 0.0);
  EXPECT_EQ(b.torque_i.x[0], 0.0);
}
