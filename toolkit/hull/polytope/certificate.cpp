#include "taut/hull/polytope/certificate.h"

#include <algorithm>
#include <utility>

#include "taut/core/nearest_in_simplex.h"
#include "taut/core/tolerances.h"

namespace taut {

ConeDepth deepest_axis(std::span<const dvec3> directions) {
  constexpr double narrow = 0.95;
  constexpr int iterations = 64;
  if (directions.empty()) return {};
  // The lowest direction over a unit vector x bounds the distance from below.
  const auto lowest = [&](const dvec3& x) {
    return *std::min_element(
        directions.begin(), directions.end(),
        [&](const dvec3& a, const dvec3& b) { return glm::dot(a, x) < glm::dot(b, x); });
  };
  const auto bound_over = [](const dvec3& w, const dvec3& x) {
    return glm::dot(w, x) - 8 * rounding_unit;
  };
  dvec3 mean(0.0);
  for (const dvec3& d : directions) mean += d;
  mean = unit(mean);
  ConeDepth best{bound_over(lowest(mean), mean), mean};
  if (best.depth > narrow) return best;

  Corral corral(directions.front());
  // The direction that is lowest over the nearest point, and its bound.
  const auto next = [&]() -> std::pair<dvec3, double> {
    const dvec3 x = corral.nearest().direction;
    const dvec3 w = lowest(x);
    const double bound = bound_over(w, x);
    if (bound > best.depth) best = {bound, x};
    return {w, bound};
  };
  for (int k = 0; k < iterations; ++k) {
    const double length = glm::length(corral.nearest().point);
    const auto [w, bound] = next();
    if (corral.nearest().contains_origin || length - bound < 0.01 * length) break;
    corral.add(w);
    if (glm::length(corral.nearest().point) < length) continue;
    next();  // rounding is reached
    break;
  }
  best.depth = std::min(best.depth, 1.0);
  return best;
}

double cone_depth(std::span<const dvec3> directions) { return deepest_axis(directions).depth; }

}  // namespace taut
