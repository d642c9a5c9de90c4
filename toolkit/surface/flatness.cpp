#include "taut/surface/flatness.h"

#include <algorithm>
#include <cmath>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// The one of the points that is farthest by this measure.
template <class Measure>
dvec3 farthest(const std::vector<dvec4>& points, const Measure& measure) {
  dvec3 result = euclidean(points.front());
  for (const dvec4& p : points) {
    if (measure(euclidean(p)) > measure(result)) result = euclidean(p);
  }
  return result;
}

/// Largest absolute space coordinate and weight of the homogeneous points.
HomogeneousBound largest_entries(const std::vector<dvec4>& points) {
  HomogeneousBound result;
  for (const dvec4& p : points) {
    result.space = std::max({result.space, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    result.weight = std::max(result.weight, p.w);
  }
  return result;
}

}  // namespace

double largest_coordinate(const std::vector<dvec4>& points) {
  double result = 0;
  for (const dvec4& p : points) {
    const dvec3 x = glm::abs(euclidean(p));
    result = std::max({result, x.x, x.y, x.z});
  }
  return result;
}

bool is_straight(const BezierCurve& curve) {
  const double tolerance = ruled_rounding * largest_coordinate(curve.points);
  const dvec3 first = euclidean(curve.points.front());
  const dvec3 last =
      farthest(curve.points, [&](const dvec3& p) { return glm::distance(p, first); });
  const dvec3 along = unit(last - first);
  return std::all_of(curve.points.begin(), curve.points.end(), [&](const dvec4& p) {
    return glm::length(glm::cross(euclidean(p) - first, along)) <= tolerance;
  });
}

bool is_ruled(const BezierPatch& patch, Direction direction) {
  if (direction == Direction::v) return is_ruled(transposed(patch), Direction::u);
  const HomogeneousBound largest = largest_entries(patch.points);
  for (int i = 2; i <= patch.degree_u; ++i) {
    for (int j = 0; j <= patch.degree_v; ++j) {
      const dvec4 d = glm::abs(patch.at(i, j) - 2.0 * patch.at(i - 1, j) + patch.at(i - 2, j));
      if (std::max({d.x, d.y, d.z}) > ruled_rounding * largest.space) return false;
      if (d.w > ruled_rounding * largest.weight) return false;
    }
  }
  return true;
}

bool is_plane(const BezierPatch& patch) {
  const double tolerance = ruled_rounding * largest_coordinate(patch.points);
  const dvec3 a = euclidean(patch.points.front());
  const dvec3 b = farthest(patch.points, [&](const dvec3& p) { return glm::distance(p, a); });
  const dvec3 ab = unit(b - a);
  const dvec3 c =
      farthest(patch.points, [&](const dvec3& p) { return glm::length(glm::cross(p - a, ab)); });
  const dvec3 n = unit(glm::cross(ab, c - a));
  return std::all_of(patch.points.begin(), patch.points.end(), [&](const dvec4& p) {
    return std::abs(glm::dot(euclidean(p) - a, n)) <= tolerance;
  });
}

BezierCurve parameter_curve(const BezierPatch& patch, Direction direction, double s) {
  const bool of_u = direction == Direction::u;
  if (s <= 0) return border(patch, of_u ? Side::u0 : Side::v0);
  const Interval below{0, s};
  return of_u ? border(restricted(patch, below, {}), Side::u1)
              : border(restricted(patch, {}, below), Side::v1);
}

}  // namespace taut
