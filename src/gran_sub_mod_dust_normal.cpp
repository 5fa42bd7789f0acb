/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "gran_sub_mod_dust_normal.h"

#include "core/hamaker.h"
#include "core/jkr.h"
#include "core/overlap_rate.h"

#include "error.h"
#include "force.h"
#include "gran_sub_mod_damping.h"
#include "gran_sub_mod_heat.h"
#include "granular_model.h"
#include "neigh_request.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <string>

using namespace LAMMPS_NS;
using namespace Granular_NS;

// places in the history after the neck's
static constexpr int PLACE_OF_ROLLING = 1, PLACE_OF_RATE = 4;
static constexpr double CUTOFF = 10.0;    // of the attraction, in z0: a hundredth of the pull-off force is left there

/* ---------------------------------------------------------------------- */

GranSubModNormalJKRVdW::GranSubModNormalJKRVdW(GranularModel *_gm, LAMMPS *_lmp) :
    GranSubModNormal(_gm, _lmp), mixed_modulus(0.0), last_Reff(-1.0), warned(false), neck(false), laid_out(-1)
{
  num_coeffs = 5;
  material_properties = cohesive_flag = beyond_contact = contact_radius_flag = 1;
}

GranSubModNormalJKRVdWCut::GranSubModNormalJKRVdWCut(GranularModel *_gm, LAMMPS *_lmp) :
    GranSubModNormalJKRVdW(_gm, _lmp)
{
  num_coeffs = 6;
}

/* ----------------------------------------------------------------------
   Neck, rolling displacement and rate of the overlap are kept at the end of the history, in the place of the heat
   model, the last one: there they move no value of other models in the same pair style, which LAMMPS would then copy
   wrongly when i and j change places.
------------------------------------------------------------------------- */

void GranSubModNormalJKRVdW::init()
{
  const std::string &damping = gm->damping_model->name;
  if (damping == "velocity" || damping == "mass_velocity")
    error->all(FLERR, "Normal model {} cannot use damping {}, which acts without a neck: use viscoelastic", name,
               damping);
  gm->heat_model->size_history = PLACE_OF_RATE + 3;
  gm->size_history = 0;
  for (const GranSubMod *model : gm->sub_models) gm->size_history += model->size_history;
  laid_out = -1;
}

int GranSubModNormalJKRVdW::neck_place() const { return gm->heat_model->history_index; }

double *GranSubModNormalJKRVdW::rolling_in(double *history) const { return history + neck_place() + PLACE_OF_ROLLING; }

/* ----------------------------------------------------------------------
   When i and j change places, LAMMPS copies as many values as this model has, but keeps room for the largest sub-model
   of each kind between them: count the gaps too.
------------------------------------------------------------------------- */

void GranSubModNormalJKRVdW::lay_out_history()
{
  laid_out = neck_place();
  gm->size_history = laid_out + gm->heat_model->size_history;
  if (!gm->nondefault_history_transfer) return;
  delete[] gm->transfer_history_factor;
  gm->transfer_history_factor = new double[gm->size_history];
  std::fill_n(gm->transfer_history_factor, gm->size_history, -1.0);
  for (const GranSubMod *model : gm->sub_models)
    if (model->nondefault_history_transfer)
      std::copy_n(model->transfer_history_factor, model->size_history,
                  gm->transfer_history_factor + model->history_index);
}

/* ---------------------------------------------------------------------- */

void GranSubModNormalJKRVdW::coeffs_to_local()
{
  Emod = coeffs[0];
  damp = coeffs[1];
  poiss = coeffs[2];
  hamaker = coeffs[3];
  z0 = coeffs[4];
  z_cut = num_coeffs > 5 ? coeffs[5] : CUTOFF * z0;

  if (!(Emod > 0.0)) error->all(FLERR, "Normal model {}: E {} must be above 0", name, Emod);
  if (!(damp >= 0.0)) error->all(FLERR, "Normal model {}: eta {} must be at least 0", name, damp);
  if (!(poiss > -1.0 && poiss <= 0.5))
    error->all(FLERR, "Normal model {}: nu {} must be above -1 and at most 0.5", name, poiss);
  if (!(hamaker > 0.0)) error->all(FLERR, "Normal model {}: A {} must be above 0", name, hamaker);
  if (!(z0 > 0.0)) error->all(FLERR, "Normal model {}: z0 {} must be above 0", name, z0);
  if (!(z_cut > z0)) error->all(FLERR, "Normal model {}: z_cut {} must be above z0 {}", name, z_cut, z0);

  modulus = mixed_modulus > 0.0 ? mixed_modulus : Dust::combined_modulus(Emod, poiss, Emod, poiss);
  gamma = Dust::surface_energy(hamaker, z0);
  range = z_cut - z0;
  last_Reff = -1.0;
}

