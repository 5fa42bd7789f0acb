/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(wall/gran,FixWallGranNear);
// clang-format on
#else

#ifndef LMP_FIX_WALL_GRAN_NEAR_H
#define LMP_FIX_WALL_GRAN_NEAR_H

#include "core/contact_batch.h"
#include "core/whereabouts.h"

#include "fix_wall_gran.h"

#include <memory>
#include <vector>

namespace LAMMPS_NS {

/* ----------------------------------------------------------------------
   LAMMPS' fix wall/gran under its own name, with the same bits: it looks only at atoms that may touch the wall, and
   computes the laws of carriers and of grains for many contacts at once
------------------------------------------------------------------------- */

class FixWallGranNear : public FixWallGran {
 public:
  FixWallGranNear(class LAMMPS *, int, char **);
  ~FixWallGranNear() override;
  void init() override;
  void reset_dt() override;
  void post_force(int) override;
  double memory_usage() override;

 private:
  bool left_to_parent;
  std::vector<class ContactLaw> laws;    // the one
  void read_law();
  Dust::Planes planes() const;

  std::vector<int> near;     // atoms that touch the wall or may soon, or have a history
  Dust::Whereabouts then;    // when they were found
  double margin;             // up to which they are near
  bool near_known;
  void find_near();

  std::unique_ptr<class ContactQueue> queue;
  void add_contacts();
  void compute_model(int, double);
  void compute_waiting();
};

}    // namespace LAMMPS_NS

#endif
#endif
