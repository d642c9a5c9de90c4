#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "taut/hull/decide/direction_map.h"

namespace taut {

/// Finds cells of a direction map by their places. The cells must outlive it.
class CellTree {
 public:
  explicit CellTree(const std::vector<MapCell>& cells);

  /// The cell at a place of a face of the cube, which may be a little beyond its border; -1 if
  /// there is none.
  int at(int face, double s, double t) const;

  /// A side between two cells, whole for the finer of them.
  struct CellSide {
    int finer = -1, other = -1;
    dvec3 from, to;  ///< directions of its ends
  };
  /// One of the four sides of a cell, if it is the finer one there (of equal ones the first).
  /// False if not.
  bool side(int cell, int number, CellSide& result) const;

 private:
  using Key = std::uint64_t;
  static Key key(int face, int level, std::uint32_t i, std::uint32_t j);

  const std::vector<MapCell>& cells_;
  std::unordered_map<Key, int> index_;
  int deepest_ = 0;
};

}  // namespace taut
