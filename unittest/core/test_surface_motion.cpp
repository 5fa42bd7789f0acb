// Grains that slide and roll over their carrier, against a reference that follows each alone in tiny steps, and against
// closed forms.

#include "surface_motion.h"

#include "collision.h"
#include "hamaker.h"
#include "impulse_record.h"
#include "jkr.h"
#include "motion_bound.h"
#include "normal_motion.h"
#include "texture_placement.h"
#include "vec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <random>

using namespace Dust;

namespace {

constexpr double RP = 0.75e-3, RD = 10.0e-6, SHELL = RP + RD;
constexpr double NO_SPIN[3] = {0.0, 0.0, 0.0};
const Material CALCITE = {2700.0, surface_energy(std::sqrt(10.1e-20 * 21.2e-20), 0.4e-9),
                          combined_modulus(75.0e9, 0.3, 210.0e9, 0.3), 0.3, 0.15};
const double HOLD =
    pull_off_force(CALCITE.gamma, effective_radius(RP, RD)) / (4.0 / 3.0 * M_PI * RD * RD * RD * 2700.0);

Vec along_surface(const Vec &v, const Vec &n) { return v - dot(v, n) * n; }

// a collision: contact acceleration and spin of each step
struct History {
  std::vector<Vec> a, spin;
  Vec spin0;    // before
  double dt;
  bool smooth;    // what lifts a grain does not jump between steps
  // at the end of a step
  Vec a_after(size_t k) const { return 0.5 * (a[k] + a[std::min(k + 1, a.size() - 1)]); }
  Vec spin_after(size_t k) const { return 0.5 * (spin[k] + spin[std::min(k + 1, spin.size() - 1)]); }
};

// largest F_n/F_c of a grain that is followed in forces, spin and displacement, in small steps: it leaves where this
// comes to 1, and is followed on all the same, so that the answer tells by how much
double largest_load(const Grain &grain, double carrier_radius, const Material &m, const History &h)
{
  const double mass = 4.0 / 3.0 * M_PI * std::pow(grain.radius, 3) * m.density,
               inertia = 0.4 * mass * grain.radius * grain.radius;
  const double r12 = effective_radius(carrier_radius, grain.radius), shell = carrier_radius + grain.radius;
  const double fc = pull_off_force(m.gamma, r12), pivot = r12 * m.rolling;
  Vec n = {grain.n[0], grain.n[1], grain.n[2]}, omega = h.spin0, w = shell * cross(omega, n), xi;
  const int substeps = 1 + static_cast<int>(4000 / h.a.size());
  const double dt = h.dt / substeps;
  double most = 0.0;
  for (size_t k = 0; k <= h.a.size(); k++) {
    const bool over = k == h.a.size();
    for (int s = 0; s < (over ? 1 : substeps); s++) {
      const double part = (s + 1.0) / substeps;
      const Vec a = over ? Vec() : h.a[k], before = k == 0 || over ? a : h.a_after(k - 1);
      const Vec felt = h.smooth && !over ? before + part * (h.a_after(k) - before) : a;
      const double fn = mass * (dot(w, w) / shell - dot(felt, n));
      most = std::max(most, fn / fc);
      if (over) return most;
      const double stiffness = 2.0 * fc * (1.0 + std::sqrt(std::max(0.0, 1.0 - fn / fc))),
                   limit = m.friction * std::fabs(2.0 * fc - fn);
      const Vec from = k == 0 ? h.spin0 : h.spin_after(k - 1), carrier = from + part * (h.spin_after(k) - from);
      const Vec slip = w - grain.radius * cross(omega, n) - carrier_radius * cross(carrier, n),
                push = -mass * along_surface(a, n), resist = -stiffness * cross(n, xi);
      // without friction the slip of the next step would be this; friction changes it by (1/m + R^2/I) f dt
      const Vec next = slip + dt / mass * push - dt * grain.radius / inertia * cross(resist, n);
      Vec f = -1.0 / (dt * (1.0 / mass + grain.radius * grain.radius / inertia)) * next;
      if (size(f) > limit) f = limit / size(f) * f;
      w = w + dt / mass * (push + f);
      omega = omega + dt / inertia * (resist - grain.radius * cross(n, f));
      n = n + dt / shell * w;
      n = 1.0 / size(n) * n;
      w = along_surface(w, n);
      xi = along_surface(xi + dt * r12 * cross(omega - carrier, n), n);
      if (size(xi) > pivot) xi = pivot / size(xi) * xi;
    }
  }
  return most;
}

// a step as Collision takes it, with the spin half a step earlier
Motion motion_of(const History &h, size_t k)
{
  const Vec &a = h.a[k], alpha = 1.0 / h.dt * (h.spin[k] - (k ? h.spin[k - 1] : h.spin0)),
            spin = h.spin[k] - 0.5 * h.dt * alpha;
  return {{a.x, a.y, a.z}, {alpha.x, alpha.y, alpha.z}, {spin.x, spin.y, spin.z}};
}

// mode by grain, by Collision; handed over to another one every `handover` steps
std::map<int, Mode> by_collision(const GrainTable &table, const History &h, int handover = 0)
{
  std::map<int, Mode> left;
  std::vector<uint64_t> attached = table.all_attached();
  Workspace work;
  Collision collision;
  const Motion earlier = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}, {7.0, 8.0, 9.0}};    // a collision before this one
  collision.begin(Quaternion(), earlier.spin);
  collision.step(table, earlier, 1.0, attached.data(), work);
  collision.begin(Quaternion(), &h.spin0.x);
  for (size_t k = 0; k <= h.a.size(); k++) {
    if (k < h.a.size())
      collision.step(table, motion_of(h, k), h.dt, attached.data(), work);
    else
      collision.end(table, &h.spin.back().x, attached.data(), work);
    for (const Detachment &d : work.detached) left[table.grain(d.bit)] = d.mode;
    work.detached.clear();
    if (handover && k % handover == 0) {
      std::vector<double> buf(collision.packed_size());
      Packer packer(buf.data());
      collision.pack(packer);
      Collision other;
      std::vector<uint64_t> all = table.all_attached();
      other.begin(Quaternion(), earlier.spin);    // one that has been used
      other.step(table, earlier, 1.0, all.data(), work);
      work.detached.clear();
      Unpacker unpacker(buf.data());
      other.unpack(unpacker);
      collision = std::move(other);
    }
  }
  return left;
}

