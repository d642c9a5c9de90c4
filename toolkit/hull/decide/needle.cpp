#include "taut/hull/decide/needle.h"

#include "taut/hull/decide/farthest.h"

namespace taut {

std::optional<std::array<Box, 2>> needle_halves(std::span<const dvec3> points, double resolution) {
  if (points.empty()) return std::nullopt;
  const dvec3 first = points.front();
  const dvec3 a = farthest(points, [&](const dvec3& x) { return glm::distance(x, first); });
  const dvec3 b = farthest(points, [&](const dvec3& x) { return glm::distance(x, a); });
  if (!(glm::distance(a, b) > resolution)) return std::nullopt;  // it is a point
  const dvec3 along = unit(b - a);
  std::array<Box, 2> halves;
  for (const dvec3& x : points) {
    if (!(glm::length(glm::cross(x - a, along)) <= 0.5 * resolution)) return std::nullopt;
    halves[glm::distance(x, a) < glm::distance(x, b) ? 0 : 1].include(x);
  }
  return halves;
}

}  // namespace taut
