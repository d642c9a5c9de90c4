#pragma once

#include <vector>

#include "taut/hull/decide/cell_tree.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// Which cells of a map of directions separating curves pass through, as far as the great arcs
/// between their rulings tell.
class MapCrossings {
 public:
  /// The map must outlive it.
  explicit MapCrossings(const DirectionMap& map);

  void add(const SeparatingArc& arc);
  bool crosses(int cell) const { return crossed_[std::size_t(cell)]; }

 private:
  void add(const dvec3& from, const dvec3& to);

  const DirectionMap& map_;
  CellTree tree_;
  std::vector<bool> crossed_;
};

}  // namespace taut
