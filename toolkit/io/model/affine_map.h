#pragma once

#include "taut/surface/model.h"

namespace taut {

/// x -> linear * x + translation.
struct AffineMap {
  dmat3 linear = dmat3(1.0);
  dvec3 translation = dvec3(0.0);
};

/// The linear part is orthogonal with determinant 1 within rotation_tolerance.
bool is_rigid(const AffineMap& map);
/// The image of space is flat: the determinant is zero, exactly. @pre all entries are finite
bool is_singular(const AffineMap& map);

/// The image of a part. Faces and edges keep their parameters and loops.
/// @pre the part is not connected @throws InvalidInput if the image is not finite
Part transformed(const Part& part, const AffineMap& map);

}  // namespace taut
