/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "deck_contacts.h"

#include "core/jkr.h"

#include "atom.h"
#include "fix_wall_gran.h"
#include "force.h"
#include "gran_sub_mod_damping.h"
#include "gran_sub_mod_normal.h"
#include "gran_sub_mod_tangential.h"
#include "granular_model.h"
#include "modify.h"
#include "pair_granular.h"
#include "pair_hybrid_scaled.h"

#include <algorithm>
#include <utility>

using namespace LAMMPS_NS;
using Granular_NS::GranularModel;

namespace {

CarrierContact::Law law_of(const GranularModel *model)
{
  const std::string &name = model->normal_model->name;
  if (name == "hertz" || name == "hertz/material") return CarrierContact::HERTZ;
  if (name == "hooke") return CarrierContact::HOOKE;
  return CarrierContact::OTHER;
}

// normal elastic force of a Hertz or Hooke model with overlap and contact radius 1; what this changes is set for each
// contact
double unit_force(GranularModel *model)
{
  model->delta = model->contact_radius = 1.0;
  return model->normal_model->calculate_forces();
}

double stiffness_of(GranularModel *model, bool mixed)
{
  switch (law_of(model)) {
    case CarrierContact::HERTZ: return 0.75 * unit_force(model);
    case CarrierContact::HOOKE: return unit_force(model);
    default: break;
  }
  const Granular_NS::GranSubModNormal *normal = model->normal_model;
  if (!normal->get_material_properties()) return 0.0;
  const double E = normal->get_emod(), nu = normal->get_poiss();
  return mixed ? E : Dust::combined_modulus(E, nu, E, nu);    // LAMMPS' mixed models have E* for their E
}

/* ----------------------------------------------------------------------
   whether two bodies that come apart fast enough are pulled back by the damping
------------------------------------------------------------------------- */

bool damping_pulls(GranularModel *model)
{
  if (model->limit_damping) return false;
  if (model->damping_model->name == "mdr") return true;    // not to be had without a contact at hand
  model->meff = model->delta = model->contact_radius = 1.0;
  model->vnnr = 1.0e30;
  model->Fnormal = law_of(model) == CarrierContact::OTHER ? 0.0 : unit_force(model);
  return model->Fnormal + model->damping_model->calculate_forces() < 0.0;
}

/* ----------------------------------------------------------------------
   With contacts S times softer the same impact is S^0.4 (Hertz) or S^0.5 (Hooke) times longer. All of its forces must
   be so.
------------------------------------------------------------------------- */

std::string reason_not_to_stiffen(const GranularModel *model, double stiffness)
{
  const CarrierContact::Law law = law_of(model);
  if (law == CarrierContact::OTHER) return "is " + model->normal_model->name;
  // forces that do not follow the contact's stiffness stay as they are
  for (const char *name : {"^velocity", "^mass_velocity", "^viscoelastic"})
    if (utils::strmatch(model->damping_model->name, name))
      return fmt::format("has damping {}, which is not softened with it: use coeff_restitution/limited",
                         model->damping_model->name);
  const std::string &friction = model->tangential_model->name;
  const double *coeffs = model->tangential_model->coeffs;
  const double mu = coeffs[model->tangential_model->num_coeffs - 1];
  if (mu == 0.0 || utils::strmatch(friction, "nohistory")) return "";
  const bool mindlin = utils::strmatch(friction, "^mindlin");
  if (mindlin != (law == CarrierContact::HERTZ))
    return fmt::format("has {} friction with {} contacts", friction, model->normal_model->name);
  // Mindlin's stiffness is 3 (1 - nu)/(2 - nu) times Hertz' 4/3 E*, at most 1.5 times for positive nu: a larger one
  // has not been softened as well. NULL is that of the material.
  constexpr double LARGEST = 1.6;
  if (mindlin && coeffs[0] > LARGEST * (4.0 / 3.0) * stiffness)
    return fmt::format("has a tangential stiffness of {:.4g}, which is not as soft as its normal one: use NULL",
                       coeffs[0]);
  return "";
}

// whether a contact of these two is one of a carrier
bool meet(Meets a, Meets b)
{
  return a != Meets::NOTHING && b != Meets::NOTHING && (a == Meets::CARRIER || b == Meets::CARRIER);
}

// a class for the factors of hybrid/scaled, which have no other way out
class Scaled : public PairHybridScaled {
 public:
  // what the forces of a sub-style are multiplied with; whether that is a number, not a variable
  static std::pair<double, bool> factor(const Pair *all, const Pair *style)
  {
    const auto *scaled = dynamic_cast<const PairHybridScaled *>(all);
    if (!scaled) return {1.0, true};
    const Pair *const *styles = scaled->*(&Scaled::styles);
    const auto n = std::find(styles, styles + scaled->*(&Scaled::nstyles), style) - styles;
    return {(scaled->*(&Scaled::scaleval))[n], (scaled->*(&Scaled::scaleidx))[n] < 0};
  }
};

}    // namespace

