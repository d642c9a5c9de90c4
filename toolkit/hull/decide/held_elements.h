#pragma once

#include <vector>

#include "taut/hull/decide/pieces.h"

namespace taut {

/// Covers the elements that a round shape holds to within the budget, those of no shape that is
/// covered, and then what the convex hull of two shapes holds. What holds others stands for them,
/// and is held by none. Returns which elements are covered so.
/// @pre one likeness an element
std::vector<bool> hold_by_rounds(const MapPieces& pieces, const std::vector<RoundShape>& rounds,
                                 double budget, std::vector<Likeness>& likenesses);

/// Upper bound of how far the element reaches out of what the shape encloses, rounding included.
double distance_outside(const MapPieces& pieces, int element, const RoundShape& round);

}  // namespace taut
