/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_ACTIVITY_H
#define DUST_CORE_ACTIVITY_H

namespace Dust {

/*! When a collision is lively, and when it has come to rest though its contact lasts
 *
 * A step is lively if inertia could move a grain in it, or if the acceleration grew beyond all before. Lively steps
 * come in bursts; a pause longer than the burst before it ends that burst. A collision that has been quiet for QUIET
 * times its last burst is at rest; for WEAK_QUIET times if it is weak, that is, if inertia has not been able to move a
 * grain so far. */
class Activity {
 public:
  bool has_begun() const { return steps > 0.0; }
  void count_step() { steps += 1.0; }

  /*! The step that was counted last is lively */
  void mark_lively()
  {
    const double before = steps - 1.0;
    if (before - lively_end > lively_end - burst) burst = before;
    lively_end = steps;
  }
  /*! Whether that step was lively */
  bool is_lively() const { return lively_end == steps; }

  bool at_rest(bool weak) const { return steps - lively_end > (weak ? WEAK_QUIET : QUIET) * (lively_end - burst); }

 private:
  static constexpr double QUIET = 3.0, WEAK_QUIET = 0.1;
  // whole numbers, of time steps since the collision began
  double steps = 0.0;
  double burst = 0.0, lively_end = 0.0;    // when the present or last burst began and ended
};

}    // namespace Dust

#endif
