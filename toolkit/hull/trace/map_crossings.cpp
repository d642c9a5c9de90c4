#include "taut/hull/trace/map_crossings.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

/// Share of a cell's size by which places along a great arc follow each other.
constexpr double walking_step = 0.25;
constexpr double nearly_opposite_directions = -0.9;
constexpr double no_unit = 1e-6;
/// How far from a cell's middle those beside it are looked for, in its half widths.
constexpr double beyond_sides = 1.5;

}  // namespace

MapCrossings::MapCrossings(const DirectionMap& map)
    : map_(map), tree_(map.cells), stretches_(map.cells.size()) {}

void MapCrossings::add(const SeparatingArc& arc) {
  for (const ArcPiece& piece : arc.pieces) {
    for (std::size_t k = 1; k < piece.rulings.size(); ++k) {
      const Stretch stretch{piece.rulings[k - 1], piece.rulings[k]};
      // What was traced in vain may have normals that are none.
      const bool is_way = std::abs(glm::length(stretch.from.n) - 1) < no_unit &&
                          std::abs(glm::length(stretch.to.n) - 1) < no_unit;
      if (is_way) add(stretch, stretch.from.n, stretch.to.n);
    }
  }
}

std::vector<int> MapCrossings::around(int cell) const {
  const MapCell& own = map_.cells[std::size_t(cell)];
  const double half = std::ldexp(1.0, -own.level);
  const double s = -1 + half * (2 * own.i + 1);
  const double t = -1 + half * (2 * own.j + 1);
  std::vector<int> result;
  for (int k = 0; k < 9; ++k) {
    if (k == 4) continue;
    const int across = k / 3 - 1;
    const int along = k % 3 - 1;
    const int other =
        tree_.at(own.face, s + beyond_sides * half * across, t + beyond_sides * half * along);
    if (other >= 0) result.push_back(other);
  }
  return result;
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
  if (glm::dot(from, to) < nearly_opposite_directions) return;  // no great arc to speak of
  const dvec3 middle = unit(from + to);
  add(stretch, from, middle);
  add(stretch, middle, to);
}

}  // namespace taut
