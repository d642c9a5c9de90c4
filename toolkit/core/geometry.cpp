#include "taut/core/geometry.h"

#include <cmath>
#include <numbers>

namespace taut {
namespace {

/// Power of two that brings the largest component of v into [1/2, 1), so that squares neither
/// over- nor underflow; scaling by it is exact up to subnormal results.
int binary_exponent(const dvec3& v) {
  int exponent = 0;
  std::frexp(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}), &exponent);
  return exponent;
}

dvec3 scaled(const dvec3& v, int exponent) {
  return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
}

}  // namespace

double diagonal(const Box& box) {
  if (box.empty()) return 0;
  // Halves first: the difference of two huge coordinates must not overflow.
  const dvec3 half = 0.5 * box.upper - 0.5 * box.lower;
  const int exponent = binary_exponent(half);
  return std::ldexp(glm::length(scaled(half, -exponent)), exponent + 1);
}

dvec3 unit(const dvec3& v) {
  if (v == dvec3(0.0)) return v;
  const dvec3 s = scaled(v, -binary_exponent(v));
  return s / glm::length(s);
}

double angle_between(const dvec3& a, const dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

double distance_to_segment(const dvec3& x, const dvec3& a, const dvec3& b) {
  const dvec3 along = b - a;
  const double square = glm::dot(along, along);
  const double t = square > 0 ? std::clamp(glm::dot(x - a, along) / square, 0.0, 1.0) : 0;
  return glm::distance(x, a + t * along);
}

dvec3 polygon_normal(const std::vector<dvec3>& points) {
  dvec3 sum(0.0);
  for (std::size_t k = 1; k + 1 < points.size(); ++k) {
    sum += glm::cross(points[k] - points[0], points[k + 1] - points[0]);
  }
  return unit(sum);
}

dvec3 plane_normal(const std::vector<dvec3>& points) {
  const dvec3 normal = polygon_normal(points);
  dvec3 longest(0.0);
  for (const dvec3& p : points) {
    if (glm::length(p - points[0]) > glm::length(longest)) longest = p - points[0];
  }
  const dvec3 along = unit(longest);
  return unit(normal - glm::dot(normal, along) * along);
}

double exterior_angle(const dvec3& m, const dvec3& n, const dvec3& along) {
  const double sine = glm::dot(glm::cross(m, n), along);
  const double cosine = glm::dot(m, n) - glm::dot(m, along) * glm::dot(n, along);
  const double angle = std::atan2(sine, cosine);
  // Those of both sides of a plane polygon, or of a thin wedge, are half a turn but for rounding.
  return angle < -0.5 * std::numbers::pi ? angle + 2 * std::numbers::pi : angle;
}

std::array<dvec3, 2> tangent_frame(const dvec3& n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1.0 / (sign + n.z);
  const double b = n.x * n.y * a;
  return {dvec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
          dvec3(b, sign + n.y * n.y * a, -n.y)};
}

}  // namespace taut
