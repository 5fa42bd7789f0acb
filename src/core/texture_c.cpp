/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "texture_c.h"

#include "texture_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <fstream>
#include <memory>
#include <new>
#include <string>

struct DustTexture {
  Dust::Texture texture;
};

// no exception may leave a C function
static std::unique_ptr<DustTexture> read(const char *path, std::string &message)
{
  try {
    return std::make_unique<DustTexture>(DustTexture{Dust::read_texture_file(path)});
  } catch (const Dust::TextureError &wrong) {
    message = wrong.what();
  } catch (const std::bad_alloc &) {
    message = "not enough memory for its grains";
  } catch (const std::exception &other) {
    message = other.what();
  }
  return nullptr;
}

DustTexture *dust_texture_read(const char *path, char *message, int size)
{
  std::string what;
  std::unique_ptr<DustTexture> texture = read(path, what);
  if (message && size > 0) {
    const size_t length = std::min(what.size(), static_cast<size_t>(size) - 1);
    std::copy_n(what.data(), length, message);
    message[length] = 0;
  }
  return texture.release();
}

int dust_texture_check(const char *path, char *message, int size)
{
  DustTexture *texture = dust_texture_read(path, message, size);
  dust_texture_free(texture);
  return texture ? 1 : 0;
}

double dust_texture_carrier_diameter(const DustTexture *texture) { return 2.0 * texture->texture.carrier_radius; }

void dust_texture_bare(const DustTexture *texture, double *half_angle, double axis[3])
{
  *half_angle = texture->texture.bare.half_angle;
  std::copy_n(texture->texture.bare.axis, 3, axis);
}

long long dust_texture_grains(const DustTexture *texture)
{
  return static_cast<long long>(texture->texture.grains.size());
}

void dust_texture_table(const DustTexture *texture, double *table)
{
  for (const Dust::Grain &grain : texture->texture.grains) {
    table = std::copy_n(grain.n, 3, table);
    *table++ = 2.0 * grain.radius;
  }
}

void dust_texture_adhesion(const DustTexture *texture, double *factors)
{
  for (const Dust::Grain &grain : texture->texture.grains) *factors++ = grain.adhesion;
}

void dust_texture_free(DustTexture *texture) { delete texture; }
