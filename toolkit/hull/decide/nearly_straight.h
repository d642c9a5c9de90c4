#pragma once

#include <vector>

#include "taut/hull/decide/pieces.h"

namespace taut {

/// Which pieces of edges lie within `budget` of the straight segment between two vertices, together
/// with all that they go on into on the way: edges that were straight before their numbers were
/// rounded. They support together with a vertex, if at all.
///
/// `covered`: elements that others stand for; such vertices do not count.
std::vector<bool> nearly_straight(const MapPieces& pieces, const std::vector<bool>& covered,
                                  double budget);

}  // namespace taut
