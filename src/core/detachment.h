/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_DETACHMENT_H
#define DUST_CORE_DETACHMENT_H

#include "acceleration_history.h"
#include "impulse_record.h"
#include "lift_off_window.h"
#include "quaternion.h"
#include "texture.h"

#include <cstdint>
#include <memory>
#include <vector>

/* The detachment functions: which grains of a texture leave a carrier in a collision, from the carrier's motion alone.

   All criteria compare accelerations, since forces on a grain scale with its mass: g = -(a + alpha x r + omega x (omega x r))
   is the inertia force per grain mass on a grain that moves with its carrier, r = (R_p + R_d) n, and c = F_c/m_d the
   pull-off force per grain mass. With g_n = g.n and
   g_t = |g - g_n n| on the grain at direction n, the criteria of Ibrahim et al., J. Aerosol Sci. 34, 765 (2003), and
   Cui & Sommerfeld, Powder Technol. 344, 741 (2019), are (Eq. 2 of the paper)

     lift-off  g_n > c,    sliding  g_t > mu_f |2 c - g_n|,    rolling  g_t R_d > |c - g_n| a0.

   Attachment is one bit a grain. The bits are in the order of compact patches of 64 grains, one 64-bit word a patch, so
   that whole patches can be passed over. */

namespace Dust {

/*! How a grain left its carrier */
enum Mode { NORMAL, TANGENTIAL, SLIDING, ROLLING, NMODES };

/*! What makes grains detach */
struct Criteria {
  bool count = true;       //!< grains that meet the sliding and rolling criteria
  bool ibrahim = false;    //!< sliding and rolling detach too
  //! no Eq. 3b, Eq. 4 alone, Eqs. 4-6, or each grain's own motion (surface_motion.h)
  enum { OFF, FRICTIONLESS, ESTIMATE, INTEGRATE } tangential = ESTIMATE;
};

/*! Material of the grains and of their contact with the carrier, in one consistent set of units */
struct Material {
  double density;           //!< of the grains
  double gamma;             //!< surface energy, pull-off force 3 pi gamma R_12
  double modulus;           //!< combined modulus E* of grain and carrier
  double friction;          //!< mu_f
  double rolling = 0.15;    //!< theta_crit; only INTEGRATE uses it
  double damping =
      -1.0;    //!< damping ratio of the contact; INTEGRATE then lets grains ring (normal_motion.h), below 0 not
};

/*! One texture made ready for evaluation; shared by all carriers, never changed */
class DetachmentFunctions {
 public:
  DetachmentFunctions(const Texture &texture, const Material &material, const Criteria &criteria);

  int grains() const { return static_cast<int>(sites.size()); }
  int words() const { return static_cast<int>(all.size()); }
  const std::vector<uint64_t> &all_attached() const { return all; }

  /*! index in the texture of the grain at a bit */
  int grain(int bit) const { return sites[bit].grain; }
  /*! mass of the grain at a bit as a multiple of the mean grain mass: exactly 1 for equal grains */
  double weight(int bit) const { return sites[bit].weight; }
  double mean_mass() const { return mass; }
  /*! least and largest pull-off force per grain mass */
  double least_hold() const { return least; }
  double largest_hold() const { return largest; }

  /*! Whether inertia can make a grain slide (or leave) that moves with its carrier: if none can, it is at rest */
  bool may_move(const Motion &motion) const;
  /*! False only if may_move() is: the same from squares, without a root or a division
   *  \param force2, torque2, spin2  squares
   *  \param mass                    of the carrier, over what `stiffen` makes of its acceleration */
  bool might_move(double force2, double torque2, double spin2, double mass) const
  {
    // (x + y + z)^2 <= 3 (x^2 + y^2 + z^2); alpha = torque/(2/5 m R_p^2)
    return force2 + per_arm2 * torque2 > (still2 - reach * reach * spin2 * spin2) * mass * mass;
  }
  /*! Whether a carrier that nothing touches spins fast enough to throw off a grain */
  bool may_spin_off(double spin2) const { return reach * spin2 > least; }

 private:
  friend class Collision;
  friend class LiftOffWindow;

