/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_COLLISION_H
#define DUST_CORE_COLLISION_H

#include "acceleration_history.h"
#include "activity.h"
#include "grain_table.h"
#include "impulse_record.h"
#include "lift_off_schedule.h"
#include "pack.h"
#include "quaternion.h"
#include "tangential_law.h"

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

/* Which grains of a texture leave a carrier in a collision, from the carrier's motion alone. */

namespace Dust {

class Entrainment;

/*! One grain that has just left */
struct Detachment {
  int bit;
  Mode mode;
  double direction[3];    //!< n, in space
  double velocity[3];     //!< relative to the carrier's centre, in space
  /*! So long before the present call: 0 but for laws that tell when a grain left during the collision. With the
   *  carrier's velocity v and place x at the end of the collision they were v + carrier_velocity and
   *  x - before_end v + carrier_place then, as far as contact forces moved it (retrospect.h) */
  double before_end;
  double carrier_velocity[3], carrier_place[3];
};

/*! What is kept of a collision from when inertia could make a grain slide; what each step needs comes first */
struct alignas(64) Strong {
  AccelerationHistory history;
  std::vector<uint64_t> start;    // attached at begin(), kept from when the first grain could leave
  struct Moment {
    double time;
    double impulse[3], spin[3];    // as of Collision
  };
  struct State {             // in space
    Quaternion now;          // the carrier
    Moment lively;           // at the last lively step
    double count[NMODES];    // of the grains that have left, those that had met SLIDING and ROLLING
  } state;
  LiftOffSchedule schedule;
};

/*! What the collisions of a rank share */
struct Workspace {
  std::vector<Detachment> detached;              //!< grains that have left: to be taken and cleared by the caller
  bool locate = true;                            //!< whether the caller wants their directions and velocities
  std::vector<std::unique_ptr<Strong>> spare;    //!< strong parts that no collision needs now
  // of the present call
  std::vector<Loss> losses;
  std::vector<Release> released;
};

/*! Collision of one carrier
 *
 * It begins with the first contact force after free flight, or where a carrier at rest is moved so hard that a grain
 * could slide. It ends with the first step without contact force: an isolated impact is followed from first contact to
 * rebound, as in the paper. Or it comes to rest (activity.h). What came after its last lively step then does not count.
 * In a bed of carriers this ends the collision where neither a first contact nor a rebound could be told. Damped Hertz
 * contacts with restitution from 0.3 on (0.1) rebound before, if their peak is 1.01 (1.6) times what can make a grain
 * slide.
 *
 * It is weak until inertia first can make a grain slide. Most contacts of a bed stay weak: of that time only the sums
 * and the largest acceleration are kept.
 *
 * Vectors come in space. The frame of first contact is the carrier's axes at the first step; it does not turn with them
 * later.
 *
 * In most steps no grain can change, and little is done in the others:
 * - A grain that holds at q holds at lambda q + e too if what e and the spin add is no more than (1 - lambda) c:
 *   unloading needs no look.
 * - LiftOffSchedule knows which grains can lift off next.
 * - Whether a grain has met the sliding or rolling criterion is asked once, when it leaves or at the end: as long as it
 *   holds, g_t + k g_n is a convex function of g, so the motions that the history keeps decide. */
class alignas(64) Collision {
 public:
  /*! Starts before the first step that has a contact force
   *  \param orientation  of the carrier at that step
   *  \param spin         before that contact */
  void begin(const Quaternion &orientation, const double *spin);

  /*! One time step: Eq. 2 and lift-off normal
   *  \param middle    must be finite; its spin is that of the middle of the step that ends now, as a leapfrog has it
   *  \param attached  bits of the grains; those that leave are cleared. A weak collision does not touch them
   *  \param work      the grains that leave are appended to its list
   *  \return          true if any left */
  bool step(const GrainTable &table, const Motion &middle, double dt, std::vector<uint64_t> &attached, Workspace &work);

  /*! Has what a step needs brought from memory into the cache. Each go needs what the one before has asked for: between
   *  them is the time to ask for that of others. In line, as calls of a function that only fetches are left out */
  enum class Fetch { FIRST, SECOND, THIRD };
  __attribute__((always_inline)) void fetch(Fetch go) const
  {
    constexpr int WRITE = 1, LINE = 64;
    const auto *own = reinterpret_cast<const char *>(this), *part = reinterpret_cast<const char *>(strong.get());
    if (go == Fetch::FIRST)
      for (int line : {0, 1}) __builtin_prefetch(own + LINE * line, WRITE);
    else if (part && go == Fetch::SECOND)
      for (int line : {0, 1, 2}) __builtin_prefetch(part + LINE * line, WRITE);
    else if (part)
      strong->history.fetch();
    else if (go == Fetch::SECOND)
      for (int line : {2, 3}) __builtin_prefetch(own + LINE * line, WRITE);
  }

