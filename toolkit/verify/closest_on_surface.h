#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "taut/verify/closest_on_curve.h"
#include "taut/verify/document_geometry.h"

namespace taut {

/// Gauss and Newton's step to the surface's point nearest to p, from parameters in [0, 1]^2; it
/// leads from a border along it or inside. The distances that matter are zero, where second
/// derivatives count for nothing.
inline dvec2 step_to_nearest(const SourceJet& j, const dvec3& p, const dvec2& t) {
  const dvec3 off = p - j.x;
  const dvec2 square(glm::dot(j.dx[0], j.dx[0]), glm::dot(j.dx[1], j.dx[1]));
  const dvec2 slope(glm::dot(off, j.dx[0]), glm::dot(off, j.dx[1]));
  const double mixed = glm::dot(j.dx[0], j.dx[1]);
  const double determinant = square.x * square.y - mixed * mixed;
  const auto leaves = [&](int a, double step) { return step < 0 ? t[a] <= 0 : t[a] >= 1; };
  if (determinant > 0) {
    const dvec2 step(square.y * slope.x - mixed * slope.y, square.x * slope.y - mixed * slope.x);
    if (!leaves(0, step.x) && !leaves(1, step.y)) return step / determinant;
  }
  // Along one of the parameters, the one that gains more.
  double best = 0;
  dvec2 result(0.0);
  for (const int a : {0, 1}) {
    if (!(square[a] > 0) || leaves(a, slope[a])) continue;
    const double gain = slope[a] * slope[a] / square[a];
    if (!(gain > best)) continue;
    best = gain;
    result = dvec2(0.0);
    result[a] = slope[a] / square[a];
  }
  return result;
}

/// A surface's parameters with the distance of its point from another one.
struct ClosestOnSurface {
  dvec2 t = dvec2(0.0);
  double distance = std::numeric_limits<double>::infinity();
};

/// Into how many parts each parameter of a Bezier patch is divided by samples.
inline std::array<int, 2> sampled_parts(const HullDocument::Patch& patch) {
  return {patch.rows + 4, patch.columns + 4};
}

/// The samples of a grid of so many along each parameter that are no farther than those beside
/// them, the nearest first.
inline std::vector<ClosestOnSurface> nearest_samples(const std::vector<ClosestOnSurface>& grid,
                                                     const std::array<int, 2>& count) {
  const auto at = [&](int i, int k) -> const ClosestOnSurface& {
    return grid[std::size_t(i * count[1] + k)];
  };
  const auto is_nearest = [&](int i, int k) {
    for (int a = std::max(i - 1, 0); a <= std::min(i + 1, count[0] - 1); ++a) {
      for (int b = std::max(k - 1, 0); b <= std::min(k + 1, count[1] - 1); ++b) {
        if (at(a, b).distance < at(i, k).distance) return false;
      }
    }
    return true;
  };
  std::vector<ClosestOnSurface> found;
  for (int i = 0; i < count[0]; ++i) {
    for (int k = 0; k < count[1]; ++k) {
      if (is_nearest(i, k)) found.push_back(at(i, k));
    }
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.distance < b.distance; });
  return found;
}

/// The point of a surface over [0, 1]^2 that is nearest to p, by Newton's method from the samples
/// that are nearer than those beside them; where that ends in a point that a side is collapsed to,
/// whence steps lead along one parameter only, also from such ones inside. `jet(t)` is the
/// surface's SourceJet, `parts` how many there are between the samples along each parameter; there
/// are more of them where none leads to p itself, though p is no farther from one than these are
/// from each other.
template <class Jet>
ClosestOnSurface closest_on_surface(const dvec3& p, const Jet& jet,
                                    const std::array<int, 2>& parts) {
  constexpr int closer = 4;
  constexpr int steps = 40;
  constexpr double least_share = 1.0 / 4096;
  // Of the lengths of the derivatives; at regular points of patches they differ by much less. What
  // is taken for collapsed though it is not costs time only.
  constexpr double collapsed = 1e-6;
  double farthest = 0;
  const auto at = [&](const dvec2& t) {
    const ClosestOnSurface found{t, glm::distance(jet(t).x, p)};
    farthest = std::max(farthest, found.distance);
    return found;
  };
  const auto approach = [&](ClosestOnSurface own) {
    for (int i = 0; i < steps && own.distance > 0; ++i) {
      const double before = own.distance;
      const dvec2 from = own.t;
      const dvec2 step = step_to_nearest(jet(from), p, from);
      // Where the surface degenerates, at corners, or turns sharply a whole step may lead astray.
      for (double share = 1; share >= least_share && !(own.distance < before); share *= 0.5) {
        const ClosestOnSurface next = at(glm::clamp(from + share * step, dvec2(0.0), dvec2(1.0)));
        if (next.distance < own.distance) own = next;
      }
      if (!(own.distance < before)) break;
    }
    return own;
  };
  const auto is_point = [&](const dvec2& t) {
    const SourceJet j = jet(t);
    const auto [least, most] = std::minmax({glm::length(j.dx[0]), glm::length(j.dx[1])});
    return least <= collapsed * most;
  };
  ClosestOnSurface best;
  // False if p is farther from all samples than these are from each other.
  const auto look = [&](double first, const std::array<int, 2>& own) {
    const int ends = first == 0 ? 1 : 0;
    const std::array<int, 2> count = {own[0] + ends, own[1] + ends};
    std::vector<ClosestOnSurface> grid;
    std::vector<dvec3> points;
    dvec2 apart(0.0);  // neighbours along either parameter, at most
    for (int k = 0; k < count[0] * count[1]; ++k) {
      const dvec2 t = (dvec2(k / count[1], k % count[1]) + first) / dvec2(own[0], own[1]);
      const dvec3 x = jet(t).x;
      const auto off = [&](int back) { return glm::distance(x, points[std::size_t(k - back)]); };
      if (k >= count[1]) apart.x = std::max(apart.x, off(count[1]));
      if (k % count[1] > 0) apart.y = std::max(apart.y, off(1));
      points.push_back(x);
      grid.push_back({t, glm::distance(x, p)});
      farthest = std::max(farthest, grid.back().distance);
    }
    const double cell = apart.x + apart.y;
    const std::vector<ClosestOnSurface> starts = nearest_samples(grid, count);
    for (const ClosestOnSurface& start : starts) {
      if (start.distance > best.distance + cell) break;
      const ClosestOnSurface found = approach(start);
      if (found.distance < best.distance) best = found;
      if (best.distance <= no_distance * farthest) break;
    }
    return starts.front().distance <= cell;
  };
  const bool may_be_closer = look(0, parts);
  if (may_be_closer && best.distance > no_distance * farthest) {
    look(0, {closer * parts[0], closer * parts[1]});
  }
  if (best.distance > 0 && is_point(best.t)) look(0.5, parts);
  return best;
}

}  // namespace taut
