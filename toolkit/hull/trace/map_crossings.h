#pragma once

#include <vector>

#include "taut/hull/decide/cell_tree.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// Which cells of a map of directions separating curves pass through, as far as the great arcs
/// between their rulings tell.
class MapCrossings {
 public:
  /// Two rulings between which a curve crosses a cell.
  struct Stretch {
    Ruling from, to;
  };

  /// The map must outlive it.
  explicit MapCrossings(const DirectionMap& map);

  void add(const SeparatingArc& arc);
  const std::vector<Stretch>& of(int cell) const { return stretches_[std::size_t(cell)]; }
  bool crosses(int cell) const { return !of(cell).empty(); }
  /// The cells beside a cell's sides and corners, as far as one step beyond tells.
  std::vector<int> around(int cell) const;

 private:
  void add(const Stretch& stretch, const dvec3& from, const dvec3& to);

  const DirectionMap& map_;
  CellTree tree_;
  std::vector<std::vector<Stretch>> stretches_;  // by cell
};

}  // namespace taut
