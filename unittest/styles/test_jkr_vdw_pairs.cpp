// Adhesive contact of two spheres in LAMMPS: jkr/vdw with mindlin and dominik/tielens against closed forms and
// conservation laws. Every closed form is written out here; nothing is taken from src/core.

#include "deck.h"

#include <algorithm>
#include <array>
#include <utility>

namespace {

using Vec = std::array<double, 3>;

Vec operator+(const Vec &a, const Vec &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vec operator*(double s, const Vec &a) { return {s * a[0], s * a[1], s * a[2]}; }
Vec operator-(const Vec &a, const Vec &b) { return a + -1.0 * b; }
double dot(const Vec &a, const Vec &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec cross(const Vec &a, const Vec &b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vec &a) { return std::sqrt(dot(a, a)); }

// from sphere 1 to sphere 2, and two directions across it
const Vec N = {1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0}, T1 = {2.0 / 3.0, 1.0 / 3.0, -2.0 / 3.0},
          T2 = {2.0 / 3.0, -2.0 / 3.0, 1.0 / 3.0};

const double HAMAKER = 14.633e-20, Z0 = 0.4e-9, YOUNG = 1.1053e11, NU = 0.3, DENSITY = 2700.0;
const double CARRIER = 0.75e-3;
const std::vector<std::pair<double, double>> SIZES = {{CARRIER, 10e-6}, {10e-6, 5e-6}};    // radii

// two spheres: JKR branch over x = a/a0 (Chokshi et al. 1993) with gamma = A/(18 pi z0^2)
struct Contact {
  double r1, r2, r, modulus, gamma, fc, a0, delta_c, delta_0;
  Contact(double _r1, double _r2) : r1(_r1), r2(_r2), r(r1 * r2 / (r1 + r2))
  {
    modulus = YOUNG / (2.0 * (1.0 - NU * NU));
    gamma = HAMAKER / (18.0 * M_PI * Z0 * Z0);
    fc = 3.0 * M_PI * gamma * r;
    a0 = std::cbrt(9.0 * M_PI * gamma * r * r / modulus);
    delta_c = a0 * a0 / (2.0 * std::cbrt(6.0) * r);
    delta_0 = a0 * a0 / (3.0 * r);
  }
  double x(double overlap) const    // by bisection, on the stable part
  {
    double low = std::pow(6.0, -2.0 / 3.0), high = 10.0;
    for (int k = 0; k < 100; k++) {
      const double mid = 0.5 * (low + high);
      (std::cbrt(6.0) * (2.0 * mid * mid - 4.0 / 3.0 * std::sqrt(mid)) * delta_c < overlap ? low : high) = mid;
    }
    return low;
  }
  double force(double overlap) const { return 4.0 * fc * (std::pow(x(overlap), 3.0) - std::pow(x(overlap), 1.5)); }
  double energy(double overlap) const    // the integral of -force
  {
    const double y = x(overlap);
    return 4.0 * std::cbrt(6.0) * fc * delta_c * (0.8 * std::pow(y, 5.0) - 4.0 / 3.0 * std::pow(y, 3.5) + y * y / 3.0);
  }
  double attraction(double gap) const { return gap < 9.0 * Z0 ? HAMAKER * r / (6.0 * (Z0 + gap) * (Z0 + gap)) : 0.0; }
  double mass(int id) const { return 4.0 / 3.0 * M_PI * std::pow(id == 1 ? r1 : r2, 3.0) * DENSITY; }
  double inertia(int id) const { return 0.4 * mass(id) * std::pow(id == 1 ? r1 : r2, 2.0); }
  // about the equilibrium overlap: k0 = (6/5) E* a0
  double period() const
  {
    return 2.0 * M_PI * std::sqrt(mass(1) * mass(2) / (mass(1) + mass(2)) / (1.2 * modulus * a0));
  }
};

std::string model(double mu, double theta_crit, double eta = 0.0)
{
  return line("jkr/vdw 1.1053e11 %.17g 0.3 14.633e-20 0.4e-9 damping viscoelastic tangential mindlin NULL 0.0 %.17g "
              "rolling dominik/tielens %.17g",
              eta, mu, theta_crit);
}

std::string triple(const Vec &a) { return line("%.17g %.17g %.17g", a[0], a[1], a[2]); }

Vec get(const Deck &deck, const char *name, int id)
{
  const double *p = deck.atom(name, id);
  return {p[0], p[1], p[2]};
}

void place(Deck &deck, int id, const Vec &x)
{
  deck(line("set atom %.17g x %.17g y %.17g z %.17g", id, x[0], x[1], x[2]));
}

void spin(Deck &deck, int id, const Vec &omega) { deck(line("set atom %g", id) + " omega " + triple(omega)); }

void move(Deck &deck, int id, const Vec &v)
{
  deck(line("group one id %g\nvelocity one set ", id) + triple(v) + "\ngroup one delete");
}

// sphere 1 in the origin and sphere 2 towards N; a neck holds them if it is asked for
void two_spheres(Deck &deck, const Contact &c, double overlap, const std::string &model, double timestep, bool neck)
{
  const double box = 3.0 * (c.r1 + c.r2);
  deck("units si\natom_style sphere\nboundary f f f\nnewton off\ncomm_modify vel yes\nregion box block " +
       line("%g %g %g %g ", -box, box, -box, box) +
       line("%g %g\ncreate_box 1 box\nneighbor %g bin\n", -box, box, 0.1 * box) +
       "pair_style granular\npair_coeff * * " + model);
  const double start = neck ? std::max(overlap, c.delta_0) : overlap;
  deck("create_atoms 1 single 0 0 0\ncreate_atoms 1 single " + triple((c.r1 + c.r2 - start) * N));
  deck(line("set atom 1 diameter %.17g density %.17g\nset atom 2 diameter %.17g density %.17g\n", 2.0 * c.r1, DENSITY,
            2.0 * c.r2, DENSITY) +
       line("timestep %.17g", timestep));
  if (!neck) return;
  deck("fix move all nve/noforce\nrun 1 post no\nunfix move");
  place(deck, 2, (c.r1 + c.r2 - overlap) * N);
}

Vec normal(const Deck &deck)
{
  const Vec apart = get(deck, "x", 2) - get(deck, "x", 1);
  return 1.0 / length(apart) * apart;
}

double overlap(const Deck &deck, const Contact &c)
{
  return c.r1 + c.r2 - length(get(deck, "x", 2) - get(deck, "x", 1));
}

// of both spheres about the origin
Vec angular_momentum(const Deck &deck, const Contact &c)
{
  Vec sum = {};
  for (int id : {1, 2})
    sum = sum + c.mass(id) * cross(get(deck, "x", id), get(deck, "v", id)) + c.inertia(id) * get(deck, "omega", id);
  return sum;
}

// a spin of both spheres that rolls them on each other without sliding, by their relative angular velocity
void roll(Deck &deck, const Contact &c, const Vec &relative)
{
  spin(deck, 1, c.r2 / (c.r1 + c.r2) * relative);
  spin(deck, 2, -c.r1 / (c.r1 + c.r2) * relative);
}

bool synchronized_verlet()    // 4Feb2025 has none
{
  Deck deck;
  return lammps_version(deck.lmp) >= 20260704;
}

void expect_near(const Vec &a, const Vec &b, double tolerance, const std::string &what)
{
  for (int d = 0; d < 3; d++) EXPECT_NEAR(a[d], b[d], tolerance) << what << " " << d;
}

}    // namespace

TEST(JkrVdwPairs, ForceOnApproachInContactAndOnPullOff)
{
  for (const auto &[r1, r2] : SIZES) {
    const Contact c(r1, r2);
    const double step = 0.002e-9;
    Deck deck;
    two_spheres(deck, c, -10.0 * Z0 - 0.3 * step, model(0.3, 0.15), 1e-9, false);    // no step ends where a neck forms
    move(deck, 2, -step / 1e-9 * N);
    deck("fix move all nve/noforce\nrun 0 post no");
    bool pulled = false, neck = false;
    double most = 0.0;
    for (int k = 0; k < 10000; k++) {
      deck("run 1 pre no post no");
      const double d = overlap(deck, c);
      if (!pulled && d > 2.0 * c.delta_0) {
        pulled = true;
        move(deck, 2, step / 1e-9 * N);
        deck("run 0 post no");
      }
      neck = d >= 0.0 || (neck && d > -c.delta_c);
      const Vec f = get(deck, "f", 2);
      const double expected = neck ? c.force(d) : -c.attraction(-d);
      // round-off of the position, 1e-19 m, is 1e-9 of delta_c; sqrt of it at the end of the branch
      ASSERT_NEAR(dot(f, N), expected, 1e-4 * c.fc) << "overlap " << d;
      ASSERT_LT(length(f - dot(f, N) * N), 1e-9 * c.fc);
      for (int n = 0; n < 3; n++) ASSERT_EQ(get(deck, "f", 1)[n], -f[n]);
      most = std::min(most, dot(f, N));
      if (d < -10.0 * Z0) break;
    }
    ASSERT_TRUE(pulled && !neck);
    EXPECT_NEAR(most, -c.fc, 1e-3 * c.fc);    // the steps pass the minimum within a hundredth of delta_c
  }
}

TEST(JkrVdwPairs, WorkOfPullingApartAndBreakAtTheEndOfTheBranch)
{
  const int steps = 2000;
  for (const auto &[r1, r2] : SIZES)
    for (bool from_zero : {true, false}) {
      const Contact c(r1, r2);
      const double from = from_zero ? 0.0 : c.delta_0, step = (from + c.delta_c) / steps;
      Deck deck;
      two_spheres(deck, c, from, model(0.3, 0.15), 1e-9, true);
      move(deck, 2, step / 1e-9 * N);
      deck("fix move all nve/noforce\nrun 0 post no");
      double work = 0.0, before = dot(get(deck, "f", 2), N);
      EXPECT_NEAR(before, from_zero ? -8.0 / 9.0 * c.fc : 0.0, 1e-6 * c.fc);
      for (int k = 1; k < steps; k++) {
        deck("run 1 pre no post no");
        const double now = dot(get(deck, "f", 2), N);
        work -= 0.5 * (before + now) * step;
        before = now;
      }
      EXPECT_NEAR(before, c.force(step - c.delta_c), 1e-4 * c.fc);    // a step before the end a neck is there
      work += 5.0 / 9.0 * c.fc * step;
      EXPECT_NEAR(work, (from_zero ? 0.9355 : 1.5426) * c.fc * c.delta_c, 1e-3 * work);
      deck("run 2 pre no post no");    // the first of them ends on -delta_c, within round-off
      EXPECT_NEAR(dot(get(deck, "f", 2), N), -c.attraction(c.delta_c + step), 1e-6 * c.fc);
    }
}

TEST(JkrVdwPairs, NothingButAttractionWithoutANeck)
{
  // spinning, sliding and approaching, before the neck forms and after it broke
  const Contact c(10e-6, 5e-6);
  for (bool broken : {false, true}) {
    Deck deck;
    two_spheres(deck, c, broken ? -0.9 * c.delta_c : -0.3e-9, model(0.3, 0.15, 1e15), 1e-12, broken);
    spin(deck, 1, {1e3, 2e3, 3e3});
    if (broken) {
      deck("fix move all nve/noforce\nrun 10 post no");
      ASSERT_GT(length(get(deck, "torque", 1)), 0.0);
      place(deck, 2, (c.r1 + c.r2 + 1.01 * c.delta_c) * N);
      deck("unfix move");
    }
    move(deck, 2, 0.1 * T1 - 0.1 * N);
    deck("fix move all nve/noforce\nrun 100 post no");
    ASSERT_LT(overlap(deck, c), 0.0);
    // round-off of the position
    expect_near(get(deck, "f", 2), -c.attraction(-overlap(deck, c)) * normal(deck), 1e-6 * c.fc, "force");
    for (int id : {1, 2})
      for (double torque : get(deck, "torque", id)) EXPECT_EQ(torque, 0.0);
    // and what they did meanwhile is forgotten when a neck forms
    for (int id : {1, 2}) {
      spin(deck, id, {});
      move(deck, id, {});
    }
    place(deck, 2, (c.r1 + c.r2 - c.delta_0) * N);
    deck("run 10 post no");
    expect_near(get(deck, "f", 2), {}, 1e-6 * c.fc, "force");
    for (double torque : get(deck, "torque", 1)) EXPECT_EQ(torque, 0.0);
  }
}

TEST(JkrVdwPairs, MomentumAndAngularMomentumAreConserved)
{
  // oblique and spinning: hits, sticks or not, slides and rolls; Verlet conserves both but for round-off
  const Contact c(10e-6, 5e-6);
  for (double speed : {0.02, 0.5}) {
    Deck deck;
    two_spheres(deck, c, -0.5e-9, model(0.3, 0.05, 1e13), c.period() / 100.0, false);
    spin(deck, 1, {3e4, -2e4, 1e4});
    spin(deck, 2, {-1e4, 5e4, 2e4});
    move(deck, 1, -speed * (0.3 * T2 + 0.1 * T1));
    move(deck, 2, -speed * (N + 0.8 * T1));
    deck("fix move all nve/sphere\nrun 0 post no");
    const Vec before = angular_momentum(deck, c), spin_before = get(deck, "omega", 2);
    const Vec momentum = c.mass(1) * get(deck, "v", 1) + c.mass(2) * get(deck, "v", 2);
    double pushed = 0.0;
    for (int k = 0; k < 2000; k++) {
      deck("run 1 pre no post no");
      pushed = std::max(pushed, dot(get(deck, "f", 2), N));
      for (int d = 0; d < 3; d++) ASSERT_EQ(get(deck, "f", 1)[d], -get(deck, "f", 2)[d]);
    }
    EXPECT_GT(pushed, c.fc);
    const Vec change = c.inertia(2) * (get(deck, "omega", 2) - spin_before);
    EXPECT_GT(length(change), 0.1 * c.inertia(2) * length(spin_before));
    expect_near(angular_momentum(deck, c), before, 1e-10 * length(change), "angular momentum");
    expect_near(c.mass(1) * get(deck, "v", 1) + c.mass(2) * get(deck, "v", 2), momentum, 1e-12 * length(momentum),
                "momentum");
  }
}

TEST(JkrVdwPairs, SlidingStartsAtTheLimit)
{
  // pulled along at constant overlap: first the spring 8 G* a (Mindlin), then mu |F + 2 F_c| (Thornton 1991)
  const double mu = 0.3, speed = 1e-3, dt = 1e-10;
  for (const auto &[r1, r2] : SIZES) {
    const Contact c(r1, r2);
    for (double held : {c.delta_0, 3.0 * c.delta_0, -0.4 * c.delta_c, -0.95 * c.delta_c}) {
      const double stiffness = 8.0 * YOUNG / (4.0 * (2.0 - NU) * (1.0 + NU)) * c.x(held) * c.a0;
      const double limit = mu * std::fabs(c.force(held) + 2.0 * c.fc);
      Deck deck;
      two_spheres(deck, c, held, model(mu, 0.15), dt, true);
      move(deck, 2, speed * T1);
      deck("fix move all nve/noforce\nrun 0 post no");
      int slides = 0;
      for (int k = 1; k <= 20000 && slides < 100; k++) {
        deck("run 1 pre no post no");
        const Vec f = get(deck, "f", 2);
        // 0.1 % as asked; the spheres' distance grows by 1e-9 of delta_c only
        ASSERT_NEAR(dot(f, T1), -std::min(stiffness * speed * k * dt, limit), 1e-3 * limit) << k << " overlap " << held;
        if (stiffness * speed * k * dt > limit) slides++;
      }
      EXPECT_EQ(slides, 100);
      // friction acts in the middle of the overlap, on both in the same sense
      for (int id : {1, 2})
        expect_near(get(deck, "torque", id), -((id == 1 ? r1 : r2) - 0.5 * held) * limit * cross(T1, N),
                    2e-3 * (id == 1 ? r1 : r2) * limit, "torque");
    }
  }
}

TEST(JkrVdwPairs, RollingTorqueAndItsLimit)
{
  // M = 4 F_c x^(3/2) xi with xi = R_12 times the relative angle; in one direction, then across, up to R_12 theta_crit
  const double theta_crit = 0.15, step = 1e-3;
  for (const auto &[r1, r2] : SIZES) {
    const Contact c(r1, r2);
    for (double held : {c.delta_0, 3.0 * c.delta_0, -0.95 * c.delta_c}) {
      const double stiffness = 4.0 * c.fc * std::pow(c.x(held), 1.5) * c.r;
      Deck deck;
      two_spheres(deck, c, held, model(0.0, theta_crit), 1e-9, true);
      deck("fix move all nve/noforce");
      Vec angle = {};
      for (const Vec &axis : {T1, T2}) {
        roll(deck, c, step / 1e-9 * axis);
        deck("run 0 post no");
        for (int k = 0; k < 200; k++) {
          angle = angle + step * axis;
          angle = std::min(1.0, theta_crit / length(angle)) * angle;    // the pivot follows
          deck("run 1 pre no post no");
          // 1e-6: round-off of the held overlap where the branch is steepest
          const double tolerance = 1e-6 * stiffness * theta_crit;
          ASSERT_LT(length(get(deck, "torque", 1) + stiffness * angle), tolerance) << k << " overlap " << held;
          for (int d = 0; d < 3; d++) ASSERT_EQ(get(deck, "torque", 1)[d], -get(deck, "torque", 2)[d]);
        }
      }
      EXPECT_NEAR(length(get(deck, "torque", 1)), stiffness * theta_crit, 1e-6 * stiffness * theta_crit);
    }
  }
}

TEST(JkrVdwPairs, EnergyOfRollingByARightAngle)
{
  // Dominik & Tielens, Astrophys. J. 480, 647 (1997): 6 pi^2 gamma R_12 xi_crit, all of it dissipated
  const double theta_crit = 0.02, step = 1e-4;
  const Contact c(10e-6, 5e-6);
  Deck deck;
  two_spheres(deck, c, c.delta_0, model(0.3, theta_crit), 1e-9, true);
  roll(deck, c, step / 1e-9 * T1);
  deck("fix move all nve/noforce\nrun 300 post no");
  double work = 0.0;
  const int steps = static_cast<int>(0.5 * M_PI / step);
  for (int k = 0; k < steps; k++) {
    deck("run 1 pre no post no");
    for (int id : {1, 2}) work -= dot(get(deck, "torque", id), get(deck, "omega", id)) * 1e-9;
  }
  EXPECT_NEAR(work, 6.0 * M_PI * M_PI * c.gamma * c.r * c.r * theta_crit, 1e-3 * work);    // the angle, by a step
}

TEST(JkrVdwPairs, RollingDisplacementTurnsWithTheContact)
{
  // loaded to half of the limit and to the limit, then turned as a whole by a right angle across the normal
  const double theta_crit = 0.1;
  const Contact c(10e-6, 5e-6);
  for (const std::string option : {"", " synchronized_verlet"}) {
    if (!option.empty() && !synchronized_verlet()) continue;
    for (double part : {0.5, 1.0})
      for (const Vec &axis : {T1, T2, std::sqrt(0.5) * (T1 - T2)}) {
        Deck deck;
        two_spheres(deck, c, c.delta_0, model(0.0, theta_crit) + option, 1e-9, true);
        roll(deck, c, part * theta_crit / 100e-9 * T1);
        deck("fix move all nve/noforce\nrun 100 post no\nunfix move");
        const Vec before = get(deck, "torque", 1);
        ASSERT_NEAR(length(before), part * 4.0 * c.fc * c.r * theta_crit, 1e-6 * length(before));
        deck("fix move all move rotate 0 0 0 " + triple(axis) + " 40e-6\nrun 10000 post no");
        // projected on the turned plane in steps dphi it turns by up to phi dphi/4 = 6e-5 too little; with synchronized
        // Verlet the torque lags by half a step, pi/40000 = 8e-5
        const Vec expected = dot(before, axis) * axis + cross(axis, before);
        EXPECT_LT(length(get(deck, "torque", 1) - expected), 1e-4 * length(before)) << part << option;
      }
  }
}

TEST(JkrVdwPairs, EnergyOfAThousandNormalOscillations)
{
  // swings into the stretched neck: 0.8 of the work from delta_0 to -delta_c; Verlet's error is below (omega dt)^2/8 =
  // 3e-5
  const Contact c(10e-6, 5e-6);
  const double swing = 0.8 * 1.5426 * c.fc * c.delta_c;
  Deck deck;
  two_spheres(deck, c, c.delta_0, model(0.3, 0.15), c.period() / 400.0, false);
  const double speed = std::sqrt(2.0 * swing * (1.0 / c.mass(1) + 1.0 / c.mass(2)));
  move(deck, 1, -c.mass(2) / (c.mass(1) + c.mass(2)) * speed * N);
  move(deck, 2, c.mass(1) / (c.mass(1) + c.mass(2)) * speed * N);
  deck("fix move all nve/sphere\nrun 0 post no");
  double deepest = c.delta_0, highest = c.delta_0;
  for (int k = 0; k < 1200; k++) {    // a swing as wide as this takes longer than the period about delta_0
    deck("run 397 pre no post no");
    double energy = c.energy(overlap(deck, c)) - c.energy(c.delta_0);
    for (int id : {1, 2}) energy += 0.5 * c.mass(id) * dot(get(deck, "v", id), get(deck, "v", id));
    ASSERT_NEAR(energy, swing, 1e-4 * swing) << k;
    deepest = std::max(deepest, overlap(deck, c));
    highest = std::min(highest, overlap(deck, c));
  }
  EXPECT_LT(highest, -0.3 * c.delta_c);
  EXPECT_GT(deepest, 1.5 * c.delta_0);
}

TEST(JkrVdwPairs, EnergyOfRollingOscillations)
{
  // below the limit; a thousand of like spheres, which roll without sliding, and some of unlike ones, where the stiffer
  // spring of friction takes part and needs smaller steps. A spring of stiffness k holds F^2/(2 k).
  struct Case {
    double r2;
    int oscillations, steps;    // steps of a period of the normal oscillation
  };
  for (const Case &test : {Case{10e-6, 1000, 12}, Case{8e-6, 50, 60}}) {
    const Contact c(10e-6, test.r2);
    const double sliding = 8.0 * YOUNG / (4.0 * (2.0 - NU) * (1.0 + NU)) * c.a0, rolling = 4.0 * c.fc * c.r;
    const double period = 2.0 * M_PI / std::sqrt(rolling * (1.0 / c.inertia(1) + 1.0 / c.inertia(2))),
                 dt = c.period() / test.steps;
    Deck deck;
    two_spheres(deck, c, c.delta_0, model(1e3, 0.15), dt, false);
    roll(deck, c, 0.01 * 2.0 * M_PI / period * T1);
    deck("fix move all nve/sphere\nrun 0 post no");
    double first = 0.0, most = 0.0;
    for (int k = 0; k <= test.oscillations; k++) {
      double energy = c.energy(overlap(deck, c)) - c.energy(c.delta_0);
      for (int id : {1, 2})
        energy += 0.5 * c.mass(id) * dot(get(deck, "v", id), get(deck, "v", id)) +
                  0.5 * c.inertia(id) * dot(get(deck, "omega", id), get(deck, "omega", id));
      if (k == 0) first = energy;
      const Vec n = normal(deck), f = get(deck, "f", 1), friction = f - dot(f, n) * n;
      const Vec torque = get(deck, "torque", 1) - (c.r1 - 0.5 * overlap(deck, c)) * cross(n, friction);
      const double stored = dot(torque, torque) / (2.0 * rolling);
      most = std::max(most, stored);
      ASSERT_NEAR(energy + stored + dot(friction, friction) / (2.0 * sliding), first, 1e-4 * first)
          << test.r2 << " " << k;
      deck(line("run %g pre no post no", std::round(1.03 * period / dt)));    // passes all phases
    }
    EXPECT_GT(most, 0.5 * first);
  }
}

namespace {

struct Sphere {
  int type;
  double radius;
  Vec x, v, omega;
};
using Cluster = std::vector<Sphere>;

struct Setting {
  bool newton = false, reversed = false, resorted = false;
  Vec shift = {};
  double timestep = 2e-9;
  std::string option;
};

Vec rotated(const Vec &a)    // by 1.1 rad about an axis that is none of the box
{
  const Vec axis = {2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0};
  const double angle = 1.1;
  return std::cos(angle) * a + std::sin(angle) * cross(axis, a) + (1.0 - std::cos(angle)) * dot(axis, a) * axis;
}

const double BOX = 8e-3;

// how a cluster moves after a time; in two runs, between which atoms can change places
Cluster evolve(Cluster cluster, const Setting &setting, double time)
{
  const int n = static_cast<int>(cluster.size());
  const auto id = [&](int k) { return setting.reversed ? n - k : k + 1; };
  Deck deck;
  deck("units si\natom_style sphere\nboundary p p p\ncomm_modify vel yes\natom_modify sort 0 0\nnewton " +
       std::string(setting.newton ? "on" : "off") +
       "\nregion box block 0 8e-3 0 8e-3 0 8e-3\ncreate_box 2 box\nneighbor 1e-4 bin\npair_style granular\npair_coeff "
       "1 1 " +
       contact(0.7) + "\npair_coeff * 2 " + model(0.3, 0.05, 1e14) + setting.option);
  for (int made = 1; made <= n; made++) {
    const Sphere &s = cluster[setting.reversed ? n - made : made - 1];
    Vec x = s.x + setting.shift;
    for (double &coordinate : x) coordinate -= BOX * std::floor(coordinate / BOX);
    deck(line("create_atoms %g single ", s.type) + triple(x) +
         line("\nset atom %g diameter %.17g density %.17g", made, 2.0 * s.radius, DENSITY));
    spin(deck, made, s.omega);
    move(deck, made, s.v);
  }
  deck(line("timestep %.17g\nfix move all nve/sphere", setting.timestep));
  const double steps = std::round(time / setting.timestep);
  deck(line("run %g post no", 0.5 * steps));
  if (setting.resorted) deck("atom_modify sort 1 1e-4");
  deck(line("run %g post no", 0.5 * steps));
  for (int k = 0; k < n; k++) {
    cluster[k].v = get(deck, "v", id(k));
    cluster[k].omega = get(deck, "omega", id(k));
  }
  return cluster;
}

// largest difference of any sphere's velocity or spin, relative to the fastest of its type
double difference(const Cluster &a, const Cluster &b)
{
  double worst = 0.0;
  for (int type : {1, 2}) {
    double v = 0.0, omega = 0.0, dv = 0.0, domega = 0.0;
    for (size_t k = 0; k < a.size(); k++) {
      if (a[k].type != type) continue;
      v = std::max(v, length(a[k].v));
      omega = std::max(omega, length(a[k].omega));
      dv = std::max(dv, length(a[k].v - b[k].v));
      domega = std::max(domega, length(a[k].omega - b[k].omega));
    }
    if (v > 0.0) worst = std::max({worst, dv / v, domega / omega});
  }
  return worst;
}

// a carrier with grains, one of them on another one, is hit by a free grain and by a second carrier with a grain
Cluster collision()
{
  const Vec centre = {4e-3, 4e-3, 4e-3};
  const auto on = [](const Sphere &below, double radius, const Vec &direction) {
    const double distance = below.radius + radius - Contact(below.radius, radius).delta_0;
    const Vec x = below.x + distance / length(direction) * direction;
    return Sphere{2, radius, x, below.v + cross(below.omega, x - below.x), below.omega};
  };
  Cluster all = {{1, CARRIER, centre, {0.0, 0.0, 0.0}, {100.0, -50.0, 20.0}}};
  all.push_back(on(all[0], 10e-6, N));
  all.push_back(on(all[1], 5e-6, N + 0.5 * T1));
  all.push_back(on(all[0], 10e-6, T1));
  all.push_back(on(all[0], 7e-6, T2 - T1));
  all.push_back({2, 6e-6, all[1].x + (16e-6 + 6e-9) * T2, all[1].v - 0.1 * T2 + 0.05 * T1, {3e4, 1e4, -2e4}});
  const Vec from = 0.8 * T2 - 0.6 * T1;
  all.push_back({1, CARRIER, centre + (2.0 * CARRIER + 50e-9) * from, -1.0 * from + 0.7 * N, {-30.0, 200.0, 60.0}});
  all.push_back(on(all[6], 10e-6, -1.0 * from + 0.3 * N));
  return all;
}

}    // namespace

TEST(JkrVdwPairs, TrajectoryTurnsWithTheFrame)
{
  const Cluster start = collision();
  Cluster turned = start;
  const auto turn = [](Cluster &cluster) {
    const Vec centre = {4e-3, 4e-3, 4e-3};
    for (Sphere &s : cluster) s = {s.type, s.radius, centre + rotated(s.x - centre), rotated(s.v), rotated(s.omega)};
  };
  turn(turned);
  Cluster end = evolve(start, {}, 10e-6);
  EXPECT_GT(difference(end, start), 0.1);
  const Cluster end_turned = evolve(turned, {}, 10e-6);
  turn(end);
  EXPECT_LT(difference(end, end_turned), 1e-6);    // round-off of the positions, 5e-19 m, grows to 3e-8
}

TEST(JkrVdwPairs, TrajectoryDoesNotDependOnNewtonOrderOrPlace)
{
  const Cluster start = collision(), end = evolve(start, {}, 10e-6);
  const Vec corner = {4e-3 - 0.5 * CARRIER, 4e-3, 4e-3 + CARRIER};    // contacts across the box's faces
  for (bool newton : {false, true})
    for (const Vec &shift : {Vec{}, corner})
      for (const auto &[reversed, resorted] : {std::pair{false, false}, {true, false}, {false, true}, {true, true}}) {
        // the same but for round-off; a position's, 5e-19 m, is 1e-12 in the rate of an overlap, and of a shift it
        // grows to 1e-8
        EXPECT_LT(difference(end, evolve(start, {newton, reversed, resorted, shift, 2e-9, ""}, 10e-6)),
                  shift[0] > 0.0 ? 1e-6 : 1e-11)
            << newton << reversed << resorted << shift[0];
      }
}

TEST(JkrVdwPairs, SynchronizedVerletConvergesToTheSame)
{
  // two grains in contact that swing, slide and roll; the two schemes differ by the first order of the time step
  if (!synchronized_verlet()) GTEST_SKIP();
  const Contact c(10e-6, 7e-6);
  const Vec centre = {4e-3, 4e-3, 4e-3};
  const Cluster start = {{2, c.r1, centre, {0.01, -0.02, 0.01}, {3e4, 1e4, -2e4}},
                         {2, c.r2, centre + (c.r1 + c.r2 - c.delta_0) * N, {-0.02, 0.01, 0.0}, {-2e4, 3e4, 1e4}}};
  double before = 0.0;
  for (double timestep : {2e-9, 1e-9, 0.5e-9}) {
    Setting setting;
    setting.timestep = timestep;
    const Cluster plain = evolve(start, setting, 4e-6);
    setting.option = " synchronized_verlet";
    const double now = difference(plain, evolve(start, setting, 4e-6));
    if (before > 0.0) {
      EXPECT_LT(now, 0.7 * before);
    }
    before = now;
  }
  EXPECT_LT(before, 1e-3);
}

namespace {

// eta for a damping ratio at the equilibrium overlap
double damping(const Contact &c, double zeta) { return 4.0 * M_PI * zeta / c.period() / c.a0; }

// with LAMMPS' synchronized Verlet too where there is one
std::vector<std::string> schemes()
{
  if (synchronized_verlet()) return {"", " synchronized_verlet"};
  return {""};
}

// sphere 1 is held, and sphere 2 set off along it and away from it, without friction
void set_off(Deck &deck, const Contact &c, double along, double away, double zeta, double dt, const std::string &scheme)
{
  two_spheres(deck, c, c.delta_0, model(0.0, 0.15, damping(c, zeta)) + scheme, dt, false);
  move(deck, 2, along * T1 + away * N);
  deck("group grain id 2\nfix move grain nve/sphere");
}

}    // namespace

TEST(JkrVdwPairs, LeavesAHeldCarrierWhereThePullOffForceHoldsItNoLonger)
{
  // a grain that glides round the carrier needs m w^2/(r1 + r2) > F_c, whatever the time step and the damping; one that
  // rings leaves earlier, as the load is there at once: speeds from an integration of the branch in the fourth order,
  // 9.2869 and 10.0089 m/s
  const Contact c(CARRIER, 10e-6);
  const double held = std::sqrt(c.fc * (c.r1 + c.r2) / c.mass(2));
  EXPECT_NEAR(held, 10.0539, 1e-4);
  struct Case {
    double zeta, speed, within;
  };
  for (const Case &test : {Case{0.2, 9.2869, 1e-3}, Case{0.5, 10.0089, 1e-3}, Case{0.7, held, 5e-4},
                           Case{1.0, held, 5e-4}, Case{2.0, held, 5e-4}})
    for (double dt : {2e-9, 1e-9, 0.5e-9})
      for (const std::string &scheme : schemes())
        for (double side : {-1.0, 1.0}) {
          Deck deck;
          set_off(deck, c, test.speed * (1.0 + side * test.within), 0.0, test.zeta, dt, scheme);
          deck(line("run %g post no", std::round(40e-6 / dt)));
          EXPECT_EQ(overlap(deck, c) < -c.delta_c, side > 0.0) << test.zeta << " " << dt << scheme << " " << side;
        }
}

TEST(JkrVdwPairs, DampingIsOfSecondOrderInTheTimeStep)
{
  // rings while it glides round the carrier: half of the time step, a quarter of the error
  const Contact c(CARRIER, 10e-6);
  for (double zeta : {0.2, 1.0})
    for (const std::string &scheme : schemes()) {
      std::vector<double> ends;
      for (double dt : {2e-9, 1e-9, 0.5e-9}) {
        Deck deck;
        set_off(deck, c, 8.0, 1e-3, zeta, dt, scheme);
        deck(line("run %g post no", std::round(0.2e-6 / dt)));
        ends.push_back(overlap(deck, c));
      }
      EXPECT_NEAR((ends[0] - ends[1]) / (ends[1] - ends[2]), 4.0, 0.5) << zeta << scheme;
    }
}

TEST(JkrVdwPairs, SlidingAndRollingAreOfSecondOrderInTheTimeStep)
{
  // a smooth push across the carrier and onto it, as on its north in an impact: a grain rolls, and slides if it is
  // strong
  const Contact c(CARRIER, 10e-6);
  for (double across : {2.0, 20.0}) {
    std::vector<std::pair<Vec, Vec>> ends;
    for (double dt : {2e-9, 1e-9, 0.5e-9}) {
      Deck deck;
      two_spheres(deck, c, c.delta_0, model(0.3, 0.15, damping(c, 1.0)), dt, false);
      deck("group grain id 2\nfix move grain nve/sphere\nvariable pulse equal (step*dt<2e-6)*sin(PI*step*dt/2e-6)^2");
      const Vec push = c.fc * (across * T1 - 10.0 * N);
      for (int d = 0; d < 3; d++) deck("variable f" + std::to_string(d) + line(" equal %.17g*v_pulse", push[d]));
      deck("fix push grain addforce v_f0 v_f1 v_f2\n" + line("run %g post no", std::round(3e-6 / dt)));
      ends.push_back({get(deck, "v", 2), get(deck, "omega", 2)});
    }
    const auto &[v0, omega0] = ends[0];
    const auto &[v1, omega1] = ends[1];
    const auto &[v2, omega2] = ends[2];
    EXPECT_EQ(length(v2) > 1.2 * c.r2 * length(omega2), across > 2.0);
    EXPECT_NEAR(length(v0 - v1) / length(v1 - v2), 4.0, 0.5) << across;
    EXPECT_NEAR(length(omega0 - omega1) / length(omega1 - omega2), 4.0, 0.5) << across;
  }
}

TEST(JkrVdwPairs, OutputAndSplitRunsDoNotChangeTheDamping)
{
  // at 37 steps the damping is a good part of the force; a setup repeats it, output asks for it again and again
  const Contact c(CARRIER, 10e-6);
  const auto motion = [&](const std::string &scheme, const std::string &runs) {
    Deck deck;
    set_off(deck, c, 5.0, 5e-3, 1.0, 1e-9, scheme);
    deck(runs);
    return std::pair(get(deck, "x", 2), get(deck, "f", 2));
  };
  const std::string asked = "compute force all pair/local force\ncompute most all reduce max c_force inputs local\n"
                            "thermo_style custom step c_most\nthermo 1\n";
  for (const std::string &scheme : schemes()) {
    const auto [x, f] = motion(scheme, "run 37 post no");
    const double damped = dot(f, N) - c.force(c.r1 + c.r2 - length(x));
    EXPECT_GT(std::fabs(damped), 0.05 * c.fc);
    for (const std::string &runs :
         {std::string("run 37 post no\nrun 0 post no"), std::string("run 5\nrun 0\nrun 15\nrun 17"),
          asked + "run 37 post no", asked + "run 20\nrun 17\nrun 0"}) {
      const auto [other_x, other_f] = motion(scheme, runs);
      expect_near(other_f, f, 1e-6 * c.fc, runs + scheme);    // round-off of the positions; 1e-3 for LAMMPS' velocity
      EXPECT_LT(length(other_x - x), 1e-6 * c.delta_0) << runs << scheme;
    }
  }
}

TEST(JkrVdwPairs, NewNeckIsDampedByTheVelocityAlone)
{
  // two spheres made at the equilibrium overlap are at rest: no rate comes of an overlap that was none before
  const Contact c(10e-6, 7e-6);
  for (const std::string &scheme : schemes()) {
    Deck deck;
    two_spheres(deck, c, c.delta_0, model(0.3, 0.15, damping(c, 2.0)) + scheme, 1e-9, false);
    deck("fix move all nve/sphere\nrun 0 post no");
    for (int k = 0; k < 5; k++) {
      deck("run 1 pre no post no");
      ASSERT_LT(length(get(deck, "f", 2)), 1e-6 * c.fc) << k << scheme;
    }
  }
}

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const int result = RUN_ALL_TESTS();
  lammps_mpi_finalize();
  return result;
}
