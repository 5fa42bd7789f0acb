/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "surface_contacts.h"

#if __has_include("fix_surface_global.h")
#include "fix_surface_global.h"

using namespace LAMMPS_NS;
using Granular_NS::GranularModel;

namespace {

// It keeps them private, and has no function that tells them. An explicit instantiation may name any member.
template <class Name, typename Name::Type MEMBER> struct Opened {
  friend typename Name::Type member_of(Name /*name*/) { return MEMBER; }
};
struct Models {
  using Type = GranularModel **FixSurfaceGlobal::*;
  friend Type member_of(Models);
};
struct Number {
  using Type = int FixSurfaceGlobal::*;
  friend Type member_of(Number);
};
struct Moves {
  using Type = int FixSurfaceGlobal::*;
  friend Type member_of(Moves);
};
template struct Opened<Models, &FixSurfaceGlobal::models>;
template struct Opened<Number, &FixSurfaceGlobal::nmodel>;
template struct Opened<Moves, &FixSurfaceGlobal::anymove>;

}    // namespace

SurfaceContacts::SurfaceContacts(const Fix *fix)
{
  const auto *surface = dynamic_cast<const FixSurfaceGlobal *>(fix);
  if (!surface) return;
  GranularModel **first = surface->*member_of(Models());
  models.assign(first, first + surface->*member_of(Number()));
  moves = surface->*member_of(Moves());
}

#else

LAMMPS_NS::SurfaceContacts::SurfaceContacts(const Fix * /*fix*/) {}

#endif
