/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef LMP_DUST_SHEDDING_H
#define LMP_DUST_SHEDDING_H

#include "pointers.h"

#include "core/pack.h"

#include <array>
#include <functional>
#include <vector>

namespace LAMMPS_NS {

/* Grains that leave their carriers. Mass and momentum go in the step in which the grain does. To become an atom it
   waits for a time at which LAMMPS can take one, and for the end of its carrier's collision. Until then it belongs
   to the data of its carrier, whatever happens to that one, and flies freely from where it left. If there is no room
   for it then, it goes back to its carrier. */

class DustShedding : protected Pointers {
 public:
  // a grain that waits, as it was when it left
  struct Grain {
    double number;    // in the texture, from 1
    double mass, radius;
    double time;    // of now()
    double x[3], v[3], spin[3];
  };

  // emit: type of the atoms that the grains of a fix become, or 0
  DustShedding(class LAMMPS *, class Fix *, int emit);
  ~DustShedding() override;
  DustShedding(const DustShedding &) = delete;
  DustShedding &operator=(const DustShedding &) = delete;

  // stops if the deck stands in the way of emitted grains: before a run
  void check_deck() const;

  // time since the fix is there: the time step may change
  double now() const { return clock; }
  void pass(double dt) { clock += dt; }

  // carrier i loses mass and momentum. Its velocity may be that of the half step: M v + (kicks to come) is conserved
  void take_off(int i, double mass, const double *momentum);
  // one of those grains becomes an atom later
  void wait(int i, const Grain &);
  // a carrier's mass has changed on some rank since this was asked last: ghosts must be told. All ranks ask.
  bool masses_changed();
  void mass_changed() { changed = true; }

  // all ranks: the grains of those carriers become atoms or go back; ghosts are gone then. Returns how many of this
  // rank went back. ready(i): whether carrier i has left its collision
  double emit_grains(const std::function<bool(int)> &ready);
  // the same for all of them at the end of a run: LAMMPS has ghosts and neighbours again
  double emit_all();
  // all ranks, after atoms have come: stops if one has the ID of an emitted grain
  void check_new_ids();

  // per-atom data
  void grow(int nmax);
  void copy(int i, int j)
  {
    waiting[j] = waiting[i];
    unseen[j] = unseen[i];
  }
  void set_new(int i)
  {
    waiting[i] = NOBODY;
    unseen[i] = 1;
  }
  bool is_new(int i) const { return unseen[i]; }
  void set_seen(int i) { unseen[i] = 0; }
  // lists of carriers that have left this rank or were deleted
  void drop_lost();
  void pack(int i, bool for_file, Dust::Packer &) const;
  void unpack(int i, Dust::Unpacker &);
  // a carrier that has been displaced since its restart file was written takes its grains along; once, before a run
  void follow_displaced();

  // what a restart file keeps of all ranks: numbers
  static constexpr int SIZE = 2;
  std::array<double, SIZE> numbers() const { return {clock, double(highest)}; }
  void set(const double *numbers);

  double memory_usage() const;

 private:
  class Fix *fix;
  int emit;
  double clock;
  bool changed;
  tagint highest;    // ID of an atom made here

  // by atom
  enum { NOBODY = -1 };
  int *waiting;    // number of the list of its grains that wait, or NOBODY
  int *unseen;     // 1 until its ID has been compared with those that were given here
  struct List {
    std::vector<Grain> grains;
    bool from_file;       // and not in a run since
    double carrier[3];    // where it was in the file, if so
  };
  std::vector<List> lists;
  std::vector<int> idle;    // numbers of lists that no carrier has
  List &list_of(int i);
  void drop(int number);

  // a grain that wants to become an atom, known to all ranks; doubles only
  struct Candidate {
    double carrier, number;
    double rank, index;    // of its carrier
    double mass, radius;
    double x[3], v[3], spin[3], from[3];    // from: where it left
  };
  std::vector<Candidate> gather(const std::function<bool(int)> &ready);
  double send_back(const std::vector<Candidate> &, const std::vector<int> &room);
  void create(const std::vector<Candidate> &, const std::vector<int> &room);
  void unwrapped(int i, double *x) const;
};

}    // namespace LAMMPS_NS

#endif
