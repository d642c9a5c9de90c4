#include "taut/subdivision/point_hull_distance.h"

#include <algorithm>
#include <vector>

#include "taut/core/nearest_in_simplex.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// From the point p + x towards q it is nearer to p, by more than rounding.
bool descends(const dvec3& p, const dvec3& x, const dvec3& q) {
  const double rounding = 16 * rounding_unit * glm::length(x) * glm::distance(p, q);
  return glm::dot(q - p, x) < glm::dot(x, x) - rounding;
}

}  // namespace

double PointHullDistance::bound(const dvec3& p, double enough) {
  constexpr int step_limit = 64;
  constexpr std::size_t most_recent = 24;
  const dvec3 nearest = points_.nearest(p);
  std::vector<dvec3> untried = recent_;  // each once: it may seem to descend by rounding
  std::erase(untried, nearest);
  Corral corral(nearest - p);
  dvec3 x = corral.nearest().point;
  const auto rounding_of = [&](const dvec3& q) {
    return 16 * rounding_unit * (glm::length(p) + glm::length(q));
  };
  double rounding = rounding_of(nearest);
  double best = glm::length(x);
  for (int step = 0; step < step_limit && best > 0 && best + rounding > enough; ++step) {
    const auto lowest = std::min_element(
        untried.begin(), untried.end(),
        [&](const dvec3& a, const dvec3& b) { return glm::dot(a, x) < glm::dot(b, x); });
    const bool known = lowest != untried.end() && descends(p, x, *lowest);
    const dvec3 q = known ? *lowest : points_.lowest(x);
    if (!descends(p, x, q)) break;
    if (known) {
      untried.erase(lowest);
    } else {
      std::erase(recent_, q);
      if (recent_.size() == most_recent) recent_.erase(recent_.begin());
      recent_.push_back(q);
    }
    Corral next = corral;
    next.add(q - p);
    if (glm::length(next.nearest().point) < best) {
      corral = next;
      x = corral.nearest().point;
      best = glm::length(x);
      rounding = std::max(rounding, rounding_of(q));
      if (corral.nearest().contains_origin) break;
    } else if (!known) {
      break;
    }
  }
  return best + rounding;
}

}  // namespace taut