Vec random_direction(std::mt19937 &random)
{
  std::uniform_real_distribution<double> u(0.0, 1.0);
  const double z = 2.0 * u(random) - 1.0, phi = 2.0 * M_PI * u(random), s = std::sqrt(1.0 - z * z);
  return {s * std::cos(phi), s * std::sin(phi), z};
}

// one to three pulses, each in a direction of its own; with spins of about `spin`, what each changes the spin by, and
// pulses that begin and end smoothly within the collision
History random_history(std::mt19937 &random, double spin = 0.0)
{
  const auto u = [&]() { return std::uniform_real_distribution<double>(0.0, 1.0)(random); };
  History h;
  h.smooth = spin > 0.0;
  const int steps = (spin > 0.0 ? 400 : 3) + static_cast<int>(800 * u() * u());
  h.a.assign(steps, Vec());
  if (spin > 0.0) h.spin0 = spin * random_direction(random);
  h.spin.assign(steps, h.spin0);
  const int pulses = 1 + static_cast<int>(2.5 * u());
  for (int p = 0; p < pulses; p++) {
    const double strength = HOLD * std::exp(3.5 * u()), part = u(), length = 0.2 + u();
    const double middle = steps * (spin > 0.0 ? std::clamp(part, 0.25, 0.75) : part);
    const double width = spin > 0.0 ? std::min({steps * length, middle, steps - middle}) : steps * length;
    const Vec direction = random_direction(random), turn = spin > 0.0 ? spin * random_direction(random) : Vec();
    for (int k = 0; k < steps; k++) {
      const double x = std::clamp((k + 0.5 - middle) / width, -1.0, 1.0);
      if (std::fabs(x) < 1.0) h.a[k] = h.a[k] + strength * std::pow(1.0 - x * x, spin > 0.0 ? 2 : 1) * direction;
      h.spin[k] = h.spin[k] + (0.5 + 0.75 * x - 0.25 * x * x * x) * turn;
    }
  }
  h.dt = (1.0 + 6.0 * u()) * 1.0e-6 / steps;
  return h;
}

Criteria integrate()
{
  Criteria criteria;
  criteria.tangential = Criteria::INTEGRATE;
  return criteria;
}

struct Comparison {
  int tangential = 0, close = 0, stay = 0;
};

// random collisions of a texture against the reference; grains whose load comes as close as `tolerance` to 1 may do
// either
Comparison compare(const Texture &texture, Material m, int collisions, double tolerance, double spin = 0.0)
{
  std::mt19937 random(3);
  Comparison found;
  for (int i = 0; i < collisions; i++) {
    m.friction = i % 5 == 4 ? 0.0 : i % 5 == 3 ? 5.0 : 0.1 + 0.1 * (i % 4);
    m.rolling = i % 4 == 2 ? 0.0 : i % 2 == 1 ? 3.0 : 0.15;
    const GrainTable table(texture, m, integrate());
    const History h = random_history(random, spin);
    const std::map<int, Mode> left = by_collision(table, h);
    EXPECT_EQ(by_collision(table, h, 17), left) << "collision " << i << " handed over";
    for (size_t k = 0; k < texture.grains.size(); k++) {
      const auto it = left.find(k);
      if (it != left.end() && it->second == NORMAL) continue;
      const bool leaves = it != left.end();
      const double load = largest_load(texture.grains[k], texture.carrier_radius, m, h);
      if (load > 1.0 + tolerance || load < 1.0 - tolerance) {
        EXPECT_EQ(leaves, load > 1.0) << "collision " << i << " grain " << k << " load " << load;
      } else
        found.close++;
      (leaves ? found.tangential : found.stay)++;
    }
    if (::testing::Test::HasFailure()) break;
  }
  return found;
}

