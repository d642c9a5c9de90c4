#pragma once

#include "taut/surface/bezier.h"

namespace taut {

/// @name Where a surface or curve is straight, up to the rounding of its control points
/// The tolerance is ruled_rounding of the largest coordinate (and of the largest weight).
/// @{

/// The curve lies on a line. So does one that is a single point.
bool is_straight(const BezierCurve& curve);

/// For every value of the other parameter the patch is a straight segment, or a point, along this
/// one: its homogeneous control points are affine in it. Raising the degree changes nothing.
bool is_ruled(const BezierPatch& patch, Direction direction);

/// The Gauss curvature vanishes everywhere: the numerator of it does where it is looked at, which
/// is at as many places as determine it. The surface is immersed, but for its border: through all
/// of its points run straight segments that end on the border (Hartman and Nirenberg 1959).
bool is_developable(const BezierPatch& patch);

/// All control points lie in one plane.
bool is_plane(const BezierPatch& patch);
/// The patch, which lies in a plane, turns over somewhere inside, by places on a grid: it reaches
/// beyond its border there. @pre is_plane
bool is_folded(const BezierPatch& patch);
/// @}

/// Control points of the curve u = s (direction u) or v = s of the patch.
BezierCurve parameter_curve(const BezierPatch& patch, Direction direction, double s);

/// Largest absolute coordinate of the Euclidean control points.
double largest_coordinate(const std::vector<dvec4>& points);

/// @name How far points are from where they would be straight
/// Upper bounds.
/// @{

/// Of a curve's control points from the segment between its ends.
double distance_from_segment(const BezierCurve& curve);

/// Of its control points from a plane.
double distance_from_plane(const BezierPatch& patch);
/// @}

}  // namespace taut
