/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_DETACHMENT_H
#define DUST_CORE_DETACHMENT_H

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
   that the grains that can detach in a step share few words. */

namespace Dust {

/*! How a grain left its carrier */
enum Mode { NORMAL, TANGENTIAL, SLIDING, ROLLING, NMODES };

/*! What makes grains detach */
struct Criteria {
  bool ibrahim = false;       //!< sliding and rolling detach too (they are counted always)
  enum { OFF, FRICTIONLESS, ESTIMATE } tangential = ESTIMATE;    //!< no Eq. 3b, Eq. 4 alone, Eqs. 4-6
};

/*! Material of the grains and of their contact with the carrier, in one consistent set of units */
struct Material {
  double density;     //!< of the grains
  double gamma;       //!< surface energy, pull-off force 3 pi gamma R_12
  double modulus;     //!< combined modulus E* of grain and carrier
  double friction;    //!< mu_f
};

/*! One texture made ready for evaluation; shared by all carriers, never changed */
class DetachmentFunctions {
 public:
  /*! \param acceleration_unit  of force/mass in velocity/time; 1 in a consistent set of units */
  DetachmentFunctions(const Texture &texture, const Material &material, const Criteria &criteria,
                      double acceleration_unit = 1.0);

  int grains() const { return static_cast<int>(grain_of.size()); }
  int words() const { return static_cast<int>(all.size()); }
  const std::vector<uint64_t> &all_attached() const { return all; }

  /*! index in the texture of the grain at a bit */
  int grain(int bit) const { return grain_of[bit]; }
  /*! mass of the grain at a bit as a multiple of the mean grain mass: exactly 1 for equal grains */
  double weight(int bit) const { return relative_mass[bit]; }
  double mean_mass() const { return mass; }
  /*! least and largest pull-off force per grain mass */
  double least_hold() const { return least; }
  double largest_hold() const { return largest; }

 private:
  friend class Collision;

  Criteria criteria;
  double friction;
  double mass;
  double least, largest;            // of hold
  double slow2;                     // no tangential lift-off below this square of a velocity
  double quiet;                     // no criterion of Eq. 2 is met by any grain while |g| is below
  std::vector<uint64_t> all;        // bits that hold a grain: all but the last ones of the last word
  std::vector<int> grain_of;        // by bit
  // by bit, whole patches
  std::vector<double> nx, ny, nz;
  std::vector<double> hold;         // c = F_c/m_d
  std::vector<double> lever;        // a0/R_d
  std::vector<double> shell;        // |r_pd| = R_p + R_d
  std::vector<double> relative_mass;

  // how far |g| can grow from 0 before a grain meets anything
  double margin_at_rest(int bit) const;
};

/*! One grain that has just left */
struct Detachment {
  int bit;
  Mode mode;
  double velocity[3];    //!< relative to the carrier's centre
};

/*! Collision of one carrier, from the first step with a contact force to the first without
 *
 * In most steps no grain can change: every criterion is met by no more grains at an inertia force lambda g, lambda <= 1,
 * than at g, and changes by at most a known multiple of a change of g. So a patch needs no look before the force has
 * moved farther away from all it has been seen at, [0, g], than the patch's grain closest to a criterion allows. */
class Collision {
 public:
  /*! Starts with the velocity before the first step that has a contact force */
  void begin(const DetachmentFunctions &functions, const double *velocity);

  /*! One time step: Eq. 2 and lift-off normal
   *  \param acceleration  contact force / carrier mass
   *  \param attached      bits of the grains; those that leave are cleared
   *  \param detached      the grains that leave are appended
   *  \return              true if any left */
  bool step(const DetachmentFunctions &functions, const double *acceleration, double dt, uint64_t *attached,
            std::vector<Detachment> &detached);

  /*! Lift-off tangential, with the velocity at the first step without contact force: Eqs. 3b and 4-6 */
  bool end(const DetachmentFunctions &functions, const double *velocity, uint64_t *attached,
           std::vector<Detachment> &detached);

  /*! Grains lost since begin() on the north, n.(velocity - velocity before contact) > 0; before the end with the
   *  velocity so far */
  int lost_north(const DetachmentFunctions &functions, const double *velocity, const uint64_t *attached) const;

  double duration() const { return time; }           //!< of the steps so far
  double peak_acceleration() const;           //!< largest |contact acceleration| so far
  int sliding_grains() const { return nslid; }       //!< that met the sliding criterion of Eq. 2
  int rolling_grains() const { return nrolled; }

  // transfer to another rank and restart, as numbers
  int packed_size() const;
  void pack(double *buf) const;
  int unpack(const DetachmentFunctions &functions, const double *buf);

 private:
  double v0[3];
  double time;
  int nslid, nrolled;
  // made when the first grain could change: attached at the start of the collision; have met a criterion of Eq. 2
  std::vector<uint64_t> start, slid, rolled;
  // where the inertia force has been: a patch is due when the path of its seen range has come to due[patch]
  double seen[3], path, next_due;
  std::vector<double> due;
  std::vector<double> extreme;    // x y z of the accelerations that can be largest in some direction
  int peak;                       // which of them is largest

  void wake(const DetachmentFunctions &functions, const uint64_t *attached);
  void look(const DetachmentFunctions &functions, int patch, const double *g, uint64_t &attached,
            std::vector<Detachment> &detached);
  void remember(const double *acceleration);
  double largest_along(const double *n) const;
};

}    // namespace Dust

#endif
