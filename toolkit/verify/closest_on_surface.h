#pragma once

#include <algorithm>
#include <limits>

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

/// The point of a surface over [0, 1]^2 that is nearest to p, by Newton's method from the nearest
/// of some samples; where that ends in a point that a side is collapsed to, whence steps lead along
/// one parameter only, also from the nearest inside. `jet(t)` is the surface's SourceJet.
template <class Jet>
ClosestOnSurface closest_on_surface(const dvec3& p, const Jet& jet) {
  constexpr int samples = 8;
  constexpr int steps = 40;
  constexpr double least_share = 1.0 / 64;
  // Of the lengths of the derivatives; at regular points of patches they differ by much less. What
  // is taken for collapsed though it is not costs time only.
  constexpr double collapsed = 1e-6;
  ClosestOnSurface best;
  const auto consider = [&](const dvec2& at) {
    const double distance = glm::distance(jet(at).x, p);
    if (distance < best.distance) best = {at, distance};
  };
  const auto approach = [&] {
    for (int i = 0; i < steps && best.distance > 0; ++i) {
      const double before = best.distance;
      const dvec2 from = best.t;
      const dvec2 step = step_to_nearest(jet(from), p, from);
      // Where the surface degenerates, at corners, a whole step may lead astray.
      for (double share = 1; share >= least_share && !(best.distance < before); share *= 0.5) {
        consider(glm::clamp(from + share * step, dvec2(0.0), dvec2(1.0)));
      }
      if (!(best.distance < before)) break;
    }
  };
  const auto is_point = [&](const dvec2& t) {
    const SourceJet j = jet(t);
    const auto [least, most] = std::minmax({glm::length(j.dx[0]), glm::length(j.dx[1])});
    return least <= collapsed * most;
  };
  for (int i = 0; i <= samples; ++i) {
    for (int k = 0; k <= samples; ++k) consider(dvec2(i, k) / double(samples));
  }
  approach();
  if (best.distance == 0 || !is_point(best.t)) return best;
  const ClosestOnSurface point = best;
  best = {};
  for (int i = 0; i < samples; ++i) {
    for (int k = 0; k < samples; ++k) consider((dvec2(i, k) + 0.5) / double(samples));
  }
  approach();
  return best.distance < point.distance ? best : point;
}

template <class Jet>
double distance_to_surface(const dvec3& p, const Jet& jet) {
  return closest_on_surface(p, jet).distance;
}

}  // namespace taut
