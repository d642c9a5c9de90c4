#pragma once

#include <limits>

namespace taut {

/// Largest relative error of one rounded operation on doubles, 2^-53.
inline constexpr double rounding_unit = std::numeric_limits<double>::epsilon() / 2;

/// Two surfaces that meet along a common border are joined smoothly (G1) if their tangent planes
/// differ by at most this angle everywhere along it, in radians (0.057 degrees).
///
/// CAD kernels write borders that agree to about 1e-6 of the model and tangents to 1e-4 .. 1e-3
/// radians; a crease that a designer means is a hundred times larger. An error in this choice
/// costs accuracy nowhere: it decides only whether a border is listed as an edge.
inline constexpr double smooth_join_angle = 1e-3;

/// Two border points are the same if they differ by at most this fraction of their part's
/// diagonal. Exchanged borders agree to about that; ten times more would join the two sides of thin
/// parts and take short sides of long ones for points.
inline constexpr double join_distance = 1e-7;

/// Largest entry by which R^T R of a rotation may differ from the identity, and its determinant
/// from one. Files write matrices to nine digits or more; an error of this size scales a model by
/// half of it, invisibly in what the files themselves promise.
inline constexpr double rotation_tolerance = 1e-9;

/// A support query stops when nothing can exceed the value found by more than this fraction of the
/// scene's size (2^-43, about 1.1e-13), rounding apart.
///
/// Contact along a whole curve in general position needs cells of the size of the slack's cube
/// root; a smaller one would buy no accuracy, since the value itself is polished by Newton steps to
/// the last bits.
inline constexpr double support_slack = 1024 * rounding_unit;

/// Highest degree of a curve or surface in either direction. Exchange formats in use stop at 25.
inline constexpr int max_degree = 31;

}  // namespace taut