// one grain on a wall, nearly: a carrier so large that its surface is flat. Normal z, pushed along x
struct OnAPlane {
  static constexpr double CARRIER = 1.0e3;
  SurfaceMotion motion;
  OnAPlane(double friction, double rolling) : motion(friction, rolling)
  {
    const double n[3] = {0.0, 0.0, 1.0};
    motion.add(n, HOLD, RD, CARRIER, NO_SPIN);
  }
  // the inertia force pushes with `push`
  void advance(double push, double time, int steps)
  {
    const double a[3] = {-push, 0.0, 0.0};
    for (int k = 0; k < steps; k++) motion.advance(a, NO_SPIN, time / steps);
  }
  double w() const { return motion.velocity(0, 0); }
  double p() const { return motion.rolling_velocity(0, 0); }
  double psi() const { return motion.rolling_angle(0, 0); }
  double energy() const { return 0.5 * w() * w() + 0.2 * p() * p() + 0.5 * RD * STIFFNESS * psi() * psi(); }
  static constexpr double STIFFNESS_IN_HOLD = 4.0;    // s = k/m without load
  static inline const double STIFFNESS = STIFFNESS_IN_HOLD * HOLD;
};

}    // namespace

TEST(SurfaceMotion, SameGrainsAsAReferenceInTinySteps)
{
  Texture texture = place_monolayer(RP, 40.0e-6, 0.15, BareCap(), 2);
  for (Grain &g : texture.grains) g.radius = RD;
  const Comparison found = compare(texture, CALCITE, 60, 0.003);
  EXPECT_GT(found.tangential, 300);    // the test tests something
  EXPECT_GT(found.stay, 2000);
  EXPECT_LT(found.close, 30);
}

TEST(SurfaceMotion, SameGrainsAsAReferenceForGrainsOfAllSizes)
{
  std::mt19937 random(4);
  Texture texture = place_monolayer(RP, 40.0e-6, 0.15, BareCap(), 2);
  for (Grain &g : texture.grains) g.radius = RD * (0.3 + 2.2 * std::uniform_real_distribution<double>()(random));
  const Comparison found = compare(texture, CALCITE, 40, 0.003);
  EXPECT_GT(found.tangential, 100);
  EXPECT_GT(found.stay, 500);
}

TEST(SurfaceMotion, SameGrainsAsAReferenceOnACarrierThatTurns)
{
  std::mt19937 random(4);
  int left = 0, stay = 0, close = 0;
  for (int i = 0; i < 150; i++) {
    Material m = CALCITE;
    m.friction = i % 5 == 4 ? 0.0 : i % 5 == 3 ? 5.0 : 0.1 + 0.1 * (i % 4);
    m.rolling = i % 4 == 2 ? 0.0 : i % 2 == 1 ? 3.0 : 0.15;
    const History h = random_history(random, 0.5 * std::sqrt(HOLD / SHELL));
    SurfaceMotion motion(m.friction, m.rolling);
    std::vector<double> loads;
    while (!motion.full()) {
      const Vec n = random_direction(random);
      const Grain grain = {{n.x, n.y, n.z}, RD * (0.5 + 0.03 * motion.grains())};
      const double hold =
          HOLD * effective_radius(RP, grain.radius) / effective_radius(RP, RD) * std::pow(RD / grain.radius, 3);
      motion.add(grain.n, hold, grain.radius, RP, &h.spin0.x);
      loads.push_back(largest_load(grain, RP, m, h));
    }
    for (size_t k = 0; k < h.a.size(); k++) {
      const Vec spin = h.spin_after(k);
      motion.advance(&h.a[k].x, &spin.x, h.dt);
    }
    motion.release();
    for (int k = 0; k < motion.grains(); k++) {
      (motion.attached(k) ? stay : left)++;
      if (std::fabs(loads[k] - 1.0) < 0.005)
        close++;
      else
        EXPECT_EQ(motion.attached(k), loads[k] < 1.0) << "collision " << i << " grain " << k << " load " << loads[k];
    }
  }
  EXPECT_GT(left, 1000);
  EXPECT_GT(stay, 1000);
  EXPECT_LT(close, 60);
}

TEST(SurfaceMotion, SameGrainsByCollisionsOfACarrierThatTurns)
{
  // the spans of the record are longer than steps of time
  Texture texture = place_monolayer(RP, 40.0e-6, 0.15, BareCap(), 2);
  for (Grain &g : texture.grains) g.radius = RD;
  const Comparison found = compare(texture, CALCITE, 40, 0.1, 0.5 * std::sqrt(HOLD / SHELL));
  EXPECT_GT(found.tangential, 80);    // more lift off while they stick
  EXPECT_GT(found.stay, 1000);
}

TEST(SurfaceMotion, WithoutFrictionAGrainKeepsItsVelocity)
{
  OnAPlane grain(0.0, 0.15);
  grain.advance(1.0e6, 3.0e-6, 50);
  EXPECT_NEAR(grain.w(), 3.0, 1e-9);
  EXPECT_EQ(grain.p(), 0.0);
}

