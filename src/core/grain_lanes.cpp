/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

// compiled as surface_motion.cpp
#include "grain_lanes.h"

#include "geometry.h"
#include "jkr.h"
#include "lanes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

using namespace Dust;

namespace {

constexpr double TINY = 1.0e-200;                       // squares of what moves a grain are far above it
constexpr double NEW_NECK = 0.87358046473629888;        // y at the overlap 0, (2/3)^(1/3)
constexpr double MIN_Y = 1.02 * 0.55032120814910446;    // the branch ends at 6^(-1/3), where its slope has no bound

// one grain, named as in grain_lanes.h
struct Fixed {
  double hold, inv_breaking_gap, shell, radius, inv_radius, rolling, drag;
};
struct State {
  Vector n, v, spin, psi, push, twist;
  double gap, y, held;
};
struct Step {
  double h, inv_h;
  Vector a, omega, alpha;
  double friction, theta;
};

// yes and no are 1 and 0, and one of two is picked by sums: the compiler makes branches of questions, but no vectors
DUST_IN_LANES double pick(double first, double a, double b) { return first * a + (1.0 - first) * b; }
DUST_IN_LANES Vector pick(double first, const Vector &a, const Vector &b) { return first * a + (1.0 - first) * b; }
DUST_IN_LANES double is_below(double a, double b) { return a < b ? 1.0 : 0.0; }

// y at an overlap in delta_c: a step of y^4 = D/(2 6^(1/3)) + 2/3 y from the last one, and one of Newton's
struct Branch {
  double y, slope;    // dF/dD in F_c, delta_c
};
DUST_IN_LANES Branch follow_branch(double overlap, double y)
{
  const double fourth = overlap / (2.0 * ROOT_6) + 2.0 / 3.0 * y;
  y = std::sqrt(std::sqrt(fourth > 0.0 ? fourth : 0.0));
  y = y > MIN_Y ? y : MIN_Y;
  const double y3 = y * y * y, inv = 1.0 / (8.0 * y3 - 4.0 / 3.0);
  y -= ((2.0 * y3 - 4.0 / 3.0) * y - overlap / ROOT_6) * inv;
  y = y > MIN_Y ? y : MIN_Y;
  return {y, (24.0 * y3 - 12.0) * y * y / ROOT_6 * inv};
}

struct Contact {
  double pressure;    // 2 c + c F: times mu_f, the limit of friction
  double rolling;     // s
  double dv;          // of v_n over the step
};

// outward: all that pulls along n, but for the contact itself
DUST_IN_LANES Contact normal_motion(State &s, const Fixed &g, const Step &step, double outward, double vn)
{
  const Branch branch = follow_branch(-s.gap * g.inv_breaking_gap, s.y);
  const double y = branch.y, y2 = y * y, y3 = y2 * y;
  const double force = 4.0 * g.hold * y3 * (y3 - 1.0), drag = g.drag * y2;
  const double slope = branch.slope > 0.0 ? branch.slope : 0.0;
  const double stiffness = g.hold * g.inv_breaking_gap * slope, h = step.h;
  s.y = pick(s.held, y, NEW_NECK);
  const double dv =
      h * (outward + s.held * (force - drag * vn)) / (1.0 + s.held * (0.5 * h * drag + 0.25 * h * h * stiffness));
  return {s.held * std::fabs(2.0 * g.hold + force), s.held * g.rolling * y3, dv};
}

// all of v and Omega: to the end of the step
DUST_IN_LANES void kick(State &s, const Fixed &g, const Step &step, double shell)
{
  const Vector n = s.n, r = shell * n;
  const Vector t = s.push - step.a - cross(step.alpha, r) - cross(step.omega, cross(step.omega, r) + 2.0 * s.v);
  const double vn = dot(s.v, n), along = dot(t, n);
  const Vector vt = s.v - vn * n, tt = t - along * n;
  const Contact c = normal_motion(s, g, step, along + s.held * dot(vt, vt) / shell, vn);

  const Vector spin = step.h * (s.twist - step.alpha - cross(step.omega, s.spin));
  const Vector slip = vt - g.radius * cross(s.spin + spin, n);
  const Vector f = -2.0 / 7.0 * (step.inv_h * slip + tt + 2.5 * c.rolling * s.psi);
  const double f2 = dot(f, f), limit = step.friction * c.pressure;
  const Vector held = std::min(1.0, limit / std::sqrt(f2 + TINY)) * f;
  s.v = vt + step.h * (tt + held) + (vn + c.dv) * n;
  s.spin = s.spin + spin + (2.5 * step.h * g.inv_radius) * cross(held + c.rolling * s.psi, n);
}

// to the middle of the next step: held grains along the surface, others straight on
DUST_IN_LANES void drift(State &s, const Fixed &g, const Step &step, double shell)
{
  const Vector n = s.n;
  const double vn = dot(s.v, n), time = step.h;
  const Vector vt = s.v - vn * n;
  const Vector x = shell * n + time * (vt + ((1.0 - s.held) * vn) * n);
  const double r = std::sqrt(dot(x, x));
  const double held = s.held;
  s.n = (1.0 / r) * x;
  s.gap = pick(held, s.gap + time * vn, r - g.shell);
  s.v = pick(held, vt - dot(vt, s.n) * s.n + vn * s.n, s.v);
  Vector psi = s.psi + time * cross(s.spin, s.n);
  psi = psi - dot(psi, s.n) * s.n;
  const double psi2 = dot(psi, psi);
  psi = std::min(1.0, step.theta / std::sqrt(psi2 + TINY)) * psi;    // the pivot gives way
  // the neck breaks, or a new one forms
  s.held = is_below(s.gap * g.inv_breaking_gap, held);
  s.psi = (held * s.held) * psi;
}

// whether a grain only rocks on its pivot, and hardly swings in its contact
DUST_IN_LANES double is_calm(const State &s, const Fixed &g, const Step &step)
{
  const double y3 = s.y * s.y * s.y, rocking = 5.0 / 7.0 * g.rolling * y3 * g.radius;
  const double vn = dot(s.v, s.n);
  const Vector vt = s.v - vn * s.n, slip = vt - g.radius * cross(s.spin, s.n);
  constexpr double LITTLE = 1.0e-3;    // of the energy that moves the pivot
  const double enough = rocking * step.theta * step.theta;
  return is_below(dot(vt, vt) + rocking * dot(s.psi, s.psi), 1.001 * enough) *
         is_below(dot(slip, slip), LITTLE * enough) * is_below(vn * vn, LITTLE * g.hold / g.inv_breaking_gap);
}

}    // namespace

