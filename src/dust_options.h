/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_OPTIONS_H
#define LMP_DUST_OPTIONS_H

#include "pointers.h"

#include "core/quaternion.h"
#include "core/texture_placement.h"
#include "keywords.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

// the words that say which grains sit on the carriers and how they adhere: shared by all commands that put them there

class DustOptions : protected Pointers {
 public:
  DustOptions(class LAMMPS *, const std::string &command);

  // reads the words from arg[first] on, of a command that has some of its own
  void read(int first, int narg, char **arg, const std::vector<Keyword> &own);

  // radius of an atom that is to be a carrier; stops if it cannot be one
  double carrier_radius(int i) const;
  // whether two radii are one size
  static bool same_size(double, double);
  // whether textures come from files; then which of them, from 0, is for carriers of a radius
  bool from_file() const { return !files.empty(); }
  int file_for(double carrier_radius) const;
  // all ranks: the texture for carriers of a radius. The last monolayer that was placed in this process is kept
  std::shared_ptr<const Dust::Texture> texture(double carrier_radius) const;
  static bool may_keep(const Dust::Texture &texture) { return texture.grains.size() <= MOST_KEPT; }
  // writes it to a file if that is asked for: the first of them, or each one
  void save(const Dust::Texture &, bool first) const;

  // how the carrier with an ID stands at first
  Dust::Quaternion orientation(tagint) const;
  bool same_orientation() const { return orientation_seed == 0; }

  double density, surface_energy, elastic[4];    // elastic: E and nu of the grains, E and nu of the carriers
  double modulus() const;                        // combined modulus E*
  double class_width;                            // w: a texture serves sizes up to a factor 1 + w from that of its file

 protected:
  std::string command;

  // one for each word that is known here
  std::vector<Keyword> keywords();
  // after the last keyword: what must be there is, the rest gets its default
  void complete();
  bool reference_units() const;    // in which the reference case is known, so that there are defaults

 private:
  static constexpr size_t MOST_KEPT = 100000;    // grains, 5 MB
  std::string write;
  struct File {
    std::string name;
    std::shared_ptr<const Dust::Texture> texture;
  };
  std::vector<File> files;
  double diameter, coverage;
  bool distributed;    // sizes instead of diameter
  Dust::SizeDistribution sizes;
  double spread;    // geometric standard deviation of the pull-off forces of grains of a size
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
  std::shared_ptr<const Dust::Texture> monolayer(double carrier_radius) const;
  void read_file(const std::string &);
  void check_plausible(const Dust::Texture &) const;
};

}    // namespace LAMMPS_NS

#endif
