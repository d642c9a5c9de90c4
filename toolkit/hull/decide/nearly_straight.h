#pragma once

#include <vector>

#include "taut/hull/decide/pieces.h"

namespace taut {

/// By element.
struct NearlyStraight {
  std::vector<bool> edges;
  std::vector<bool> ends;  ///< vertices that stand for these
};

/// Which pieces of edges lie within `budget` of the straight segment between two vertices that
/// support by themselves, together with all that they go on into up to the vertices where they end:
/// edges that were straight before their numbers were rounded. They support together with a vertex,
/// if at all.
NearlyStraight nearly_straight(const MapPieces& pieces, double budget);

}  // namespace taut
