/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_GRAIN_LANES_H
#define DUST_CORE_GRAIN_LANES_H

#include "grain_table.h"
#include "motion.h"

#include <algorithm>
#include <vector>

namespace Dust {

/*! A step of a carrier: how it moves in its middle, along its own axes, and its time */
struct CarrierStep {
  Motion motion;
  double h;
};

/*! The grains of a carrier that slide, roll, swing in their contacts and fly, under given forces of other grains
 *
 * Along the carrier's axes, which turn with omega, a grain is at (|r_pd| + z) n, z being the gap of its surface to the
 * carrier's, negative in a contact. It moves with v over the carrier and spins with Omega relative to it; with
 * v = v_t + v_n n, g = -a - alpha x r - omega x (omega x r) - 2 omega x v the inertia and q the push of others, per
 * grain mass, and c = F_c/m:
 *
 *   held      dv_n/dt = (g + q).n + |v_t|^2/|r| + c F(z) - 2 zeta sqrt(k0/m) (a/a0) v_n         (normal_motion.h)
 *             dv_t/dt = (g + q)_t + f,  |f| <= mu_f |2 c + c F|, against the slip v_t - R_d Omega x n
 *             (2/5) R_d^2 dOmega/dt = -R_d n x f - R_d s n x psi + torque of others,  s = 4 c (R_12/R_d) (a/a0)^(3/2)
 *             dpsi/dt = Omega x n, |psi| held at theta_crit                                      (surface_motion.h)
 *   flying    dv/dt = g + q
 *
 * F(z) is the force of the JKR branch in F_c (jkr.h): the neck breaks at z = delta_c, and forms again at z = 0.
 *
 * A step is a leapfrog: positions stand in the middle of steps, all of one length in a row, velocities at their ends.
 * Friction is the one that ends the slip within the step, or its limit; what the contact's spring and damper change
 * during the step is taken along their slopes (the implicit midpoint rule), so that no contact is too stiff for a step.
 * Held grains keep their distance exactly, flying ones go straight. A grain's step depends on no other grain's: how
 * they are put side by side changes no result. */
class GrainLanes {
 public:
  static constexpr int WIDTH = 8;    // side by side, for the compiler's vectors

  /*! What is kept of a grain */
  struct Grain {
    double n[3], gap;        //!< z
    double v[3], spin[3];    //!< v, Omega
    double psi[3], y;        //!< rolling angle, sqrt(a/a0)
    double held;             //!< 1 as long as it has a neck to the carrier, then 0
    double awake;            //!< 1, or 0 if it is left out: it rests, or is not there
  };

  /*! All grains at rest in their contacts, without a load, and none awake
   *  \param zeta  damping ratio of the grains' contacts at the equilibrium overlap */
  GrainLanes(const GrainTable &table, double zeta);

  int grains() const { return count; }
  Grain get(int bit) const;
  void put(int bit, const Grain &grain);
  /*! Puts those that are awake side by side if many sleep beside them, to be passed over */
  void compact();

  /*! Adds to what others do to a grain in the step to come, f times a acceleration and t times b angular acceleration;
   *  it wakes up */
  void push(int bit, const double *f, double a, const double *t, double b)
  {
    Block &block = blocks[slots[bit] / WIDTH];
    const int i = slots[bit] % WIDTH;
    for (int d = 0; d < 3; d++) {
      block.push[d][i] += a * f[d];
      block.twist[d][i] += b * t[d];
    }
    block.touched[i] = 1.0;
    set_awake(bit, true);
  }

  /*! One step of all that are awake
   *  \param settle  whether grains that only rock on their contacts, and no other touches, are put to rest */
  void advance(const CarrierStep &step, bool settle);

  bool held(int bit) const { return blocks[slots[bit] / WIDTH].held[slots[bit] % WIDTH] != 0.0; }
  bool awake(int bit) const { return blocks[slots[bit] / WIDTH].awake[slots[bit] % WIDTH] != 0.0; }
  void set_awake(int bit, bool is)
  {
    Block &b = blocks[slots[bit] / WIDTH];
    b.awake[slots[bit] % WIDTH] = is;
    b.busy = b.busy || is;
  }
  double gap(int bit) const { return blocks[slots[bit] / WIDTH].gap[slots[bit] % WIDTH]; }

  // place relative to the carrier's centre, velocity over it, spin relative to it
  const double *place(int bit) const { return &places[4 * bit]; }
  void velocity(int bit, double *v) const
  {
    for (int d = 0; d < 3; d++) v[d] = blocks[slots[bit] / WIDTH].v[d][slots[bit] % WIDTH];
  }
  void spin(int bit, double *w) const
  {
    for (int d = 0; d < 3; d++) w[d] = blocks[slots[bit] / WIDTH].spin[d][slots[bit] % WIDTH];
  }

  double max_speed() const { return fastest; }    //!< of the last step
  bool any_awake() const
  {
    return std::any_of(blocks.begin(), blocks.end(), [](const Block &block) { return block.busy; });
  }
  /*! All without a neck to the carrier, in any order */
  void find_flying(std::vector<int> &found) const;

  double memory_usage() const    //!< bytes
  {
    return double(blocks.size()) * sizeof(Block) + double(slots.size()) * 2 * sizeof(int) +
           double(places.size()) * sizeof(double);
  }

  /*! Grains side by side */
  struct alignas(64) Block {
    // constants of grains
    double hold[WIDTH], inv_breaking_gap[WIDTH], shell[WIDTH], radius[WIDTH], inv_radius[WIDTH];
    double rolling[WIDTH], drag[WIDTH];    // 4 c R_12/R_d, 2 zeta sqrt(k0/m)
    // Grain
    double n[3][WIDTH], gap[WIDTH], v[3][WIDTH], spin[3][WIDTH], psi[3][WIDTH], y[WIDTH], held[WIDTH], awake[WIDTH];
    // from others, in the step to come
    double push[3][WIDTH], twist[3][WIDTH], touched[WIDTH];
    bool busy, flies;    // whether any is awake, any has no neck
  };

 private:
  int count;
  double friction, theta_crit;
  std::vector<Block> blocks;
  std::vector<int> slots, bits;    // where a grain is, WIDTH to a block; which grain is there
  std::vector<double> places;      // four numbers a grain, the last one its radius
  double fastest = 0.0;

  void show_places(const Block &block, const int *bits_of_block);
};

}    // namespace Dust

#endif
