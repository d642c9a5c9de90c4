#pragma once

#include <vector>

#include "taut/hull/decide/cell_view.h"

namespace taut {

/// A rectangle of a patch, and whether heights grow from its sides into it, for all directions of a
/// cell. True is certain.
class RectangleSides {
 public:
  /// The pieces must outlive it.
  explicit RectangleSides(const MapPieces& pieces) : pieces_(pieces) {}

  /// Turns to a rectangle. @pre the element is a patch
  void turn_to(int element, const Interval& u, const Interval& v);

  /// Straight inwards, or if `obliquely` also along the side so that the slope is much the same all
  /// over it; by more than `tilt` along vectors of length one.
  bool rise(const CellView& view, Side side, double tilt, bool obliquely = true) const;
  /// No height along the side is lower than those on both sides of it: they are concave, or
  /// monotone; so are they less a function that grows by no more than `tilt` along vectors of
  /// length one, and has no hollow.
  bool have_no_low(const CellView& view, Side side, double tilt = 0) const;

  /// A corner, and what leads from it along the one side that ends there and along the other.
  struct Corner {
    dvec4 point;
    dvec3 along, along_other;
  };
  Corner corner(Side side, Side other) const;

 private:
  const dvec4& at(int i, int j) const { return net_[std::size_t(i * (shape_.q + 1) + j)]; }

  const MapPieces& pieces_;
  NetShape shape_ = {};
  std::vector<dvec4> net_;
};

}  // namespace taut
