#include "taut/surface/beside_piece.h"

namespace taut {

PatchPlace beside_piece(const Part& part, int piece, double t) {
  for (std::size_t p = 0; p < part.patches().size(); ++p) {
    for (const Side side : all_sides) {
      const Border& border = part.patches()[p].borders[std::size_t(side)];
      if (border.piece != piece) continue;
      return {int(p), on_side(side, border.piece_reversed ? 1 - t : t)};
    }
  }
  return {};
}

}  // namespace taut
