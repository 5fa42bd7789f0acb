// The surface energy, and with it the constants of the adhesive contact: those of the reference case worked out by
// hand.

#include "hamaker.h"
#include "jkr.h"

#include <gtest/gtest.h>

#include <cmath>

TEST(Hamaker, ReferenceGrainOnItsCarrier)
{
  const double hamaker = std::sqrt(10.1e-20 * 21.2e-20);
  const double gamma = Dust::surface_energy(hamaker, 0.4e-9);
  const double r12 = Dust::effective_radius(0.75e-3, 10.0e-6);
  const double modulus = Dust::combined_modulus(75.0e9, 0.3, 210.0e9, 0.3);
  EXPECT_NEAR(gamma, 0.016173, 0.5e-6);
  EXPECT_NEAR(r12, 9.8684e-6, 0.5e-10);
  EXPECT_NEAR(modulus, 6.073e10, 0.5e7);
  EXPECT_NEAR(Dust::pull_off_force(gamma, r12), 1.5042e-6, 0.5e-10);
  EXPECT_NEAR(Dust::equilibrium_contact_radius(gamma, r12, modulus), 90.18e-9, 0.5e-11);
}

TEST(Hamaker, PullOffForceIsTheVanDerWaalsForceAtTheLeastDistance)
{
  const double hamaker = 3.0e-20, z0 = 0.3e-9, r12 = 4.0e-6;
  EXPECT_DOUBLE_EQ(Dust::pull_off_force(Dust::surface_energy(hamaker, z0), r12), hamaker * r12 / (6.0 * z0 * z0));
}

TEST(Hamaker, EffectiveRadiusAgainstAFlatWall)
{
  EXPECT_NEAR(Dust::effective_radius(1.0, 1.0e12), 1.0, 1.0e-11);
  EXPECT_DOUBLE_EQ(Dust::effective_radius(2.0, 2.0), 1.0);
}
