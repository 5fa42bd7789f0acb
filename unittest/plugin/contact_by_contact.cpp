// Contacts followed over some steps by LAMMPS' granular model and by the loops of src/core, without a LAMMPS around
// them: prints how many have other forces, torques or histories. For processors that there is only an emulator of.

#include "contact_queue.h"

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
using Dust::at;
using Dust::put;
using Dust::Vector;

namespace {

constexpr double DT = 1e-6;
constexpr int CONTACTS = 400, STEPS = 60, HISTORY = 32;

struct Sphere {
  Vector x, v, omega;
  double radius, mass;
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

void step_of_lammps(GranularModel *model, const Sphere &i, const Sphere &j, Result &result)
{
  double numbers[6][3];
  const Vector *vectors[] = {&i.x, &j.x, &i.v, &j.v, &i.omega, &j.omega};
  for (int k = 0; k < 6; k++) put(numbers[k], *vectors[k]);
  model->xi = numbers[0];
  model->xj = numbers[1];
  model->vi = numbers[2];
  model->vj = numbers[3];
  model->omegai = numbers[4];
  model->omegaj = numbers[5];
  model->radi = i.radius;
  model->radj = j.radius;
  model->meff = i.mass * j.mass / (i.mass + j.mass);
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

void step_of_ours(ContactLaw &law, ContactQueue &queue, const Sphere &i, const Sphere &j, Result &result)
{
  if (!law.touches(dot(i.x - j.x, i.x - j.x), i.radius, j.radius)) return result.clear();
  result.touch = true;
  double x[6], v[6], omega[6];
  for (int k = 0; k < 2; k++) {
    const Sphere &sphere = k ? j : i;
    put(x + 3 * k, sphere.x);
    put(v + 3 * k, sphere.v);
    put(omega + 3 * k, sphere.omega);
  }
  const double radius[2] = {i.radius, j.radius}, mass[2] = {i.mass, j.mass};
  queue.clear();
  queue.add(&law, result.history, 0, 1);
  queue.meet(Dust::Spheres{x, v, omega, radius, mass});
  queue.compute(DT, true, 0);
  const ContactQueue::Contact &contact = *queue.begin();
  put(result.force, contact.force());
  put(result.force + 3, contact.torque_i());
  put(result.force + 6, contact.torque_j());
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
  std::vector<ContactLaw> laws = {ContactLaw(model, 1)};
  ContactQueue queue(laws);
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const auto vector = [&](double size) { return Vector{size * u(engine), size * u(engine), size * u(engine)}; };
  for (int c = 0; c < CONTACTS; c++) {
    const auto size = [&] { return 0.7e-3 + 1e-4 * u(engine); };
    const auto weight = [&] { return 1e-5 * (1.0 + 0.3 * u(engine)); };
    Sphere i = {vector(1.0), vector(1.0), vector(500.0), size(), weight()};
    Sphere j = {{0.0, 0.0, 0.0}, vector(1.0), vector(500.0), size(), weight()};
    i.x = ((i.radius + j.radius - 1e-5) / std::sqrt(dot(i.x, i.x))) * i.x;
    Result lammps, ours;
    for (int s = 0; s < STEPS; s++) {
      i.v = i.v + vector(0.05);
      i.x = i.x + DT * i.v;
      j.x = j.x + DT * j.v;
      step_of_lammps(model, i, j, lammps);
      step_of_ours(laws.front(), queue, i, j, ours);
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
