#pragma once

#include <vector>

#include "taut/hull/decide/pieces.h"

namespace taut {

/// By element.
struct NearlyStraight {
  std::vector<bool> edges;
  std::vector<bool> ends;  ///< what stands for these: vertices, and pieces of edges
};

/// Which pieces of edges lie within `budget` of the straight segment between two points that
/// support by themselves, together with all that they go on into up to where they end, in vertices
/// or in pieces that bend: edges, or parts of them, that were straight before their numbers were
/// rounded. They support together with one of these, if at all.
NearlyStraight nearly_straight(const MapPieces& pieces, double budget);

}  // namespace taut
