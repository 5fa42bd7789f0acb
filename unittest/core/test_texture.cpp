// What makes a list of grains a texture: none in the bare cap, wider than its carrier or overlapping another.

#include "texture.h"

#include "hertz.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace Dust;

namespace {

// grains of a carrier of radius 1 at polar angles, in the plane y = 0; the bare cap lies about -z
Texture texture(const std::vector<double> &angles, const std::vector<double> &radii, double half_angle = 0.3)
{
  Texture t;
  t.carrier_radius = 1.0;
  t.bare.half_angle = half_angle;
  for (size_t k = 0; k < angles.size(); k++)
    t.grains.push_back({{std::sin(angles[k]), 0.0, std::cos(angles[k])}, radii[k]});
  return t;
}

std::string message(const Texture &t, const std::vector<int> &lines = {})
{
  try {
    check_texture(t, lines);
  } catch (TextureError &e) {
    return e.what();
  }
  return "no error";
}

}    // namespace

// steel on steel at 20 m/s by Hertz: the lowest grains just do not touch at the largest overlap
TEST(Texture, DefaultBareCapKeepsGrainsOffTheWall)
{
  EXPECT_EQ(bare_half_angle(0.75e-3, 10.0e-6), 0.33);
  EXPECT_EQ(bare_half_angle(750.0, 10.0), 0.33);
  for (double carrier : {0.05e-3, 0.75e-3, 1.5e-3})
    for (double grain : {2.5e-6, 10.0e-6, 20.0e-6}) {
      const double mass = 4.0 / 3.0 * M_PI * carrier * carrier * carrier * 7700.0;
      const double overlap = hertz_overlap(210e9 / (2.0 * (1.0 - 0.09)), carrier, mass, 20.0);
      const auto gap = [&](double angle) { return carrier - overlap - grain - (carrier + grain) * std::cos(angle); };
      const double angle = bare_half_angle(carrier, grain);
      EXPECT_GT(gap(angle), 0.0);
      EXPECT_LT(gap(angle - 0.01), 0.0);
    }
}

TEST(Texture, NeedsAGrain)
{
  EXPECT_EQ(message(texture({}, {})), "there is no grain");
  EXPECT_EQ(message(texture({1.0}, {0.1})), "no error");
}

// law of cosines: centres at 1 + a and 1 + b are a + b apart at this angle
TEST(Texture, UnequalGrainsOverlapWhereTheyTouch)
{
  for (const double a : {0.01, 0.1, 0.3, 0.45})
    for (const double b : {0.01, 0.02, 0.3, 0.49}) {
      const double p = 1.0 + a, q = 1.0 + b, touch = std::acos((p * p + q * q - (a + b) * (a + b)) / (2.0 * p * q));
      EXPECT_EQ(message(texture({0.2, 0.2 + touch * (1.0 + 1e-6)}, {a, b})), "no error") << a << " " << b;
      EXPECT_EQ(message(texture({0.2, 0.2 + touch * (1.0 - 1e-6)}, {a, b})),
                "grain 2: the grain overlaps that of grain 1")
          << a << " " << b;
    }
  EXPECT_EQ(message(texture({0.0, 1.0, 2.0, 2.01}, {0.01, 0.01, 0.02, 0.01}), {5, 6, 8, 11}),
            "line 11: the grain overlaps that of line 8");
}

TEST(Texture, TheBareCapIsBare)
{
  for (const double half : {0.1, 1.0, 2.0}) {
    EXPECT_EQ(message(texture({M_PI - half - 1e-8}, {0.01}, half)), "no error") << half;
    EXPECT_NE(message(texture({M_PI - half + 1e-8}, {0.01}, half), {7}).find("line 7: the grain lies in the bare cap"),
              std::string::npos)
        << half;
  }
  EXPECT_EQ(message(texture({M_PI}, {0.01}, 0.0)), "no error");    // 0 is none
  EXPECT_EQ(message(texture({M_PI - 0.2}, {0.01})),
            "grain 1: the grain lies in the bare cap, 0.2 rad from its axis: it must be 0.3 at least");
}

TEST(Texture, SizesMustFit)
{
  EXPECT_EQ(message(texture({1.0}, {0.499})), "no error");
  for (const double a : {0.5, 0.933, 1.0}) {    // 0.933: 1.4 mm on 1.5 mm
    const std::string diameter = "grain diameter " + number_text(2.0 * a);
    EXPECT_EQ(message(texture({1.0}, {a})), diameter + " is not below the carrier's radius, 1");
  }
  EXPECT_NE(message(texture({1.0}, {0.0})).find("grain diameter 0 is not above 0"), std::string::npos);
  EXPECT_NE(message(texture({1.0}, {NAN})).find("grain diameter nan"), std::string::npos);
  EXPECT_NE(message(texture({1.0}, {0.1}, -0.1)).find("bare half-angle -0.1"), std::string::npos);
  EXPECT_NE(message(texture({1.0}, {0.1}, 3.2)).find("bare half-angle 3.2"), std::string::npos);
  Texture t = texture({1.0}, {0.1});
  t.carrier_radius = -1.0;
  EXPECT_NE(message(t).find("carrier diameter -2"), std::string::npos);
}
