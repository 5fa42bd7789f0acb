/* -*- c++ -*- ----------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#ifndef DUST_CORE_STICKING_CRITERIA_H
#define DUST_CORE_STICKING_CRITERIA_H

#include "grain_table.h"

namespace Dust {

/* The criteria of grains that move with their carrier, Ibrahim et al., J. Aerosol Sci. 34, 765 (2003), and Cui &
   Sommerfeld, Powder Technol. 344, 741 (2019) (Eq. 2 of the paper). With the inertia force per grain mass
   g = -(a + alpha x r + omega x (omega x r)), r = (R_p + R_d) n, g_n = g.n outward and g_t = |g - g_n n|:

     lift-off  g_n > c,    sliding  g_t > mu_f |2 c - g_n|,    rolling  g_t R_d > |c - g_n| a0. */

/*! SLIDING and ROLLING are g_t > slope |factor c - g_n| */
struct Limit {
  double factor, slope;
};
/*! \param friction  mu_f
 *  \param lever     a0/R_d of the grain */
inline Limit limit_of(Mode mode, double friction, double lever)
{
  return mode == SLIDING ? Limit{2.0, friction} : Limit{1.0, lever};
}

/*! Inertia force per mass on a grain: outward along n, and normal to n */
struct Load {
  double normal, tangential;
};
Load load_on(const GrainTable::Site &site, const Motion &motion);

/*! By how much a grain meets SLIDING or ROLLING, per grain mass */
double excess(const GrainTable &table, Mode mode, int bit, const Load &load);
inline double excess(const GrainTable &table, Mode mode, int bit, const Motion &motion)
{
  return excess(table, mode, bit, load_on(table.site(bit), motion));
}

/*! Bounds of the excess of all grains of a patch */
struct Range {
  double min, max;
};
Range excess_in_patch(const GrainTable &table, Mode mode, int word, const Motion &motion);

/*! A grain that does not stick any longer, and by which criterion */
struct Loss {
  int bit;
  Mode mode;
};

/*! Appends the attached grains that meet any of the three: lift-off is asked first, then sliding, then rolling */
void find_losses(const GrainTable &table, const Motion &motion, const uint64_t *attached, std::vector<Loss> &losses);

}    // namespace Dust

#endif
