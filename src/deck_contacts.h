/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DECK_CONTACTS_H
#define LMP_DECK_CONTACTS_H

#include "pointers.h"

#include <functional>
#include <string>
#include <vector>

namespace LAMMPS_NS {

namespace Granular_NS {
class GranularModel;
}

// one contact model of a deck that carriers meet, as far as it can be read

struct CarrierContact {
  enum Law { HERTZ, HOOKE, OTHER };

  // factor: what multiplies all of the model's forces
  CarrierContact(const std::string &where, class Granular_NS::GranularModel *model, bool mixed, double factor,
                 bool wall);

  std::string where;      // "pair_coeff 1 1", "fix wall"
  std::string damping;    // name of the model
  bool wall;
  Law law;
  double stiffness;    // HERTZ: E* = 3/4 force/(overlap x contact radius); HOOKE: force/overlap; OTHER: E*, 0 unknown
  bool pulls;          // its damping may do so
  std::string not_stiffened;    // why softening it by one factor is not softening all of its forces alike, or empty
};

// the models between carriers and the atoms they can meet, and between carriers and their walls

// what the atoms of a type are to a fix
enum class Meets { NOTHING, ATOM, CARRIER };

class DeckContacts : protected Pointers {
 public:
  DeckContacts(class LAMMPS *, const std::vector<Meets> &types, const std::function<bool(const class Fix *)> &acts);

  std::vector<CarrierContact> all;
  // pair styles that push carriers but are no granular models; those of them that act beyond contact
  std::vector<std::string> other_styles, far_styles;

 private:
  void look_at_style(class Pair *, const std::string &style, const std::vector<Meets> &types);
  void look_at_pairs(class PairGranular *, const std::vector<Meets> &types, double factor);
  void add(const CarrierContact &);
};

}    // namespace LAMMPS_NS

#endif
