/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_OPTIONS_H
#define LMP_DUST_OPTIONS_H

#include "pointers.h"

#include "core/quaternion.h"
#include "core/texture.h"

#include <string>

namespace LAMMPS_NS {

// the words that say which grains sit on the carriers and how they adhere: shared by all commands that put them there

class DustOptions : protected Pointers {
 public:
  DustOptions(class LAMMPS *, const std::string &);

  // reads the keyword at iarg and its values; returns the place after them, or iarg if the keyword is not known here
  int parse(int iarg, int narg, char **arg);
  // after the last keyword: what must be there is, the rest gets its default
  void complete();

  // helpers for the keywords of a command itself: errors name the command, the keyword and the value
  void need(int iarg, int n, int narg, char **arg) const;
  double number(int iarg, int k, char **arg) const;
  int whole_number(int iarg, int k, char **arg) const;
  double positive(int iarg, int k, char **arg) const;
  void check(int iarg, int k, char **arg, bool ok, const char *range) const;

  // diameter of the carriers of a group on all ranks, halved; 0 if there are none, an error if they differ
  double carrier_radius(int igroup) const;
  // whether carriers of two radii can share a texture
  static bool same_size(double, double);
  // the texture for carriers of a radius; writes it to a file if asked for
  Dust::Texture texture(double carrier_radius) const;

  // how the carrier with an ID stands at first
  Dust::Quaternion orientation(tagint) const;
  bool same_orientation() const { return orientation_seed == 0; }

  double density, surface_energy, elastic[4];    // elastic: E and nu of the grains, E and nu of the carriers
  double modulus() const;                        // combined modulus E*

 private:
  std::string command;
  std::string file, write;
  Dust::Texture from_file;
  double diameter, coverage;
  bool distributed;    // sizes instead of diameter
  Dust::SizeDistribution sizes;
  int seed;
  Dust::BareCap bare;
  bool bare_given;
  int orientation_seed;    // 0: all the same

  int parse_texture(int iarg, int narg, char **arg);
  void read(const std::string &);
};

}    // namespace LAMMPS_NS

#endif
