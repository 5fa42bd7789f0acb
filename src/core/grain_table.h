/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_GRAIN_TABLE_H
#define DUST_CORE_GRAIN_TABLE_H

#include "criteria.h"
#include "motion.h"
#include "texture.h"

#include <cstdint>
#include <tuple>
#include <vector>

namespace Dust {

struct TangentialLaw;

/*! Material of the grains and of their contact with the carrier, in one consistent set of units */
struct Material {
  double density;           //!< of the grains
  double gamma;             //!< surface energy, pull-off force 3 pi gamma R_12
  double modulus;           //!< combined modulus E* of grain and carrier
  double friction;          //!< mu_f
  double rolling = 0.15;    //!< theta_crit; IMPULSE and INTEGRATE use it
  //! damping ratio of the contact; these two then let grains ring (normal_motion.h), below 0 not
  double damping = -1.0;
  // for grains that meet (entrainment.h): surface energy of two grains over gamma, their combined modulus, how much
  // softer it is taken, and the time step, by default (0) half of sqrt(m/k0) of a grain of the mean mass
  double cohesion = 0.0, grain_modulus = 0.0, softening = 1.0, step = 0.0;

  auto all() const
  {
    return std::make_tuple(density, gamma, modulus, friction, rolling, damping, cohesion, grain_modulus, softening,
                           step);
  }
  bool operator==(const Material &other) const { return all() == other.all(); }
};

/*! One texture made ready for evaluation: what each grain needs to leave. Shared by all carriers, never changed.
 *
 * All criteria compare accelerations, since forces on a grain scale with its mass: the pull-off force is c = F_c/m_d
 * per grain mass. Attachment is one bit a grain. The bits are in the order of compact patches of 64 grains, one 64-bit
 * word a patch, so that whole patches can be passed over. */
class GrainTable {
 public:
  GrainTable(const Texture &texture, const Material &material, const Criteria &criteria);

  /*! All that is asked of a grain, in one cache line */
  struct alignas(64) Site {
    double n[3];      //!< direction from the carrier's centre
    double hold;      //!< c = F_c/m_d
    double lever;     //!< a0/R_d
    double shell;     //!< |r_pd| = R_p + R_d
    double weight;    //!< mass in mean grain masses: exactly 1 for equal grains
    int grain;        //!< index in the texture
  };

  /*! A direction, the largest chord from it to a grain of the patch, and the extremes of its grains */
  struct Patch {
    double centre[3], radius;
    double min_hold, max_hold, min_lever, max_lever, min_shell;
  };

  int grains() const { return static_cast<int>(sites.size()); }
  int words() const { return static_cast<int>(all.size()); }    //!< of 64 bits, one a patch
  const std::vector<uint64_t> &all_attached() const { return all; }
  const Site &site(int bit) const { return sites[bit]; }
  const Patch &patch(int word) const { return patches[word]; }

  int grain(int bit) const { return sites[bit].grain; }
  double weight(int bit) const { return sites[bit].weight; }
  double mean_mass() const { return mass; }

  double carrier_radius() const { return rp; }
  double min_hold() const { return hold_min; }
  double max_hold() const { return hold_max; }
  double max_shell() const { return shell_max; }
  /*! Square of the smallest velocity along the surface at which adhesion cannot hold some grain on its curved path,
   *  v^2 = c |r_pd| */
  double min_critical_velocity2() const { return velocity2_min; }
  /*! Smallest inertia force per mass that meets SLIDING or ROLLING for some grain */
  double min_force_to(Mode mode) const { return force_min[mode]; }
  /*! Inertia force per mass from which grains slide (or leave), within limits */
  double moving_force() const { return moving; }

  const Material &material() const { return matter; }
  const Criteria &criteria() const { return asked; }
  /*! The law of tangential lift-off that the criteria name, or null */
  const TangentialLaw *tangential() const { return law; }
  /*! Overshoot of contacts that ring (normal_motion.h), 0 if they do not */
  double overshoot() const { return ring; }

  /*! Time step in which grains that meet are followed */
  double step() const { return following_step; }

  /*! Whether inertia can make a grain slide (or leave) that moves with its carrier: if none can, it is at rest */
  bool may_move(const Motion &motion) const;
  /*! False only if may_move() is: the same from squares, without a root or a division
   *  \param force2, torque2, spin2  squares
   *  \param inertia                 mass of the carrier, over what `stiffen` makes of its acceleration */
  bool might_move(double force2, double torque2, double spin2, double inertia) const
  {
    // (x + y + z)^2 <= 3 (x^2 + y^2 + z^2); alpha = torque/(2/5 m R_p^2)
    // true if any of it is not a number, so that somebody looks at it
    return !(force2 + inv_arm2 * torque2 <= (still2 - shell_max * shell_max * spin2 * spin2) * inertia * inertia);
  }
  /*! Whether a carrier that nothing touches spins fast enough to throw off a grain */
  bool may_spin_off(double spin2) const { return shell_max * spin2 > hold_min; }

 private:
  Material matter;
  Criteria asked;
  double ring;
  const TangentialLaw *law;
  double rp;
  double mass, following_step;
  double hold_min, hold_max, shell_max, velocity2_min;
  double force_min[NMODES];
  double moving;
  double still2, inv_arm2;      // moving^2/3; (shell_max/(2/5 R_p^2))^2
  std::vector<uint64_t> all;    // bits that hold a grain: all but the last ones of the last word
  std::vector<Site> sites;
  std::vector<Patch> patches;

  void fill_sites(const Texture &texture);
  void find_thresholds();
  void fill_patches();
};

}    // namespace Dust

#endif
