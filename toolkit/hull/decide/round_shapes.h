#pragma once

#include <vector>

#include "taut/hull/decide/pieces.h"
#include "taut/hull/decide/round_shape.h"

namespace taut {

/// Elements that go on into each other smoothly, without a border, and lie on an ellipse or an
/// ellipsoid to within the distance, as is proven by the coefficients of the square of the norm of
/// their points where the shape is the unit sphere. They cover it: a ray from its centre meets
/// them an odd number of times, so every one does.
std::vector<RoundShape> round_shapes(const MapPieces& pieces, double distance);

}  // namespace taut