/* ----------------------------------------------------------------------
   a mixed model gets the E and nu of a body whose contact with its like has the two materials' combined moduli E* and
   G*, for models that ask it for them: 2 G* = E* (1 - nu)/(2 - nu)
------------------------------------------------------------------------- */

void GranSubModNormalJKRVdW::mix_coeffs(double *icoeffs, double *jcoeffs)
{
  static constexpr const char *SAME = "Normal model {} cannot mix {} {} and {}: give the pair its own pair_coeff";
  if (icoeffs[4] != jcoeffs[4]) error->all(FLERR, SAME, name, "z0", icoeffs[4], jcoeffs[4]);
  if (num_coeffs > 5 && icoeffs[5] != jcoeffs[5]) error->all(FLERR, SAME, name, "z_cut", icoeffs[5], jcoeffs[5]);
  std::copy_n(icoeffs, num_coeffs, coeffs);
  mixed_modulus = Dust::combined_modulus(icoeffs[0], icoeffs[2], jcoeffs[0], jcoeffs[2]);
  if (icoeffs[2] != jcoeffs[2]) {
    const double ratio = 2.0 * mix_stiffnessG(icoeffs[0], jcoeffs[0], icoeffs[2], jcoeffs[2]) / mixed_modulus;
    coeffs[2] = (1.0 - 2.0 * ratio) / (1.0 - ratio);
  }
  coeffs[0] = 2.0 * mixed_modulus * (1.0 - coeffs[2] * coeffs[2]);
  coeffs[1] = mix_geom(icoeffs[1], jcoeffs[1]);
  coeffs[3] = mix_geom(icoeffs[3], jcoeffs[3]);
  coeffs_to_local();
}

/* ---------------------------------------------------------------------- */

void GranSubModNormalJKRVdW::use_radius(double Reff)
{
  last_Reff = Reff;
  Fc = Dust::pull_off_force(gamma, Reff);
  a0 = Dust::equilibrium_contact_radius(gamma, Reff, modulus);
  delta_c = Dust::breaking_gap(a0, Reff);
  largest_gap = std::max(delta_c, range);
  const double shared = std::min(delta_c, range);
  if (!warned && Dust::NECK_WORK * delta_c < z0 * shared / (z0 + shared)) {
    warned = true;
    error->warning(
        FLERR,
        "Normal model {}: with an effective radius of {} the neck breaks at a gap of {} z0: a bounce gains energy",
        name, Reff, delta_c / z0);
  }
}

/* ---------------------------------------------------------------------- */

GranSubModNormalJKRVdW::Adhesion GranSubModNormalJKRVdW::adhesion(double Reff)
{
  if (Reff != last_Reff) use_radius(Reff);
  return {hamaker, z0, range, Fc, a0, delta_c, largest_gap};
}

int GranSubModNormalJKRVdW::place_in_history()
{
  if (laid_out != neck_place()) lay_out_history();
  return laid_out;
}

/* ----------------------------------------------------------------------
   as far as either attraction can reach; LAMMPS has not set the history yet, so the neck is not known here
------------------------------------------------------------------------- */

bool GranSubModNormalJKRVdW::touch()
{
  if (gm->Reff != last_Reff) use_radius(gm->Reff);
  const double reach = gm->radsum + largest_gap;
  return gm->rsq < reach * reach;
}

/* ----------------------------------------------------------------------
   fix wall/gran/region asks for a flat wall with radius 0; in pairs that is no neighbour
------------------------------------------------------------------------- */