/* ---------------------------------------------------------------------- */

GrainLanes::GrainLanes(const GrainTable &table, double zeta) :
    count(table.grains()), friction(table.material().friction), theta_crit(table.material().rolling),
    blocks((count + WIDTH - 1) / WIDTH), slots(blocks.size() * WIDTH), places(4 * slots.size())
{
  std::iota(slots.begin(), slots.end(), 0);
  bits = slots;
  const double rp = table.carrier_radius(), density = table.material().density;
  for (int bit = 0; bit < static_cast<int>(slots.size()); bit++) {
    const GrainTable::Site &site = table.site(std::min(bit, count - 1));    // the last block is filled up
    Block &b = blocks[bit / WIDTH];
    const int i = bit % WIDTH;
    const double radius = site.shell - rp, r12 = effective_radius(rp, radius), a0 = site.lever * radius;
    const double mass = 4.0 / 3.0 * PI * radius * radius * radius * density, gap = breaking_gap(a0, r12);
    b.hold[i] = site.hold;
    b.inv_breaking_gap[i] = 1.0 / gap;
    b.shell[i] = site.shell;
    b.radius[i] = radius;
    b.inv_radius[i] = 1.0 / radius;
    b.rolling[i] = 4.0 * site.hold * r12 / radius;
    b.drag[i] = 2.0 * zeta * std::sqrt(1.2 * table.material().modulus * a0 / mass);
    places[4 * bit + 3] = radius;
    put(bit, {{site.n[0], site.n[1], site.n[2]}, -2.0 / 3.0 * ROOT_6 * gap, {}, {}, {}, 1.0, 1.0, 0.0});
  }
}