TEST(SurfaceMotion, RollingWithoutResistanceGivesFiveSevenths)
{
  OnAPlane grain(10.0, 0.0);
  grain.advance(1.0e6, 3.0e-6, 50);
  EXPECT_NEAR(grain.w(), 5.0 / 7.0 * 3.0, 1e-9);
  EXPECT_NEAR(grain.p(), grain.w(), 1e-9);
}

TEST(SurfaceMotion, SlidingIsBrakedByTheLimitOfFriction)
{
  // pushed faster than it can roll: no slip would need 2/7 of the push
  OnAPlane grain(0.3, 0.0);
  const double push = 20.0 * HOLD, brake = 0.3 * 2.0 * HOLD, time = 1.0e-6;
  ASSERT_GT(2.0 / 7.0 * push, brake);
  grain.advance(push, time, 50);
  EXPECT_NEAR(grain.w(), (push - brake) * time, 1e-8);
  EXPECT_NEAR(grain.p(), 2.5 * brake * time, 1e-8);
  // then left alone until it rolls: w + (2/5) p does not change
  const double kept = grain.w() + 0.4 * grain.p();
  grain.advance(0.0, 40.0e-6, 4000);
  EXPECT_NEAR(grain.w(), kept / 1.4, 1e-8);
  EXPECT_NEAR(grain.p(), grain.w(), 1e-8);
}

TEST(SurfaceMotion, LoadOnTheContactRaisesTheLimit)
{
  // pressed on with g_n = -3 c: the limit is mu (2 c + 3 c)
  OnAPlane grain(0.3, 0.0);
  const double a[3] = {-40.0 * HOLD, 0.0, 3.0 * HOLD}, time = 1.0e-6;
  for (int k = 0; k < 50; k++) grain.motion.advance(a, NO_SPIN, time / 50);
  EXPECT_NEAR(grain.w(), (40.0 - 0.3 * 5.0) * HOLD * time, 1e-6);
}

TEST(SurfaceMotion, AGrainBelowTheLimitsRocksAboutItsPlace)
{
  // no slip: w' = (5/7) (push - s psi), psi' = w/R_d, an oscillator
  OnAPlane grain(0.3, 0.15);
  const double push = 0.2 * HOLD, period = 2.0 * M_PI * std::sqrt(7.0 * RD / (5.0 * OnAPlane::STIFFNESS));
  EXPECT_NEAR(period, 32.3e-6, 0.1e-6);
  grain.advance(push, 0.5 * period, 200);
  EXPECT_NEAR(grain.psi(), 2.0 * push / OnAPlane::STIFFNESS, 1e-4 * 0.1);
  EXPECT_GT(grain.psi(), 0.09);
  EXPECT_NEAR(grain.w(), 0.0, 1e-3);
  grain.advance(push, 0.5 * period, 200);
  EXPECT_NEAR(grain.psi(), 0.0, 1e-4 * 0.1);
  EXPECT_NEAR(grain.w(), 0.0, 1e-3);
  EXPECT_TRUE(grain.motion.attached(0));
  // nothing moves it at all: it stays as it is
  OnAPlane still(0.3, 0.15);
  still.advance(0.0, period, 200);
  EXPECT_EQ(still.w(), 0.0);
  EXPECT_EQ(still.psi(), 0.0);
}

TEST(SurfaceMotion, RollingResistanceIsHeldAtThePivotsAngle)
{
  // far beyond it: w' = (5/7) (push - s theta_crit)
  OnAPlane grain(5.0, 0.02);
  grain.advance(2.0 * HOLD, 10.0e-6, 200);
  EXPECT_GE(grain.psi(), 0.02);
  EXPECT_LE(grain.psi(), 0.02 + 0.5 * 5.0e-8 * grain.p() / RD + 1e-12);    // held in the middle of each step
  const double before = grain.w();
  grain.advance(2.0 * HOLD, 1.0e-6, 20);
  EXPECT_NEAR(grain.w() - before, 5.0 / 7.0 * (2.0 - 4.0 * 0.02) * HOLD * 1.0e-6, 1e-6);
}

TEST(SurfaceMotion, EnergyIsKeptInRollingAndNeverMadeBySliding)
{
  OnAPlane grain(1.0, 10.0);
  grain.advance(1.0 * HOLD, 3.0e-6, 100);
  const double start = grain.energy();
  EXPECT_GT(start, 0.01);
  for (int k = 0; k < 50; k++) {
    grain.advance(0.0, 1.0e-6, 20);
    EXPECT_NEAR(grain.energy(), start, 0.005 * start);    // psi is half a step ahead of nothing: second order
  }
  OnAPlane slides(0.02, 0.15);
  slides.advance(10.0 * HOLD, 2.0e-6, 100);
  double last = slides.energy();
  const double first = last;
  for (int k = 0; k < 50; k++) {
    slides.advance(0.0, 1.0e-6, 20);
    EXPECT_LE(slides.energy(), last * (1.0 + 1e-3));
    last = slides.energy();
  }
  EXPECT_LT(last, 0.9 * first);
}

