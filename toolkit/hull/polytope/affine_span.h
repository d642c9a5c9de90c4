#pragma once

#include <array>
#include <span>
#include <vector>

#include "taut/core/geometry.h"

namespace taut {

/// What points span if deviations of up to a width are allowed for.
struct AffineSpan {
  /// Of a point, line, plane or all of space.
  int dimension = 0;
  /// dimension + 1 of the points, by number, that span it: spread far, though not the farthest.
  std::array<int, 4> witnesses = {0, -1, -1, -1};
  /// Along the line; in the plane.
  dvec3 line = dvec3(0.0);
  /// Of the plane; in space, of the first three witnesses' plane.
  dvec3 normal = dvec3(0.0);
};

/// The span of points, to within rounding. Where it is less than space, the points deviate from the
/// witnesses' point, line or plane by less than the width, to within rounding of their distances.
/// @pre there are points; their differences' squares neither over- nor underflow
AffineSpan affine_span(std::span<const dvec3> points, double width);

/// Unit directions across the span in which points that leave it must reach out: eight about a
/// line, two across a plane, none in space; 26 about a point.
std::vector<dvec3> directions_across(const AffineSpan& span);

}  // namespace taut
