// Placement of grains: exact coverage, no overlap, bare cap, uniform, reproducible; what cannot be is refused at once.

#include "texture_placement.h"

#include "texture_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

using namespace Dust;

namespace {

constexpr double RP = 0.75e-3, RD = 10.0e-6;

double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// smallest gap between two grains, by comparing all pairs
double least_gap(const Texture &t)
{
  double least = 1.0;
  for (size_t i = 0; i < t.grains.size(); i++)
    for (size_t j = 0; j < i; j++) {
      const Grain &a = t.grains[i], &b = t.grains[j];
      double d2 = 0.0;
      for (int k = 0; k < 3; k++) {
        const double d = (t.carrier_radius + a.radius) * a.n[k] - (t.carrier_radius + b.radius) * b.n[k];
        d2 += d * d;
      }
      least = std::min(least, std::sqrt(d2) - a.radius - b.radius);
    }
  return least;
}

std::string placing_error(double rp, double rd, double coverage)
{
  try {
    place_monolayer(rp, rd, coverage, BareCap(), 1);
  } catch (TextureError &e) {
    return e.what();
  }
  return "no error";
}

std::string written(const Texture &t)
{
  std::ostringstream out;
  write_texture(t, out);
  return out.str();
}

}    // namespace

TEST(TexturePlacement, ReferenceMonolayer)
{
  const Texture t = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  ASSERT_EQ(t.grains.size(), 4500u);
  EXPECT_GE(least_gap(t), 0.999e-3 * 2.0 * RD);    // the stated gap, to the round-off of a chord
  for (const Grain &g : t.grains) {
    EXPECT_NEAR(dot(g.n, g.n), 1.0, 1.0e-14);
    EXPECT_GE(g.n[2], -std::cos(0.33));
    EXPECT_EQ(g.radius, RD);
  }
}

TEST(TexturePlacement, GrainsAreUniformOutsideTheBareCap)
{
  // counts in ten bands of equal area, and in ten of azimuth, summed over seeds: chi squared with 9 degrees of freedom
  // is above 27.9 once in a thousand; grains that exclude each other scatter less than independent ones
  double band[10] = {}, sector[10] = {};
  const double low = -std::cos(0.33);
  int n = 0;
  for (int seed = 1; seed <= 20; seed++)
    for (const Grain &g : place_monolayer(RP, RD, 0.2, BareCap(), seed).grains) {
      band[std::min(9, static_cast<int>(10.0 * (g.n[2] - low) / (1.0 - low)))]++;
      sector[std::min(9, static_cast<int>(10.0 * (std::atan2(g.n[1], g.n[0]) / (2.0 * M_PI) + 0.5)))]++;
      n++;
    }
  double chi_band = 0.0, chi_sector = 0.0;
  for (int k = 0; k < 10; k++) {
    chi_band += std::pow(band[k] - 0.1 * n, 2) / (0.1 * n);
    chi_sector += std::pow(sector[k] - 0.1 * n, 2) / (0.1 * n);
  }
  EXPECT_LT(chi_band, 27.9);
  EXPECT_LT(chi_sector, 27.9);
}

TEST(TexturePlacement, BareCapAboutAnyAxis)
{
  for (const auto &axis : {std::array<double, 3>{0.6, 0.0, 0.8}, {0.0, 0.0, 1.0}, {0.0, -1.0, 0.0}, {0.0, 0.0, -1.0}}) {
    BareCap cap;
    cap.half_angle = 0.5;
    std::copy_n(axis.data(), 3, cap.axis);
    const Texture t = place_monolayer(RP, RD, 0.2, cap, 3);
    double nearest = -1.0;
    for (const Grain &g : t.grains) nearest = std::max(nearest, dot(g.n, cap.axis));
    EXPECT_LE(nearest, std::cos(0.5) + 1.0e-12);
    EXPECT_GT(nearest, std::cos(0.55));    // the rim is reached
    EXPECT_NO_THROW(check_texture(t));
  }
}

TEST(TexturePlacement, SeedDecides)
{
  const std::string one = written(place_monolayer(RP, RD, 0.2, BareCap(), 1));
  EXPECT_EQ(one, written(place_monolayer(RP, RD, 0.2, BareCap(), 1)));
  EXPECT_NE(one, written(place_monolayer(RP, RD, 0.2, BareCap(), 2)));
}