  Criteria criteria;
  double friction, rolling, damping;
  double carrier_radius;
  double mass;
  double least, largest;        // of hold
  double reach;                 // largest shell
  double least_to[NMODES];      // least inertia force per mass that meets SLIDING or ROLLING for some grain
  double moving;                // the one that can make a grain slide (or leave), within limits
  double still2, per_arm2;      // moving^2/3; (reach/(2/5 R_p^2))^2
  double slow2;                 // no tangential lift-off below this square of a velocity
  std::vector<uint64_t> all;    // bits that hold a grain: all but the last ones of the last word
  // by bit: all that is asked of a grain in one cache line
  struct alignas(64) Site {
    double n[3];
    double hold;      // c = F_c/m_d
    double lever;     // a0/R_d
    double shell;     // |r_pd| = R_p + R_d
    double weight;    // mass in mean grain masses
    int grain;        // index in the texture
  };
  std::vector<Site> sites;
  // by patch: a direction, the largest chord from it to a grain, and the extremes of its grains
  struct Patch {
    double centre[3], radius;
    double least_hold, largest_hold, least_lever, largest_lever, least_shell;
  };
  std::vector<Patch> patches;

  double lift(int bit, const Motion &motion) const { return motion.lift(sites[bit].n, sites[bit].shell); }
  // the criterion g_t > slope |factor c - g_n| of sliding or rolling
  struct Limit {
    double factor, slope;
  };
  Limit limit(Mode mode, double lever) const { return mode == SLIDING ? Limit{2.0, friction} : Limit{1.0, lever}; }
  // inertia force per mass on a grain, along n and normal to it
  struct Load {
    double gn, gt;
  };
  Load load(int bit, const Motion &motion) const;
  // by how much a grain meets the criterion, per grain mass
  double excess(Mode mode, int bit, const Load &load) const;
  double excess(Mode mode, int bit, const Motion &motion) const { return excess(mode, bit, load(bit, motion)); }
  // least and largest that the grains of a patch can have
  struct Range {
    double least, largest;
  };
  Range excess_in_patch(Mode mode, int patch, const Motion &motion) const;
};

/*! One grain that has just left */
struct Detachment {
  int bit;
  Mode mode;
  double direction[3];    //!< n, in space
  double velocity[3];     //!< relative to the carrier's centre, in space
};

/*! What is kept of a collision from when inertia could make a grain slide */
struct Strong {
  struct Moment {
    double time;
    double impulse[3], spin[3];    // as of Collision
  };
  struct State {             // in space
    Quaternion now;          // the carrier
    Moment lively;           // at the last lively step
    double count[NMODES];    // of the grains that have left, those that had met SLIDING and ROLLING
  } state;
  std::vector<uint64_t> start;    // attached at begin(), kept from when the first grain could leave
  AccelerationHistory history;
  LiftOffWindow window;
};

/*! What the collisions of a rank share */
struct Workspace {
  std::vector<Detachment> detached;    //!< grains that have left: to be taken and cleared by the caller
  bool locate = true;                  //!< whether the caller wants their directions and velocities
  std::vector<int> leaving;
  std::vector<std::unique_ptr<Strong>> idle;
};

/*! Collision of one carrier
 *
 * It begins with the first contact force after free flight, or where a carrier at rest is moved so hard that a grain could
 * slide. It ends with the first step without contact force: an isolated impact is followed from first contact to rebound, as
 * in the paper. Or it comes to rest: for QUIET times as long as it took, no inertia could move any grain, nor was the
 * acceleration larger than before. What came after its last lively step then does not count. In a bed of carriers this
 * ends the collision where neither a first contact nor a rebound could be told. Damped Hertz contacts with restitution
 * from 0.3 on (0.1) rebound before, if their peak is 1.01 (1.6) times what can make a grain slide.
 *
 * It is weak until inertia first can make a grain slide. Most contacts of a bed stay weak: of that time only the sums and
 * the largest acceleration are kept, and it rests after WEAK_QUIET times as long as it took.
 *
 * Vectors come in space. The frame of first contact is the carrier's axes at the first step; it does not turn with them later.
 *
 * In most steps no grain can change, and little is done in the others:
 * - A grain that holds at q holds at lambda q + e too if what e and the spin add is no more than (1 - lambda) c: unloading
 *   needs no look.
 * - LiftOffWindow knows which grains can lift off next.
 * - Whether a grain has met the sliding or rolling criterion is asked once, when it leaves or at the end: as long as it
 *   holds, g_t + k g_n is a convex function of g, so the motions that the history keeps decide. */
class alignas(64) Collision {
 public:
  /*! Starts before the first step that has a contact force
   *  \param orientation  of the carrier at that step
   *  \param spin         before that contact */
  void begin(const Quaternion &orientation, const double *spin);

