/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_LIFT_OFF_WINDOW_H
#define DUST_CORE_LIFT_OFF_WINDOW_H

#include "motion.h"

#include <cstdint>
#include <vector>

namespace Dust {

class DetachmentFunctions;

/*! Finds the grains that lift off, g_n > c, without a look at each grain in each step
 *
 * While g moves by A along an axis and by B aside of it (or by what spin adds), g_n on the grain at n grows by at most
 * |axis.n| A + B, and so by at most max(|axis.n|, ratio) times what a clock A + B/ratio advances. What is missing to c
 * tells when the grain needs a look again. The window holds the grains whose time comes before it closes, in a calendar of
 * ticks; when it closes another one is opened from there, with the ratio as g moves then. Where a step is too large for
 * that, all grains are asked, by patches. */
class LiftOffWindow {
 public:
  void close() { end = -1.0; }

  /*! Appends the attached grains that lift off at this motion, in any order */
  void look(const DetachmentFunctions &functions, const Motion &motion, const uint64_t *attached,
            std::vector<int> &leaving);

 private:
  static constexpr int TICKS = 256;
  double axis[3], ratio;
  double clock, end = -1.0;    // closed if `end` is negative
  double margin;               // for round-off
  Motion last = {};            // of the last look
  int tick;                    // of the last look
  struct Entry {
    int bit, next;
  };
  std::vector<Entry> entries;
  std::vector<int> first;    // of the entries to look at in each tick, -1 if none

  void open(const DetachmentFunctions &functions, const Motion &motion, const uint64_t *attached,
            std::vector<int> &leaving);
  void put(int entry, int at)
  {
    entries[entry].next = first[at];
    first[at] = entry;
  }
  // when a grain needs a look again that misses so much, counted from now
  double wait(double missing, double u) const;
  int tick_of(double time) const;
};

}    // namespace Dust

#endif
