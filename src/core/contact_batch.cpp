/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "contact_batch.h"

using namespace Dust;

/* ----------------------------------------------------------------------
   the pointers stand in registers: none of the numbers written here is one of those read
------------------------------------------------------------------------- */

void ContactBatch::meet(const Spheres &spheres)
{
  const double *__restrict x = spheres.x, *__restrict v = spheres.v, *__restrict omega = spheres.omega;
  const double *__restrict radius = spheres.radius, *__restrict masses = spheres.mass;
  ContactBatch &__restrict b = *this;
  for (int k = 0, n = count; k < n; k++) {
    const int first = b.i[k], second = b.j[k];
    const double ri = radius[first], rj = radius[second], mi = masses[first], mj = masses[second];
    const Vector apart = at(x, first) - at(x, second);
    b.dx.set(k, apart);
    b.rsq[k] = dot(apart, apart);
    b.velocity.set(k, at(v, first) - at(v, second));
    b.turning.set(k, ri * at(omega, first) + rj * at(omega, second));
    b.radius_i[k] = ri;
    b.radius_j[k] = rj;
    b.mass[k] = mi * mj / (mi + mj);
    b.shear.set(k, at(b.kept_shear[k]));
  }
}

void ContactBatch::meet(const Spheres &spheres, const Planes &planes)
{
  const Vector resting = {0.0, 0.0, 0.0};
  for (int k = 0; k < count; k++) {
    double apart[3] = {0.0, 0.0, 0.0};
    apart[planes.axis] = planes.distance(spheres.x[3 * i[k] + planes.axis]);
    const double radius = spheres.radius[i[k]];
    dx.set(k, at(apart));
    rsq[k] = dot(at(apart), at(apart));
    velocity.set(k, at(spheres.v, i[k]) - planes.velocity);
    turning.set(k, radius * at(spheres.omega, i[k]) + resting);
    radius_i[k] = radius;
    radius_j[k] = 0.0;
    mass[k] = spheres.mass[i[k]];
    shear.set(k, at(kept_shear[k]));
  }
}
