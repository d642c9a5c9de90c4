#pragma once

#include <functional>
#include <vector>

#include "taut/bounds/scene.h"
#include "taut/bounds/support_query.h"
#include "taut/core/progress.h"
#include "taut/hull/polytope/point_hull.h"

namespace taut {

/// A supporting plane of a scene, in its frame.
struct SeenPlane {
  dvec3 n;
  double h_bound = 0;
  dvec3 point;  ///< that supports
  Contact contact;
};

/// Where a scene's hull is farthest from a polytope of its support points.
struct FarthestSupport {
  /// Of the distance of the two, proven, in the scene's frame.
  double bound = 0;
  /// The supporting plane that was seen farthest above the polytope, which touches that plane's
  /// direction with `vertex`; -1: none was seen.
  int vertex = -1;
  SeenPlane plane;
};

/// Seeks it to within a thousandth: the bound is no more than that above the distance seen, up to
/// rounding and a limit of queries.
///
/// The directions in which a vertex is highest are a cone about the normals of its facets. It is
/// cut into triangles, in which certificate.h bounds the distance by what is seen in their corners,
/// and these are bisected where that could be more than the largest distance seen anywhere. As
/// triangles get narrower the bounds tend to what is seen, with the square of their size.
///
/// `frame_points`: per point of the polytope, `planes`: per facet, for the facet's normal or one
/// that stands for it. @throws Cancelled, LimitMet
FarthestSupport farthest_support(SupportQuery& query, const PointHull& polytope,
                                 const std::vector<dvec3>& frame_points,
                                 const std::function<SeenPlane(int facet)>& plane_of,
                                 const Progress& progress);

}  // namespace taut
