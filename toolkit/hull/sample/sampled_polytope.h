#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/bounds/scene.h"
#include "taut/hull/polytope/point_hull.h"
#include "taut/hull/result/hull_options.h"
#include "taut/hull/result/hull_statistics.h"
#include "taut/hull/result/sample.h"
#include "taut/hull/sample/edge_constraints.h"

namespace taut {

/// The convex hull of support points of a scene, with the certificate of its distance from the
/// scene's hull (certificate.h).
struct SampledPolytope {
  /// Its points are model coordinates times the scene's scale, a power of two, so that its
  /// decisions hold for the coordinates as stored and never leave the range of doubles.
  PointHull hull;
  std::vector<Sample> samples;  ///< per point of the hull
  /// Per facet place, in the scene's frame: how far the model reaches above the facet's corners.
  std::vector<double> gaps;
  /// Per point, in model units: what the gaps about it bound the distance by.
  std::vector<double> vertex_bounds;
  /// Proven bound of the distance from the scene's hull, in model units, rounding included.
  double distance_bound = 0;
  /// Why the tolerance is not reached, if so.
  std::optional<std::string> failure;
  /// The limit that was met before it was (Limits::text), if so.
  std::optional<std::string> limit;
  HullStatistics statistics;  ///< what it took
};

/// Grows the hull of samples by support points, until its distance from the scene's hull is
/// certified to be within the tolerance (in model units), or as far as the budget of vertices goes,
/// where the tolerance may be 0: none. The samples, no more than that, keep their numbers. Before a
/// point hides an edge that is to stay, the edge's middle is inserted, and so are in the end those
/// of wanted edges that others hide, until all are there or have no middle.
///
/// Where a limit of the progress is met once a distance is certified, the polytope is the one that
/// is there, with that distance.
/// @pre the points, per sample in model coordinates, span space @throws Cancelled
SampledPolytope sampled_polytope(const Scene& scene, const HullOptions& options, double tolerance,
                                 std::vector<Sample> samples, const std::vector<dvec3>& points,
                                 EdgeConstraints* constraints = nullptr);

}  // namespace taut
