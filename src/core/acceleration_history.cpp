/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "acceleration_history.h"

#include "geometry.h"

#include <algorithm>

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
  points.clear();
  levels.clear();
  largest = 0;
  size2_of_peak = 0.0;
}

/* ---------------------------------------------------------------------- */

void AccelerationHistory::add(const double *a, double size2)
{
  const auto covers = [](const double *q, double q2, const double *p) { return is_between(split(p, q, q2), q2); };
  size_t n = points.size() / 3;
  if (n && size2 <= size2_of_peak && covers(peak(), size2_of_peak, a)) return;
  if (n > largest + 1) {
    const double *last = &points[3 * (n - 1)];
    if (covers(last, dot(last, last), a)) return;
  }
  while (n && covers(a, size2, &points[3 * (n - 1)])) n--;
  points.resize(3 * (n + 1));
  std::copy_n(a, 3, &points[3 * n]);
  if (size2 > size2_of_peak || largest >= n) {
    largest = n;
    size2_of_peak = size2;
  }
  update_tree();
}

/* ---------------------------------------------------------------------- */

void AccelerationHistory::update_tree()
{
  // the last point may be replaced by the next one and is in no sphere; others never change but by being dropped
  size_t whole = points.size() / 3 - 1;
  for (size_t level = 0; whole >= BRANCH || level < levels.size(); level++) {
    whole /= BRANCH;
    if (level == levels.size()) levels.emplace_back();
    std::vector<Sphere> &spheres = levels[level];
    if (spheres.size() > whole) spheres.resize(whole);
    while (spheres.size() < whole) {
      const size_t first = spheres.size() * BRANCH;
      const auto member = [&](size_t i) {
        if (level > 0) return levels[level - 1][first + i];
        const double *p = &points[3 * (first + i)];
        return Sphere{{p[0], p[1], p[2]}, 0.0};
      };
      Sphere s = {{0.0, 0.0, 0.0}, 0.0};
      for (size_t i = 0; i < BRANCH; i++)
        for (int d = 0; d < 3; d++) s.centre[d] += member(i).centre[d] / BRANCH;
      for (size_t i = 0; i < BRANCH; i++) {
        const Sphere m = member(i);
        const double r[3] = {m.centre[0] - s.centre[0], m.centre[1] - s.centre[1], m.centre[2] - s.centre[2]};
        s.radius = std::max(s.radius, (std::sqrt(dot(r, r)) + m.radius) * (1.0 + 1.0e-12));    // round-off
      }
      spheres.push_back(s);
    }
  }
}

/* ---------------------------------------------------------------------- */

double AccelerationHistory::largest_along(const double *n, size_t &hint) const
{
  const auto along = [&](size_t i) { return dot(&points[3 * i], n); };
  if (along(largest) > along(hint)) hint = largest;
  double most = along(hint);
  search([&](const Sphere &s) { return dot(s.centre, n) + s.radius > most; },
         [&](size_t i) {
           if (along(i) > most) {
             hint = i;
             most = along(i);
           }
           return false;
         });
  return std::max(0.0, most);
}

/* ---------------------------------------------------------------------- */

void AccelerationHistory::assign(const double *first, const double *last)
{
  clear();
  points.assign(first, last);
  for (size_t i = 0; i < points.size() / 3; i++) {
    const double size2 = dot(&points[3 * i], &points[3 * i]);
    if (size2 > size2_of_peak) {
      largest = i;
      size2_of_peak = size2;
    }
  }
  if (!points.empty()) update_tree();
}