/* ---------------------------------------------------------------------- */

CarrierContact::CarrierContact(const std::string &_where, GranularModel *model, bool mixed, double factor, bool _wall) :
    where(_where), damping(model->damping_model->name), wall(_wall), law(law_of(model)),
    stiffness(stiffness_of(model, mixed)), pulls(damping_pulls(model)),
    not_stiffened(reason_not_to_stiffen(model, stiffness))
{
  stiffness *= factor;
}

/* ---------------------------------------------------------------------- */

DeckContacts::DeckContacts(LAMMPS *_lmp, const std::vector<Meets> &types,
                           const std::function<bool(const Fix *)> &acts) : Pointers(_lmp)
{
  if (force->pair && !utils::strmatch(force->pair_style, "^hybrid"))
    look_at_style(force->pair, force->pair_style, types);
  else if (force->pair) {
    // all sub-styles: the hybrid's own name begins with h; a single one comes again and again
    Pair *last = nullptr;
    for (int k = 1; Pair *pair = force->pair_match("^[^h]", 0, k); k++) {
      if (pair == last) break;
      look_at_style(pair, force->pair_match_ptr(pair), types);
      last = pair;
    }
  }

  for (Fix *fix : modify->get_fix_list())
    if (const auto *wall = dynamic_cast<FixWallGran *>(fix))
      if (wall->model && acts(fix)) all.emplace_back(std::string("fix ") + fix->id, wall->model, false, 1.0, true);
}

/* ---------------------------------------------------------------------- */

void DeckContacts::look_at_style(Pair *pair, const std::string &style, const std::vector<Meets> &types)
{
  const auto [factor, fixed] = Scaled::factor(force->pair, pair);
  const bool readable = utils::strmatch(style, "^granular") && fixed && factor >= 0.0;
  if (readable) return look_at_pairs(dynamic_cast<PairGranular *>(pair), types, factor);
  if (utils::strmatch(style, "^zero")) return;
  bool acts = false;
  for (int t = 1; t <= atom->ntypes; t++) {
    for (int u = t; u <= atom->ntypes; u++)
      acts = acts || (meet(types[t], types[u]) && pair->setflag && pair->setflag[t][u]);
  }
  if (!acts) return;
  other_styles.push_back(fixed ? style : style + " (hybrid/scaled by a variable)");
  if (!utils::strmatch(style, "^granular") && !utils::strmatch(style, "^gran/") &&
      !utils::strmatch(style, "^surf/gran"))
    far_styles.push_back(style);
}

// contacts of one law that several sub-styles give the same types act as one, with the sum of their stiffnesses
void DeckContacts::add(const CarrierContact &contact)
{
  const auto same = std::find_if(all.begin(), all.end(), [&](const CarrierContact &other) {
    return other.where == contact.where && other.law == contact.law && contact.law != CarrierContact::OTHER;
  });
  if (same == all.end()) return all.push_back(contact);
  same->stiffness += contact.stiffness;
  same->pulls = same->pulls || contact.pulls;
  if (same->not_stiffened.empty()) same->not_stiffened = contact.not_stiffened;
}

void DeckContacts::look_at_pairs(PairGranular *pair, const std::vector<Meets> &types, double factor)
{
  if (!pair || !pair->setflag || !pair->types_indices || factor == 0.0) return;
  for (int t = 1; t <= atom->ntypes; t++)
    for (int u = t; u <= atom->ntypes; u++) {
      // what is not given has been mixed, but as part of a hybrid it has not all pairs of types
      const bool given = pair->setflag[t][u];
      if (!meet(types[t], types[u]) || !(given || pair == force->pair)) continue;
      GranularModel *model = pair->models_list[pair->types_indices[t][u]];
      add(CarrierContact(fmt::format("pair_coeff {} {}", t, u), model, !given, factor, false));
    }
}
