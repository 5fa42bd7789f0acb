/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CONTACT_QUEUE_H
#define DUST_CONTACT_QUEUE_H

#include "contact_law.h"
#include "core/grain_contacts.h"
#include "core/hertz_contacts.h"

#include "lmptype.h"

#include <cstdint>
#include <vector>

namespace LAMMPS_NS {

/* ----------------------------------------------------------------------
   Contacts that wait, in their order, to be computed together: each law's in a batch of its own. They are no more than
   fit into one batch, so that none can overflow.
------------------------------------------------------------------------- */

class ContactQueue {
 public:
  struct Contact {
    Dust::ContactBatch *batch;
    int place;    // in the batch
    ContactLaw *law;
    int i() const { return batch->i[place]; }
    int j() const { return batch->j[place]; }
    Dust::Vector dx() const { return batch->dx[place]; }
    Dust::Vector force() const { return batch->force[place]; }
    Dust::Vector torque_i() const { return batch->torque_i[place]; }
    Dust::Vector torque_j() const { return batch->torque_j[place]; }
  };

  // \param wall  whether j are flat walls
  explicit ContactQueue(const std::vector<ContactLaw> &, bool wall = false);

  bool empty() const { return count == 0; }
  bool full() const { return count == Dust::ContactBatch::COUNT; }
  const Contact *begin() const { return contacts; }
  const Contact *end() const { return contacts + count; }
  void clear() { count = hertz.count = grains.count = computed.count = 0; }

  // of a law with a batch
  void add(ContactLaw *law, double *history, int i, int j)
  {
    const bool adheres = law->kind == ContactLaw::GRAIN;
    Dust::ContactBatch *batch = &hertz;
    if (adheres) batch = &grains;
    const int k = batch->count++;
    contacts[count++] = {batch, k, law};
    batch->i[k] = i;
    batch->j[k] = j;
    batch->kept_shear[k] = history + law->shear_place;
    if (adheres) grains.kept[k] = history + law->neck_place;
    if (stamp[law->kind][k] != law->stamp) set_coefficients(*law, *batch, k);
  }
  // what LAMMPS' own functions have computed
  void add_computed(ContactLaw *law, int i, int j);

  // how the spheres of all contacts meet each other, or planes
  template <class... With> void meet(const With &...with)
  {
    hertz.meet(with...);
    grains.meet(with...);
  }
  // forces and torques, and the histories moved on if `move`; step is that of events
  void compute(double dt, bool move, bigint step);

 private:
  // all lanes of a block are computed: those that no contact has had yet are 0
  Dust::HertzBatch hertz = {};
  Dust::GrainBatch grains = {};
  Dust::ContactBatch computed;
  Contact contacts[Dust::ContactBatch::COUNT];
  int count;
  // of the law whose coefficients stand there
  std::int64_t stamp[2][Dust::ContactBatch::COUNT] = {};

  void set_coefficients(const ContactLaw &, Dust::ContactBatch &, int);
  void tell_events(bigint) const;
};

}    // namespace LAMMPS_NS

#endif