/* ---------------------------------------------------------------------- */

GrainLanes::Grain GrainLanes::get(int bit) const
{
  const Block &b = blocks[slots[bit] / WIDTH];
  const int i = slots[bit] % WIDTH;
  Grain g;
  for (int d = 0; d < 3; d++) {
    g.n[d] = b.n[d][i];
    g.v[d] = b.v[d][i];
    g.spin[d] = b.spin[d][i];
    g.psi[d] = b.psi[d][i];
  }
  g.gap = b.gap[i];
  g.y = b.y[i];
  g.held = b.held[i];
  g.awake = b.awake[i];
  return g;
}

void GrainLanes::put(int bit, const Grain &g)
{
  Block &b = blocks[slots[bit] / WIDTH];
  const int i = slots[bit] % WIDTH;
  for (int d = 0; d < 3; d++) {
    b.n[d][i] = g.n[d];
    b.v[d][i] = g.v[d];
    b.spin[d][i] = g.spin[d];
    b.psi[d][i] = g.psi[d];
    b.push[d][i] = b.twist[d][i] = 0.0;
    places[4 * bit + d] = (b.shell[i] + g.gap) * g.n[d];
  }
  b.touched[i] = 0.0;
  b.gap[i] = g.gap;
  b.y[i] = g.y;
  b.held[i] = g.held;
  set_awake(bit, g.awake > 0.0);
  b.flies = b.flies || (g.awake > 0.0 && g.held == 0.0);
}

void GrainLanes::compact()
{
  size_t busy = 0, awake = 0;
  for (const Block &b : blocks) {
    if (!b.busy) continue;
    busy += WIDTH;
    for (double is : b.awake) awake += is > 0.0;
  }
  constexpr size_t FEW = 3;    // of four
  if (4 * awake > FEW * busy) return;
  std::vector<int> order;
  order.reserve(bits.size());
  for (const bool wanted : {true, false})
    for (const int bit : bits)
      if (this->awake(bit) == wanted) order.push_back(bit);

  std::vector<Block> before = blocks;
  for (Block &b : blocks) b.busy = b.flies = false;
  constexpr int FIELDS = offsetof(Block, busy) / sizeof(double) / WIDTH;
  for (size_t slot = 0; slot < order.size(); slot++) {
    const int bit = order[slot], from = slots[bit];
    const double *old = before[from / WIDTH].hold + from % WIDTH;
    Block &b = blocks[slot / WIDTH];
    double *now = b.hold + slot % WIDTH;
    for (int field = 0; field < FIELDS; field++) now[field * WIDTH] = old[field * WIDTH];
    slots[bit] = static_cast<int>(slot);
    const bool is = b.awake[slot % WIDTH] > 0.0;
    b.busy = b.busy || is;
    b.flies = b.flies || (is && b.held[slot % WIDTH] == 0.0);
  }
  bits = std::move(order);
}

/* ----------------------------------------------------------------------
   a step of grains side by side; returns the square of the largest speed
------------------------------------------------------------------------- */

