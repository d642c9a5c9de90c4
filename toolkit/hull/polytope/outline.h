#pragma once

#include <span>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/hull/polytope/rounding_width.h"

namespace taut {

/// Points of a plane in space as they are seen along a coordinate axis: two of their coordinates,
/// so that nothing is rounded and exact predicates in the view answer for the plane itself.
class PlaneView {
 public:
  /// The view in which a, b, c run counter-clockwise, along the axis that foreshortens least.
  /// @pre a, b, c are not collinear (exactly)
  PlaneView(const dvec3& a, const dvec3& b, const dvec3& c);

  /// The point as it is seen.
  dvec2 operator()(const dvec3& p) const { return {p[first_], p[second_]}; }

 private:
  int first_ = 0;
  int second_ = 1;
};

/// The corners of the points' convex hull in the view, counter-clockwise, by number; two where all
/// points are on a line, one where all are equal. Exact; no corner lies on a side.
///
/// Source: Andrew 1979, "Another efficient algorithm for convex hulls in two dimensions".
std::vector<int> convex_outline(std::span<const dvec3> points, const PlaneView& view);

/// A convex polygon with fewer corners: every one that is left out lies within the width of a side.
/// Two corners are left where all lie within the width of a line. @pre at least one corner
std::vector<int> simplified_outline(const std::vector<int>& outline, std::span<const dvec3> points,
                                    const RoundingWidth& width);

}  // namespace taut