TEST(SurfaceMotion, AGrainLeavesWhereItsMotionOutweighsAdhesion)
{
  // no friction, a slow kick along the surface: it leaves at |w|^2/|r_pd| = c
  const double n[3] = {0.0, 0.0, 1.0}, a[3] = {-1.0e6, 0.0, 0.0};
  SurfaceMotion motion(0.0, 0.15);
  motion.add(n, HOLD, RD, RP, NO_SPIN);
  for (int k = 0; k < 4000 && motion.attached(0); k++) motion.advance(a, NO_SPIN, 5.0e-9);
  ASSERT_FALSE(motion.attached(0));
  double w[3], at[3];
  for (int d = 0; d < 3; d++) {
    w[d] = motion.velocity(0, d);
    at[d] = motion.direction(0, d);
  }
  const double w2 = w[0] * w[0] + w[1] * w[1] + w[2] * w[2], lift = w2 / (RP + RD) - a[0] * at[0];
  EXPECT_NEAR(lift, HOLD, 0.01 * HOLD);
  const double before = w[0];
  motion.advance(a, NO_SPIN, 5.0e-9);    // gone: not moved any more
  EXPECT_EQ(motion.velocity(0, 0), before);
}

TEST(SurfaceMotion, GrainsAfterTheContactAreAskedOnceMore)
{
  // pressed on until the end, with a velocity that adhesion alone cannot hold
  const double n[3] = {0.0, 0.0, 1.0};
  SurfaceMotion motion(0.0, 0.15);
  motion.add(n, HOLD, RD, RP, NO_SPIN);
  const double a[3] = {-11.0e6, 0.0, 20.0 * HOLD};
  for (int k = 0; k < 100; k++) motion.advance(a, NO_SPIN, 1.0e-8);
  EXPECT_TRUE(motion.attached(0));
  motion.release();
  EXPECT_FALSE(motion.attached(0));
}

TEST(SurfaceMotion, GrainsDoNotDependOnTheirNeighbours)
{
  std::mt19937 random(5);
  const History h = random_history(random, 5.0e3);
  const Texture texture = place_monolayer(RP, 40.0e-6, 0.15, BareCap(), 2);
  SurfaceMotion together(0.3, 0.15);
  for (int k = 0; k < SurfaceMotion::LANES; k++)
    together.add(texture.grains[k].n, HOLD * (1.0 + k), RD / (1.0 + k), RP, &h.spin0.x);
  EXPECT_TRUE(together.full());
  for (size_t k = 0; k < h.a.size(); k++) together.advance(&h.a[k].x, &h.spin[k].x, h.dt);
  for (int k = 0; k < SurfaceMotion::LANES; k++) {
    SurfaceMotion alone(0.3, 0.15);
    alone.add(texture.grains[k].n, HOLD * (1.0 + k), RD / (1.0 + k), RP, &h.spin0.x);
    for (size_t i = 0; i < h.a.size(); i++) alone.advance(&h.a[i].x, &h.spin[i].x, h.dt);
    EXPECT_EQ(alone.attached(0), together.attached(k));
    for (int d = 0; d < 3; d++) EXPECT_EQ(alone.velocity(0, d), together.velocity(k, d));
  }
}

TEST(SurfaceMotion, AGrainAtTheEquatorTurnsWithItsCarrier)
{
  const double n[3] = {1.0, 0.0, 0.0}, still[3] = {0.0, 0.0, 0.0}, spin[3] = {0.0, 0.0, 0.95 * std::sqrt(HOLD / SHELL)};
  SurfaceMotion motion(0.3, 0.15);
  motion.add(n, HOLD, RD, RP, spin);
  const double angle = 10.0;    // rad
  for (int k = 0; k < 10000; k++) motion.advance(still, spin, angle / spin[2] / 10000);
  EXPECT_TRUE(motion.attached(0));
  EXPECT_NEAR(motion.direction(0, 0), std::cos(angle), 1e-5);    // tan(angle/20000) for angle/20000, twice a step
  EXPECT_NEAR(motion.direction(0, 1), std::sin(angle), 1e-5);
  EXPECT_EQ(motion.direction(0, 2), 0.0);
  const double speed = spin[2] * SHELL;
  EXPECT_NEAR(motion.velocity(0, 0), -speed * motion.direction(0, 1), 1e-12 * speed);
  EXPECT_NEAR(motion.velocity(0, 1), speed * motion.direction(0, 0), 1e-12 * speed);
  EXPECT_NEAR(motion.rolling_velocity(0, 1), spin[2] * RD * motion.direction(0, 0), 1e-12 * speed);
  for (int d = 0; d < 3; d++) EXPECT_NEAR(motion.rolling_angle(0, d), 0.0, 1e-14);
}

