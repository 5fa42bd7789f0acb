/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

// for a LAMMPS without GRANSURF: one line that says so, where LAMMPS would not know the style
#if !__has_include("fix_surface_global.h")
#ifdef FIX_CLASS
// clang-format off
FixStyle(surface/global,FixSurfaceMissing);
FixStyle(surface/local,FixSurfaceMissing);
// clang-format on
#else

#ifndef LMP_FIX_SURFACE_MISSING_H
#define LMP_FIX_SURFACE_MISSING_H

#include "error.h"
#include "fix.h"
#include "version.h"

namespace LAMMPS_NS {

class FixSurfaceMissing : public Fix {
 public:
  FixSurfaceMissing(class LAMMPS *_lmp, int narg, char **arg) : Fix(_lmp, narg, arg)
  {
    error->all(
        FLERR,
        "Fix {} needs LAMMPS 4 Jul 2026 or later with its package GRANSURF, and this is LAMMPS {} without it: use "
        "fix wall/gran or wall/gran/region",
        style, LAMMPS_VERSION);
  }
  int setmask() override { return 0; }
};

}    // namespace LAMMPS_NS

#endif
#endif
#endif
