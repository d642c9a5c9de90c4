#pragma once

#include <array>
#include <span>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/hull/decide/seen_piece.h"

namespace taut {

/// The upper envelope of the heights of some points over a cell of directions: there the support
/// function of their convex hull. It is linear on convex polygons that fill the cell.
class BeaconEnvelope {
 public:
  /// A corner of the polygons, at a place (s, t) of the cell, from (0, 0) to (1, 1): heights that
  /// are linear in the direction are below the envelope if they are at all of these.
  struct Vertex {
    double s = 0, t = 0;
    double height = 0;
  };

  /// Of points with these heights at the cell's corners.
  void find(std::span<const Corners> points);

  /// The corners of the cell first, in their order.
  const std::vector<Vertex>& vertices() const { return vertices_; }
  /// A point is the highest of all somewhere in the cell. Of equal ones the first.
  bool is_highest(std::size_t point) const { return highest_[point]; }

 private:
  /// A corner of a polygon, and the line along which the side goes on from it: that with another
  /// point, or a side of the cell, below 0.
  struct PolygonCorner {
    double s = 0, t = 0;
    int line = 0;
  };
  bool clip(const Corners& above, int line);
  void add_vertices(int point, const Corners& heights);

  std::vector<Vertex> vertices_;
  std::vector<std::array<int, 3>> known_;  // what meets at the vertices behind the cell's corners
  std::vector<bool> highest_;
  std::vector<std::size_t> rivals_;               // scratch: points in the order they are tried in
  std::vector<PolygonCorner> polygon_, clipped_;  // scratch
  std::vector<double> over_;                      // scratch
};

/// Heights at a place of a cell.
inline double height_at(const Corners& y, double s, double t) {
  return y[0] + s * (y[2] - y[0]) + t * (y[1] - y[0]);
}

}  // namespace taut
