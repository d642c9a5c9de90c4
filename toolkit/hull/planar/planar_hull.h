#pragma once

#include <span>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/core/stop.h"
#include "taut/hull/planar/outline_side.h"

namespace taut {

/// The outline of a convex hull in the plane.
struct PlanarHull {
  std::vector<OutlineSide> sides;  ///< counter-clockwise
  /// Every straight side and several tangents of every curved one were found to support all.
  bool verified = true;
};

/// The convex hull of points and rational Bezier curves, (w x, w y, w), of the plane.
///
/// Guarantee, where verified: no part is above a straight side by more than 1e-13, nor above the
/// tangents of a curved side. Corners are given points, ends of curves, and tangent points, which
/// solve the equations of their bitangent to rounding. Where two curves follow each other without
/// an edge there is a corner too, and where a closed curve has its ends.
///
/// Elements that coincide to within 1e-10 share a corner: it is on the curve along which the
/// outline goes on, else on the one along which it came, else it is the point of the lowest number,
/// if there is one. Of three corners within 1e-12 of a line the middle one is left out. Of
/// arcs that coincide any one is followed as far as it goes.
///
/// A straight curve counts with its two ends only. All on a segment: two corners, all in one point:
/// one corner, with straight sides. Nothing: no corner.
///
/// @pre coordinates are of size about one, weights are positive, curves have a degree of one or
/// more @throws Cancelled
PlanarHull planar_hull(std::span<const dvec2> points, std::span<const std::vector<dvec3>> curves,
                       const Stop& stop = {});

}  // namespace taut
