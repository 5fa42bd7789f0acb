/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "texture_file.h"

#include "geometry.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

using namespace Dust;

static const char FIRST_LINE[] = "# dust texture 1";

/* ----------------------------------------------------------------------
   numbers with the digits that tell any two of them apart, whatever the locale
------------------------------------------------------------------------- */

static void append(std::string &text, double x)
{
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof(digits), x, std::chars_format::general, 17).ptr;
  text.append(digits, end);
}

static void append(std::string &text, const double *n, double last)
{
  for (int d = 0; d < 3; d++) {
    append(text, n[d]);
    text += ' ';
  }
  append(text, last);
  text += '\n';
}

// hands the text to put() in pieces
template <typename Put> static void put_texture(const Texture &texture, Put put)
{
  std::string text = std::string(FIRST_LINE) + "\ncarrier_diameter ";
  append(text, 2.0 * texture.carrier_radius);
  text += "\nbare ";
  append(text, texture.bare.half_angle);
  for (const double x : texture.bare.axis) {
    text += ' ';
    append(text, x);
  }
  text += "\ngrains " + std::to_string(texture.grains.size()) + "\n# nx ny nz diameter\n";
  constexpr size_t PIECE = 1 << 20;
  for (const Grain &grain : texture.grains) {
    append(text, grain.n, 2.0 * grain.radius);
    if (text.size() < PIECE) continue;
    put(text);
    text.clear();
  }
  put(text + "end\n");
}

/* ---------------------------------------------------------------------- */

void Dust::write_texture(const Texture &texture, std::ostream &out)
{
  put_texture(texture, [&out](const std::string &text) { out << text; });
}

/* ----------------------------------------------------------------------
   a file that is open for writing
------------------------------------------------------------------------- */

namespace {

[[noreturn]] void fail_to_write() { throw TextureError(std::string("it cannot be written: ") + std::strerror(errno)); }

class Output {
 public:
  explicit Output(int descriptor) : file(descriptor)
  {
    if (file < 0) fail_to_write();
  }
  ~Output()
  {
    if (file >= 0) ::close(file);
  }
  Output(const Output &) = delete;
  Output &operator=(const Output &) = delete;

  void put(const std::string &text) const
  {
    for (size_t done = 0; done < text.size();) {
      const ssize_t written = ::write(file, text.data() + done, text.size() - done);
      if (written < 0 && errno != EINTR) fail_to_write();
      if (written > 0) done += static_cast<size_t>(written);
    }
  }
  void close(bool to_disk)
  {
    if (to_disk && ::fsync(file) != 0) fail_to_write();
    const int descriptor = file;
    file = -1;
    if (::close(descriptor) != 0) fail_to_write();
  }

 private:
  int file;
};

// the file behind a link, so that the link stays one
std::string target_of(const std::string &path)
{
  const std::unique_ptr<char, decltype(&std::free)> target(::realpath(path.c_str(), nullptr), &std::free);
  return target ? target.get() : path;
}

// so that the new name survives a crash, where the file system can promise that
void sync_folder_of(const std::string &path)
{
  const size_t slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}    // namespace

/* ----------------------------------------------------------------------
   under another name beside it, to be renamed when it is complete and on the disk; devices have nothing to lose
------------------------------------------------------------------------- */

void Dust::write_texture_file(const Texture &texture, const std::string &path)
{
  const std::string target = target_of(path);
  struct stat there;
  const bool exists = ::stat(target.c_str(), &there) == 0;
  if (exists && ::access(target.c_str(), W_OK) != 0) fail_to_write();
  if (exists && !S_ISREG(there.st_mode)) {
    Output out(::open(target.c_str(), O_WRONLY));
    put_texture(texture, [&out](const std::string &text) { out.put(text); });
    out.close(false);
    return;
  }
  const std::string part = target + ".part" + std::to_string(::getpid());
  Output out(::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW, 0666));
  try {
    put_texture(texture, [&out](const std::string &text) { out.put(text); });
    out.close(true);
    if (::rename(part.c_str(), target.c_str()) != 0) fail_to_write();
  } catch (...) {
    ::unlink(part.c_str());
    throw;
  }
  sync_folder_of(target);
}

/* ----------------------------------------------------------------------
   line by line; every complaint names the line
------------------------------------------------------------------------- */

namespace {

class Lines {
 public:
  explicit Lines(std::istream &stream) : in(stream), number(0) {}

  // the next line that counts; expected = what should be there
  void next(const std::string &expected)
  {
    do {
      if (!get()) fail("the file ends where " + expected + " should be: it is cut off");
    } while (skipped());
  }
  void first()
  {
    if (!get() || line != FIRST_LINE)
      fail(std::string("a texture file starts with '") + FIRST_LINE + "', not with " + shown(line));
  }
  void nothing_more()
  {
    while (get())
      if (!skipped()) fail("only lines that start with # may follow 'end', not " + shown(line));
  }

