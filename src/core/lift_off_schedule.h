/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_LIFT_OFF_SCHEDULE_H
#define DUST_CORE_LIFT_OFF_SCHEDULE_H

#include "sticking_criteria.h"

#include <cstdint>
#include <vector>

namespace Dust {

/*! Finds the grains that lift off, g_n > c, without a look at each grain in each step: a calendar queue of looks
 *
 * While g moves by A along an axis and by B aside of it (or by what spin adds), g_n on the grain at n grows by at most
 * |axis.n| A + B, and so by at most max(|axis.n|, ratio) times what a clock A + B/ratio advances. What is missing to c
 * tells when the grain needs a look again. The calendar (Brown, Commun. ACM 31, 1220 (1988)) has TICKS days up to a
 * horizon; it holds the grains whose look is due before, each in the list of its day, and after a look a grain goes to
 * a later day. At the horizon another calendar is begun, with the ratio as g moves then. Where a step is too large for
 * that, none is, and all grains are asked, by patches. */
class LiftOffSchedule {
 public:
  void clear() { open = false; }

  /*! Appends the attached grains that lift off at this motion, in any order */
  void look(const GrainTable &table, const Motion &motion, const uint64_t *attached, std::vector<Loss> &losses);

 private:
  static constexpr int TICKS = 256, NONE = -1;
  double axis[3], ratio;
  bool open = false;    // whether there is a calendar
  double clock, horizon;
  double margin;       // for round-off
  Motion last = {};    // of the last look
  int tick;            // of the last look
  struct Entry {
    int bit, next;
  };
  std::vector<Entry> entries;
  std::vector<int> first;    // of the entries of each tick, or NONE

  void begin(const GrainTable &table, const Motion &motion, const uint64_t *attached, std::vector<Loss> &losses);
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
