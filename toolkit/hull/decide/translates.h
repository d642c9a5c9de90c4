#pragma once

#include <vector>

#include "taut/hull/decide/pieces.h"

namespace taut {

/// Which elements lie in the convex hull of their own translates, to within `budget`: of copies in
/// a row those between, of equal ones all but the first, of points those that are no corners of
/// their hull. Such an element supports only together with others that are not of these.
///
/// Two elements of one kind are translates if their control points are, within the budget, and
/// their weights are the same but for a factor. A patch or piece counts only together with those
/// that it goes on into smoothly. Of more translates than translate_limit none is told.
std::vector<bool> covered_translates(const MapPieces& pieces, double budget);

/// The work grows with their number's square.
inline constexpr std::size_t translate_limit = 4096;

}  // namespace taut
