#pragma once

#include <array>
#include <span>
#include <vector>

#include "taut/core/geometry.h"

namespace taut {

/// Which points may be on the convex hull of something of which some points are known.
///
/// The sphere of directions is divided into cells; a set of points stays below the known ones over
/// a cell if all of them stay below one known point, the farthest along the cell's axis.
class TouchTest {
 public:
  TouchTest();

  /// Points of the geometry.
  void add(std::span<const dvec3> points);

  /// False is certain: no supporting plane of the known points' hull, moved out to the geometry's,
  /// touches the convex hull of the points.
  bool may_touch(std::span<const dvec3> points) const;

 private:
  /// The directions within an angle of an axis: the centre square of a cube's side.
  struct Cell {
    dvec3 axis;
    double cos_angle = 1, sin_angle = 0;
    dvec3 farthest;
    double height = 0;
  };

  void add(const dvec3& p, int level, std::size_t cell);
  bool may_touch(std::span<const dvec3> points, int level, std::size_t cell) const;

  static constexpr int level_count = 7;
  std::array<std::vector<Cell>, level_count> levels_;
  bool empty_ = true;
};

}  // namespace taut
