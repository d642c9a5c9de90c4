#include "taut/hull/trace/map_crossings.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

/// Share of a cell's size by which places along a great arc follow each other.
constexpr double walking_step = 0.25;

}  // namespace

MapCrossings::MapCrossings(const DirectionMap& map)
    : map_(map), tree_(map.cells), stretches_(map.cells.size()) {}

void MapCrossings::add(const SeparatingArc& arc) {
  for (const ArcPiece& piece : arc.pieces) {
    for (std::size_t k = 1; k < piece.rulings.size(); ++k) {
      const Stretch stretch{piece.rulings[k - 1], piece.rulings[k]};
      add(stretch, stretch.from.n, stretch.to.n);
    }
  }
}

/// The size of a cell is about that of its image on the sphere, no less than half of it.
void MapCrossings::add(const Stretch& stretch, const dvec3& from, const dvec3& to) {
  int deepest = 0;
  for (const dvec3& n : {from, to}) {
    const int cell = tree_.at(n);
    if (cell < 0) continue;
    std::vector<Stretch>& own = stretches_[std::size_t(cell)];
    const bool known =
        !own.empty() && own.back().from.n == stretch.from.n && own.back().to.n == stretch.to.n;
    if (!known) own.push_back(stretch);
    deepest = std::max(deepest, map_.cells[std::size_t(cell)].level);
  }
  if (glm::distance(from, to) <= walking_step * std::ldexp(1.0, -deepest)) return;
  const dvec3 middle = unit(from + to);
  add(stretch, from, middle);
  add(stretch, middle, to);
}

}  // namespace taut
