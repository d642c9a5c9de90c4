#pragma once

#include <optional>

#include "taut/core/geometry.h"
#include "taut/envelope/cull/concave_patch.h"

namespace taut {

/// The paraboloid that osculates a surface at a point, by coordinates about that point in the plane
/// normal to an axis: the surface falls below its tangent plane by half the square of the distance
/// in these coordinates, to second order.
class OsculatingParaboloid {
 public:
  /// None if the surface does not fall to all sides, away from the axis. Of a stand-in, distances
  /// count.
  static std::optional<OsculatingParaboloid> about(const ConcavePatch& patch, const dvec2& p,
                                                   const dvec3& axis);

  dvec2 operator()(const dvec3& p) const {
    return {glm::dot(p - center_, x_), glm::dot(p - center_, y_)};
  }
  /// The step in the surface's parameters, to first order.
  dvec2 step(const dvec2& to) const;

 private:
  dvec3 center_, x_, y_;
  double uu_ = 0, uv_ = 0, vv_ = 0;  // of the map of the surface's parameters
};

}  // namespace taut
