/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.
------------------------------------------------------------------------- */

#include "acceleration_history.h"

#include <algorithm>
#include <cmath>

using namespace Dust;

void AccelerationHistory::clear()
{
  constexpr size_t KEPT = 1024;    // room for more is given back: a bed has many histories, and few are long
  if (motions.capacity() > KEPT) motions = {};
  motions.clear();
  levels.clear();
  in_tree = 0;
  peak_at = 0;
  any_rotated = false;
  size2_of_peak = 0.0;
}

/* ----------------------------------------------------------------------
   a motion matters to no grain if it lies between none and another one: g is linear in it, but for the spin
------------------------------------------------------------------------- */

void AccelerationHistory::add(const Motion &motion, double size2, bool rotates)
{
  any_rotated = any_rotated || rotates;
  const auto covers = [this](const Motion &q, double q2, const Motion &p) {
    return is_between(split(p.acceleration, q.acceleration, q2), q2) && !(any_rotated && (p.rotates() || q.rotates()));
  };
  size_t n = motions.size();
  if (!rotates) {
    if (n && size2 <= size2_of_peak && covers(peak(), size2_of_peak, motion)) return;
    if (n > peak_at + 1) {
      const Motion &last = motions[n - 1];
      if (covers(last, dot(last.acceleration, last.acceleration), motion)) return;
    }
    while (n && covers(motion, size2, motions[n - 1])) n--;
  }
  motions.resize(n);
  // the short ones of soft contacts waste little, the long ones of stiff impacts are seldom copied
  if (n == motions.capacity()) motions.reserve(std::max<size_t>(8, n < 64 ? 2 * n : 4 * n));
  motions.push_back(motion);
  in_tree = std::min(in_tree, n);
  if (size2 > size2_of_peak || peak_at >= n) {
    peak_at = n;
    size2_of_peak = size2;
  }
}

/* ---------------------------------------------------------------------- */

AccelerationHistory::Sphere AccelerationHistory::member(size_t level, size_t i) const
{
  if (level > 0) return levels[level - 1][i];
  return {motions[i], 0.0, 0.0};
}

AccelerationHistory::Sphere AccelerationHistory::around(size_t level, size_t first) const
{
  Sphere s = {};
  for (size_t i = 0; i < BRANCH; i++) {
    const Motion m = member(level, first + i).centre;
    for (int d = 0; d < 3; d++) {
      s.centre.acceleration[d] += m.acceleration[d] / BRANCH;
      s.centre.angular_acceleration[d] += m.angular_acceleration[d] / BRANCH;
      s.centre.spin[d] += m.spin[d] / BRANCH;
    }
  }
  const auto distance = [](const double *a, const double *b) {
    const double r[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return std::sqrt(dot(r, r));
  };
  for (size_t i = 0; i < BRANCH; i++) {
    const Sphere part = member(level, first + i);
    const Motion &m = part.centre, &c = s.centre;
    const double rotation = distance(m.angular_acceleration, c.angular_acceleration) + spin_difference(m.spin, c.spin);
    constexpr double ROUND_OFF = 1.0 + 1.0e-12;
    s.radius = std::max(s.radius, (distance(m.acceleration, c.acceleration) + part.radius) * ROUND_OFF);
    s.rotation = std::max(s.rotation, (rotation + part.rotation) * ROUND_OFF);
  }
  return s;
}

/* ---------------------------------------------------------------------- */

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
    while (spheres.size() < whole) spheres.push_back(around(level, spheres.size() * BRANCH));
  }
}

/* ---------------------------------------------------------------------- */

double AccelerationHistory::max_push(const double *n, double shell, size_t &hint) const
{
  const auto push = [&](size_t i) { return -motions[i].lift(n, shell); };
  if (push(peak_at) > push(hint)) hint = peak_at;
  double max = push(hint);
  search([&](const Sphere &s) { return s.size(shell) - s.centre.lift(n, shell) > max; },
         [&](size_t i) {
           if (push(i) > max) {
             hint = i;
             max = push(i);
           }
           return false;
         });
  return max;
}

/* ---------------------------------------------------------------------- */

void AccelerationHistory::pack(Packer &packer) const
{
  packer.put(static_cast<double>(peak_at));
  packer.put(size2_of_peak);
  packer.put(motions);
}

void AccelerationHistory::unpack(Unpacker &unpacker)
{
  clear();
  peak_at = static_cast<size_t>(unpacker.number());
  size2_of_peak = unpacker.number();
  unpacker.get(motions);
  for (const Motion &m : motions) any_rotated = any_rotated || m.rotates();
}
