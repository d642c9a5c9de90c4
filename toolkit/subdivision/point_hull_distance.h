#pragma once

#include <utility>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/subdivision/point_tree.h"

namespace taut {

/// Distances of points from the convex hull of others. Those that recent searches among all have
/// found are looked at first: points that are asked for in turn are near each other mostly. Bounds
/// depend on what was asked before, by rounding and by what is enough; not for several threads.
class PointHullDistance {
 public:
  /// @pre not empty, coordinates are finite
  explicit PointHullDistance(std::vector<dvec3> points) : points_(std::move(points)) {}

  /// Upper bound of the distance, that of a point of the hull that is nearest up to rounding (Wolfe
  /// 1976, "Finding the nearest point in a polytope"); no nearer one is sought once it is no more
  /// than `enough`.
  double bound(const dvec3& p, double enough = 0);

 private:
  PointTree points_;
  std::vector<dvec3> recent_;  // found, the oldest first
};

}  // namespace taut
