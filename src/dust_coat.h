/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_COAT_H
#define LMP_DUST_COAT_H

#include "pointers.h"

#include "core/grain_table.h"
#include "core/texture.h"

#include <map>
#include <memory>
#include <vector>

namespace LAMMPS_NS {

// the texture that all carriers of a class of sizes share, made ready

struct DustCoat {
  double key;       // of the class
  double radius;    // of the carrier that it was placed on
  std::shared_ptr<const Dust::Texture> texture;
  std::shared_ptr<const Dust::GrainTable> table;
  double mass;        // mean of its grains, in that of the first class: exactly 1 for equal grains
  double checksum;    // tells this texture from another one in a restart file

  explicit operator bool() const { return table != nullptr; }
};

// the coats of all classes that a fix has met, one placed when its first carrier appears: the same on all ranks, in the
// same order

class DustCoats : protected Pointers {
 public:
  DustCoats(class LAMMPS *, const class Fix *, const class DetachSettings &);

  bool empty() const { return coats.empty(); }
  int size() const { return static_cast<int>(coats.size()); }
  const DustCoat &operator[](int number) const { return coats[number]; }
  const Dust::GrainTable &table(int number) const { return *coats[number].table; }
  int max_words() const { return words; }    // of 64 attached bits
  double unit_mass() const { return empty() ? 0.0 : coats[0].table->mean_mass(); }

  // number of the coat of carriers of a radius, which has been placed
  int number_of(double radius) const { return numbers.at(key_of(radius)); }
  // all ranks: coats for the radii that any of them has carriers of
  void place(const std::vector<double> &radii);

  // what a restart file keeps, and from there; all ranks
  std::vector<double> numbers_to_keep() const;
  static bool any_in(const double *list) { return list[2] > 0.0; }
  const double *restore(const double *);

 private:
  const class Fix *fix;
  const class DetachSettings &settings;
  double reference;    // R0, the largest radius when the first carriers are there; 0 until then
  std::vector<DustCoat> coats;
  std::map<double, int> numbers;    // by key
  int words;

  double key_of(double radius) const;
  double radius_of(double key, double largest) const;
  DustCoat make(double key, double radius) const;
  void add(DustCoat &&);
};

}    // namespace LAMMPS_NS

#endif
