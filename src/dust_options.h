/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_OPTIONS_H
#define LMP_DUST_OPTIONS_H

#include "pointers.h"

#include "core/quaternion.h"
#include "core/texture_placement.h"
#include "keywords.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

// the words that say which grains sit on the carriers and how they adhere: shared by all commands that put them there

class DustOptions : protected Pointers {
 public:
  DustOptions(class LAMMPS *, const std::string &command);

  // reads the words from arg[first] on, of a command that has no keywords of its own
  void read(int first, int narg, char **arg);

  // diameter of the carriers of a group on all ranks, halved; 0 if there are none, an error if they differ
  double carrier_radius(int igroup) const;
  // whether carriers of two radii can share a texture
  static bool same_size(double, double);
  // the texture for carriers of a radius
  Dust::Texture texture(double carrier_radius) const;
  // writes it to a file if that is asked for
  void save(const Dust::Texture &) const;

  // how the carrier with an ID stands at first
  Dust::Quaternion orientation(tagint) const;
  bool same_orientation() const { return orientation_seed == 0; }

  double density, surface_energy, elastic[4];    // elastic: E and nu of the grains, E and nu of the carriers
  double modulus() const;                        // combined modulus E*

 protected:
  std::string command;

  // one for each word that is known here
  std::vector<Keyword> keywords();
  // after the last keyword: what must be there is, the rest gets its default
  void complete();
  bool reference_units() const;    // in which the reference case is known, so that there are defaults

 private:
  std::string file, write;
  Dust::Texture from_file;
  double diameter, coverage;
  bool distributed;    // sizes instead of diameter
  Dust::SizeDistribution sizes;
  int seed;
  Dust::BareCap bare;
  bool bare_given;
  int orientation_seed;    // 0: all the same

  void take_texture(Keywords &);
  void take_bare(Keywords &);
  void take_hamaker(Keywords &);
  Range surface_energies() const;
  void take_elastic(Keywords &);
  void take_distribution(Keywords &);
  template <typename Action> void on_one_rank(const std::string &what, Action) const;
  void share(Dust::Texture &) const;
  Dust::BareCap bare_cap(double carrier_radius) const;
  void read_file(const std::string &);
  void check_plausible(const Dust::Texture &) const;
};

}    // namespace LAMMPS_NS

#endif
