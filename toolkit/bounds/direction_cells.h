#pragma once

#include <cstdint>
#include <vector>

#include "taut/bounds/normal_pyramid.h"

namespace taut {

/// A cell of the sphere of directions: a square [i, i + 1] x [j, j + 1], in units of 2^(1 - level)
/// from -1, of a face of the cube [-1, 1]^3, seen from the centre. Faces 0 .. 5 are +x, -x, +y, -y,
/// +z, -z; the square's axes are the two coordinates after the face's own, cyclically.
struct DirectionCell {
  int face = 0;         ///< 0 .. 5
  int level = 0;        ///< 0 .. 15
  std::uint32_t i = 0;  ///< 0 .. 2^level - 1
  std::uint32_t j = 0;  ///< 0 .. 2^level - 1

  /// The cell of that level that holds the direction. @pre not zero; 0 <= level <= 15
  static DirectionCell of(const dvec3& n, int level);
  /// Directions of its corners, on the cube.
  std::array<dvec3, 4> corners() const;
  /// Index along a Z-shaped curve among all cells of the level; descendants are consecutive.
  std::uint32_t index() const;
};

/// Cells of one level of the six quadtrees that a pyramid (or its opposite) may meet: all that it
/// meets, and few others. Appended.
void cells_met(const NormalPyramid& pyramid, bool opposite, int level,
               std::vector<DirectionCell>& cells);

}  // namespace taut
