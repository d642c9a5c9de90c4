#pragma once

#include <array>
#include <span>

#include "taut/core/geometry.h"

namespace taut {

/// The point of least norm in the convex hull of up to four points.
struct NearestInSimplex {
  /// The sum of the carrying points times their weights, so that it lies in the convex hull but for
  /// four rounding units of the farthest point's distance.
  dvec3 point = dvec3(0.0);
  /// Unit, towards it; across the triangle where it lies in one, also if the point is the origin,
  /// and across the nearest triangle where the origin is inside. Zero where the point is the origin
  /// and lies in no triangle.
  dvec3 direction = dvec3(0.0);
  /// The points that carry it, by number, with their positive weights of sum one.
  std::array<int, 4> carrier = {-1, -1, -1, -1};
  std::array<double, 4> weight = {};
  int size = 0;
  /// The four points are a tetrahedron with the origin strictly inside, up to rounding.
  bool contains_origin = false;
};

/// Looks at all vertices, sides and faces; those of no area, up to underflow, are passed over. Of
/// those that are equally near but for rounding the one of more points carries, since its normal
/// tells the direction, unless one of fewer meets the origin exactly.
/// @pre 1 <= points.size() <= 4
NearestInSimplex nearest_in_simplex(std::span<const dvec3> points);

/// Points that carry the point of least norm in their convex hull (Wolfe 1976, "Finding the nearest
/// point in a polytope"; Gilbert, Johnson and Keerthi 1988).
class Corral {
 public:
  explicit Corral(const dvec3& point);

  /// Takes one more point, and drops those that carry nothing then.
  /// @pre the origin is not inside
  void add(const dvec3& point);
  const NearestInSimplex& nearest() const { return nearest_; }

 private:
  std::array<dvec3, 4> points_;
  NearestInSimplex nearest_;
};

}  // namespace taut
