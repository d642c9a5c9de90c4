#pragma once

#include <array>
#include <cstddef>

namespace taut {

class MapPiece;

/// Four numbers, one for each corner of a cell of directions.
using Corners = std::array<double, 4>;

/// What one piece is to one cell of directions d, with heights (x - q) . d over a point q.
struct SeenPiece {
  const MapPiece* piece = nullptr;
  std::size_t values = 0;  ///< of the control points: first index into CellView's
  Corners top = {};        ///< upper bounds of the heights over the piece, by corner
  Corners low = {};        ///< lower bounds
};

}  // namespace taut
