#include "taut/hull/trace/map_crossings.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

/// Share of a cell's size by which places along a great arc follow each other.
constexpr double walking_step = 0.25;

}  // namespace

MapCrossings::MapCrossings(const DirectionMap& map)
    : map_(map), tree_(map.cells), crossed_(map.cells.size(), false) {}

void MapCrossings::add(const SeparatingArc& arc) {
  for (const ArcPiece& piece : arc.pieces) {
    for (std::size_t k = 1; k < piece.rulings.size(); ++k) {
      add(piece.rulings[k - 1].n, piece.rulings[k].n);
    }
  }
}

/// The size of a cell is about that of its image on the sphere, no less than half of it.
void MapCrossings::add(const dvec3& from, const dvec3& to) {
  int deepest = 0;
  for (const dvec3& n : {from, to}) {
    const int cell = tree_.at(n);
    if (cell < 0) continue;
    crossed_[std::size_t(cell)] = true;
    deepest = std::max(deepest, map_.cells[std::size_t(cell)].level);
  }
  if (glm::distance(from, to) <= walking_step * std::ldexp(1.0, -deepest)) return;
  const dvec3 middle = unit(from + to);
  add(from, middle);
  add(middle, to);
}

}  // namespace taut
