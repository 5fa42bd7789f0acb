/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_SURFACE_CONTACTS_H
#define LMP_SURFACE_CONTACTS_H

#include <vector>

namespace LAMMPS_NS {

class Fix;
namespace Granular_NS {
class GranularModel;
}

// what a fix surface/global does not tell by itself; no models of any other fix

struct SurfaceContacts {
  std::vector<Granular_NS::GranularModel *> models;
  bool moves = false;    // by fix_modify move

  explicit SurfaceContacts(const Fix *);
};

}    // namespace LAMMPS_NS

#endif
