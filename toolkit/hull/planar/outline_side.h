#pragma once

#include "taut/core/geometry.h"

namespace taut {

/// A stretch of the outline, and the corner in which it begins.
struct OutlineSide {
  /// The corner: a point's number, or a curve's number and parameter.
  int point = -1;  ///< -1: on a curve
  int curve = -1;  ///< -1: a point
  double t = 0;
  dvec2 x = dvec2(0);
  /// From the corner to the next one: along this curve from parameter `from` to `to` (from > to:
  /// backwards); -1: a straight segment.
  int along = -1;
  double from = 0;
  double to = 0;
};

}  // namespace taut
