#pragma once

#include <optional>
#include <vector>

#include "taut/bounds/scene.h"
#include "taut/core/progress.h"
#include "taut/hull/result/hull_document.h"
#include "taut/surface/polygon_mesh.h"

namespace taut::tool {

/// What points of a hull and of its model say of each other, in model units.
struct ContainedSamples {
  /// Points of the hull to check, and how far the farthest of them is outside of the model's hull
  /// and is proven to be inside of it, beyond the bound that its face states. The distances are
  /// those to the exact hull.
  long hull_points = 0;
  double hull_outside = 0;
  double hull_inside = 0;
  /// Points of the model, and how far the farthest is outside of the mesh; none where the mesh is
  /// not closed, or exact.
  std::optional<long> model_points;
  double model_outside = 0;
};

/// Every vertex of the mesh against the exact hull of the scene, and points spread over all
/// patches, edges and vertices of the model against the mesh. Convex sets being what they are, the
/// first is the distance by which the mesh reaches outside, known to `accuracy` (in model units).
ContainedSamples contained_samples(const PolygonMesh& mesh, const Scene& scene, double accuracy,
                                   int threads, const Progress& progress);

/// Every point of curves, rulings and facets of an exact hull against the hull of the scene, on
/// whose boundary they are to lie.
ContainedSamples contained_samples(const HullDocument& hull, const Scene& scene, double accuracy,
                                   int threads, const Progress& progress);

}  // namespace taut::tool