double GranSubModNormalJKRVdW::pulloff_distance(double radi, double radj)
{
  if (radi <= 0.0 || (radj <= 0.0 && gm->contact_type == PAIR)) return 0.0;
  const double Reff = radj > 0.0 ? Dust::effective_radius(radi, radj) : radi;
  const double reach =
      std::max(Dust::breaking_gap(Dust::equilibrium_contact_radius(gamma, Reff, modulus), Reff), range);
  if (gm->contact_type == PAIR) check_skin(reach);
  return reach;
}

/* ----------------------------------------------------------------------
   pair lists by radii (4Feb2025) reach as far as the skin beyond contact
------------------------------------------------------------------------- */

void GranSubModNormalJKRVdW::check_skin(double reach)
{
  const Pair *pair = force->pair_match("granular", 1);
  const NeighRequest *request = pair ? neighbor->find_request((void *)pair) : nullptr;
  if (request && request->get_size() && neighbor->skin < reach)
    error->all(FLERR,
               "Normal model {}: this LAMMPS needs a neighbor skin of at least the attraction's reach {}, not {}", name,
               reach, neighbor->skin);
}

/* ----------------------------------------------------------------------
   called first of all: forms the neck at contact, breaks it at the end of the branch
------------------------------------------------------------------------- */

double GranSubModNormalJKRVdW::calculate_contact_radius()
{
  if (gm->Reff != last_Reff) use_radius(gm->Reff);
  // x of the last step, negated when i and j have changed places
  double &kept = gm->history[place_in_history()];
  neck = gm->delta >= 0.0 || (kept != 0.0 && gm->delta > -delta_c);
  x = neck ? Dust::jkr_contact_radius(gm->delta / delta_c, kept) : 0.0;

  const double before = kept;
  if (gm->history_update) {
    if (neck != (before != 0.0)) last_events.neck = update->ntimestep;
    // nothing is remembered of before the neck: stock models sum up their displacements all the time
    if (!neck || before == 0.0)
      for (const GranSubMod *model : gm->sub_models)
        std::fill_n(gm->history + model->history_index, model->size_history, 0.0);
    kept = std::copysign(x, before);
  }
  if (neck) use_overlap_rate(before == 0.0);
  return x * a0;
}

/* ----------------------------------------------------------------------
   Damping models take the velocity at which the surfaces part from gm->vnnr: give them that of this step. The rate is
   even under a swap of i and j, so it is kept times the sign of the neck. Where history must not change, in setup and
   for output, that of the last step is used again; a new neck has none yet, and LAMMPS' velocity serves.
------------------------------------------------------------------------- */

void GranSubModNormalJKRVdW::use_overlap_rate(bool anew)
{
  double *kept = gm->history + laid_out + PLACE_OF_RATE;
  const double sign = std::copysign(1.0, gm->history[laid_out]), decay = damp * x * a0;
  Dust::OverlapRate now = {sign * kept[0], sign * kept[1], sign * kept[2]};
  if (!gm->history_update) {
    if (!anew) gm->vnnr = -now.rate;
    return;
  }
  if (anew)
    now.begin(gm->delta, -gm->vnnr, decay, update->dt);
  else
    now.advance(gm->delta, decay, update->dt);
  kept[0] = sign * now.overlap;
  kept[1] = sign * now.coasting;
  kept[2] = sign * now.rate;
  gm->vnnr = -now.rate;
}

/* ---------------------------------------------------------------------- */

double GranSubModNormalJKRVdW::calculate_forces()
{
  if (neck)
    Fne = Fc * Dust::jkr_force(x);
  else
    Fne = gm->delta > -range ? -Dust::hamaker_force(hamaker, z0, gm->Reff, -gm->delta) : 0.0;
  return Fne;
}

/* ----------------------------------------------------------------------
   sliding limit per friction coefficient: Thornton, J. Phys. D 24, 1942 (1991); without damping
------------------------------------------------------------------------- */

void GranSubModNormalJKRVdW::set_fncrit() { Fncrit = neck ? std::fabs(Fne + 2.0 * Fc) : 0.0; }
