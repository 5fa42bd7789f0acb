/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "gran_sub_mod_dust_rolling.h"

#include "core/rolling.h"
#include "gran_sub_mod_dust_normal.h"

#include "error.h"
#include "granular_model.h"

#include <algorithm>

using namespace LAMMPS_NS;
using namespace Granular_NS;

/* ----------------------------------------------------------------------
   says that the model works with synchronized Verlet, which 4Feb2025 does not have
------------------------------------------------------------------------- */

template <typename Model> static auto allow_synchronized_verlet(Model *model, int) -> decltype(void(model->allow_synchronization))
{
  model->allow_synchronization = 1;
}

template <typename Model> static void allow_synchronized_verlet(Model *, long) {}

/* ----------------------------------------------------------------------
   history: rolling displacement, then the normal model's neck. A displacement is even under a swap of i and j, as the
   rolling velocity is: the factor is +1 where LAMMPS' default is -1. Once a model has factors of its own, LAMMPS copies
   of each other model's history no more than its size, from the start of the storage: with the neck at the end rather
   than in the normal model's place at the start, models without one keep theirs whole.
------------------------------------------------------------------------- */

GranSubModRollingDominikTielens::GranSubModRollingDominikTielens(GranularModel *gm, LAMMPS *lmp) :
    GranSubModRolling(gm, lmp), normal(nullptr)
{
  num_coeffs = 1;
  size_history = 4;
  nondefault_history_transfer = 1;
  transfer_history_factor = new double[size_history];
  std::fill_n(transfer_history_factor, size_history, 1.0);
  contact_radius_flag = 1;
  allow_synchronized_verlet(this, 0);
}

/* ---------------------------------------------------------------------- */

void GranSubModRollingDominikTielens::coeffs_to_local()
{
  theta_crit = coeffs[0];
  if (!(theta_crit > 0.0)) error->all(FLERR, "Rolling model dominik/tielens: theta_crit {} must be above 0", theta_crit);
  find_normal_model();
}

/* ---------------------------------------------------------------------- */

void GranSubModRollingDominikTielens::find_normal_model()
{
  normal = dynamic_cast<GranSubModNormalJKRVdW *>(gm->normal_model);
  if (!normal)
    error->all(FLERR, "Rolling model dominik/tielens needs a normal model that knows the pull-off force: jkr/vdw, not {}",
               gm->normal_model ? gm->normal_model->name : "none");
  normal->keep_neck_in(this, 3);
}

/* ---------------------------------------------------------------------- */

void GranSubModRollingDominikTielens::init()
{
  find_normal_model();
}

/* ----------------------------------------------------------------------
   normal of the full step: another one than gm->nx with synchronized Verlet
------------------------------------------------------------------------- */

template <typename Model> static auto full_step_normal(Model *gm, int) -> decltype(&gm->nx_unrotated[0])
{
  return gm->synchronized_verlet ? gm->nx_unrotated : gm->nx;
}

template <typename Model> static double *full_step_normal(Model *gm, long)
{
  return gm->nx;
}

/* ----------------------------------------------------------------------
   M = -4 F_c (a/a0)^(3/2) xi; LAMMPS makes the moment R_eff n x fr of a rolling force fr
------------------------------------------------------------------------- */

void GranSubModRollingDominikTielens::calculate_forces()
{
  double *fr = gm->fr;
  if (!normal->has_neck()) {
    std::fill_n(fr, 3, 0.0);
    return;
  }
  double xi[3];
  std::copy_n(gm->history + history_index, 3, xi);
  if (gm->history_update) {
    Dust::roll_on(xi, full_step_normal(gm, 0), gm->vrl, gm->dt, gm->Reff * theta_crit);
    std::copy_n(xi, 3, gm->history + history_index);
  }
  const double x = gm->contact_radius / normal->equilibrium_contact_radius();
  const double k = Dust::rolling_stiffness(normal->pull_off_force(), x) / gm->Reff;
  for (int d = 0; d < 3; d++) fr[d] = -k * xi[d];
}
