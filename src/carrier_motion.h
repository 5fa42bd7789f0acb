/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_CARRIER_MOTION_H
#define LMP_CARRIER_MOTION_H

#include "pointers.h"

#include "core/motion.h"

#include <vector>

namespace LAMMPS_NS {

// How carriers really move, whatever makes them, for `inertia motion`: their acceleration over a step, asked for at its
// end, when all integrators have done.
//
// - Verlet integrators (fix nve*) have the velocity of the middle of the step when forces are there, and another half
//   kick makes it that of the end: a = 2 (v - v_middle)/dt, which is force/mass if nothing else acts.
// - A fix move gives a carrier the velocity of its path from the first step on, however it moved before: that jump is
//   no motion. With the mean velocity of the step from the places, a = 2 (v - way/dt)/dt. Its spin is steady.
// - Of any other integrator: a = (v - v_before)/dt.

class CarrierMotion : protected Pointers {
 public:
  explicit CarrierMotion(class LAMMPS *_lmp) : Pointers(_lmp), carried(0), kicked(0) {}

  // who pulls all of a carrier alike, who carries it along, and who kicks it; in init()
  void look();

  static constexpr int SIZE = 9;                 // numbers that remember() keeps of an atom: place, velocity, spin
  void remember(int i, double *before) const;    // at the end of a step
  void note_middle();                            // of all atoms of this rank, when the forces of a step are there

  // less gravity, which pulls grains, too; the spin is that of the middle of the step
  Dust::Motion of(int i, const double *before, bool rotation) const;

 private:
  struct Gravity {
    int groupbit;
    const double *acceleration;
  };
  std::vector<Gravity> gravities;
  int carried, kicked;           // bits of the groups of fixes that do
  std::vector<double> middle;    // velocity and spin
};

}    // namespace LAMMPS_NS

#endif
