#pragma once

#include <vector>

#include "taut/containment/placed_surface.h"

namespace taut {

/// Counts how often rays cross a placed surface, exactly but for rounding that it detects.
///
/// A patch is crossed where the two coordinates across the ray vanish. Their Bernstein coefficients
/// exclude cells; a cell on which the preconditioned derivatives are diagonally dominant has at
/// most one crossing, which Newton's method finds; others are split. A crossing too near to a
/// patch's side for rounding, and cracks between patches, or to a direction that is tangent there,
/// is a doubt. Triangles are decided by exact predicates.
///
/// Holds scratch memory, so use one object a thread; the surface must outlive it.
class RayCrossings {
 public:
  explicit RayCrossings(const PlacedSurface& surface) : surface_(surface) {}

  /// Whether the ray from x crosses the surface of each body, or of one alone, an odd number of
  /// times, in odd(). False where there is a doubt; then another direction is to be tried. @pre
  /// |direction| = 1 within rounding, x within a few sizes of the frame and not on the surface
  bool count(const dvec3& x, const dvec3& direction, int body = -1);
  const std::vector<char>& odd() const { return odd_; }

 private:
  struct Cell {
    double u, v, size_u, size_v;
    int depth;
    std::size_t slot;  ///< of the nets of the two coordinates across and the one along, one by one
  };
  enum class Answer { none, one, doubt, split };

  bool cross(const PlacedPatch& patch);
  bool cross(const PlacedTriangle& triangle);
  Answer look(const PlacedPatch& patch, const Cell& cell);
  void split(const PlacedPatch& patch, const Cell& cell);

  const PlacedSurface& surface_;
  dvec3 x_ = dvec3(0.0);
  dvec3 end_ = dvec3(0.0);  ///< a point of the ray beyond the surface
  dvec3 along_ = dvec3(0.0);
  std::array<dvec3, 2> across_ = {dvec3(0.0), dvec3(0.0)};
  std::vector<char> odd_;
  std::vector<Cell> stack_;
  std::vector<double> nets_;
};

}  // namespace taut
