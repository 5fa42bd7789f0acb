/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "gran_sub_mod_dust_rolling.h"

#include "core/rolling.h"
#include "gran_sub_mod_dust_normal.h"

#include "error.h"
#include "gran_sub_mod_tangential.h"
#include "granular_model.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace Granular_NS;

/* ----------------------------------------------------------------------
   says that the model works with synchronized Verlet, which 4Feb2025 does not have
------------------------------------------------------------------------- */

template <typename Model> static auto allow_synchronized_verlet(Model *model, int)
    -> decltype(void(model->allow_synchronization))
{
  model->allow_synchronization = 1;
}

template <typename Model> static void allow_synchronized_verlet(Model *, long) {}

/* ----------------------------------------------------------------------
   The rolling displacement is even under a swap of i and j, as the rolling velocity is, but LAMMPS negates all history:
   so it is kept times the sign of the neck, which is negated with it, and in the normal model's place.
------------------------------------------------------------------------- */

GranSubModRollingDominikTielens::GranSubModRollingDominikTielens(GranularModel *_gm, LAMMPS *_lmp) :
    GranSubModRolling(_gm, _lmp), normal(nullptr)
{
  num_coeffs = 1;
  contact_radius_flag = 1;
  allow_synchronized_verlet(this, 0);
}

/* ---------------------------------------------------------------------- */

void GranSubModRollingDominikTielens::coeffs_to_local()
{
  theta_crit = coeffs[0];
  if (!(theta_crit > 0.0))
    error->all(FLERR, "Rolling model dominik/tielens: theta_crit {} must be above 0", theta_crit);
  find_normal_model();
}

/* ---------------------------------------------------------------------- */

void GranSubModRollingDominikTielens::find_normal_model()
{
  normal = dynamic_cast<GranSubModNormalJKRVdW *>(gm->normal_model);
  if (!normal)
    error->all(FLERR,
               "Rolling model dominik/tielens needs a normal model that knows the pull-off force: jkr/vdw, not {}",
               gm->normal_model ? gm->normal_model->name : "none");
}

/* ---------------------------------------------------------------------- */

void GranSubModRollingDominikTielens::init() { find_normal_model(); }

/* ----------------------------------------------------------------------
   normal of the full step: another one than gm->nx with synchronized Verlet
------------------------------------------------------------------------- */

template <typename Model> static auto full_step_normal(Model *gm, int) -> decltype(&gm->nx_unrotated[0])
{
  return gm->synchronized_verlet ? gm->nx_unrotated : gm->nx;
}

template <typename Model> static double *full_step_normal(Model *gm, long) { return gm->nx; }

/* ----------------------------------------------------------------------
   the tangential model, called before, has cut its force down to the limit
------------------------------------------------------------------------- */

bool GranSubModRollingDominikTielens::slides() const
{
  const double limit = gm->tangential_model->get_mu() * normal->get_fncrit();
  return limit > 0.0 && Dust::dot(gm->fs, gm->fs) > (1.0 - 1.0e-12) * limit * limit;
}

static Dust::Vector three(const double *v) { return {v[0], v[1], v[2]}; }

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
  double *history = normal->rolling_in(gm->history);
  const double sign = std::copysign(1.0, normal->neck_in(gm->history));
  Dust::Vector xi = sign * three(history);
  if (gm->history_update) {
    const Dust::Rolling moved =
        Dust::roll_on(xi, three(full_step_normal(gm, 0)), three(gm->vrl), gm->dt, gm->Reff * theta_crit);
    xi = moved.displacement;
    if (moved.gave_way) normal->last_events.roll = update->ntimestep;
    if (slides()) normal->last_events.slide = update->ntimestep;
    history[0] = sign * xi.x;
    history[1] = sign * xi.y;
    history[2] = sign * xi.z;
  }
  const double x = gm->contact_radius / normal->equilibrium_contact_radius();
  const double k = Dust::rolling_stiffness(normal->pull_off_force(), x) / gm->Reff;
  fr[0] = -k * xi.x;
  fr[1] = -k * xi.y;
  fr[2] = -k * xi.z;
}
