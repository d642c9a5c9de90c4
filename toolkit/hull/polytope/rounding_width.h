#pragma once

#include <algorithm>
#include <span>

#include "taut/core/geometry.h"

namespace taut {

/// How far rounding may have moved points: half the axes, along those of the coordinates, of an
/// ellipsoid about each.
struct RoundingWidth {
  dvec3 half_axes{0.0};  ///< along x, y and z, not negative

  RoundingWidth() = default;
  /// The same in all directions.
  RoundingWidth(double width) : half_axes(width) {}  // NOLINT(google-explicit-constructor)

  /// In the direction of a unit vector.
  double along(const dvec3& n) const { return glm::length(half_axes * n); }
  /// In any direction.
  double largest() const { return std::max({half_axes.x, half_axes.y, half_axes.z}); }
};

/// The width along those axes in which some coordinate has digits that small, none along others:
/// numbers that are all multiples of a power of two above the width have not been rounded by it.
/// @pre width >= 0
RoundingWidth rounding_width(std::span<const dvec3> points, double width);

}  // namespace taut
