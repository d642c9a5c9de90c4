#pragma once

#include "taut/hull/result/hull_mesh.h"

namespace taut {

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
