/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "acceleration_history.h"

#include <algorithm>
#include <cmath>

using namespace Dust;

Split Dust::split(const double *p, const double *q, double q2)
{
  const double lambda = dot(p, q) / q2;
  const double e[3] = {p[0] - lambda * q[0], p[1] - lambda * q[1], p[2] - lambda * q[2]};
  return {lambda, dot(e, e)};
}

bool Dust::is_between(const Split &s, double q2)
{
  constexpr double ROUND_OFF2 = 1.0e-24;
  return s.lambda >= 0.0 && s.lambda <= 1.0 && s.aside2 <= ROUND_OFF2 * q2;
}

/* ---------------------------------------------------------------------- */

void AccelerationHistory::clear()
{
  motions.clear();
  levels.clear();
  in_tree = 0;
  largest = 0;
  size2_of_peak = 0.0;
}

/* ----------------------------------------------------------------------
   a motion matters to no grain if it lies between none and another one: g is linear in it, but for the spin
------------------------------------------------------------------------- */

void AccelerationHistory::add(const Motion &motion, double size2)
{
  const bool turns = motion.turns();
  const auto covers = [](const Motion &q, double q2, const Motion &p) {
    return is_between(split(p.acceleration, q.acceleration, q2), q2) && !p.turns() && !q.turns();
  };
  size_t n = motions.size();
  if (n && !turns && size2 <= size2_of_peak && covers(peak(), size2_of_peak, motion)) return;
  if (n > largest + 1 && !turns) {
    const Motion &last = motions[n - 1];
    if (covers(last, dot(last.acceleration, last.acceleration), motion)) return;
  }
  if (!turns)
    while (n && covers(motion, size2, motions[n - 1])) n--;
  motions.resize(n);
  motions.push_back(motion);
  in_tree = std::min(in_tree, n);
  if (size2 > size2_of_peak || largest >= n) {
    largest = n;
    size2_of_peak = size2;
  }
}

/* ---------------------------------------------------------------------- */

AccelerationHistory::Sphere AccelerationHistory::member(size_t level, size_t i) const
{
  if (level > 0) return levels[level - 1][i];
  const Motion &m = motions[i];
  const double *a = m.acceleration;
  return {{a[0], a[1], a[2]}, 0.0, m.turning()};
}

void AccelerationHistory::update_tree() const
{
  if (in_tree == motions.size()) return;
  size_t whole = motions.size(), kept = in_tree;
  in_tree = motions.size();
  for (size_t level = 0; whole >= BRANCH || level < levels.size(); level++) {
    whole /= BRANCH;
    kept /= BRANCH;
    if (level == levels.size()) levels.emplace_back();
    std::vector<Sphere> &spheres = levels[level];
    if (spheres.size() > kept) spheres.resize(kept);
    while (spheres.size() < whole) {
      const size_t first = spheres.size() * BRANCH;
      Sphere s = {};
      for (size_t i = 0; i < BRANCH; i++)
        for (int d = 0; d < 3; d++) s.centre[d] += member(level, first + i).centre[d] / BRANCH;
      for (size_t i = 0; i < BRANCH; i++) {
        const Sphere m = member(level, first + i);
        const double r[3] = {m.centre[0] - s.centre[0], m.centre[1] - s.centre[1], m.centre[2] - s.centre[2]};
        constexpr double ROUND_OFF = 1.0 + 1.0e-12;
        s.radius = std::max(s.radius, (std::sqrt(dot(r, r)) + m.radius) * ROUND_OFF);
        s.turning = std::max(s.turning, m.turning * ROUND_OFF);
      }
      spheres.push_back(s);
    }
  }
}

/* ---------------------------------------------------------------------- */

double AccelerationHistory::largest_push(const double *n, double shell, size_t &hint) const
{
  const auto push = [&](size_t i) { return -motions[i].lift(n, shell); };
  if (push(largest) > push(hint)) hint = largest;
  double most = push(hint);
  search([&](const Sphere &s) { return dot(s.centre, n) + s.radius > most; },
         [&](size_t i) {
           if (push(i) > most) {
             hint = i;
             most = push(i);
           }
           return false;
         });
  return std::max(0.0, most);
}

/* ---------------------------------------------------------------------- */

void AccelerationHistory::assign(const Motion *first, size_t count)
{
  clear();
  motions.assign(first, first + count);
  for (size_t i = 0; i < count; i++) {
    const double size2 = dot(motions[i].acceleration, motions[i].acceleration);
    if (size2 > size2_of_peak) {
      largest = i;
      size2_of_peak = size2;
    }
  }
}
