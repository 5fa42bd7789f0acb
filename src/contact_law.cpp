/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "contact_law.h"

#include "gran_sub_mod_dust_damping.h"
#include "gran_sub_mod_dust_rolling.h"

#include "gran_sub_mod_heat.h"
#include "gran_sub_mod_normal.h"
#include "gran_sub_mod_tangential.h"
#include "gran_sub_mod_twisting.h"
#include "granular_model.h"

#include <typeinfo>

using namespace LAMMPS_NS;
using namespace Granular_NS;

namespace {

// classes for coefficients of LAMMPS' sub-models that have no other way out

class Hertz : public GranSubModNormalHertz {
 public:
  static double stiffness(const GranSubModNormal *model)
  {
    return static_cast<const GranSubModNormalHertz *>(model)->*(&Hertz::k);
  }
};

class Damping : public GranSubModDamping {
 public:
  static double coefficient(const GranSubModDamping *model) { return model->*(&Damping::damp); }
};

class Mindlin : public GranSubModTangentialMindlin {
 public:
  static double damping(const GranSubModTangential *model)
  {
    return static_cast<const GranSubModTangentialMindlin *>(model)->*(&Mindlin::xt);
  }
};

// of this class, not of a child with other forces
template <class Model, class Parent> bool is(const Parent *model) { return typeid(*model) == typeid(Model); }

// 4Feb2025 has no synchronized Verlet
template <typename Model> auto synchronizes(const Model *model, int) -> decltype(bool(model->synchronized_verlet))
{
  return model->synchronized_verlet;
}

template <typename Model> bool synchronizes(const Model *, long) { return false; }

template <typename Model> constexpr auto can_synchronize(const Model *model, int)
    -> decltype(bool(model->synchronized_verlet))
{
  return true;
}

template <typename Model> constexpr bool can_synchronize(const Model *, long) { return false; }

ContactLaw::Kind kind_of(const GranularModel *model)
{
  const bool mindlin = is<GranSubModTangentialMindlin>(model->tangential_model);
  const bool no_more = is<GranSubModTwistingNone>(model->twisting_model) && model->heat_model->name == "none";
  if (!mindlin || !no_more) return ContactLaw::MODEL;
  const GranSubModNormal *normal = model->normal_model;
  if ((is<GranSubModNormalHertz>(normal) || is<GranSubModNormalHertzMaterial>(normal)) &&
      is<GranSubModDampingCoeffRestitutionLimited>(model->damping_model) &&
      is<GranSubModRollingNone>(model->rolling_model))
    return ContactLaw::HERTZ;
  if ((is<GranSubModNormalJKRVdW>(normal) || is<GranSubModNormalJKRVdWCut>(normal)) &&
      is<GranSubModDampingViscoelastic>(model->damping_model) &&
      is<GranSubModRollingDominikTielens>(model->rolling_model))
    return ContactLaw::GRAIN;
  return ContactLaw::MODEL;
}

}    // namespace

/* ---------------------------------------------------------------------- */

bool ContactLaw::cuts_by_inverse() { return !can_synchronize(static_cast<const GranularModel *>(nullptr), 0); }

/* ---------------------------------------------------------------------- */

ContactLaw::ContactLaw(GranularModel *_model, int number) :
    kind(kind_of(_model)), model(_model), normal(dynamic_cast<GranSubModNormalJKRVdW *>(_model->normal_model)),
    stiffness(0.0), damping(0.0), shear_stiffness(0.0), shear_damping(0.0), friction(0.0), theta_crit(0.0),
    synchronized(synchronizes(_model, 0) && _model->contact_type != WALL), shear_place(0), neck_place(0),
    stamp(std::int64_t(number) << 40), wall(_model->contact_type == WALL), largest_radius(0.0), largest_reach(0.0)
{
  if (kind == MODEL) return;
  damping = Damping::coefficient(model->damping_model);
  shear_stiffness = model->tangential_model->get_k();
  shear_damping = Mindlin::damping(model->tangential_model);
  friction = model->tangential_model->get_mu();
  shear_place = model->tangential_model->history_index;
  if (kind == HERTZ) {
    stiffness = Hertz::stiffness(model->normal_model);
  } else {
    neck_place = normal->place_in_history();
    theta_crit = model->rolling_model->coeffs[0];
  }
}

/* ---------------------------------------------------------------------- */

bool ContactLaw::heats() const { return model->heat_model->name != "none"; }

/* ---------------------------------------------------------------------- */

void ContactLaw::find_adhesion(double radius_i, double radius_j)
{
  const double radii = radius_i + radius_j, R = wall ? radius_i : radius_i * radius_j / radii;
  const auto by_radius = normal->adhesion(R);
  recall({radius_i, radius_j, R, radii + by_radius.reach, by_radius});
  if (R <= largest_radius) return;
  largest_radius = R;
  largest_reach = by_radius.reach;
}
