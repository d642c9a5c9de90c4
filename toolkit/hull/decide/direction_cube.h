#pragma once

#include <array>

#include "taut/core/geometry.h"

namespace taut {

/// Of a face of the cube of directions: its middle, and the axes of its cells. The cube is turned
/// out of all that models are aligned with.
struct FaceAxes {
  dvec3 own, first, second;
};

/// @pre 0 <= face < 6
FaceAxes face_axes(int face);

/// Where a direction meets the cube, on a grid that has the corners of all cells: one place for
/// those that are computed from several faces.
std::array<long long, 3> place_on_cube(const dvec3& d);

}  // namespace taut
