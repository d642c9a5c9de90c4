#include "taut/bounds/normal_pyramid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Gnomonic coordinates are quotients of two products of three terms with rounded unit vectors,
/// some 10 rounding units of one plus the coordinate; the corners add 4. Twice that, since the
/// sides of a wide pyramid are seen at a slant.
constexpr double coordinate_error = 32 * rounding_unit;

/// A side's normal is the product of a corner and its difference to the next, which with the
/// product by a direction lose less than this share of the three lengths.
constexpr double side_error = 16 * rounding_unit;

/// A vector orthogonal to the unit vector a, of length one.
dvec3 orthogonal(const dvec3& a) {
  const dvec3 b = glm::abs(a);
  const dvec3 axis = b.x <= b.y && b.x <= b.z ? dvec3(1, 0, 0)
                     : b.y <= b.z             ? dvec3(0, 1, 0)
                                              : dvec3(0, 0, 1);
  return glm::normalize(glm::cross(a, axis));
}

}  // namespace

bool NormalPyramid::may_contain(const dvec3& n) const {
  const double length = glm::length(n);
  for (std::size_t k = 0; k < 4; ++k) {
    const dvec3& a = corners[k];
    const dvec3 b = corners[(k + 1) % 4] - a;
    const double error = side_error * glm::length(a) * glm::length(b) * length;
    if (glm::dot(glm::cross(a, b), n) < -error) return false;
  }
  return glm::dot(axis, n) > 0;
}

std::optional<NormalPyramid> normal_pyramid(std::span<const dvec3> vectors, double vector_error,
                                            const dvec3& along) {
  const double skipped = 2 * vector_error;
  dvec3 sum(0.0);
  for (const dvec3& v : vectors) {
    const double length2 = glm::dot(v, v);
    if (length2 > skipped * skipped) sum += v / std::sqrt(length2);
  }
  const double length = glm::length(sum);
  if (!(length > 0)) return std::nullopt;
  const dvec3 a = sum / length;
  dvec3 e1 = along - glm::dot(along, a) * a;
  const double spread2 = glm::dot(e1, e1);
  // What is left of a direction nearly along the mean is rounding.
  e1 =
      spread2 > coordinate_error * glm::dot(along, along) ? e1 / std::sqrt(spread2) : orthogonal(a);
  e1 = glm::normalize(e1 - glm::dot(e1, a) * a);  // the first time may have cancelled digits
  const dvec3 e2 = glm::cross(a, e1);

  double x0 = std::numeric_limits<double>::infinity();
  double y0 = x0;
  double x1 = -x0;
  double y1 = -x0;
  for (const dvec3& v : vectors) {
    const double length2 = glm::dot(v, v);
    if (length2 <= skipped * skipped) continue;
    const double height = glm::dot(v, a);
    if (!(height > 0 && height * height > pyramid_limit * pyramid_limit * length2)) {
      return std::nullopt;
    }
    const double x = glm::dot(v, e1) / height;
    const double y = glm::dot(v, e2) / height;
    double error = coordinate_error;
    if (vector_error > 0) {
      // v + e has coordinates within |e| (1 + |x|) / (height - |e|) of those of v.
      if (!(height > skipped)) return std::nullopt;
      error += 2 * vector_error / height;
    }
    const double dx = error * (1 + std::abs(x));
    const double dy = error * (1 + std::abs(y));
    x0 = std::min(x0, x - dx);
    x1 = std::max(x1, x + dx);
    y0 = std::min(y0, y - dy);
    y1 = std::max(y1, y + dy);
  }
  NormalPyramid result;
  const auto at = [&](double x, double y) { return a + x * e1 + y * e2; };
  result.axis = a;
  result.corners = {at(x0, y0), at(x1, y0), at(x1, y1), at(x0, y1)};
  return result;
}

}  // namespace taut
