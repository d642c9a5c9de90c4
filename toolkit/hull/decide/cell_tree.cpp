#include "taut/hull/decide/cell_tree.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

/// How far beyond a side a neighbour is looked for, as a share of the side.
constexpr double step_beyond = 1.0 / 64;

}  // namespace

CellTree::CellTree(const std::vector<MapCell>& cells) : cells_(cells) {
  index_.reserve(cells.size());
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const MapCell& c = cells[k];
    index_.emplace(key(c.face, c.level, c.i, c.j), int(k));
    deepest_ = std::max(deepest_, c.level);
  }
}

CellTree::Key CellTree::key(int face, int level, std::uint32_t i, std::uint32_t j) {
  // The leading one tells the level: of level 30 it is the highest bit.
  return ((((Key(1) << level) | i) << level | j) << 3) | Key(face);
}

int CellTree::at(int face, double s, double t) const {
  if (std::abs(s) > 1 || std::abs(t) > 1) {
    const auto [other, first, second] = DirectionMap::place(DirectionMap::direction(face, s, t));
    face = other;
    s = first;
    t = second;
  }
  for (int level = 0; level <= deepest_; ++level) {
    const double count = std::ldexp(1.0, level);
    const auto place = [&](double x) {
      return std::uint32_t(std::clamp(std::floor(0.5 * (x + 1) * count), 0.0, count - 1));
    };
    const auto found = index_.find(key(face, level, place(s), place(t)));
    if (found != index_.end()) return found->second;
  }
  return -1;
}

bool CellTree::side(int k, int number, CellSide& result) const {
  const MapCell& own = cells_[std::size_t(k)];
  const double size = std::ldexp(2.0, -own.level);
  const double s = -1 + size * own.i;
  const double t = -1 + size * own.j;
  const bool across_s = number < 2;
  const double outwards = number % 2 == 0 ? -1 : 1;
  const double fixed = (across_s ? s : t) + (outwards > 0 ? size : 0);
  const double begin = across_s ? t : s;
  const auto place = [&](double across, double along) {
    return across_s ? dvec2(across, along) : dvec2(along, across);
  };
  const dvec2 beyond = place(fixed + outwards * step_beyond * size, begin + 0.5 * size);
  const int other = at(own.face, beyond.x, beyond.y);
  if (other < 0) return false;
  const int level = cells_[std::size_t(other)].level;
  if (level > own.level || (level == own.level && other < k)) return false;
  const dvec2 a = place(fixed, begin);
  const dvec2 b = place(fixed, begin + size);
  result = {k, other, DirectionMap::direction(own.face, a.x, a.y),
            DirectionMap::direction(own.face, b.x, b.y)};
  return true;
}

}  // namespace taut
