#pragma once

#include "taut/core/geometry.h"
#include "taut/subdivision/point_tree.h"

namespace taut {

/// Upper bound of the distance of a point from the convex hull of others, that of a point of it
/// that is nearest up to rounding (Wolfe 1976, "Finding the nearest point in a polytope"); no
/// nearer one is sought once it is no more than `enough`.
/// @pre not empty
double distance_from_hull_bound(const dvec3& p, const PointTree& points, double enough = 0);

}  // namespace taut
