/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CONTACT_LAW_H
#define DUST_CONTACT_LAW_H

#include "gran_sub_mod_dust_normal.h"

#include "granular_model.h"

#include <cstdint>

namespace LAMMPS_NS {

// what fused loops need of a granular model: which loop it is for, and its coefficients

class ContactLaw {
 public:
  enum Kind {
    HERTZ,    // hertz or hertz/material, mindlin, coeff_restitution/limited
    GRAIN,    // jkr/vdw, mindlin, viscoelastic, dominik/tielens
    MODEL     // any other: LAMMPS' own functions, contact by contact
  };

  // \param number  from 1 on, another one for each law of a queue
  ContactLaw(Granular_NS::GranularModel *, int number);

  // whether this LAMMPS cuts friction as MindlinBlock::by_inverse says
  static bool cuts_by_inverse();

  Kind kind;
  Granular_NS::GranularModel *model;
  Granular_NS::GranSubModNormalJKRVdW *normal;    // of grains, in other laws too
  double stiffness, damping, shear_stiffness, shear_damping, friction, theta_crit;
  bool synchronized;
  int shear_place, neck_place;    // in a contact's history
  std::int64_t stamp;             // another one whenever any of these numbers has changed

  // of two grains
  struct Adhesion {
    double radius_i = -1.0, radius_j = -1.0;
    double effective_radius = 0.0, reach = 0.0;    // up to which the centres attract each other
    Granular_NS::GranSubModNormalJKRVdW::Adhesion by_radius = {};
    bool is_of(double ri, double rj) const { return radius_i == ri && radius_j == rj; }
  };
  Adhesion adhesion;    // of those asked for last
  // as it was found before: cube roots are saved
  void recall(const Adhesion &found)
  {
    stamp++;
    adhesion = found;
  }

  bool heats() const;

  // whether it is known where its contacts end
  bool ends() const { return normal || !model->beyond_contact; }

  // whether spheres of these radii are within reach of each other, or of each other's surroundings; true leaves the
  // adhesion of grains here
  bool touches(double rsq, double radius_i, double radius_j, double margin = 0.0)
  {
    if (normal) return grain_touches(rsq, radius_i, radius_j, margin);
    const double touching = radius_i + radius_j + margin;
    return rsq < touching * touching;
  }

 private:
  bool wall;                               // flat: of radius 0
  double largest_radius, largest_reach;    // of all effective radii so far: the larger, the farther

  bool grain_touches(double rsq, double radius_i, double radius_j, double margin)
  {
    if (!adhesion.is_of(radius_i, radius_j)) {
      if (far(rsq, radius_i, radius_j, margin)) return false;
      find_adhesion(radius_i, radius_j);
    }
    const double reach = adhesion.reach + margin;
    return rsq < reach * reach;
  }

  // beyond the reach of the largest ones
  bool far(double rsq, double radius_i, double radius_j, double margin) const
  {
    constexpr double SLACK = 1.0e-12;
    const double radii = radius_i + radius_j, farthest = (radii + largest_reach + margin) * (1.0 + SLACK);
    const bool larger = wall ? radius_i > largest_radius : radius_i * radius_j > largest_radius * radii;
    return rsq > farthest * farthest && !larger;
  }
  void find_adhesion(double, double);
};

}    // namespace LAMMPS_NS

#endif
