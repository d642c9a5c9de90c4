#include "taut/hull/polytope/rounding_width.h"

#include <cmath>

namespace taut {

RoundingWidth rounding_width(std::span<const dvec3> points, double width) {
  RoundingWidth result;
  if (!(width > 0)) return result;
  const double step = std::ldexp(1.0, std::ilogb(width) + 1);
  for (int axis = 0; axis < 3; ++axis) {
    const bool multiples = std::all_of(points.begin(), points.end(), [&](const dvec3& p) {
      const double steps = p[axis] / step;
      return std::trunc(steps) == steps;
    });
    if (!multiples) result.half_axes[axis] = width;
  }
  return result;
}

}  // namespace taut
