#pragma once

#include <cstddef>
#include <vector>

#include "taut/core/geometry.h"

namespace taut {

/// Points in a tree of boxes, halved at medians, for searches in logarithmic time. The boxes are
/// along the points' principal axes, thin where the points lie about a plane, however it is turned.
class PointTree {
 public:
  PointTree() = default;
  /// @pre coordinates are finite
  explicit PointTree(std::vector<dvec3> points);

  bool empty() const { return points_.empty(); }
  /// @pre not empty
  dvec3 nearest(const dvec3& p) const;
  /// The point of the least scalar product with the direction. @pre not empty
  dvec3 lowest(const dvec3& direction) const;

 private:
  /// Of a range of points; children follow their parent: `2 k + 1`, `2 k + 2`.
  struct Range {
    std::size_t begin = 0;
    std::size_t end = 0;
    std::size_t node = 0;

    Range child(bool upper) const;
    bool is_leaf() const;
  };

  dvec3 to_frame(const dvec3& p) const { return (p - centre_) * axes_; }
  void build(const Range& range);
  template <typename OfBox, typename OfPoint>
  void search(const Range& range, const OfBox& of_box, const OfPoint& of_point, double& least,
              std::size_t& found) const;
  template <typename OfBox, typename OfPoint>
  dvec3 least(const OfBox& of_box, const OfPoint& of_point) const;

  std::vector<dvec3> points_;
  dvec3 centre_ = dvec3(0.0);
  dmat3 axes_ = dmat3(1.0);  // as columns
  std::vector<Box> boxes_;   // of nodes, in the frame of these
};

}  // namespace taut
