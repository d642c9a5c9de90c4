#include "taut/hull/certificate.h"

#include <algorithm>

#include "taut/core/tolerances.h"

namespace taut {

double cone_depth(std::span<const dvec3> directions) {
  constexpr int iterations = 16;
  dvec3 x(0.0);
  for (const dvec3& d : directions) x += d;
  x /= double(std::max<std::size_t>(directions.size(), 1));
  double best = -1;
  for (int k = 0; k < iterations; ++k) {
    const double length = glm::length(x);
    if (!(length > 0)) break;
    const dvec3* lowest = nullptr;
    double least = 2;
    for (const dvec3& d : directions) {
      const double value = glm::dot(d, x) / length;
      if (value < least) {
        least = value;
        lowest = &d;
      }
    }
    best = std::max(best, least - 8 * rounding_unit);
    // The distance is between `least` and |x|.
    if (lowest == nullptr || length - least < 0.02 * length) break;
    const dvec3 edge = *lowest - x;
    x += std::clamp(-glm::dot(x, edge) / glm::dot(edge, edge), 0.0, 1.0) * edge;
  }
  return std::min(best, 1.0);
}

}  // namespace taut
