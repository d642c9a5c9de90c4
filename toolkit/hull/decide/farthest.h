#pragma once

#include <algorithm>
#include <span>

#include "taut/core/geometry.h"

namespace taut {

/// The point of which a measure is the largest; of equal ones the first. @pre there are points
template <class Measure>
dvec3 farthest(std::span<const dvec3> points, const Measure& measure) {
  return *std::max_element(points.begin(), points.end(),
                           [&](const dvec3& a, const dvec3& b) { return measure(a) < measure(b); });
}

}  // namespace taut
