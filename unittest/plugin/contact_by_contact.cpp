// Contacts followed over some steps by LAMMPS' granular model and by the loops of src/core, without a LAMMPS around
// them: prints how many have other forces, torques or histories. For processors that there is only an emulator of.

#include "contact_law.h"
#include "core/grain_contacts.h"
#include "core/hertz_contacts.h"

#include "force.h"
#include "gran_sub_mod.h"
#include "granular_model.h"
#include "lammps.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>
#include <string>
#include <vector>

using namespace LAMMPS_NS;
using namespace Granular_NS;
using Dust::Vector;

namespace {

constexpr double DT = 1e-6;
constexpr int CONTACTS = 400, STEPS = 60, HISTORY = 32;

struct Sphere {
  Vector x, v, omega;
  double radius;
};

// what a step leaves of a contact
struct Result {
  bool touch = false;
  double force[9] = {};    // and torques on both
  double history[HISTORY] = {};

  void clear() { *this = {}; }
  bool operator==(const Result &other) const
  {
    return touch == other.touch && !std::memcmp(force, other.force, sizeof(force)) &&
           !std::memcmp(history, other.history, sizeof(history));
  }
};

// LAMMPS' classes ask an instance for no more than this
LAMMPS *instance()
{
  alignas(64) static char lammps[1 << 14], update[1 << 14], force[1 << 14];
  auto *lmp = reinterpret_cast<LAMMPS *>(lammps);
  lmp->update = reinterpret_cast<Update *>(update);
  lmp->force = reinterpret_cast<Force *>(force);
  lmp->update->dt = DT;
  return lmp;
}

GranularModel *model_of(bool grains, bool synchronized, double shear_damping)
{
  auto *model = new GranularModel(instance());
  const auto add = [model](const std::string &name, SubModelType type, const std::vector<double> &coeffs) {
    model->construct_sub_model(name, type);
    std::copy(coeffs.begin(), coeffs.end(), model->sub_models[type]->coeffs);
    model->sub_models[type]->coeffs_to_local();
  };
  model->dt = DT;
  model->synchronized_verlet = synchronized;
  if (grains)
    add("jkr/vdw", NORMAL, {1e7, 2e5, 0.3, 1e-13, 1e-7});
  else
    add("hertz/material", NORMAL, {2.1e8, 0.7, 0.3});
  add("mindlin", TANGENTIAL, {-1.0, shear_damping, 0.3});
  add(grains ? "viscoelastic" : "coeff_restitution/limited", DAMPING, {});
  if (grains) add("dominik/tielens", ROLLING, {0.05});
  model->init();
  int next = 0;
  for (GranSubMod *part : model->sub_models) {
    part->history_index = next;
    next += part->size_history;
  }
  return model;
}

void step_of_lammps(GranularModel *model, const Sphere &i, const Sphere &j, double mass, Result &result)
{
  double numbers[6][3];
  const Vector *vectors[] = {&i.x, &j.x, &i.v, &j.v, &i.omega, &j.omega};
  for (int k = 0; k < 6; k++) {
    numbers[k][0] = vectors[k]->x;
    numbers[k][1] = vectors[k]->y;
    numbers[k][2] = vectors[k]->z;
  }
  model->xi = numbers[0];
  model->xj = numbers[1];
  model->vi = numbers[2];
  model->vj = numbers[3];
  model->omegai = numbers[4];
  model->omegaj = numbers[5];
  model->radi = i.radius;
  model->radj = j.radius;
  model->meff = mass;
  model->touch = result.touch;
  model->history_update = 1;
  model->history = result.history;
  if (!model->check_contact()) return result.clear();
  result.touch = true;
  model->calculate_forces();
  std::copy_n(model->forces, 3, result.force);
  std::copy_n(model->torquesi, 3, result.force + 3);
  std::copy_n(model->torquesj, 3, result.force + 6);
}

Vector at(const double *v) { return {v[0], v[1], v[2]}; }

void put(double *to, const Vector &v)
{
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

template <class Batch> Batch &batch_of(const ContactLaw &law, const Sphere &i, const Sphere &j, double mass, Result &r)
{
  static Batch b;
  b.clear();
  b.count = 1;
  const Vector dx = i.x - j.x;
  b.dx.set(0, dx);
  b.rsq[0] = dot(dx, dx);
  b.radius_i[0] = i.radius;
  b.radius_j[0] = j.radius;
  b.velocity.set(0, i.v - j.v);
  b.turning.set(0, i.radius * i.omega + j.radius * j.omega);
  b.mass[0] = mass;
  b.half[0] = law.synchronized ? 0.5 * DT : 0.0;
  b.damping[0] = law.damping;
  b.shear_stiffness[0] = law.shear_stiffness;
  b.shear_damping[0] = law.shear_damping;
  b.friction[0] = law.friction;
  b.synchronized = law.synchronized;
  b.shear_damped = law.shear_damping != 0.0;
  b.shear.set(0, at(r.history + law.shear_place));
  return b;
}

void keep(const Dust::ContactBatch &b, const ContactLaw &law, Result &result)
{
  put(result.force, b.force[0]);
  put(result.force + 3, b.torque_i[0]);
  put(result.force + 6, b.torque_j[0]);
  put(result.history + law.shear_place, b.shear[0]);
}

void step_of_carriers(const ContactLaw &law, const Sphere &i, const Sphere &j, double mass, Result &result)
{
  const double radii = i.radius + j.radius;
  if (!(dot(i.x - j.x, i.x - j.x) < radii * radii)) return result.clear();
  result.touch = true;
  auto &b = batch_of<Dust::HertzBatch>(law, i, j, mass, result);
  b.stiffness[0] = law.stiffness;
  Dust::compute_forces(b, DT, true);
  keep(b, law, result);
}

void step_of_grains(ContactLaw &law, const Sphere &i, const Sphere &j, double mass, Result &result)
{
  if (!law.grain_touches(dot(i.x - j.x, i.x - j.x), i.radius, j.radius)) return result.clear();
  result.touch = true;
  auto &b = batch_of<Dust::GrainBatch>(law, i, j, mass, result);
  double *kept = result.history + law.neck_place;
  b.effective_radius[0] = law.effective_radius;
  b.theta_crit[0] = law.theta_crit;
  b.hamaker[0] = law.adhesion.hamaker;
  b.z0[0] = law.adhesion.z0;
  b.range[0] = law.adhesion.range;
  b.pull_off_force[0] = law.adhesion.pull_off_force;
  b.equilibrium_radius[0] = law.adhesion.equilibrium_radius;
  b.breaking_gap[0] = law.adhesion.breaking_gap;
  b.spin.set(0, i.omega - j.omega);
  b.neck[0] = kept[0];
  b.rolling.set(0, at(kept + 1));
  b.overlap[0] = kept[4];
  b.coasting[0] = kept[5];
  b.rate[0] = kept[6];
  Dust::compute_forces(b, DT, true);
  keep(b, law, result);
  kept[0] = b.neck[0];
  put(kept + 1, b.rolling[0]);
  kept[4] = b.overlap[0];
  kept[5] = b.coasting[0];
  kept[6] = b.rate[0];
}

struct Count {
  int touching = 0, different = 0;
  double worst = 0.0;    // of a force

  void add(const Result &lammps, const Result &ours)
  {
    touching += lammps.touch;
    if (lammps == ours) return;
    different++;
    const Vector force = at(lammps.force), off = force - at(ours.force);
    if (dot(force, force) > 0.0) worst = std::max(worst, std::sqrt(dot(off, off) / dot(force, force)));
  }
};

void compare(bool grains, bool synchronized, double shear_damping, Count &count)
{
  GranularModel *model = model_of(grains, synchronized, shear_damping);
  ContactLaw law(model, 1);
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const auto vector = [&](double size) { return Vector{size * u(engine), size * u(engine), size * u(engine)}; };
  for (int c = 0; c < CONTACTS; c++) {
    Sphere i = {vector(1.0), vector(1.0), vector(500.0), 0.7e-3 + 1e-4 * u(engine)};
    Sphere j = {{0.0, 0.0, 0.0}, vector(1.0), vector(500.0), 0.7e-3 + 1e-4 * u(engine)};
    i.x = ((i.radius + j.radius - 1e-5) / std::sqrt(dot(i.x, i.x))) * i.x;
    const double mass = 5e-6 * (1.0 + 0.3 * u(engine));
    Result lammps, ours;
    for (int s = 0; s < STEPS; s++) {
      i.v = i.v + vector(0.05);
      i.x = i.x + DT * i.v;
      j.x = j.x + DT * j.v;
      step_of_lammps(model, i, j, mass, lammps);
      grains ? step_of_grains(law, i, j, mass, ours) : step_of_carriers(law, i, j, mass, ours);
      count.add(lammps, ours);
    }
  }
}

}    // namespace

int main()
{
  for (const bool grains : {false, true}) {
    Count count;
    for (const bool synchronized : {false, true})
      for (const double shear_damping : {0.0, 0.4}) compare(grains, synchronized, shear_damping, count);
    std::printf("%s: %d steps in contact, %d with other bits, a force by %.2g of it at most\n",
                grains ? "grains" : "carriers", count.touching, count.different, count.worst);
  }
}