TEST(SurfaceMotion, AwayFromTheEquatorItRocksAboutWhereTheCentrifugalForceHoldsIt)
{
  // without slip (7/5) v' = T - s psi, T = |r_pd| omega^2 sin cos: after half a period psi = 2 T/s
  const double spin[3] = {0.0, 0.0, 1.0e3}, n[3] = {std::sqrt(0.5), 0.0, std::sqrt(0.5)}, still[3] = {0.0, 0.0, 0.0};
  const double push = 0.5 * SHELL * spin[2] * spin[2], s = 4.0 * HOLD * RP / SHELL;
  SurfaceMotion motion(0.3, 0.15);
  motion.add(n, HOLD, RD, RP, spin);
  for (int k = 0; k < 400; k++) motion.advance(still, spin, M_PI * std::sqrt(7.0 * RD / (5.0 * s)) / 400);
  const Vec psi = {motion.rolling_angle(0, 0), motion.rolling_angle(0, 1), motion.rolling_angle(0, 2)};
  EXPECT_NEAR(size(psi), 2.0 * push / s, 0.005 * push / s);
  EXPECT_LT(psi.z, 0.0);    // to the equator
}

TEST(SurfaceMotion, WithoutFrictionAGrainLeavesTheTurningCarrierBehind)
{
  // on a great circle, with the velocity it had
  const double spin[3] = {0.0, 0.0, 5.0e3}, n[3] = {std::sqrt(0.5), 0.0, std::sqrt(0.5)}, still[3] = {0.0, 0.0, 0.0};
  SurfaceMotion motion(0.0, 0.0);
  motion.add(n, HOLD, RD, RP, spin);
  const double angle = 0.3;
  for (int k = 0; k < 1000; k++) motion.advance(still, spin, angle / (spin[2] * std::sqrt(0.5)) / 1000);
  EXPECT_NEAR(motion.direction(0, 0), std::sqrt(0.5) * std::cos(angle), 1e-4);
  EXPECT_NEAR(motion.direction(0, 1), std::sin(angle), 1e-4);
  EXPECT_NEAR(motion.direction(0, 2), std::sqrt(0.5) * std::cos(angle), 1e-4);
  const double speed = spin[2] * SHELL * std::sqrt(0.5);
  EXPECT_NEAR(motion.velocity(0, 1), speed * std::cos(angle), 2e-4 * speed);
}

TEST(SurfaceMotion, ACarrierSpunUpThrowsGrainsOffItsEquatorOnly)
{
  // slowly enough that they follow
  const double equator[3] = {0.0, 1.0, 0.0}, axis[3] = {0.0, 0.0, -1.0}, still[3] = {0.0, 0.0, 0.0};
  for (double share : {0.995, 1.005}) {
    SurfaceMotion motion(0.3, 0.15);
    motion.add(equator, HOLD, RD, RP, still);
    motion.add(axis, HOLD, RD, RP, still);
    const int steps = 40000;
    for (int k = 1; k <= steps; k++) {
      const double spin[3] = {0.0, 0.0, share * std::sqrt(HOLD / SHELL) * k / steps};
      motion.advance(still, spin, 1.0e-3 / steps);
    }
    motion.release();
    EXPECT_EQ(motion.attached(0), share < 1.0);
    EXPECT_TRUE(motion.attached(1));
    EXPECT_EQ(motion.velocity(1, 0), 0.0);
  }
}

TEST(SurfaceMotion, DoesNotDependOnTheAxes)
{
  std::mt19937 random(8);
  const auto turned = [](const Vec &v) {
    return Vec{0.36 * v.x + 0.48 * v.y - 0.8 * v.z, -0.8 * v.x + 0.6 * v.y, 0.48 * v.x + 0.64 * v.y + 0.6 * v.z};
  };
  for (int i = 0; i < 20; i++) {
    const History h = random_history(random, 5.0e3);
    SurfaceMotion one(0.3, 0.15), other(0.3, 0.15);
    while (!one.full()) {
      const Vec n = random_direction(random), m = turned(n), spin = turned(h.spin0);
      one.add(&n.x, HOLD, RD, RP, &h.spin0.x);
      other.add(&m.x, HOLD, RD, RP, &spin.x);
    }
    for (size_t k = 0; k < h.a.size(); k++) {
      const Vec a = turned(h.a[k]), spin = turned(h.spin[k]);
      one.advance(&h.a[k].x, &h.spin[k].x, h.dt);
      other.advance(&a.x, &spin.x, h.dt);
    }
    for (int k = 0; k < one.grains(); k++) {
      EXPECT_EQ(one.attached(k), other.attached(k));
      const Vec v = turned({one.velocity(k, 0), one.velocity(k, 1), one.velocity(k, 2)});
      EXPECT_NEAR(size(v - Vec{other.velocity(k, 0), other.velocity(k, 1), other.velocity(k, 2)}), 0.0, 1e-10);
    }
  }
}

