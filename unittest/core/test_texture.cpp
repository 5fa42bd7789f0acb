// Textures: exact coverage, no overlap, bare cap, uniform, reproducible; text format and its errors.

#include "texture_file.h"
#include "texture_placement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>

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

std::string message(const std::string &text)
{
  std::istringstream in(text);
  try {
    read_texture(in);
  } catch (TextureError &e) {
    return e.what();
  }
  return "no error";
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

TEST(Texture, ReferenceMonolayer)
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

TEST(Texture, GrainsAreUniformOutsideTheBareCap)
{
  // counts in ten bands of equal area, and in ten of azimuth, summed over seeds: chi squared with 9 degrees of freedom is
  // above 27.9 once in a thousand; grains that exclude each other scatter less than independent ones
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

TEST(Texture, BareCapAboutAnyAxis)
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

TEST(Texture, SeedDecides)
{
  const std::string one = written(place_monolayer(RP, RD, 0.2, BareCap(), 1));
  EXPECT_EQ(one, written(place_monolayer(RP, RD, 0.2, BareCap(), 1)));
  EXPECT_NE(one, written(place_monolayer(RP, RD, 0.2, BareCap(), 2)));
}

TEST(Texture, DenseMonolayersUpToJamming)
{
  const Texture t = place_monolayer(RP, RD, 0.5, BareCap(), 1);
  EXPECT_EQ(t.grains.size(), 11250u);
  EXPECT_GE(least_gap(t), 0.999e-3 * 2.0 * RD);

  // random sequential placement of discs jams at 0.5470; here on the shell of the centres, outside the cap, with the gap;
  // the sphere's curvature and chance leave a few thousandths
  const double shell = 0.5470 * std::pow((RP + RD) / RP, 2) * (1.0 - 0.5 * (1.0 - std::cos(0.33))) / std::pow(1.001, 2);
  const std::string error = placing_error(RP, RD, 0.7);
  const std::string full = "the monolayer is full at ";
  ASSERT_NE(error.find("coverage 0.7 cannot be placed"), std::string::npos) << error;
  EXPECT_NEAR(std::stod(error.substr(error.find(full) + full.size())), shell, 0.004);
}

TEST(Texture, FewLargeGrains)
{
  const Texture t =
      place_monolayer(1.0, 0.5, 0.25, BareCap(), 5);    // four grains: the grid of the sphere at its coarsest
  EXPECT_EQ(t.grains.size(), 4u);
  EXPECT_GT(least_gap(t), 0.0);
}

TEST(Texture, WrongNumbersAreNamed)
{
  EXPECT_NE(placing_error(RP, RD, 0.0).find("coverage 0 "), std::string::npos);
  EXPECT_NE(placing_error(RP, RD, -1.0).find("coverage -1 "), std::string::npos);
  EXPECT_NE(placing_error(RP, RD, NAN).find("coverage nan "), std::string::npos);
  EXPECT_NE(placing_error(RP, 2.0 * RP, 0.2).find("grain diameter"), std::string::npos);
  EXPECT_NE(placing_error(RP, RD, 1.0e-6).find("less than one grain"), std::string::npos);
}

TEST(Texture, SurvivesBeingWrittenAndRead)
{
  BareCap cap;
  cap.axis[0] = 0.6;
  cap.axis[2] = -0.8;
  const std::string text = written(place_monolayer(RP, RD, 0.1, cap, 7));
  std::istringstream in(text);
  EXPECT_EQ(written(read_texture(in)), text);
}

TEST(Texture, CommentsAndCarriageOfNumbers)
{
  EXPECT_EQ(message("# dust texture 1\n# made by hand\ncarrier_diameter 2\nbare 0 0 0 -1\ngrains 2\n"
                    "0.57735 0.57735 0.57735 0.1\r\n# the other\n0 0 -1 1e-1\nend\n# made today\n"),
            "no error");
}

TEST(Texture, QuantilesOfSizeDistributions)
{
  const SizeDistribution lognormal = {SizeDistribution::LOGNORMAL, 15e-6, 1.5},
                         rrsb = {SizeDistribution::RRSB, 15e-6, 2.0};
  EXPECT_NEAR(lognormal.quantile(0.5), 15e-6, 1e-18);
  EXPECT_NEAR(lognormal.quantile(0.5 * std::erfc(-1.0 / std::sqrt(2.0))), 1.5 * 15e-6, 1e-17);    // one deviation above
  EXPECT_NEAR(rrsb.quantile(0.5), 15e-6, 1e-18);
  EXPECT_NEAR(rrsb.quantile(1.0 - std::exp(-1.0)), 15e-6 / std::sqrt(std::log(2.0)), 1e-17);    // x'
}

TEST(Texture, DistributedSizesAreTheOnesAskedFor)
{
  for (const SizeDistribution &sizes : {SizeDistribution{SizeDistribution::LOGNORMAL, 15e-6, 1.5},
                                        SizeDistribution{SizeDistribution::RRSB, 15e-6, 3.0}}) {
    std::vector<double> x;
    double volume = 0.0;
    for (int seed = 1; seed <= 5; seed++) {
      const Texture t = place_monolayer(RP, sizes, 0.2, BareCap(), seed);
      check_texture(t);
      if (seed == 1) EXPECT_GE(least_gap(t), 0.999e-3 * 2.0 * t.grains.back().radius);
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
    // Kolmogorov's distance by volume: 1.95/sqrt(n) once in a thousand for n equal weights, and n (sum v)^2/sum v^2 of them
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

TEST(Texture, DenseAndImpossibleDistributions)
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

TEST(Texture, ErrorsNameTheLine)
{
  const std::string head = "# dust texture 1\ncarrier_diameter 2\nbare 0.3 0 0 -1\ngrains 2\n";
  EXPECT_NE(message("").find("cut off"), std::string::npos);
  EXPECT_NE(message("grains 3\n").find("line 1"), std::string::npos);
  EXPECT_NE(message(head + "0 0 1 0.1\n").find("line 6: the file ends"), std::string::npos);
  EXPECT_NE(message(head + "0 0 1 0.1\n1 0 0 0.1\n").find("'end'"), std::string::npos);
  EXPECT_NE(message(head + "0 0 1 0.1\n1 0 0\n").find("line 6: 4 numbers"), std::string::npos);
  EXPECT_NE(message(head + "0 0 nan 0.1\n1 0 0 0.1\nend\n").find("line 5: 'nan'"), std::string::npos);
  EXPECT_NE(message(head + "0 0 1 inf\n1 0 0 0.1\nend\n").find("line 5: 'inf'"), std::string::npos);
  EXPECT_NE(message(head + "0 0 1 0.1\n1 x 0 0.1\nend\n").find("line 6: 'x'"), std::string::npos);
  EXPECT_NE(message(head + "0 0 1 0.1\n0.05 0 0.99875 0.1\nend\n").find("grains 1 and 2 overlap"), std::string::npos);
  EXPECT_NE(message(head + "0 0 1 0.1\n0 0 -1 0.1\nend\n").find("grain 2 lies in the bare cap"), std::string::npos);
  EXPECT_NE(message(head + "0 0 1 0.1\n0 0 0.5 0.1\nend\n").find("length 0.5"), std::string::npos);
  EXPECT_NE(message(head + "0 0 1 3\n1 0 0 0.1\nend\n").find("grain diameter 3"), std::string::npos);
  EXPECT_NE(message(head + "0 0 1 -0.1\n1 0 0 0.1\nend\n").find("line 5: grain diameter"), std::string::npos);
  EXPECT_NE(message(head + "0 0 1 0.1\n1 0 0 0.1\nend\n0 1 0 0.1\n").find("line 8"), std::string::npos);
  EXPECT_NE(message("# dust texture 1\ncarrier_diameter 2\nbare 0.3 0 0 -1\ngrains 1.5\n").find("number of grains"),
            std::string::npos);
}
