/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "gran_sub_mod_dust_damping.h"

#include "core/damping.h"

#include "error.h"
#include "gran_sub_mod_normal.h"
#include "granular_model.h"

#include <algorithm>
#include <cmath>
#include <string>

using namespace LAMMPS_NS;
using namespace Granular_NS;

/* ---------------------------------------------------------------------- */

GranSubModDampingCoeffRestitutionLimited::GranSubModDampingCoeffRestitutionLimited(GranularModel *_gm, LAMMPS *_lmp) :
    GranSubModDamping(_gm, _lmp)
{
  allow_cohesion = 0;
}

/* ---------------------------------------------------------------------- */

void GranSubModDampingCoeffRestitutionLimited::init()
{
  const std::string &normal = gm->normal_model->name;
  if (normal != "hooke" && normal != "hertz" && normal != "hertz/material")
    error->all(FLERR,
               "Damping coeff_restitution/limited works with the normal models hooke, hertz and hertz/material, "
               "not with {}",
               normal);

  const double e = gm->normal_model->get_damp();
  if (!(e > 0.0 && e <= 1.0))
    error->all(FLERR,
               "Damping coeff_restitution/limited takes the normal model's damping coefficient as coefficient of "
               "restitution: {} is not above 0 and at most 1",
               e);

  damp = (normal == "hooke") ? Dust::hooke_damping(e) : Dust::hertz_damping(e);
}

/* ----------------------------------------------------------------------
   F_d = -damp sqrt(m_eff F_el/delta) v_n, no lower than -F_el: the sum never pulls
------------------------------------------------------------------------- */

double GranSubModDampingCoeffRestitutionLimited::calculate_forces()
{
  damp_prefactor = (gm->delta > 0.0) ? damp * std::sqrt(gm->meff * gm->Fnormal / gm->delta) : 0.0;
  return std::max(-damp_prefactor * gm->vnnr, -gm->Fnormal);
}