TEST(SurfaceMotion, GrainsOfACollisionThatRingLeaveMore)
{
  // straight, as fast as it takes: squeezed on the north and let go
  Texture texture = place_monolayer(RP, 2.0 * RD, 0.2, BareCap(), 1);
  History h;
  h.dt = 3.0e-6 / 600;
  h.smooth = false;
  for (int k = 0; k < 600; k++) h.a.push_back({0.0, 0.0, 50.0 * HOLD * std::sin(M_PI * (k + 0.5) / 600)});
  h.spin.assign(600, Vec());
  std::map<double, std::map<int, Mode>> left;
  for (double zeta : {-1.0, 3.0, 0.06}) {
    Material m = CALCITE;
    m.damping = zeta;
    const GrainTable table(texture, m, integrate());
    left[zeta] = by_collision(table, h);
    EXPECT_EQ(by_collision(table, h, 17), left[zeta]);
  }
  EXPECT_EQ(left[3.0], left[-1.0]);
  EXPECT_GT(left[0.06].size(), left[-1.0].size() + 100);
  for (const auto &grain : left[-1.0]) EXPECT_EQ(left[0.06].count(grain.first), 1u);
}

TEST(ImpulseRecord, KeepsSumsInBoundedMemory)
{
  std::mt19937 random(6);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int steps : {1, 63, 64, 65, 128, 129, 1000, 5000}) {
    ImpulseRecord record;
    Vec impulse, turn;
    double time = 0.0;
    for (int k = 0; k < steps; k++) {
      const Vec a = {u(random), u(random), u(random)}, spin = {u(random), u(random), u(random)};
      const double dt = 1.0 + 0.5 * u(random);
      record.add(&a.x, &spin.x, dt);
      impulse = impulse + dt * a;
      turn = turn + dt * spin;
      time += dt;
      ASSERT_LE(record.spans().size(), size_t(ImpulseRecord::MAX_SPANS));
    }
    EXPECT_GE(record.spans().size(), size_t(std::min(steps, ImpulseRecord::MAX_SPANS / 2)));
    Packer counter;
    record.pack(counter);
    std::vector<double> buf(counter.size());
    Packer packer(buf.data());
    record.pack(packer);
    ImpulseRecord other;
    Unpacker unpacker(buf.data());
    other.unpack(unpacker);
    EXPECT_EQ(unpacker.position(), buf.data() + buf.size());
    ASSERT_EQ(other.spans().size(), record.spans().size());
    EXPECT_EQ(std::memcmp(other.spans().data(), record.spans().data(),
                          record.spans().size() * sizeof(ImpulseRecord::Span)),
              0);
    for (const auto &span : record.spans()) {
      impulse = impulse - Vec{span.impulse[0], span.impulse[1], span.impulse[2]};
      turn = turn - Vec{span.angle[0], span.angle[1], span.angle[2]};
      time -= span.duration;
    }
    EXPECT_NEAR(size(impulse), 0.0, 1e-9);
    EXPECT_NEAR(size(turn), 0.0, 1e-9);
    EXPECT_NEAR(time, 0.0, 1e-9);
  }
}

TEST(ImpulseRecord, IsKeptForIntegrateOnly)
{
  std::mt19937 random(7);
  const History h = random_history(random);
  const Texture texture = place_monolayer(RP, RD, 0.2, BareCap(), 1);
  std::map<int, int> sizes;
  for (auto tangential : {Criteria::OFF, Criteria::FRICTIONLESS, Criteria::ESTIMATE, Criteria::INTEGRATE}) {
    Criteria criteria;
    criteria.tangential = tangential;
    const GrainTable table(texture, CALCITE, criteria);
    std::vector<uint64_t> attached = table.all_attached();
    Workspace work;
    Collision collision;
    collision.begin(Quaternion(), NO_SPIN);
    for (size_t k = 0; k < h.a.size(); k++) collision.step(table, motion_of(h, k), h.dt, attached.data(), work);
    sizes[tangential] = collision.packed_size();
  }
  EXPECT_EQ(sizes[Criteria::OFF], sizes[Criteria::ESTIMATE]);
  EXPECT_EQ(sizes[Criteria::FRICTIONLESS], sizes[Criteria::ESTIMATE]);
  EXPECT_GT(sizes[Criteria::INTEGRATE], sizes[Criteria::ESTIMATE] + 7 * ImpulseRecord::MAX_SPANS / 2);
}

TEST(MotionBound, HoldsForWhatMovesMostAndSparesWhatDoesNot)
{
  // half a sine for 3 us along z, at the equator and at the pole
  const auto bound = [](double speed) {
    ImpulseRecord record;
    const double time = 3.0e-6, peak = 0.5 * M_PI * speed / time;
    for (int k = 0; k < 300; k++) {
      const double a[3] = {0.0, 0.0, peak * std::sin(M_PI * (k + 0.5) / 300)};
      record.add(a, NO_SPIN, time / 300);
    }
    return MotionBound(record, NO_SPIN, peak, 0.15, RP);
  };
  const double equator[3] = {1.0, 0.0, 0.0}, pole[3] = {0.0, 0.0, 1.0}, needed = std::sqrt(HOLD * (RP + RD));
  EXPECT_GT(bound(1.001 * needed).of(equator, HOLD, RP + RD).centrifugal, HOLD);    // frictionless
  EXPECT_LT(bound(1.5 * needed).of(pole, HOLD, RP + RD).centrifugal, 0.2 * HOLD);
  EXPECT_LT(bound(0.5 * needed).of(equator, HOLD, RP + RD).centrifugal, 0.5 * HOLD);
  EXPECT_GT(bound(0.5 * needed).of(equator, HOLD, RP + RD).angle, 0.5 * needed * 3.0e-6 / (RP + RD));
  EXPECT_TRUE(bound(0.5 * needed).any_may_leave(HOLD, HOLD, SHELL));
  EXPECT_FALSE(bound(0.01 * needed).any_may_leave(HOLD, HOLD, SHELL));
}

