#pragma once

#include "taut/surface/model.h"

namespace taut {

/// A place in one of a part's patches.
struct PatchPlace {
  int patch = -1;
  dvec2 uv = dvec2(0.0);
};

/// A piece's point at t as a place on the first patch that has the piece along a border; patch -1
/// if none has. A seam is no source of contacts itself: that patch's face is.
PatchPlace beside_piece(const Part& part, int piece, double t);

}  // namespace taut
