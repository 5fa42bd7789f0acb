/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.

   Inertia from motion: the hooks of fix dust/detach where it is the carriers' motion that counts.
------------------------------------------------------------------------- */

#include "fix_dust_detach.h"

#include "atom.h"
#include "update.h"

using namespace LAMMPS_NS;

/* ----------------------------------------------------------------------
   here f holds contact forces only
------------------------------------------------------------------------- */

void FixDustDetach::note_contacts()
{
  motions.note_middle();
  const int nlocal = atom->nlocal;
  const double *const *f = atom->f;
  touched.resize(nlocal);
  for (int i = 0; i < nlocal; i++) touched[i] = f[i][0] != 0.0 || f[i][1] != 0.0 || f[i][2] != 0.0 ? 1 : 0;
  if (!settings.rotation) return;
  carriers.add_turn(0, nlocal);
  if (update->ntimestep % CarrierData::TURN_EVERY == 0) carriers.turn();
}

/* ----------------------------------------------------------------------
   all integrators have moved the carriers
------------------------------------------------------------------------- */

void FixDustDetach::end_of_step()
{
  if (settings.criteria.meet) follow_grains();
  for (int i = 0; i < atom->nlocal; i++) {
    if ((atom->mask[i] & groupbit) && carriers.state[i] != NO_CARRIER) follow(i);
    motions.remember(i, carriers.before[i]);    // what it has lost may have changed its velocity
  }
  close_step();
}

/* ----------------------------------------------------------------------
   a collision lasts while contact forces act on carrier i or its acceleration could move a grain; a steady spin is none
------------------------------------------------------------------------- */

void FixDustDetach::follow(int i)
{
  const bool held = checks.holds(atom->mask[i]);
  bool acts = touched[i];
  if (acts && held) return;
  const Dust::Motion motion = motion_of(i);
  if (!acts) {
    Dust::Motion straight = motion;
    for (double &w : straight.spin) w = 0.0;
    acts = table_of(i).may_move(straight);
  }
  if (acts && held) return;
  if (acts)
    collide(i, motion);
  else if (carriers.state[i] >= 0)
    finish_collision(i, FREE_FLIGHT);
  else if (carriers.state[i] == AT_REST)
    leave_contact(i);
}
