/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_ACTIVITY_H
#define DUST_CORE_ACTIVITY_H

namespace Dust {

/*! When a collision is lively, and when it has come to rest though its contact lasts
 *
 * A step is lively if inertia could move a grain in it, or if the acceleration grew beyond all before. Lively steps
 * come in bursts; a pause longer than the burst before it ends that burst.
 *
 * Rest is told by the course of |a| alone, as no grain's hold says how long a contact takes. The unit of time is the
 * collision's own, integral |a| dt/max |a| over the burst and since. An impact that nothing else disturbs rises once
 * and falls once, to 0: for Hertz contacts of restitution 0.1 to 1 that takes at no time more than 2.9 of these units,
 * and between two steps in which it grows, or has fallen by FALL since the last such step, there are at most 0.6 of
 * them. What lasts comes down to what carries the weight, and falls no more. So a collision rests when it has been
 * quiet, neither lively nor fallen so, for QUIET of its own times. One that is weak, as inertia has not been able to
 * move a grain, also rests if it takes longer than LONG of them; another one only when it has been quiet for PAUSE
 * times its burst, too. */
class Activity {
 public:
  bool has_begun() const { return steps > 0.0; }

  /*! One time step
   *  \param size    |a|
   *  \param lively  whether inertia could move a grain, or a is the largest so far */
  void add(double size, bool lively)
  {
    if (lively) {
      if (steps - lively_end > lively_end - burst) {
        burst = steps;
        push = 0.0;
      }
      lively_end = steps + 1.0;
      if (size > peak) peak = size;
    }
    steps += 1.0;
    push += size;
    if (lively || size < (1.0 - FALL) * low) {
      low = size;
      quiet_from = steps;
    }
  }

  /*! Whether the last step was lively */
  bool is_lively() const { return lively_end == steps; }

  bool at_rest(bool weak) const
  {
    const double quiet = steps - quiet_from;
    if (weak) return quiet * peak > QUIET * push || (steps - burst) * peak > LONG * push;
    return quiet * peak > QUIET * push && quiet > PAUSE * (lively_end - burst);
  }

 private:
  static constexpr double FALL = 0.125, QUIET = 0.75, PAUSE = 3.0, LONG = 4.0;
  // times are whole numbers of steps since the collision began
  double steps = 0.0;
  double push = 0.0;                       // sum of |a| of the burst and since
  double peak = 0.0, low = 0.0;            // the largest |a|, and that of the step that was the last to count
  double quiet_from = 0.0;                 // when that was
  double burst = 0.0, lively_end = 0.0;    // when the present or last burst began and ended
};

}    // namespace Dust

#endif
