#pragma once

#include "taut/surface/bezier.h"

namespace taut {

/// @name How far a surface is from one that is ruled
/// Upper bounds.
/// @{

/// Of a patch's points from the segments between the ends, for the same value of the other
/// parameter, of its lines along this one. By how much weights miss being products of two factors
/// counts as well; infinity where that is all of one.
double distance_from_ruled(const BezierPatch& patch, Direction direction);

/// Mean square of the lengths of these segments, over the control points of the sides.
double square_of_lines(const BezierPatch& patch, Direction direction);

/// How near a patch is to a cylinder over some curve, whatever its parameters.
struct NearCylinder {
  dvec3 along = dvec3(0.0);  ///< direction of its lines, a unit vector
  double length = 0;         ///< the patch's extent along them
  double turned = infinity;  ///< sine of the angles between them and tangent planes
  /// Of its points from segments between points of its border.
  double distance = infinity;
};

/// None that is near where weights differ or the patch turns by a right angle or more.
NearCylinder near_cylinder(const BezierPatch& patch);
/// @}

}  // namespace taut
