/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_DETACHMENT_H
#define DUST_CORE_DETACHMENT_H

#include "acceleration_history.h"
#include "impulse_record.h"
#include "texture.h"

#include <cstdint>
#include <vector>

/* The detachment functions: which grains of a texture leave a carrier in a collision, from the carrier's motion alone.

   All criteria compare accelerations, since forces on a grain scale with its mass: g = -a is the inertia force per grain
   mass on a grain that moves with its carrier, c = F_c/m_d the pull-off force per grain mass. With g_n = g.n and
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
  bool ibrahim = false;       //!< sliding and rolling detach too (they are counted always)
  //! no Eq. 3b, Eq. 4 alone, Eqs. 4-6, or each grain's own motion (surface_motion.h)
  enum { OFF, FRICTIONLESS, ESTIMATE, INTEGRATE } tangential = ESTIMATE;
};

/*! Material of the grains and of their contact with the carrier, in one consistent set of units */
struct Material {
  double density;     //!< of the grains
  double gamma;       //!< surface energy, pull-off force 3 pi gamma R_12
  double modulus;     //!< combined modulus E* of grain and carrier
  double friction;    //!< mu_f
  double rolling = 0.15;    //!< theta_crit; only INTEGRATE uses it
  double damping = -1.0;    //!< damping ratio of the contact; INTEGRATE then lets grains ring (normal_motion.h), below 0 not
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

 private:
  friend class Collision;

  Criteria criteria;
  double friction, rolling, damping;
  double carrier_radius;
  double mass;
  double least, largest;            // of hold
  double largest_shell;
  double slow2;                     // no tangential lift-off below this square of a velocity
  std::vector<uint64_t> all;        // bits that hold a grain: all but the last ones of the last word
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
  // by patch: centre, radius (chord) and least hold of its grains
  struct Patch {
    double centre[3], radius, hold;
  };
  std::vector<Patch> patches;

  double normal(int bit, const double *g) const
  {
    const double *n = sites[bit].n;
    return g[0] * n[0] + g[1] * n[1] + g[2] * n[2];
  }
  // by how much sliding and rolling of Eq. 2 are met at the inertia force g, per grain mass
  struct Excess {
    double sliding, rolling;
  };
  Excess excess(int bit, const double *g) const;
};

/*! One grain that has just left */
struct Detachment {
  int bit;
  Mode mode;
  double velocity[3];    //!< relative to the carrier's centre
};

/*! What the collisions of a rank share while one of them is looked at */
struct Workspace {
  std::vector<Detachment> detached;    //!< grains that have left: to be taken and cleared by the caller
  struct Candidate {
    int from;    // step of the window from which the grain could lift off
    int bit;
  };
  std::vector<Candidate> found;
  std::vector<int> leaving;
};

/*! Collision of one carrier, from the first step with a contact force to the first without
 *
 * In most steps no grain can change, and little is done in the others:
 * - A grain that holds at q holds at lambda q + e too if lambda <= 1 and |e| <= (1 - lambda) c: unloading needs no look.
 * - While g stays in a window, no farther than S along an axis and E from it, only those grains can lift off that would
 *   at S with E to help. They are listed by the force along the axis from which each could, and a step of time
 *   sees only the head of that list. A window is opened where g leaves the last one.
 * - Whether a grain has met the sliding or rolling criterion is asked once, when it leaves or at the end: as long as it
 *   holds, g_t + k g_n is a convex function of g, so the accelerations that the history keeps decide. */
class Collision {
 public:
  /*! Starts with the velocity and spin before the first step that has a contact force */
  void begin(const double *velocity, const double *spin);

  /*! One time step: Eq. 2 and lift-off normal
   *  \param acceleration  contact force / carrier mass
   *  \param attached      bits of the grains; those that leave are cleared
   *  \param work          the grains that leave are appended to its list
   *  \return              true if any left */
  bool step(const DetachmentFunctions &functions, const double *acceleration, const double *spin, double dt,
            uint64_t *attached, Workspace &work);

  /*! Lift-off tangential, with the velocity at the first step without contact force: Eqs. 3b and 4-6 or INTEGRATE */
  bool end(const DetachmentFunctions &functions, const double *velocity, uint64_t *attached,
           Workspace &work);

  /*! Grains lost since begin() on the north, n.(velocity - velocity before contact) > 0; before the end with the
   *  velocity so far */
  int lost_north(const DetachmentFunctions &functions, const double *velocity, const uint64_t *attached) const;

  double duration() const { return time; }           //!< of the steps so far
  double peak_acceleration() const;           //!< largest |contact acceleration| so far
  /*! Grains that have met the sliding (rolling) criterion of Eq. 2 since begin() */
  int sliding_grains(const DetachmentFunctions &functions, const uint64_t *attached) const;
  int rolling_grains(const DetachmentFunctions &functions, const uint64_t *attached) const;

  // transfer to another rank and restart, as numbers
  int packed_size() const;
  void pack(double *buf) const;
  void unpack(const double *buf);

 private:
  double v0[3], spin0[3];
  double time;
  int nslid, nrolled;               // of the grains that have left
  std::vector<uint64_t> start;      // attached at begin(), kept from when the first grain could leave
  AccelerationHistory history;
  ImpulseRecord record;             // with INTEGRATE only

  struct Window {
    double axis[3], from, along, aside;    // from where it was opened to S = along, E = aside
    double steps_per_force;
    double strayed2;                       // square of the farthest that g has been from the axis
    double width;                          // E/|g| for the next window: as g strays
    static constexpr int STEPS = 256;      // from `from` to `along`
    int step_of(double force) const;
    std::vector<Workspace::Candidate> candidates;    // by step
    size_t next;                                     // first that cannot lift off yet
    std::vector<int> close;                          // could lift off now
  } window;

  void open_window(const DetachmentFunctions &functions, const double *g, const uint64_t *attached, Workspace &work);
  void lift_off(const DetachmentFunctions &functions, const double *g, uint64_t *attached,
                Workspace &work);
  void check_all(const DetachmentFunctions &functions, const double *g, uint64_t *attached,
                 Workspace &work);
  void estimate(const DetachmentFunctions &functions, const double *velocity, uint64_t *attached, Workspace &work);
  void integrate(const DetachmentFunctions &functions, uint64_t *attached, Workspace &work);
  struct Step {
    double dt, acceleration[3];     // mean
    double after[3], spin[3];       // acceleration and spin at the end
  };
  std::vector<Step> steps() const;
  void leave(const DetachmentFunctions &functions, const Detachment &grain, const double *g, uint64_t *attached,
             Workspace &work);
  bool has_slid(const DetachmentFunctions &functions, int bit) const;
  bool has_rolled(const DetachmentFunctions &functions, int bit) const;
};

}    // namespace Dust

#endif
