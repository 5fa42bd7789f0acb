/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "texture_file.h"

#include "geometry.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <istream>
#include <ostream>
#include <sstream>
#include <string>

using namespace Dust;

/* ---------------------------------------------------------------------- */

void Dust::write_texture(const Texture &texture, std::ostream &out)
{
  char line[160];
  const BareCap &bare = texture.bare;
  out << "# dust texture 1\n";
  std::snprintf(line, sizeof(line), "carrier_diameter %.17g\nbare %.17g %.17g %.17g %.17g\n",
                2.0 * texture.carrier_radius, bare.half_angle, bare.axis[0], bare.axis[1], bare.axis[2]);
  out << line << "grains " << texture.grains.size() << "\n# nx ny nz diameter\n";
  for (const Grain &g : texture.grains) {
    std::snprintf(line, sizeof(line), "%.17g %.17g %.17g %.17g\n", g.n[0], g.n[1], g.n[2], 2.0 * g.radius);
    out << line;
  }
  out << "end\n";
}

/* ---------------------------------------------------------------------- */

Texture Dust::read_texture(std::istream &in)
{
  Texture texture;
  std::string line;
  int lineno = 0;
  const auto fail_here = [&](const std::string &what) {
    throw TextureError("line " + std::to_string(lineno) + ": " + what);
  };

  const auto next_line = [&](const std::string &expected) {
    do {
      lineno++;
      if (!std::getline(in, line)) fail_here("the file ends where " + expected + " should be: it is cut off");
      if (!line.empty() && line.back() == '\r') line.pop_back();
    } while (lineno > 1 && (line.empty() || line[0] == '#'));
  };
  // the numbers of a line after the word it starts with; each must be finite
  const auto numbers = [&](const std::string &word, size_t n) {
    next_line(word.empty() ? "a grain" : "'" + word + "'");
    std::istringstream words(line);
    std::string token;
    if (!word.empty() && (!(words >> token) || token != word))
      fail_here("'" + word + "' should be here, not '" + line + "'");
    std::vector<double> values;
    while (words >> token) {
      char *rest;
      const double value = std::strtod(token.c_str(), &rest);
      if (*rest || !std::isfinite(value)) fail_here("'" + token + "' is not a finite number");
      values.push_back(value);
    }
    if (values.size() != n)
      fail_here(std::to_string(n) + " numbers should be here, not " + std::to_string(values.size()));
    return values;
  };
  // unit vector, as written if it is one to round-off, so that a texture survives being written and read
  const auto unit_vector = [&](const double *v, double *n) {
    const double length = std::sqrt(dot(v, v));
    if (std::fabs(length - 1.0) > 1.0e-3) fail_here("the direction has length " + number_text(length) + ", not 1");
    const double scale = std::fabs(length - 1.0) < 1.0e-12 ? 1.0 : 1.0 / length;
    for (int d = 0; d < 3; d++) n[d] = v[d] * scale;
  };

  next_line("'# dust texture 1'");
  if (line != "# dust texture 1") fail_here("a texture file starts with '# dust texture 1'");
  texture.carrier_radius = 0.5 * numbers("carrier_diameter", 1)[0];
  const std::vector<double> bare = numbers("bare", 4);
  texture.bare.half_angle = bare[0];
  unit_vector(&bare[1], texture.bare.axis);
  const double n = numbers("grains", 1)[0];
  if (n < 1.0 || n > 1.0e8 || n != std::floor(n)) fail_here("the number of grains is not between 1 and 1e8");
  for (int i = 0; i < static_cast<int>(n); i++) {
    const std::vector<double> v = numbers("", 4);
    Grain grain;
    unit_vector(v.data(), grain.n);
    grain.radius = 0.5 * v[3];
    if (!(grain.radius > 0.0)) fail_here("grain diameter " + number_text(v[3]) + " is not above 0");
    texture.grains.push_back(grain);
  }
  next_line("'end'");
  if (line != "end") fail_here("'end' should be here, after " + std::to_string(texture.grains.size()) + " grains");
  while (lineno++, std::getline(in, line))
    if (!line.empty() && line != "\r" && line[0] != '#') fail_here("nothing but comments may follow 'end'");
  check_texture(texture);
  return texture;
}