TEST(TexturePlacement, DenseMonolayersUpToJamming)
{
  const Texture t = place_monolayer(RP, RD, 0.5, BareCap(), 1);
  EXPECT_EQ(t.grains.size(), 11250u);
  EXPECT_GE(least_gap(t), 0.999e-3 * 2.0 * RD);

  // random sequential placement of discs jams at 0.5470; here on the shell of the centres, outside the cap, with the
  // gap; the sphere's curvature and chance leave a few thousandths
  const double shell = 0.5470 * std::pow((RP + RD) / RP, 2) * (1.0 - 0.5 * (1.0 - std::cos(0.33))) / std::pow(1.001, 2);
  const std::string error = placing_error(RP, RD, 0.56);
  const std::string full = "the monolayer is full at ";
  ASSERT_NE(error.find("coverage 0.56 cannot be placed"), std::string::npos) << error;
  EXPECT_NEAR(std::stod(error.substr(error.find(full) + full.size())), shell, 0.004);
}

TEST(TexturePlacement, FewLargeGrains)
{
  const Texture t =
      place_monolayer(1.0, 0.49, 0.25, BareCap(), 5);    // four grains: the grid of the sphere at its coarsest
  EXPECT_EQ(t.grains.size(), 4u);
  EXPECT_GT(least_gap(t), 0.0);
}

TEST(TexturePlacement, WrongNumbersAreNamed)
{
  EXPECT_NE(placing_error(RP, RD, 0.0).find("coverage 0 "), std::string::npos);
  EXPECT_NE(placing_error(RP, RD, -1.0).find("coverage -1 "), std::string::npos);
  EXPECT_NE(placing_error(RP, RD, NAN).find("coverage nan "), std::string::npos);
  EXPECT_NE(placing_error(RP, 2.0 * RP, 0.2).find("grain diameter"), std::string::npos);
  EXPECT_NE(placing_error(RP, RD, 1.0e-6).find("less than one grain"), std::string::npos);
}

TEST(TexturePlacement, QuantilesOfSizeDistributions)
{
  const SizeDistribution lognormal = {SizeDistribution::LOGNORMAL, 15e-6, 1.5},
                         rrsb = {SizeDistribution::RRSB, 15e-6, 2.0};
  EXPECT_NEAR(lognormal.quantile(0.5), 15e-6, 1e-18);
  EXPECT_NEAR(lognormal.quantile(0.5 * std::erfc(-1.0 / std::sqrt(2.0))), 1.5 * 15e-6, 1e-17);    // one deviation above
  EXPECT_NEAR(rrsb.quantile(0.5), 15e-6, 1e-18);
  EXPECT_NEAR(rrsb.quantile(1.0 - std::exp(-1.0)), 15e-6 / std::sqrt(std::log(2.0)), 1e-17);    // x'
}

TEST(TexturePlacement, DistributedSizesAreTheOnesAskedFor)
{
  for (const SizeDistribution &sizes : {SizeDistribution{SizeDistribution::LOGNORMAL, 15e-6, 1.5},
                                        SizeDistribution{SizeDistribution::RRSB, 15e-6, 3.0}}) {
    std::vector<double> x;
    double volume = 0.0;
    for (int seed = 1; seed <= 5; seed++) {
      const Texture t = place_monolayer(RP, sizes, 0.2, BareCap(), seed);
      check_texture(t);
      if (seed == 1) {
        EXPECT_GE(least_gap(t), 0.999e-3 * 2.0 * t.grains.back().radius);
      }
      double area = 0.0, largest = 0.0;
      for (const Grain &g : t.grains) {
        x.push_back(2.0 * g.radius);
        volume += std::pow(x.back(), 3);
        area += g.radius * g.radius / (4.0 * RP * RP);
        largest = std::max(largest, g.radius);
        EXPECT_GE(g.n[2], -std::cos(0.33));
      }
      EXPECT_GE(area, 0.2);    // up to a part of one grain
      EXPECT_LE(area, 0.2 + 0.25 * std::pow(largest / RP, 2));
    }
    std::sort(x.begin(), x.end());
    EXPECT_GE(x.front(), sizes.quantile(0.01));
    EXPECT_LE(x.back(), sizes.quantile(0.99));
    // Kolmogorov's distance by volume: 1.95/sqrt(n) once in a thousand for n equal weights; n = (sum v)^2/sum v^2 here
    double below = 0.0, worst = 0.0, squares = 0.0;
    for (const double d : x) squares += std::pow(d, 6);
    const auto wanted = [&](double d) {
      const double ln = std::log(d / sizes.x50);
      const double whole = sizes.kind == SizeDistribution::RRSB
                               ? 1.0 - std::exp(-std::log(2.0) * std::exp(sizes.spread * ln))
                               : 0.5 * std::erfc(-ln / std::log(sizes.spread) / std::sqrt(2.0));
      return (whole - 0.01) / 0.98;
    };
    for (const double d : x) {
      below += std::pow(d, 3) / volume;
      worst = std::max(worst, std::fabs(below - wanted(d)));
    }
    EXPECT_LT(worst, 1.95 / std::sqrt(volume * volume / squares));
  }
}