  /*! One time step: Eq. 2 and lift-off normal
   *  \param motion    its spin is that of the middle of the step that ends now, as a leapfrog has it
   *  \param attached  bits of the grains; those that leave are cleared
   *  \param work      the grains that leave are appended to its list
   *  \return          true if any left */
  bool step(const DetachmentFunctions &functions, const Motion &motion, double dt, uint64_t *attached, Workspace &work);

  /*! Whether it has come to rest though the contact lasts */
  bool at_rest() const
  {
    return course.steps - course.lively_end > (weak() ? WEAK_QUIET : QUIET) * (course.lively_end - course.burst);
  }

  /*! Lift-off tangential, at the first step without contact force or at rest: Eqs. 3b and 4-6 or INTEGRATE
   *  \param spin  after the contact */
  bool end(const DetachmentFunctions &functions, const double *spin, uint64_t *attached, Workspace &work);

  /*! Grains lost since begin() on the north, n.(velocity - velocity before contact) > 0; before the end with the
   *  velocity so far */
  int lost_north(const DetachmentFunctions &functions, const uint64_t *attached) const;

  bool weak() const { return !strong; }
  double peak_acceleration() const;    //!< largest |contact acceleration| so far
  /*! contact force/carrier mass, integrated since begin() */
  const double *impulse() const { return course.impulse; }
  /*! Grains that have met the criterion of Eq. 2, SLIDING or ROLLING, since begin(); where no inertia could make any slide,
   *  those that have met it at the largest acceleration */
  int grains_that(Mode mode, const DetachmentFunctions &functions, const uint64_t *attached) const;

  /*! Gives back what it has taken from the workspace: when it is over, or its carrier gone */
  void release(Workspace &work);

  // transfer to another rank and restart, as numbers
  int packed_size() const;
  void pack(double *buf) const;
  void unpack(const double *buf);

 private:
  static constexpr double QUIET = 3.0, WEAK_QUIET = 0.1;

  // what a step of a weak collision needs comes first, as a bed has more of them than a cache
  std::unique_ptr<Strong> strong;    // from when inertia could make a grain slide
  struct Course {                    // in space
    double time;
    double impulse[3];           // contact force/carrier mass, integrated since begin()
    double steps;                // so far
    double burst, lively_end;    // of them, when the present or last lively ones began and ended
    // of the weak time
    double largest2;     // square of the largest acceleration
    double turned[3];    // angle about which the carrier turned
    Motion largest;      // that of the largest acceleration, and the angle until then
    double largest_turned[3];
    Quaternion frame;    // the carrier at first contact
    double spin0[3];     // before contact
  } course;
  std::unique_ptr<ImpulseRecord> record;    // with INTEGRATE only, from the first step

  void become_strong(const DetachmentFunctions &functions, Workspace &work);
  void add(const DetachmentFunctions &functions, const Motion &motion, double dt);
  void mark_lively();
  void lift_off(const DetachmentFunctions &functions, const Motion &motion, uint64_t *attached, Workspace &work);
  void check_all(const DetachmentFunctions &functions, const Motion &motion, uint64_t *attached, Workspace &work);
  void estimate(const DetachmentFunctions &functions, const Strong::Moment &last, uint64_t *attached, Workspace &work);
  void integrate(const DetachmentFunctions &functions, uint64_t *attached, Workspace &work);
  struct Step {
    double dt, acceleration[3];    // mean
    double after[3], spin[3];      // acceleration and spin at the end
  };
  std::vector<Step> steps(const double *spin0) const;
  // a grain leaves the place where it stuck, or one along the surface
  void leave_place(const DetachmentFunctions &functions, int bit, Mode mode, const Motion &motion, uint64_t *attached,
                   Workspace &work);
  void leave(const DetachmentFunctions &functions, int bit, Mode mode, const Quaternion &axes, const double *direction,
             const double *velocity, const Motion *now, uint64_t *attached, Workspace &work);
  // the largest of the weak time, along the carrier's axes
  Motion largest_of_weak() const;
  bool has_met(Mode mode, const DetachmentFunctions &functions, int bit) const;
};

}    // namespace Dust

#endif
