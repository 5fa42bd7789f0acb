/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "tangential_law.h"

#include "tangential_estimate.h"
#include "tangential_impulse.h"
#include "tangential_integration.h"

using namespace Dust;

const TangentialLaw *Dust::tangential_law(Criteria::Tangential name, bool rings)
{
  switch (name) {
    case Criteria::FRICTIONLESS: return &TANGENTIAL_FRICTIONLESS;
    case Criteria::ESTIMATE: return &TANGENTIAL_ESTIMATE;
    case Criteria::IMPULSE: return rings ? &TANGENTIAL_IMPULSE_RINGING : &TANGENTIAL_IMPULSE;
    case Criteria::INTEGRATE: return &TANGENTIAL_INTEGRATION;
    case Criteria::OFF: break;
  }
  return nullptr;
}
