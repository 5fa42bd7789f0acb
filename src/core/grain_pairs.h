/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_GRAIN_PAIRS_H
#define DUST_CORE_GRAIN_PAIRS_H

#include "grain_lanes.h"
#include "grain_table.h"

#include <utility>
#include <vector>

namespace Dust {

/*! Contacts of the grains of a carrier with each other
 *
 * JKR with their own surface energy (jkr.h), from the overlap 0 to where the neck breaks, with a modulus that is S
 * times softer: what happens in a contact is over before anything else has moved much, and so it may take longer.
 * Damping and friction, no rolling resistance, no attraction without a neck:
 *
 *   F_n = F(delta) - c v_n,    c = min(eta m_e a, 2 sqrt(k m_e)),    eta = S^(-3/5) 2 zeta sqrt(k0/m_e)/a0
 *   |F_t| <= mu |F + 2 F_c|, and half of what ends the slip of two spheres in a step
 *
 * with k0, a0 of the contact before it is softened. The restitution stays as it is, as a goes with S^(1/5) and the
 * stiffness k with S^(-4/5) (Hertz). More damping than the critical would only make the contact let go later, which is
 * short in a stiff contact but would not be in a soft one. What F_n changes by in a step is taken along the slopes (the
 * implicit midpoint rule).
 *
 * Forces are summed in the order of the grains' numbers: neither when neighbours are looked for nor how much further
 * than needed changes any result. */
class GrainPairs {
 public:
  /*! \param zeta      damping ratio of two grains at their equilibrium overlap
   *  \param softening S */
  GrainPairs(const GrainTable &table, double zeta, double softening);

  /*! A neck of two grains */
  struct Neck {
    int first, second;
  };

  /*! Pushes all grains that touch, for a step of the time h; those that sleep wake up
   *  \param present  by bit, which there are */
  void push(GrainLanes &grains, const std::vector<char> &present, double h);
  /*! How far grains may have moved since */
  void moved(double way) { travelled += way; }

  /*! Of the last push(), in the order of their numbers */
  const std::vector<Neck> &necks() const { return joined; }
  void set_necks(std::vector<Neck> necks)
  {
    joined = std::move(necks);
    travelled = skin;
  }

  double memory_usage() const    //!< bytes
  {
    return double(pairs.capacity()) * sizeof(Pair) + double(joined.capacity()) * sizeof(Neck);
  }

 private:
  struct Pair {
    int first, second;
    float reach2;    // square of a distance beyond which there is no force
    bool neck;
    Pair(int i, int j, float r2) : first(i), second(j), reach2(r2), neck(false) {}
  };
  const GrainTable &table;
  const double gamma, modulus, damping, hard_modulus, hard_share;    // hard_share: of a0
  // lengths: of a search beyond contact, of its cells, of grains from the carrier's centre, of necks before they break
  double skin, cell, far, longest_neck;
  std::vector<Pair> pairs;
  std::vector<Neck> joined;
  double travelled;    // since neighbours were found

  double mass(int bit) const { return table.weight(bit) * table.mean_mass(); }
  void find(const GrainLanes &grains, const std::vector<char> &present);
  bool touch(GrainLanes &grains, const Pair &pair, const double *r, double d2, double h) const;
};

}    // namespace Dust

#endif
