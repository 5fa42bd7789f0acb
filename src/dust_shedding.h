/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_SHEDDING_H
#define LMP_DUST_SHEDDING_H

#include "pointers.h"

#include <array>
#include <functional>
#include <vector>

namespace LAMMPS_NS {

// detached grains whose mass is still in their carrier's: it leaves at the end of the window, as atoms if asked for

class DustShedding : protected Pointers {
 public:
  enum { CARRIER, GRAIN, LOSS_MASS, LOSS_RADIUS, LOSS_STEP, LOSS_X, LOSS_V = LOSS_X + 3, LOSS_SPIN = LOSS_V + 3 };
  static constexpr int NLOSS = LOSS_SPIN + 3;
  using Loss = std::array<double, NLOSS>;

  // type of the atoms that grains become, or 0
  DustShedding(class LAMMPS *, int emit);

  void add(const Loss &loss) { losses.push_back(loss); }
  const std::vector<Loss> &of_this_rank() const { return losses; }
  // of all ranks and on all, in an order that does not depend on their number
  std::vector<Loss> of_all_ranks() const;
  void set(std::vector<Loss> list) { losses = std::move(list); }

  // all of them leave now. carries(i): whether atom i is a carrier. Returns how many of this rank found no room.
  double shed(double steps, const std::function<bool(int)> &carries);

  double memory_usage() const { return double(losses.capacity()) * sizeof(Loss); }

 private:
  int emit;
  std::vector<Loss> losses;

  std::vector<int> carriers_of(const std::vector<Loss> &, const std::function<bool(int)> &carries) const;
  double lighten(const std::vector<Loss> &, const std::vector<int> &carrier, const std::vector<char> &leaves) const;
  void find_room(const std::vector<Loss> &, double steps, const std::vector<int> &carrier,
                 std::vector<char> &leaves) const;
  void share_room(const std::vector<Loss> &, double steps, std::vector<char> &leaves) const;
  void place_of(const Loss &, double steps, double *) const;
};

}    // namespace LAMMPS_NS

#endif
