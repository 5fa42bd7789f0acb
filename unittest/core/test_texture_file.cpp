// Texture files: what doc/texture.rst says of them, line by line; the words of each complaint; nothing half written.

#include "texture_file.h"

#include "texture_placement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <clocale>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

using namespace Dust;

namespace {

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

std::string written(const Texture &t)
{
  std::ostringstream out;
  write_texture(t, out);
  return out.str();
}

std::string content(const std::string &path)
{
  std::ifstream in(path);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

std::string writing_error(const Texture &t, const std::string &path)
{
  try {
    write_texture_file(t, path);
  } catch (TextureError &e) {
    return e.what();
  }
  return "no error";
}

Texture monolayer(int seed) { return place_monolayer(0.75e-3, 10.0e-6, 0.1, BareCap(), seed); }

const std::string HEAD = "# dust texture 1\ncarrier_diameter 2\nbare 0.3 0 0 -1\ngrains 2\n";

// a folder of its own, gone afterwards
struct Folder {
  std::filesystem::path path = std::filesystem::temp_directory_path() / ("dust_texture_" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directory(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string operator/(const char *name) const { return (path / name).string(); }
  int files() const
  {
    return static_cast<int>(
        std::distance(std::filesystem::directory_iterator(path), std::filesystem::directory_iterator()));
  }
};

}    // namespace

TEST(TextureFile, SurvivesBeingWrittenAndRead)
{
  BareCap cap;
  cap.axis[0] = 0.6;
  cap.axis[2] = -0.8;
  const std::string text = written(place_monolayer(0.75e-3, 10.0e-6, 0.1, cap, 7));
  std::istringstream in(text);
  EXPECT_EQ(written(read_texture(in)), text);
}

TEST(TextureFile, Text)
{
  Texture t;
  t.carrier_radius = 0.75e-3;
  t.grains = {{{0.6, -0.8, 0.0}, 1e-5}, {{0.1, 0.2, std::sqrt(0.95)}, 0.5e-7}};
  EXPECT_EQ(written(t), "# dust texture 1\ncarrier_diameter 0.0015\nbare 0.33000000000000002 0 0 -1\ngrains 2\n"
                        "# nx ny nz diameter\n0.59999999999999998 -0.80000000000000004 0 2.0000000000000002e-05\n"
                        "0.10000000000000001 0.20000000000000001 0.97467943448089633 9.9999999999999995e-08\nend\n");
}

TEST(TextureFile, CommentsBlankLinesAndNumbers)
{
  const std::string end = "carrier_diameter 2\nbare 0 0 0 -1\ngrains 2\n0 0 1 0.1\n0 0 -1 0.1\nend\n";
  EXPECT_EQ(message("# dust texture 1\n# made by hand\n" + end + "# made today\n"), "no error");
  EXPECT_EQ(message("# dust texture 1\r\n\n  \t\r\n#\n" + end + "\n \n#\n"), "no error");
  EXPECT_EQ(message("# dust texture 1\n  carrier_diameter\t 2 \nbare +0 0.0e5 -0. -1e0\n#grains 3\ngrains 2e0\n"
                    "0.57735 0.57735 0.57735 .1\r\n# the other\n\n\t0 0 -1 1e-1\n end \n"),
            "no error");
  std::string without_last_newline = "# dust texture 1\n" + end;
  without_last_newline.pop_back();
  EXPECT_EQ(message(without_last_newline), "no error");
}

TEST(TextureFile, DirectionsAreNormalised)
{
  std::istringstream in(
      "# dust texture 1\ncarrier_diameter 2\nbare 0.3 0 0 -1.0005\ngrains 1\n0.6003 0 0.8004 0.1\nend\n");
  const Texture t = read_texture(in);
  EXPECT_EQ(t.bare.axis[2], -1.0);
  EXPECT_NEAR(t.grains[0].n[0], 0.6, 1e-15);
  EXPECT_NEAR(t.grains[0].n[2], 0.8, 1e-15);
}

TEST(TextureFile, EachRuleNamesTheLineAndWhatIsAllowed)
{
  const auto is = [](const std::string &text, const std::string &complaint) {
    EXPECT_EQ(message(text), complaint) << text;
  };
  const std::string one = "# dust texture 1\n", two = one + "carrier_diameter 2\n", three = two + "bare 0.3 0 0 -1\n";
  is("", "line 1: a texture file starts with '# dust texture 1', not with ''");
  is("grains 3\n", "line 1: a texture file starts with '# dust texture 1', not with 'grains 3'");
  is("# dust texture 2\n", "line 1: a texture file starts with '# dust texture 1', not with '# dust texture 2'");
  is(" # dust texture 1\n", "line 1: a texture file starts with '# dust texture 1', not with ' # dust texture 1'");
  is(one, "line 2: the file ends where 'carrier_diameter' should be: it is cut off");
  is(one + "bare 0.3 0 0 -1\n", "line 2: 'carrier_diameter' should be here, not 'bare 0.3 0 0 -1'");
  is(one + "carrier_diameter\n", "line 2: 1 numbers should be here, not 0");
  is(one + "carrier_diameter 1 2\n", "line 2: 1 numbers should be here, not 2");
  is(one + "carrier_diameter 0\n", "line 2: carrier_diameter 0 must be above 0");
  is(one + "carrier_diameter -2\n", "line 2: carrier_diameter -2 must be above 0");
  is(one + "carrier_diameter inf\n", "line 2: 'inf' is not a finite number");
  is(two + "grains 2\n", "line 3: 'bare' should be here, not 'grains 2'");
  is(two + "bare 0.3\n", "line 3: 4 numbers should be here, not 1");
  is(two + "bare -0.1 0 0 -1\n", "line 3: the half-angle of the bare cap, -0.1, must be at least 0 and below pi");
  is(two + "bare 3.1416 0 0 -1\n", "line 3: the half-angle of the bare cap, 3.1416, must be at least 0 and below pi");
  is(two + "bare 0.3 0 0 -2\n", "line 3: the direction has length 2: it must be 1 within 0.001");
  is(two + "bare 0.3 0 0 0\n", "line 3: the direction has length 0: it must be 1 within 0.001");
  is(three + "\n# how many\n0 0 1 0.1\n", "line 6: 'grains' should be here, not '0 0 1 0.1'");
  for (const char *wrong : {"0", "-1", "1.5", "50000001"})
    is(three + "grains " + wrong + "\n", std::string("line 4: the number of grains, ") +
                                             (std::string(wrong) == "50000001" ? "5e+07" : wrong) +
                                             ", must be a whole number from 1 to 5e+07");
  is(three + "grains two\n", "line 4: 'two' is not a finite number");
  is(HEAD + "0 0 1 0.1\n", "line 6: the file ends where a grain should be: it is cut off");
  is(HEAD + "0 0 1 0.1\n1 0 0 0.1\n", "line 7: the file ends where 'end' should be: it is cut off");
  is(HEAD + "0 0 1 0.1\n1 0 0\n", "line 6: 4 numbers should be here, not 3");
  is(HEAD + "0 0 1 0.1\nend\n", "line 6: 'end' is not a finite number");
  is(HEAD + "0 0 1 0.1\n1 0 0 0.1\n0 1 0 0.1\nend\n", "line 7: 'end' should be here, after 2 grains, not '0 1 0 0.1'");
  is(HEAD + "0 0 1 0.1\n1 0 0 0.1\nend of file\n", "line 7: 'end' should be here, after 2 grains, not 'end of file'");
  is(HEAD + "0 0 1 0.1\n1 0 0 0.1\nend\n\n0 1 0 0.1\n",
     "line 9: only lines that start with # may follow 'end', not '0 1 0 0.1'");
  for (const char *wrong : {"nan", "inf", "-inf", "x", "0x1", "1_0", "1e999", "1,5", "--1", "+-1", "1e", "."})
    is(HEAD + "0 0 1 " + wrong + "\n1 0 0 0.1\nend\n", std::string("line 5: '") + wrong + "' is not a finite number");
  is(HEAD + "0 0 0.9989 0.1\n", "line 5: the direction has length 0.9989: it must be 1 within 0.001");
  is(HEAD + "0 1.0011 0 0.1\n", "line 5: the direction has length 1.0011: it must be 1 within 0.001");
  is(HEAD + "0 0 1e200 0.1\n", "line 5: the direction has length inf: it must be 1 within 0.001");
  for (const char *wrong : {"0", "-0.1", "1", "1.867", "3"})
    is(HEAD + "0 0 1 " + wrong + "\n1 0 0 0.1\nend\n",
       std::string("line 5: grain diameter ") + wrong + " must be above 0 and below the carrier's radius, 1");
  is(HEAD + "0 0 1 0.1\n# the other\n0.05 0 0.99875 0.1\nend\n", "line 7: the grain overlaps that of line 5");
  is(HEAD + "0 0 1 0.1\n0 0 -1 0.1\nend\n",
     "line 6: the grain lies in the bare cap, 0 rad from its axis: it must be 0.3 at least");
}

TEST(TextureFile, ComplaintsAreOneShortLineWhateverTheFileHolds)
{
  const std::string odd = std::string("\x1b[2J\xff\x00\tgr", 9) + std::string(100000, 'x');
  for (const std::string &text : {odd, HEAD + odd, HEAD + "0 0 1 " + odd, HEAD + "0 0 1 0.1\n1 0 0 0.1\nend\n" + odd}) {
    const std::string complaint = message(text);
    EXPECT_EQ(complaint.compare(0, 5, "line "), 0) << complaint;
    EXPECT_LT(complaint.size(), 160u);
    EXPECT_TRUE(std::all_of(complaint.begin(), complaint.end(), [](char c) { return c >= ' ' && c <= '~'; }))
        << complaint;
  }
}

// files of three grains in which one thing is odd, judged by the rules of doc/texture.rst, with all pairs compared
TEST(TextureFile, OddFilesAreJudgedByTheRules)
{
  std::mt19937 random(5);
  const auto uniform = [&random](double low, double high) { return low + (high - low) * random() / 4294967296.0; };
  int good = 0, bad = 0;
  for (int k = 0; k < 20000; k++) {
    double half = uniform(0.0, 1.0), axis[3] = {0.0, 0.0, -1.0}, diameter = 2.0;
    std::vector<std::array<double, 4>> grains;
    for (int g = 0; g < 3; g++) {
      const double z = uniform(-1.0, 1.0), phi = uniform(0.0, 2.0 * M_PI), s = std::sqrt(1.0 - z * z);
      grains.push_back({s * std::cos(phi), s * std::sin(phi), z, uniform(0.01, 0.6)});
    }
    std::array<double, 4> &odd = grains[random() % 3];
    switch (random() % 8) {
      case 0: half = uniform(-1.0, 4.0); break;
      case 1: axis[2] = uniform(-1.002, -0.998); break;
      case 2:
        for (double scale = uniform(0.998, 1.002), *n = odd.data(); n != odd.data() + 3; n++) *n *= scale;
        break;
      case 3: odd[3] = uniform(-0.1, 2.5); break;
      case 4: diameter = uniform(-1.0, 3.0); break;
      default: break;
    }
    char line[256];
    std::snprintf(line, sizeof(line),
                  "# dust texture 1\ncarrier_diameter %.17g\nbare %.17g %.17g %.17g %.17g\ngrains 3\n", diameter, half,
                  axis[0], axis[1], axis[2]);
    std::string text = line;
    for (const auto &g : grains) {
      std::snprintf(line, sizeof(line), "%.17g %.17g %.17g %.17g\n", g[0], g[1], g[2], g[3]);
      text += line;
    }

    const double R = 0.5 * diameter;
    bool right = diameter > 0.0 && half >= 0.0 && half < M_PI && std::fabs(std::fabs(axis[2]) - 1.0) <= 0.001;
    for (auto &g : grains) {
      const double length = std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
      right = right && std::fabs(length - 1.0) <= 0.001 && g[3] > 0.0 && g[3] < R;
      for (int d = 0; d < 3; d++) g[d] /= length;
      right = right && (half == 0.0 || std::acos(-g[2]) >= half);
    }
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < a; b++) {
        double d2 = 0.0;
        for (int d = 0; d < 3; d++)
          d2 += std::pow((R + 0.5 * grains[a][3]) * grains[a][d] - (R + 0.5 * grains[b][3]) * grains[b][d], 2);
        right = right && std::sqrt(d2) >= 0.5 * (grains[a][3] + grains[b][3]);
      }
    (right ? good : bad)++;
    EXPECT_EQ(message(text + "end\n") == "no error", right) << text << message(text + "end\n");
  }
  EXPECT_GT(good, 3000);
  EXPECT_GT(bad, 3000);
}

TEST(TextureFile, TheLocaleDoesNotMatter)
{
  const Texture t = monolayer(1);
  const std::string text = written(t);
  const char *set = nullptr;
  for (const char *name : {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8", "C.UTF-8"})
    if (!set) set = std::setlocale(LC_NUMERIC, name);
  EXPECT_EQ(written(t), text);
  EXPECT_EQ(message(text), "no error");
  std::setlocale(LC_NUMERIC, "C");
}

TEST(TextureFile, IsThereCompleteUnderItsName)
{
  const Folder folder;
  const Texture one = monolayer(1), two = monolayer(2);
  write_texture_file(one, folder / "a.txt");
  EXPECT_EQ(content(folder / "a.txt"), written(one));
  EXPECT_EQ(written(read_texture_file(folder / "a.txt")), written(one));
  write_texture_file(two, folder / "a.txt");
  EXPECT_EQ(content(folder / "a.txt"), written(two));
  // a link stays one
  std::filesystem::create_symlink(folder / "a.txt", folder / "b.txt");
  write_texture_file(one, folder / "b.txt");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "b.txt"));
  EXPECT_EQ(content(folder / "a.txt"), written(one));
  // permissions as those of any new file
  std::ofstream(folder / "c.txt") << "text";
  EXPECT_EQ(std::filesystem::status(folder / "a.txt").permissions(),
            std::filesystem::status(folder / "c.txt").permissions());
  EXPECT_EQ(folder.files(), 3);
}

TEST(TextureFile, NothingHalfWrittenIsLeft)
{
  const Folder folder;
  const Texture one = monolayer(1), two = monolayer(2);
  write_texture_file(one, folder / "a.txt");
  // a limit on the size of files is as good as a full disk
  struct rlimit before, limit;
  getrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, SIG_IGN);
  limit = before;
  limit.rlim_cur = 100000;
  setrlimit(RLIMIT_FSIZE, &limit);
  const std::string old_name = writing_error(two, folder / "a.txt"), new_name = writing_error(two, folder / "b.txt");
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(old_name, "it cannot be written: File too large");
  EXPECT_EQ(new_name, old_name);
  EXPECT_EQ(content(folder / "a.txt"), written(one));
  EXPECT_EQ(folder.files(), 1);

  EXPECT_EQ(writing_error(one, "/dev/full"), "it cannot be written: No space left on device");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  EXPECT_EQ(writing_error(one, folder / "no/such/folder"), "it cannot be written: No such file or directory");
  EXPECT_EQ(writing_error(one, folder.path.string()), "it cannot be written: Is a directory");
  EXPECT_EQ(folder.files(), 1);
}

TEST(TextureFile, WhatCannotBeRead)
{
  const Folder folder;
  const auto error = [](const std::string &path) -> std::string {
    try {
      read_texture_file(path);
    } catch (TextureError &e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_EQ(error(folder / "none.txt"), "it cannot be read: No such file or directory");
  EXPECT_EQ(error(folder.path.string()), "it cannot be read: Is a directory");
  EXPECT_EQ(error(""), "it cannot be read: No such file or directory");
  std::ofstream(folder / "empty.txt").close();
  EXPECT_EQ(error(folder / "empty.txt"), "line 1: a texture file starts with '# dust texture 1', not with ''");
}
