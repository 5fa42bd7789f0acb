/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "gran_sub_mod_dust_normal.h"

#include "core/hamaker.h"
#include "core/jkr.h"

#include "error.h"
#include "granular_model.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace Granular_NS;

static constexpr double CUTOFF = 10.0;    // of the attraction, in z0: a hundredth of the pull-off force is left there

/* ---------------------------------------------------------------------- */

GranSubModNormalJKRVdW::GranSubModNormalJKRVdW(GranularModel *gm, LAMMPS *lmp) :
    GranSubModNormal(gm, lmp), mixed_modulus(0.0), last_Reff(-1.0), neck(false), neck_owner(this), neck_place(0)
{
  num_coeffs = 5;
  size_history = 1;
  material_properties = cohesive_flag = beyond_contact = contact_radius_flag = 1;
}

/* ---------------------------------------------------------------------- */

void GranSubModNormalJKRVdW::coeffs_to_local()
{
  Emod = coeffs[0];
  damp = coeffs[1];
  poiss = coeffs[2];
  hamaker = coeffs[3];
  z0 = coeffs[4];

  if (!(Emod > 0.0)) error->all(FLERR, "Normal model jkr/vdw: E {} must be above 0", Emod);
  if (!(damp >= 0.0)) error->all(FLERR, "Normal model jkr/vdw: eta {} must be at least 0", damp);
  if (!(poiss > -1.0 && poiss <= 0.5)) error->all(FLERR, "Normal model jkr/vdw: nu {} must be above -1 and at most 0.5", poiss);
  if (!(hamaker > 0.0)) error->all(FLERR, "Normal model jkr/vdw: A {} must be above 0", hamaker);
  if (!(z0 > 0.0)) error->all(FLERR, "Normal model jkr/vdw: z0 {} must be above 0", z0);

  modulus = mixed_modulus > 0.0 ? mixed_modulus : Dust::combined_modulus(Emod, poiss, Emod, poiss);
  gamma = Dust::surface_energy(hamaker, z0);
  range = (CUTOFF - 1.0) * z0;
  last_Reff = -1.0;
}

/* ----------------------------------------------------------------------
   a mixed model gets the modulus E that gives the two materials' E*, for models that ask it for E
------------------------------------------------------------------------- */

void GranSubModNormalJKRVdW::mix_coeffs(double *icoeffs, double *jcoeffs)
{
  if (icoeffs[4] != jcoeffs[4])
    error->all(FLERR, "Normal model jkr/vdw cannot mix z0 {} and {}: give the pair its own pair_coeff", icoeffs[4], jcoeffs[4]);
  mixed_modulus = Dust::combined_modulus(icoeffs[0], icoeffs[2], jcoeffs[0], jcoeffs[2]);
  coeffs[1] = mix_geom(icoeffs[1], jcoeffs[1]);
  coeffs[2] = mix_mean(icoeffs[2], jcoeffs[2]);
  coeffs[0] = 2.0 * mixed_modulus * (1.0 - coeffs[2] * coeffs[2]);
  coeffs[3] = mix_geom(icoeffs[3], jcoeffs[3]);
  coeffs[4] = icoeffs[4];
  coeffs_to_local();
}

/* ---------------------------------------------------------------------- */

void GranSubModNormalJKRVdW::keep_neck_in(GranSubMod *owner, int place)
{
  size_history = 0;
  neck_owner = owner;
  neck_place = place;
}

/* ---------------------------------------------------------------------- */

void GranSubModNormalJKRVdW::use_radius(double Reff)
{
  if (Reff == last_Reff) return;
  last_Reff = Reff;
  Fc = Dust::pull_off_force(gamma, Reff);
  a0 = Dust::equilibrium_contact_radius(gamma, Reff, modulus);
  delta_c = Dust::breaking_gap(a0, Reff);
}

/* ----------------------------------------------------------------------
   as far as either attraction can reach; LAMMPS has not set the history yet, so the neck is not known here
------------------------------------------------------------------------- */

bool GranSubModNormalJKRVdW::touch()
{
  use_radius(gm->Reff);
  const double reach = gm->radsum + std::max(delta_c, range);
  return gm->rsq < reach * reach;
}

/* ----------------------------------------------------------------------
   fix wall/gran/region asks for a flat wall with radius 0; in pairs that is no neighbour
------------------------------------------------------------------------- */

double GranSubModNormalJKRVdW::pulloff_distance(double radi, double radj)
{
  if (radi <= 0.0 || (radj <= 0.0 && gm->contact_type == PAIR)) return 0.0;
  const double Reff = radj > 0.0 ? Dust::effective_radius(radi, radj) : radi;
  return std::max(Dust::breaking_gap(Dust::equilibrium_contact_radius(gamma, Reff, modulus), Reff), range);
}

/* ----------------------------------------------------------------------
   called first of all: forms the neck at contact, breaks it at the end of the branch
------------------------------------------------------------------------- */

double GranSubModNormalJKRVdW::calculate_contact_radius()
{
  use_radius(gm->Reff);
  // x of the last step; a swap of i and j may have changed its sign
  double &kept = gm->history[neck_owner->history_index + neck_place];
  neck = gm->delta >= 0.0 || (kept != 0.0 && gm->delta > -delta_c);
  x = neck ? Dust::jkr_contact_radius(gm->delta / delta_c, kept) : 0.0;

  if (gm->history_update) {
    if (neck != (kept != 0.0)) last_events.neck = update->ntimestep;
    // nothing is remembered of before the neck: stock models sum up their displacements all the time
    if (!neck || kept == 0.0)
      for (const GranSubMod *model : gm->sub_models)
        std::fill_n(gm->history + model->history_index, model->size_history, 0.0);
    kept = x;
  }
  return x * a0;
}

/* ---------------------------------------------------------------------- */

double GranSubModNormalJKRVdW::calculate_forces()
{
  if (neck) Fne = Fc * Dust::jkr_force(x);
  else Fne = gm->delta > -range ? -Dust::hamaker_force(hamaker, z0, gm->Reff, -gm->delta) : 0.0;
  return Fne;
}

/* ----------------------------------------------------------------------
   sliding limit per friction coefficient: Thornton, J. Phys. D 24, 1942 (1991); without damping
------------------------------------------------------------------------- */

void GranSubModNormalJKRVdW::set_fncrit()
{
  Fncrit = neck ? std::fabs(Fne + 2.0 * Fc) : 0.0;
}
