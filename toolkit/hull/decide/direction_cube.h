#pragma once

#include "taut/core/geometry.h"

namespace taut {

/// Of a face of the cube of directions: its middle, and the axes of its cells. The cube is turned
/// out of all that models are aligned with.
struct FaceAxes {
  dvec3 own, first, second;
};

/// @pre 0 <= face < 6
FaceAxes face_axes(int face);

}  // namespace taut
