#pragma once

#include "taut/bounds/scene.h"
#include "taut/core/progress.h"
#include "taut/hull/hull_mesh.h"

namespace taut {

/// How convex_hull works and how close it comes.
struct HullOptions {
  /// Largest distance of the mesh from the true hull, in model units. Must be positive.
  double tolerance = 0;
  /// Threads to use, 0 for all. The result does not depend on it.
  int threads = 0;
  /// Vertices after which refinement gives up (NotConverged is thrown with what was reached). Each
  /// takes about 700 bytes meanwhile.
  int max_vertices = 4'000'000;
  Progress progress;
};

/// What the computation took.
struct HullStatistics {
  long support_queries = 0;
  long newton_iterations = 0;
  double seconds_sample = 0;
  double seconds_mesh = 0;
};

/// A convex hull with its certificate.
struct Hull {
  /// 3 for a solid. (Lower dimensions are refused with InvalidInput.)
  int dimension = 3;
  HullMesh mesh;
  /// Proven upper bound of the Hausdorff distance between the mesh and the true convex hull, in
  /// model units, rounding included.
  double distance_bound = 0;
  HullStatistics statistics;
};

/// Convex hull of a scene as a polytope of points sampled on the model (method `sampled`).
///
/// The mesh's vertices are support points of the model, rounded to double; the mesh is closed and
/// exactly convex (every orientation predicate holds on the coordinates as stored), has no face of
/// zero area, and its Hausdorff distance from the true hull is at most distance_bound <=
/// options.tolerance. Same bits for any number of threads. Safe to call concurrently.
///
/// @throws InvalidInput if the tolerance is not positive or the scene is flat, NotConverged if the
/// tolerance is below what double precision can certify for this scene (about 1e-12 of its size)
/// or max_vertices was met, Cancelled
Hull sampled_hull(const Scene& scene, const HullOptions& options);

}  // namespace taut