DUST_LANES static double advance(GrainLanes::Block &b, const Step &step, double settles)
{
  constexpr int WIDTH = GrainLanes::WIDTH;
  double speed2[WIDTH];
  for (int i = 0; i < WIDTH; i++) {
    const Fixed fixed = {b.hold[i],       b.inv_breaking_gap[i], b.shell[i], b.radius[i],
                         b.inv_radius[i], b.rolling[i],          b.drag[i]};
    State s = {{b.n[0][i], b.n[1][i], b.n[2][i]},
               {b.v[0][i], b.v[1][i], b.v[2][i]},
               {b.spin[0][i], b.spin[1][i], b.spin[2][i]},
               {b.psi[0][i], b.psi[1][i], b.psi[2][i]},
               {b.push[0][i], b.push[1][i], b.push[2][i]},
               {b.twist[0][i], b.twist[1][i], b.twist[2][i]},
               b.gap[i],
               b.y[i],
               b.held[i]};
    const double shell = fixed.shell + s.gap;
    kick(s, fixed, step, shell);
    drift(s, fixed, step, shell);
    const double was = b.awake[i], calm = is_calm(s, fixed, step) * s.held * settles * (1.0 - b.touched[i]);
    const double go = was * (1.0 - calm);
    speed2[i] = go * dot(s.v, s.v);
    b.n[0][i] = pick(was, s.n.x, b.n[0][i]);
    b.n[1][i] = pick(was, s.n.y, b.n[1][i]);
    b.n[2][i] = pick(was, s.n.z, b.n[2][i]);
    b.v[0][i] = go * s.v.x;
    b.v[1][i] = go * s.v.y;
    b.v[2][i] = go * s.v.z;
    b.spin[0][i] = go * s.spin.x;
    b.spin[1][i] = go * s.spin.y;
    b.spin[2][i] = go * s.spin.z;
    b.psi[0][i] = pick(was, s.psi.x, b.psi[0][i]);
    b.psi[1][i] = pick(was, s.psi.y, b.psi[1][i]);
    b.psi[2][i] = pick(was, s.psi.z, b.psi[2][i]);
    b.gap[i] = pick(was, s.gap, b.gap[i]);
    b.y[i] = pick(was, s.y, b.y[i]);
    b.held[i] = pick(was, s.held, b.held[i]);
    b.awake[i] = go;
  }
  double any = 0.0, flying = 0.0, max = 0.0;
  for (int i = 0; i < WIDTH; i++) {
    any += b.awake[i];
    flying += b.awake[i] * (1.0 - b.held[i]);
    max = std::max(max, speed2[i]);
    for (int d = 0; d < 3; d++) b.push[d][i] = b.twist[d][i] = 0.0;
    b.touched[i] = 0.0;
  }
  b.busy = any > 0.0;
  b.flies = flying > 0.0;
  return max;
}

/* ---------------------------------------------------------------------- */

void GrainLanes::advance(const CarrierStep &carrier, bool settle)
{
  const double *a = carrier.motion.acceleration, *w = carrier.motion.spin, *alpha = carrier.motion.angular_acceleration;
  const Step step = {carrier.h, 1.0 / carrier.h, {a[0], a[1], a[2]}, {w[0], w[1], w[2]}, {alpha[0], alpha[1], alpha[2]},
                     friction,  theta_crit};
  double fastest2 = 0.0;
  for (size_t k = 0; k < blocks.size(); k++) {
    if (!blocks[k].busy) continue;
    fastest2 = std::max(fastest2, ::advance(blocks[k], step, settle ? 1.0 : 0.0));
    show_places(blocks[k], &bits[k * WIDTH]);
  }
  fastest = std::sqrt(fastest2);
}

void GrainLanes::find_flying(std::vector<int> &found) const
{
  found.clear();
  for (size_t k = 0; k < blocks.size(); k++) {
    if (!blocks[k].flies) continue;
    for (int i = 0; i < WIDTH; i++)
      if (blocks[k].awake[i] > 0.0 && blocks[k].held[i] == 0.0) found.push_back(bits[k * WIDTH + i]);
  }
}

/* ---------------------------------------------------------------------- */

void GrainLanes::show_places(const Block &b, const int *bits_of_block)
{
  for (int i = 0; i < WIDTH; i++) {
    double *place = &places[4 * bits_of_block[i]];
    for (int d = 0; d < 3; d++) place[d] = (b.shell[i] + b.gap[i]) * b.n[d][i];
  }
}
