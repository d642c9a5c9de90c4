#pragma once

#include <vector>

#include "taut/core/progress.h"
#include "taut/hull/polytope/point_hull.h"
#include "taut/hull/polytope/rounding_width.h"

namespace taut {

/// The convex hull of some of a hull's vertices.
struct CoarseHull {
  PointHull hull;
  /// Per point of `hull`: its number in the original.
  std::vector<int> original;
  /// Bound of the distance of the two hulls.
  double distance_bound = 0;
};

/// Whether dropping vertices could simplify the hull: one of its edges is so nearly flat that the
/// one facet's far corner lies below the other's plane by less than the width, but not in it.
bool has_nearly_flat_edges(const PointHull& hull, const RoundingWidth& width);

/// Neighbours of vertices that coarse_hull() may have to look at: for each facet, those of the
/// vertex that has most. The tip of a cone of a hundred thousand sides is not worth it.
double coarsening_work(const PointHull& hull);

/// The hull of some vertices that leave none higher than the width above any facet, to within
/// rounding: hardly more than the corners that the original would have had without noise of that
/// width. `spanning` are four of the original's points that span space by more than the width.
/// @pre hull.dimension() == 3 @throws Cancelled
CoarseHull coarse_hull(const PointHull& hull, const std::array<int, 4>& spanning,
                       const RoundingWidth& width, const Progress& progress);

}  // namespace taut