TEST(TexturePlacement, DenseAndImpossibleDistributions)
{
  const SizeDistribution sizes = {SizeDistribution::LOGNORMAL, 80e-6, 1.3};
  check_texture(place_monolayer(RP, sizes, 0.45, BareCap(), 1));
  const auto error = [](const SizeDistribution &wrong, double coverage) -> std::string {
    try {
      place_monolayer(RP, wrong, coverage, BareCap(), 1);
    } catch (TextureError &e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_NE(error(sizes, 0.9).find("monolayer is full at"), std::string::npos);
  EXPECT_NE(error({SizeDistribution::LOGNORMAL, 15e-6, 1.0}, 0.2).find("geometric standard deviation 1"),
            std::string::npos);
  EXPECT_NE(error({SizeDistribution::RRSB, 15e-6, 0.0}, 0.2).find("exponent 0"), std::string::npos);
  EXPECT_NE(error({SizeDistribution::RRSB, 0.0, 3.0}, 0.2).find("median diameter 0"), std::string::npos);
  EXPECT_NE(error({SizeDistribution::LOGNORMAL, 1e-3, 2.0}, 0.2).find("carrier"), std::string::npos);
}

// the texture of a seed is what users' files and results rest on: numbers of the version that had it first
TEST(TexturePlacement, SeedsKeepTheirTextures)
{
  const auto check = [](const Texture &t, size_t number, double sum, const std::array<double, 4> &last) {
    ASSERT_EQ(t.grains.size(), number);
    double all = 0.0;
    for (size_t k = 0; k < t.grains.size(); k++) {
      const Grain &g = t.grains[k];
      all += std::cos(double(k + 1)) * (g.n[0] + 2.0 * g.n[1] + 3.0 * g.n[2] + g.radius / t.carrier_radius);
    }
    EXPECT_NEAR(all, sum, 1e-9 * number);
    for (int d = 0; d < 3; d++) EXPECT_NEAR(t.grains.back().n[d], last[d], 1e-12);
    EXPECT_NEAR(t.grains.back().radius, last[3], 1e-12 * last[3]);
  };
  check(place_monolayer(RP, RD, 0.2, BareCap(), 1), 4500, 44.4763459321715,
        {-0.606832557879376, -0.158897204781137, -0.778784902916277, 1e-05});
  check(place_monolayer(RP, RD, 0.5, BareCap(), 1), 11250, -88.4617324795377,
        {0.556641372480514, -0.394645664208544, 0.731030219734046, 1e-05});
  check(place_monolayer(RP, {SizeDistribution::LOGNORMAL, 15e-6, 1.5}, 0.2, BareCap(), 1), 13711, -323.566253420827,
        {-0.689139747414427, -0.154655918427047, -0.707932168663825, 2.92094746265368e-06});
  check(place_monolayer(RP, {SizeDistribution::LOGNORMAL, 80e-6, 1.3}, 0.45, BareCap(), 1), 839, 15.5432265837555,
        {0.619825449985009, 0.20592397205146, 0.757239545510818, 2.17300433739692e-05});
}

// 0.001 of the sum of their radii, no less, and no more either: a dense layer has pairs that just keep it
TEST(TexturePlacement, GapBetweenUnequalGrains)
{
  double least = 1.0, least_unequal = 1.0, least_equal = 1.0;
  for (int seed = 1; seed <= 3; seed++) {
    const Texture t = place_monolayer(RP, {SizeDistribution::LOGNORMAL, 60e-6, 1.6}, 0.5, BareCap(), seed);
    for (size_t i = 0; i < t.grains.size(); i++)
      for (size_t j = 0; j < i; j++) {
        const Grain &a = t.grains[i], &b = t.grains[j];
        double d2 = 0.0;
        for (int k = 0; k < 3; k++) d2 += std::pow((RP + a.radius) * a.n[k] - (RP + b.radius) * b.n[k], 2);
        const double gap = std::sqrt(d2) / (a.radius + b.radius) - 1.0, ratio = a.radius / b.radius;
        least = std::min(least, gap);
        if (ratio > 2.0 || ratio < 0.5) least_unequal = std::min(least_unequal, gap);
        if (ratio < 1.1 && ratio > 0.9) least_equal = std::min(least_equal, gap);
      }
  }
  EXPECT_GE(least, 0.000999);
  EXPECT_LT(least_unequal, 0.0012);
  EXPECT_LT(least_equal, 0.002);
}

TEST(TexturePlacement, WhatCannotBeIsRefusedAtOnce)    // each took minutes, or all memory
{
  const auto error = [](const SizeDistribution &sizes, double coverage) -> std::string {
    try {
      place_monolayer(RP, sizes, coverage, BareCap(), 1);
    } catch (TextureError &e) {
      return e.what();
    }
    return "no error";
  };
  // 0.547 (R_p + R_d)^2/R_p^2 (1 + cos 0.33)/2, less the gap of 0.001
  const double shell = 0.547 * std::pow(1.0 + 0.5e-6 / RP, 2) * 0.5 * (1.0 + std::cos(0.33)) / std::pow(1.001, 2);
  const std::string full = placing_error(RP, 0.5e-6, 3.0), most = "it must be at most about ";
  ASSERT_NE(full.find("coverage 3 cannot be placed: " + most), std::string::npos) << full;
  EXPECT_NEAR(std::stod(full.substr(full.find(most) + most.size())), shell, 1e-5);
  EXPECT_NE(placing_error(RP, 0.05e-6, 0.2).find("1.8e+08 of them: it must be at most 5e+07"), std::string::npos);
  EXPECT_NE(placing_error(1.0, 1e-9, 0.2).find("8e+17 of them"), std::string::npos);

  using Sizes = SizeDistribution;
  EXPECT_NE(error({Sizes::RRSB, 1e-12, 3.0}, 0.2).find("of them: it must be at most 5e+07"), std::string::npos);
  EXPECT_NE(error({Sizes::LOGNORMAL, 1e-12, 1.5}, 0.2).find("of them: it must be at most 5e+07"), std::string::npos);
  EXPECT_NE(error({Sizes::RRSB, 10e-6, 0.6}, 0.2).find("of them: it must be at most 5e+07"), std::string::npos);
  EXPECT_NE(error({Sizes::RRSB, 20e-6, 1e-12}, 0.2).find("coarsest grains of this distribution have diameter inf"),
            std::string::npos);
  EXPECT_NE(error({Sizes::LOGNORMAL, 20e-6, 1e6}, 0.2).find("coarsest grains of this distribution"), std::string::npos);
  EXPECT_NE(error({Sizes::LOGNORMAL, 20e-6, 2.0}, 3.0)
                .find("coverage 3 cannot be placed: it must be at most about 1.1"),
            std::string::npos);
}

TEST(TexturePlacement, NumbersOfGrainsAreForeseen)    // the message has what would have been placed
{
  // log-normal by volume with s = ln sigma_g: means of x^-3 and x^-1 give x50^2 exp(-4 s^2) as the mean of x^2 by
  // number, but for the cuts
  const double s = std::log(1.05), x = 1e-9, coverage = 0.2;
  std::string error;
  try {
    place_monolayer(RP, {SizeDistribution::LOGNORMAL, x, 1.05}, coverage, BareCap(), 1);
  } catch (TextureError &e) {
    error = e.what();
  }
  const std::string before = "with these grains is ";
  ASSERT_NE(error.find(before), std::string::npos) << error;
  const double number = 16.0 * coverage * RP * RP / (x * x) * std::exp(4.0 * s * s);
  EXPECT_NEAR(std::stod(error.substr(error.find(before) + before.size())), number, 0.01 * number);
}

TEST(TexturePlacement,
     FewFineGrains)    // ten of them, each 1e-9 of the carrier: their grid had 800 MB, their bins no number
{
  const Texture t = place_monolayer(1.0, 1e-9, 2.5e-18, BareCap(), 1);
  EXPECT_EQ(t.grains.size(), 10u);
}

TEST(TexturePlacement, SmallLayersMayBeFullerThanOnAverage)    // what chance allows is tried
{
  int placed = 0;
  for (int seed = 1; seed <= 50; seed++) {
    BareCap none;
    none.half_angle = 0.0;
    try {
      placed += place_monolayer(3.0, 1.0, 36.0 / 36.0, none, seed).grains.size() == 36;    // the formula says 34.9
    } catch (TextureError &) {
      continue;    // as most do
    }
  }
  EXPECT_GT(placed, 5);
}
