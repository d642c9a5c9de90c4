#pragma once

#include <cstdint>
#include <vector>

#include "taut/surface/bezier.h"

namespace taut {

/// A cell of a CoonsBvh: the sub-patch over the rectangle
/// [i, i + 1] / 2^level x [j, j + 1] / 2^level of the patch's unit square.
struct CoonsCell {
  std::int32_t node = 0;   ///< the explicit node, for implicit cells the leaf that holds them
  std::int32_t level = 0;  ///< depth in the hierarchy, the root is 0
  std::uint32_t i = 0;     ///< of the rectangle, along u
  std::uint32_t j = 0;     ///< of the rectangle, along v

  /// Its range of the patch's u.
  Interval u() const { return interval(i); }
  /// Its range of the patch's v.
  Interval v() const { return interval(j); }

 private:
  Interval interval(std::uint32_t k) const {
    const double size = 1.0 / double(std::uint64_t{1} << level);
    return {k * size, (k + 1) * size};
  }
};

/// Coons bounding volume hierarchy of one rational Bezier patch (Kim, Oh, Yoon, Kim, Elber 2011).
///
/// Every cell is bounded by the convex hull of four corner points, offset by a deviation:
/// each point of the sub-patch is within deviation() of the tetrahedron of corners(). Hence
///     max x.n over the cell <= max_j corner_j . n + deviation |n|.
///
/// The upper levels are stored: corners lie on the surface, and the deviation is that of the
/// sub-patch from its bilinear interpolant. A node that is closer than coons_tolerance to its Coons
/// patch is a leaf, and holds that patch: four border curves, the distance from it, and the
/// deviations of the border curves from their chords in either direction. Below, the hierarchy is
/// implicit: the sub-patches of a Coons patch are Coons patches, and the deviation of any of its
/// parameter curves from the chord is a convex combination of those of the borders. So a cell k
/// levels below its leaf deviates by at most E_u[k] + E_v[k] + the leaf's distance. The lists
/// E_u and E_v are kept as their first terms: bounded by |c''| / 8 they are geometric, ratio 1/4.
///
/// Both deviations come from differences of homogeneous control points: with |dX| and |dw| bounds
/// of the error of X and w about the cell's centre c, and R the largest |x - c|,
///     |X / w - B| <= (|dX| + R |dw|) / w_min.
/// So polynomial and rational, regular and collapsed patches are bounded alike. Rounding included.
///
/// The degrees may be zero: a curve is a patch of degrees (p, 0), a point one of degrees (0, 0).
class CoonsBvh {
 public:
  /// @pre coons_tolerance > 0; weights are positive; coordinates are of moderate size (squares
  /// neither over- nor underflow)
  CoonsBvh(const BezierPatch& patch, double coons_tolerance);

  /// The whole patch.
  CoonsCell root() const { return {}; }
  /// The cell is a leaf or below one: its children are implicit, its corners on the Coons patch.
  bool is_leaf(const CoonsCell& cell) const {
    return nodes_[static_cast<std::size_t>(cell.node)].first_child < 0;
  }
  /// In the order (u0,v0), (u0,v1), (u1,v0), (u1,v1). Never empty; the depth is limited only by
  /// the 31 levels that the cell's coordinates hold.
  std::array<CoonsCell, 4> children(const CoonsCell& cell) const;
  /// In the same order.
  std::array<dvec3, 4> corners(const CoonsCell& cell) const;
  /// How far the sub-patch is from the tetrahedron of the corners, at most, rounding included.
  double deviation(const CoonsCell& cell) const;
  /// Distance of the surface from the leaf's Coons patch; zero for inner cells, whose corners lie
  /// on the surface itself (within rounding).
  double coons_distance(const CoonsCell& cell) const;

  /// Nodes that are stored.
  int node_count() const { return static_cast<int>(nodes_.size()); }
  /// Those of them that are leaves.
  int leaf_count() const { return static_cast<int>(leaves_.size()); }
  /// Bytes held.
  std::size_t memory() const;

 private:
  struct Node {
    double deviation;
    std::int32_t corner[4];
    std::int32_t first_child;  // of four consecutive nodes; -1 - leaf for a leaf
  };
  struct Leaf {
    std::int32_t level;
    std::uint32_t i, j;
    std::int32_t first_point;  // border control points: v0, v1 along u, then u0, u1 along v
    HomogeneousBound along_u, along_v, coons;
    double min_weight;
    double radius;
  };
  class Builder;

  dvec3 coons_point(const Leaf& leaf, double u, double v) const;

  int degree_u_ = 0;
  int degree_v_ = 0;
  double rounding_ = 0;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
  std::vector<dvec3> corners_;
  std::vector<dvec4> borders_;
};

}  // namespace taut
