#pragma once

#include <vector>

#include "taut/hull/decide/pieces.h"

namespace taut {

/// By element, and the round shapes that elements make.
struct Likenesses {
  std::vector<Likeness> of_elements;
  std::vector<RoundShape> rounds;
};

/// Which elements are translates of each other, and which lie in the convex hull of others, to
/// within `budget`: of copies in a row those between, of equal ones all but the first, of points
/// those that are no corners of their hull; and what an ellipsoid or the disc of an ellipse holds
/// (RoundShape), or the convex hull of two. Such an element supports only together with others that
/// are not of these.
///
/// Two elements of one kind are translates if their control points are, within the budget, and
/// their weights are the same but for a factor; so are two ellipses or ellipsoids, whatever the
/// parameters of their elements. A patch or piece counts only together with those that it goes on
/// into smoothly. Of more translates than translate_limit none is told.
Likenesses find_translates(const MapPieces& pieces, double budget);

/// The work grows with their number's square.
inline constexpr std::size_t translate_limit = 4096;

}  // namespace taut
