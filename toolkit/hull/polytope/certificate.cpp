#include "taut/hull/polytope/certificate.h"

#include <algorithm>

#include "taut/core/nearest_in_simplex.h"
#include "taut/core/tolerances.h"

namespace taut {

double cone_depth(std::span<const dvec3> directions) {
  constexpr double narrow = 0.95;
  constexpr int iterations = 64;
  // The lowest direction over a unit vector x bounds the distance from below.
  const auto lowest = [&](const dvec3& x) {
    return *std::min_element(
        directions.begin(), directions.end(),
        [&](const dvec3& a, const dvec3& b) { return glm::dot(a, x) < glm::dot(b, x); });
  };
  struct Bound {
    dvec3 direction;
    double bound;
  };
  const auto bound_at = [&](const dvec3& x) -> Bound {
    const dvec3 w = lowest(x);
    return {w, glm::dot(w, x) - 8 * rounding_unit};
  };
  if (directions.empty()) return 1;
  dvec3 mean(0.0);
  for (const dvec3& d : directions) mean += d;
  mean = unit(mean);
  double best = bound_at(mean).bound;
  if (best > narrow) return best;

  Corral corral(directions.front());
  for (int k = 0; k < iterations; ++k) {
    const double length = glm::length(corral.nearest().point);
    const auto [w, bound] = bound_at(corral.nearest().direction);
    best = std::max(best, bound);
    if (corral.nearest().contains_origin || length - bound < 0.01 * length) break;
    corral.add(w);
    if (glm::length(corral.nearest().point) < length) continue;
    // Rounding is reached.
    best = std::max(best, bound_at(corral.nearest().direction).bound);
    break;
  }
  return std::min(best, 1.0);
}

}  // namespace taut
