#pragma once

#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// Raises the bounds of arcs and facets (ArcPiece::tolerant, HullFace::tolerant) to what pieces
/// miss each other by where they meet, and corners of facets by where they end there; and to `tie`,
/// up to which heights tie, where rulings turn back.
void bound_joints(HullBoundary& boundary, double tie);

}  // namespace taut
