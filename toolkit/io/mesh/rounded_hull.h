#pragma once

#include "taut/hull/result/hull_mesh.h"

namespace taut {

/// The float nearest to a number that is not beyond the floats. By way of memory: GCC 12 leaves the
/// rounding out where it converts two numbers to float and back at once.
inline double nearest_float(double x) {
  const volatile float nearest = static_cast<float>(x);
  return double{nearest};
}

/// A hull as floats hold it.
struct RoundedHull {
  /// The convex hull of the rounded vertices, unlabelled: closed, exactly convex, no face of zero
  /// area. Without faces where they do not span a plane.
  HullMesh mesh;
  /// The largest distance that a vertex was moved, rounded up. Neither hull has a point farther
  /// than that from the other.
  double rounding = 0;
};

/// Rounds the vertices to the nearest floats and builds their hull anew: rounding takes vertices
/// below planes of others, folds flat faces and lets short edges collapse.
/// @throws InvalidInput if a coordinate is beyond the floats
RoundedHull rounded_hull(const HullMesh& mesh);

}  // namespace taut