  // the numbers after the word that the line starts with, if it is not ""
  void numbers(const std::string &word, int n, double *values)
  {
    next(word.empty() ? "a grain" : "'" + word + "'");
    std::string_view rest = line;
    if (!word.empty() && take(rest) != word) fail("'" + word + "' should be here, not " + shown(line));
    int found = 0;
    for (std::string_view token = take(rest); !token.empty(); token = take(rest)) {
      const double value = finite(token);
      if (found < n) values[found] = value;
      found++;
    }
    if (found != n) fail(std::to_string(n) + " numbers should be here, not " + std::to_string(found));
  }
  void end(size_t grains)
  {
    next("'end'");
    std::string_view rest = line;
    if (take(rest) != "end" || !take(rest).empty())
      fail("'end' should be here, after " + std::to_string(grains) + " grains, not " + shown(line));
  }

  [[noreturn]] void fail(const std::string &what) const
  {
    throw TextureError("line " + std::to_string(number) + ": " + what);
  }
  int at() const { return number; }

 private:
  std::istream &in;
  std::string line;
  int number;

  bool get()
  {
    number++;
    if (!std::getline(in, line)) return false;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return true;
  }
  bool skipped() const { return line.find_first_not_of(BLANK) == std::string::npos || line[0] == '#'; }

  static constexpr char BLANK[] = " \t";
  static std::string_view take(std::string_view &rest)
  {
    rest.remove_prefix(std::min(rest.find_first_not_of(BLANK), rest.size()));
    const std::string_view token = rest.substr(0, rest.find_first_of(BLANK));
    rest.remove_prefix(token.size());
    return token;
  }
  double finite(std::string_view token) const
  {
    std::string_view digits = token;
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
      fail(shown(token) + " is not a finite number");
    return value;
  }
  // as one line can show it, however long and odd
  static std::string shown(std::string_view text)
  {
    constexpr size_t MOST = 40;
    std::string printable = "'";
    for (const char c : text.substr(0, MOST)) printable += c >= ' ' && c <= '~' ? c : '?';
    return printable + (text.size() > MOST ? "...'" : "'");
  }
};

// unit vector, as written if it is one to round-off, so that a texture survives being written and read
void unit_vector(const Lines &lines, const double *v, double *n)
{
  const double length = std::sqrt(dot(v, v));
  if (!(std::fabs(length - 1.0) <= 1.0e-3))
    lines.fail("the direction has length " + number_text(length) + ": it must be 1 within 0.001");
  const double scale = std::fabs(length - 1.0) < 1.0e-12 ? 1.0 : 1.0 / length;
  for (int d = 0; d < 3; d++) n[d] = v[d] * scale;
}

Grain read_grain(Lines &lines, const Texture &texture)
{
  double v[4];
  lines.numbers("", 4, v);
  Grain grain;
  unit_vector(lines, v, grain.n);
  grain.radius = 0.5 * v[3];
  if (!(v[3] > 0.0 && v[3] < texture.carrier_radius))
    lines.fail("grain diameter " + number_text(v[3]) + " must be above 0 and below the carrier's radius, " +
               number_text(texture.carrier_radius));
  return grain;
}

}    // namespace

/* ---------------------------------------------------------------------- */

Texture Dust::read_texture(std::istream &in)
{
  Texture texture;
  Lines lines(in);
  lines.first();
  double diameter, bare[4], count;
  lines.numbers("carrier_diameter", 1, &diameter);
  if (!(diameter > 0.0)) lines.fail("carrier_diameter " + number_text(diameter) + " must be above 0");
  texture.carrier_radius = 0.5 * diameter;
  lines.numbers("bare", 4, bare);
  if (!(bare[0] >= 0.0 && bare[0] < PI))
    lines.fail("the half-angle of the bare cap, " + number_text(bare[0]) + ", must be at least 0 and below pi");
  texture.bare.half_angle = bare[0];
  unit_vector(lines, bare + 1, texture.bare.axis);
  lines.numbers("grains", 1, &count);
  if (!(count >= 1.0 && count <= MOST_GRAINS && count == std::floor(count)))
    lines.fail("the number of grains, " + number_text(count) + ", must be a whole number from 1 to " +
               number_text(MOST_GRAINS));

  std::vector<int> where;    // line of each grain
  for (int i = 0; i < static_cast<int>(count); i++) {
    texture.grains.push_back(read_grain(lines, texture));
    where.push_back(lines.at());
  }
  lines.end(texture.grains.size());
  lines.nothing_more();
  check_texture(texture, where);
  return texture;
}

/* ---------------------------------------------------------------------- */

Texture Dust::read_texture_file(const std::string &path)
{
  struct stat there;
  errno = 0;
  if (::stat(path.c_str(), &there) == 0 && S_ISDIR(there.st_mode)) errno = EISDIR;
  std::ifstream in;
  if (errno == 0) in.open(path);
  if (!in.is_open()) throw TextureError(std::string("it cannot be read: ") + std::strerror(errno));
  return read_texture(in);
}