TEST(MotionBound, NeverSparesAGrainThatIsThrownOff)
{
  std::mt19937 random(9);
  int thrown = 0, spared = 0, collisions = 0;
  for (int i = 0; i < 2500; i++) {
    History h = random_history(random, i % 5 == 0 ? 0.0 : 4.0e3);
    if (h.a.size() < 32) continue;    // Collision takes smaller steps
    const double weaker = std::exp(-3.0 * std::uniform_real_distribution<double>()(random));
    for (Vec &a : h.a) a = weaker * a;
    collisions++;
    ImpulseRecord record;
    double peak = 0.0;
    for (size_t k = 0; k < h.a.size(); k++) {
      record.add(&h.a[k].x, &h.spin[k].x, h.dt);
      peak = std::max(peak, size(h.a[k]));
    }
    const double rolling = i % 3 == 0 ? 3.0 : 0.15;
    const MotionBound bound(record, &h.spin0.x, peak, rolling, RP);
    SurfaceMotion motion(i % 7 == 0 ? 0.0 : 0.3, rolling);
    std::vector<bool> stays;
    while (!motion.full()) {
      const Vec n = random_direction(random);
      const double radius = RD * (1.0 + 0.1 * (motion.grains() % 5)), hold = HOLD * RD * RD / (radius * radius);
      motion.add(&n.x, hold, radius, RP, &h.spin0.x);
      const auto [angle, centrifugal] = bound.of(&n.x, hold, RP + radius);
      bool holds = centrifugal <= hold;    // after the end
      for (const Vec &a : h.a) holds &= angle * size(a) - dot(a, n) + centrifugal <= hold;
      stays.push_back(holds);
      if (!bound.any_may_leave(hold, hold, RP + radius)) {
        EXPECT_TRUE(holds);
      }
    }
    for (const ImpulseRecord::Span &span : record.spans()) {
      const double t = span.duration, *j = span.impulse, a[3] = {j[0] / t, j[1] / t, j[2] / t};
      const double spin[3] = {span.angle[0] / t, span.angle[1] / t, span.angle[2] / t};
      motion.advance(a, spin, t);
    }
    motion.release();
    for (int k = 0; k < motion.grains(); k++) {
      thrown += !motion.attached(k);
      spared += stays[k];
      if (stays[k]) {
        EXPECT_TRUE(motion.attached(k)) << "collision " << i << " grain " << k;
      }
    }
  }
  EXPECT_GT(collisions, 2000);
  EXPECT_GT(thrown, 2000);
  EXPECT_GT(spared, 10000);
}

TEST(MotionBound, NeverSparesAGrainThatRingsOff)
{
  // an undamped contact under loads that swing at its frequency; spared where they change by 0.95 F_c, thrown off by
  // far more
  const double gap = 2.267e-10, mass = 4.0 / 3.0 * M_PI * RD * RD * RD * 2700.0, n[3] = {0.0, 0.0, 1.0};
  const double period =
      2.0 * M_PI /
      std::sqrt(1.2 * CALCITE.modulus *
                equilibrium_contact_radius(CALCITE.gamma, effective_radius(RP, RD), CALCITE.modulus) / mass);
  int spared = 0, thrown = 0;
  for (int swings = 1; swings <= ImpulseRecord::MAX_SPANS / 2; swings++)
    for (double strength = 0.0; strength < 0.5; strength += 0.01) {
      ImpulseRecord record;
      NormalMotion ringing(0.0);
      SurfaceMotion motion(0.3, 0.15);
      motion.add(n, HOLD, RD, RP, NO_SPIN);
      ringing.add(HOLD, gap, 0.0);
      for (int k = 0; k < 2 * swings; k++) {
        const double a[3] = {0.0, 0.0, (k % 2 ? 1.0 : -1.0) * strength * HOLD};
        record.add(a, NO_SPIN, 0.5 * period);
        const double load = motion.outward_force(0, a) / HOLD;
        EXPECT_NEAR(load, -a[2] / HOLD, 1e-12);
        ringing.advance(&load, 0.0);
        ringing.advance(&load, 0.5 * period);
      }
      ringing.ring_out();
      const bool may = MotionBound(record, NO_SPIN, strength * HOLD, 0.15, RP).any_may_ring_off(HOLD, HOLD, SHELL);
      spared += !may;
      thrown += !ringing.attached(0);
      if (!may) EXPECT_TRUE(ringing.attached(0)) << swings << " swings of " << strength;
    }
  EXPECT_GT(spared, 50);
  EXPECT_GT(thrown, 200);
}
