/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_ENTRAINMENT_H
#define DUST_CORE_ENTRAINMENT_H

#include "collision.h"
#include "grain_lanes.h"
#include "grain_pairs.h"
#include "grain_table.h"
#include "pack.h"
#include "quaternion.h"
#include "retrospect.h"
#include "tangential_law.h"

#include <cstdint>
#include <vector>

namespace Dust {

/*! What moving grains knock off: all grains of a carrier followed together, from the first contact of a strong
 *  collision until none moves any more
 *
 * Grains slide, roll and swing on their carrier and fly (grain_lanes.h), and meet each other (grain_pairs.h). A grain
 * is released as long as no chain of necks joins it to the carrier; one that comes back is held again. Released grains
 * stay in the way of others until they are above the tallest one: then they have left for good.
 *
 * The collision is followed at its end, from its record (impulse_record.h); after it the carrier is taken to fly on,
 * its spin steady, as time goes by. In how many calls that time comes changes no result. */
class Entrainment {
 public:
  explicit Entrainment(const GrainTable &table);

  /*! A grain that is released, or held again */
  struct Change {
    int bit;
    Mode mode;
    bool released, north;
    double velocity[3];    //!< relative to that of the carrier's centre now, in space
  };
  /*! A grain that has left for good: when it was released, and how it flies now, relative to the carrier's centre */
  struct Departure {
    Detachment left;
    double height;                            //!< of its surface over the carrier's when it was released
    double flown;                             //!< time since, or since the end of the collision if that is shorter
    double place[3], velocity[3], spin[3];    //!< now, in space
  };

  /*! Follows a collision that is over
   *  \param past      with its record
   *  \param axes      those of its vectors, in space
   *  \param start     grains at first contact, by bit
   *  \param alone     those of them that its law would have let go if they were alone, and how */
  void follow(const PastCollision &past, const Quaternion &axes, const uint64_t *start,
              const std::vector<Detachment> &alone);

  /*! Goes on for a time in free flight */
  void fly(double time);
  /*! Whether nothing is to come any more */
  bool over() const { return flown >= longest || !grains.any_awake(); }
  /*! Ends it: what is released has left, what is held stays where it was on the texture */
  void stop();

  // since they were taken last
  std::vector<Change> changes;
  std::vector<Departure> departures;

  // transfer to another rank and restart
  void pack(Packer &packer) const;
  void unpack(Unpacker &unpacker);
  /*! Numbers that pack() takes, told at once */
  int packed_size() const;

  double memory_usage() const;    //!< bytes

 private:
  const GrainTable &table;
  GrainLanes grains;
  GrainPairs pairs;
  double clear;      // gap from which a released grain has left: that above the tallest grain
  double longest;    // time after the collision

  // by bit
  std::vector<char> present, released, north;
  std::vector<Mode> mode;    // in which it leaves
  Quaternion now;            // of the carrier's axes, in space
  double spin[3];            // of the carrier, in space
  double flown, due;         // time after the collision, and what is left of it for the next step
  // grains that are released and have not left: how they were when they were
  struct Moment {
    Departure departure;
    double flown;
  };
  std::vector<Moment> moments;    // in the order in which they were released

  // of the present step
  std::vector<int> flying, changing;
  std::vector<char> linked;                // flying grains: whether others hold them to the carrier
  std::vector<GrainPairs::Neck> chains;    // necks of two that fly
  // of the collision, as long as it is followed
  const Retrospect *past_motion;
  Quaternion frame;
  double before_end;

  void follow_collision(const PastCollision &past);
  void advance(const CarrierStep &step, bool settle);
  void look_who_is_released();
  void link();
  void change(int bit, bool is_released);
  void depart(Moment &moment);
  void in_space(int bit, double *place, double *velocity) const;
};

}    // namespace Dust

#endif