  /*! Whether it has come to rest though the contact lasts */
  bool at_rest() const { return course.activity.at_rest(weak()); }

  /*! Lift-off tangential, at the first step without contact force or at rest, by the law of the table's criteria
   *  \param spin  after the contact */
  bool end(const GrainTable &table, const double *spin, uint64_t *attached, Workspace &work);

  /*! After end(), for grains that meet: hands them to those who follow them together, from the first contact on. All
   *  that were attached then are so again in `attached`
   *  \param spin  after the contact
   *  \param late  what end() has let go */
  void hand_over(const GrainTable &table, const double *spin, const std::vector<Detachment> &late, uint64_t *attached,
                 Entrainment &together) const;

  /*! Grains lost since begin() on the north, n.(velocity - velocity before contact) > 0; before the end with the
   *  velocity so far */
  int lost_north(const GrainTable &table, const uint64_t *attached) const;

  bool weak() const { return !strong; }
  double peak_acceleration() const;    //!< largest |contact acceleration| so far
  /*! Contact force/carrier mass, integrated since begin() */
  const double *impulse() const { return course.impulse; }
  /*! Grains that have met the criterion of Eq. 2, SLIDING or ROLLING, since begin(); where no inertia could make any
   *  slide, those that have met it at the largest acceleration */
  int grains_that(Mode mode, const GrainTable &table, const uint64_t *attached) const;

  /*! Gives back what it has taken from the workspace: when it is over, or its carrier gone */
  void release(Workspace &work);

  // transfer to another rank and restart. The schedule is begun anew, which changes no result
  void pack(Packer &packer) const;
  int packed_size() const;
  /*! Whether that may grow from step to step: not while it is weak, unless its law needs its course */
  bool grows(const GrainTable &table) const { return strong || needs_impulses(table); }
  /*! At least that, and told at once */
  int max_packed_size(const GrainTable &table) const
  {
    constexpr size_t SIZES = 16;    // of all vectors, and other single numbers
    size_t size = SIZES + numbers_of<Course>();
    if (needs_impulses(table) && impulses) size += numbers_of<ImpulseRecord::Span>() * impulses->spans().size();
    if (strong)
      size += numbers_of<Strong::State>() + strong->start.size() + numbers_of<Motion>() * strong->history.kept().size();
    return static_cast<int>(size);
  }
  void unpack(Unpacker &unpacker);

 private:
  // what a step of a weak collision needs comes first, as a bed has more of them than a cache
  std::unique_ptr<Strong> strong;    // from when inertia could make a grain slide
  struct Course {                    // in space
    double time;
    double impulse[3];    // contact force/carrier mass, integrated since begin()
    Activity activity;
    // of the weak time
    double peak2;       // square of the largest acceleration
    double angle[3];    // about which the carrier turned
    Motion peak;        // that of the largest acceleration, and the angle until then
    double peak_angle[3];
    Quaternion frame;    // the carrier at first contact
    double spin0[3];     // before contact
  } course;
  std::unique_ptr<ImpulseRecord> impulses;    // if the law needs them, from the first step

  // size of a motion, and whether it may move a grain
  struct Strength {
    double size2, size, rotation;    // of the acceleration; at most what rotation adds on any grain
    bool may_move;
  };
  static Strength strength_of(const GrainTable &table, const Motion &motion, const double *spin)
  {
    const double size2 = dot(motion.acceleration, motion.acceleration), size = std::sqrt(size2);
    const double rotation = table.max_shell() * motion.rotation_bound(spin);
    return {size2, size, rotation, size + rotation > table.moving_force()};
  }

  static bool needs_impulses(const GrainTable &table)
  {
    return table.tangential() && table.tangential()->needs_impulses;
  }

  void become_strong(const GrainTable &table, Workspace &work);
  void add(const GrainTable &table, const Motion &motion, const double *spin, double size, double dt, bool lively);
  void step_weak(const GrainTable &table, const Motion &motion, const double *spin, const Strength &strength,
                 double dt);
  void step_strong(const GrainTable &table, const Motion &motion, const Strength &strength, double dt,
                   std::vector<uint64_t> &attached, Workspace &work);
  void find_losses(const GrainTable &table, const Motion &motion, const uint64_t *attached, Workspace &work);
  void keep_start(const GrainTable &table, const uint64_t *attached);
  PastCollision past_at(const double *spin) const;
  void lose(const GrainTable &table, const Loss &loss, const Motion &motion, uint64_t *attached, Workspace &work);
  void let_go(const GrainTable &table, const Release &release, uint64_t *attached, Workspace &work);
  void locate_in_past(std::vector<Detachment> &detached, size_t first) const;
  Motion weak_peak() const;    // the largest of the weak time, along the carrier's axes
  bool has_met(Mode mode, const GrainTable &table, int bit) const;
};

}    // namespace Dust

#endif
