#include "taut/hull/polytope/affine_span.h"

#include <cmath>

namespace taut {
namespace {

dvec3 orthogonal(const dvec3& line) {
  const dvec3 axis = std::abs(line.x) < std::abs(line.y) ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  return unit(glm::cross(line, axis));
}

}  // namespace

AffineSpan affine_span(std::span<const dvec3> points, double width) {
  // The number of the point of largest size, and that size.
  const auto farthest = [&](auto size) {
    std::pair<double, int> best = {-1, 0};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double s = size(points[i]);
      if (s > best.first) best = {s, int(i)};
    }
    return best;
  };
  AffineSpan span;
  // An end of the longest extent, as seen from any point, makes a good first witness.
  const dvec3& any = points.front();
  span.witnesses[0] = farthest([&](const dvec3& p) { return glm::length(p - any); }).second;
  const dvec3 a = points[std::size_t(span.witnesses[0])];
  const auto [length, b] = farthest([&](const dvec3& p) { return glm::length(p - a); });
  if (length < width || length == 0) return span;
  span.dimension = 1;
  span.witnesses[1] = b;
  span.line = unit(points[std::size_t(b)] - a);
  const auto off_line = [&](const dvec3& p) {
    const dvec3 d = p - a;
    return d - glm::dot(d, span.line) * span.line;
  };
  const auto [breadth, c] = farthest([&](const dvec3& p) { return glm::length(off_line(p)); });
  if (breadth < width || breadth == 0) return span;
  span.dimension = 2;
  span.witnesses[2] = c;
  span.normal = unit(glm::cross(span.line, off_line(points[std::size_t(c)])));
  const auto [height, d] =
      farthest([&](const dvec3& p) { return std::abs(glm::dot(p - a, span.normal)); });
  if (height < width || height == 0) return span;
  span.dimension = 3;
  span.witnesses[3] = d;
  return span;
}

std::vector<dvec3> directions_across(const AffineSpan& span) {
  std::vector<dvec3> result;
  if (span.dimension == 0) {
    for (int k = 0; k < 27; ++k) {
      const dvec3 d(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      if (d != dvec3(0.0)) result.push_back(unit(d));
    }
  } else if (span.dimension == 1) {
    const dvec3 a = orthogonal(span.line);
    const dvec3 b = glm::cross(span.line, a);
    result = {a, -a, b, -b, unit(a + b), -unit(a + b), unit(a - b), -unit(a - b)};
  } else if (span.dimension == 2) {
    result = {span.normal, -span.normal};
  }
  return result;
}

}  // namespace taut
