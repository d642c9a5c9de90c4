#pragma once

#include "taut/bounds/scene.h"
#include "taut/core/progress.h"
#include "taut/surface/polygon_mesh.h"

namespace taut {

/// How hulls are checked.
struct VerifyOptions {
  /// Random directions, besides those of all facets and vertices.
  int random_directions = 10'000;
  unsigned seed = 1;  ///< of the random directions
  int threads = 0;    ///< 0: all
  Progress progress;  ///< told of the share done, and asked to stop
};

/// What verify() found; lengths in model units.
struct Verification {
  /// Every edge has exactly two polygons.
  bool closed = false;
  /// Every edge has at most two polygons and the polygons about every vertex form one fan.
  bool manifold = false;
  /// The two polygons at an edge run through it in opposite directions, and the volume is not
  /// negative.
  bool oriented = false;
  /// One connected surface of Euler characteristic 2, as the boundary of a convex body is.
  bool topological_sphere = false;
  /// By exact predicates: every polygon is planar, and no corner of it lies above the plane of a
  /// neighbour, on a closed topological sphere (for which that is convexity).
  bool convex = false;
  /// No polygon has all its corners on one line, by exact predicates.
  bool no_zero_area = false;
  /// Largest distance of a vertex above the plane of any polygon, rounded.
  double largest_violation = 0;
  /// max over the directions tried of h_model - h_mesh: how far the model reaches outside.
  double model_outside = 0;
  /// max over the directions tried of h_mesh - h_model: how far the mesh reaches outside the
  /// model's hull.
  double mesh_outside = 0;
  int directions = 0;  ///< that were tried

  /// The mesh is the model's hull within the tolerance. Files that hold rounded coordinates are not
  /// exactly convex; they pass if they are convex within the tolerance too.
  bool is_hull(double tolerance) const {
    return closed && manifold && oriented && topological_sphere && largest_violation <= tolerance &&
           model_outside <= tolerance && mesh_outside <= tolerance;
  }
};

/// Checks any mesh against a model's convex hull: topology, exact convexity, and both one-sided
/// distances measured by support functions in the directions of all facets and vertices and in
/// random ones. Up to two points without polygons are a point or a segment, in perfect order. A
/// measurement, hence a lower bound of the true distances.
Verification verify(const PolygonMesh& mesh, const Scene& scene, const VerifyOptions& options = {});

}  // namespace taut
