#pragma once

#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// Segments of a stretch of an edge within a piece, and tangents of it that are checked.
inline constexpr int stretch_points = 8;

/// A side of a planar hull's outline and the corner in which it begins.
struct FlatSide {
  Contact corner;
  dvec2 x = dvec2(0);          ///< the corner in the plane
  EdgeStretch along;           ///< none where it is straight
  std::vector<dvec2> polygon;  ///< its control points

  bool is_curved() const { return along.piece >= 0; }
  /// The place so many of stretch_points along.
  Contact at(int i) const {
    return along.at(Interval{along.from, along.to}.at(double(i) / stretch_points));
  }
};

/// The curves of a planar hull that sides make, counter-clockwise: consecutive stretches of one
/// edge are one.
std::vector<HullCurve> flat_curves(const ContactGeometry& geometry,
                                   const std::vector<FlatSide>& sides);

}  // namespace taut
