// The C interface for other languages: what it says is what the reader says.

#include "texture_c.h"

#include "adhesion_spread.h"
#include "texture_file.h"
#include "texture_placement.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace {

constexpr char PATH[] = "dust_texture_c.txt";

}    // namespace

TEST(TextureC, ReadsWhatWasWritten)
{
  Dust::BareCap cap;
  cap.axis[0] = 0.6;
  cap.axis[2] = -0.8;
  Dust::Texture wanted = Dust::place_monolayer(0.75e-3, 10.0e-6, 0.1, cap, 7);
  Dust::spread_adhesion(wanted, 2.0, 7);
  Dust::write_texture_file(wanted, PATH);
  char message[256] = "before";
  DustTexture *texture = dust_texture_read(PATH, message, sizeof(message));
  ASSERT_NE(texture, nullptr);
  EXPECT_STREQ(message, "");
  EXPECT_EQ(dust_texture_check(PATH, message, sizeof(message)), 1);
  EXPECT_EQ(dust_texture_carrier_diameter(texture), 1.5e-3);
  double half_angle, axis[3];
  dust_texture_bare(texture, &half_angle, axis);
  EXPECT_EQ(half_angle, 0.33);
  EXPECT_EQ(axis[0], 0.6);
  EXPECT_EQ(axis[1], 0.0);
  EXPECT_EQ(axis[2], -0.8);
  ASSERT_EQ(dust_texture_grains(texture), 2250);
  std::vector<double> table(4 * 2250 + 1, -7.0);
  dust_texture_table(texture, table.data());
  for (size_t k = 0; k < 2250; k++) {
    for (size_t d = 0; d < 3; d++) ASSERT_EQ(table[4 * k + d], wanted.grains[k].n[d]);
    ASSERT_EQ(table[4 * k + 3], 20.0e-6);
  }
  EXPECT_EQ(table.back(), -7.0);
  std::vector<double> factors(2250 + 1, -7.0);
  dust_texture_adhesion(texture, factors.data());
  for (size_t k = 0; k < 2250; k++) ASSERT_EQ(factors[k], wanted.grains[k].adhesion);
  EXPECT_EQ(factors.back(), -7.0);
  dust_texture_free(texture);
  dust_texture_free(nullptr);
  std::remove(PATH);
}

TEST(TextureC, SaysWhatIsWrong)
{
  std::ofstream(PATH) << "# dust texture 1\ncarrier_diameter 2\nbare 0.3 0 0 -1\ngrains 1\n0 0 1.5 0.1\nend\n";
  char message[256];
  EXPECT_EQ(dust_texture_read(PATH, message, sizeof(message)), nullptr);
  EXPECT_STREQ(message, "line 5: the direction has length 1.5: it must be 1 within 0.001");
  // cut to the room there is
  char small[8] = "1234567";
  EXPECT_EQ(dust_texture_check(PATH, small, 7), 0);
  EXPECT_STREQ(small, "line 5");
  EXPECT_EQ(small[7], '\0');
  small[0] = 'x';
  EXPECT_EQ(dust_texture_check(PATH, small, 0), 0);
  EXPECT_EQ(small[0], 'x');
  EXPECT_EQ(dust_texture_check(PATH, nullptr, 100), 0);
  std::remove(PATH);
  EXPECT_EQ(dust_texture_check(PATH, message, sizeof(message)), 0);
  EXPECT_STREQ(message, "it cannot be read: No such file or directory");
}

TEST(TextureC, FromSeveralThreads)
{
  const Dust::Texture wanted = Dust::place_monolayer(0.75e-3, 10.0e-6, 0.1, Dust::BareCap(), 7);
  Dust::write_texture_file(wanted, PATH);
  std::vector<std::thread> threads;
  std::vector<long long> grains(8);
  for (long long &n : grains)
    threads.emplace_back([&n]() {
      DustTexture *texture = dust_texture_read(PATH, nullptr, 0);
      n = texture ? dust_texture_grains(texture) : -1;
      dust_texture_free(texture);
    });
  for (std::thread &thread : threads) thread.join();
  for (const long long n : grains) EXPECT_EQ(n, 2250);
  std::remove(PATH);
}
