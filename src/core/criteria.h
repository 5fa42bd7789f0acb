/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_CRITERIA_H
#define DUST_CORE_CRITERIA_H

#include <tuple>

namespace Dust {

/*! How a grain left its carrier */
enum Mode { NORMAL, TANGENTIAL, SLIDING, ROLLING, KNOCKED, NMODES };

/*! What makes grains detach */
struct Criteria {
  bool count = false;      //!< grains that meet the sliding and rolling criteria
  bool ibrahim = false;    //!< sliding and rolling detach too
  bool meet = false;       //!< grains knock others off (entrainment.h)
  //! the law of tangential lift-off, a file each (tangential_law.h)
  enum Tangential { OFF, FRICTIONLESS, ESTIMATE, IMPULSE, INTEGRATE } tangential = IMPULSE;

  auto all() const { return std::make_tuple(count, ibrahim, meet, tangential); }
  bool operator==(const Criteria &other) const { return all() == other.all(); }
};

}    // namespace Dust

#endif
