#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "taut/core/geometry.h"

namespace taut {

/// Distances to the nearest of a set of points, by a search along x.
class NearestPoint {
 public:
  explicit NearestPoint(std::vector<dvec3> points) : points_(std::move(points)) {
    std::sort(points_.begin(), points_.end(),
              [](const dvec3& a, const dvec3& b) { return a.x < b.x; });
  }

  /// Infinite if there are no points.
  double distance(const dvec3& p) const {
    double best = std::numeric_limits<double>::infinity();
    const auto start = std::lower_bound(points_.begin(), points_.end(), p,
                                        [](const dvec3& a, const dvec3& b) { return a.x < b.x; });
    for (auto at = start; at != points_.end() && at->x - p.x < best; ++at) {
      best = std::min(best, glm::distance(*at, p));
    }
    for (auto at = start; at != points_.begin() && p.x - (at - 1)->x < best; --at) {
      best = std::min(best, glm::distance(*(at - 1), p));
    }
    return best;
  }

 private:
  std::vector<dvec3> points_;
};

}  // namespace taut
