#include "taut/hull/polytope/certificate.h"

#include <algorithm>
#include <array>
#include <limits>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// The point of least norm in the convex hull of up to three points, and which of them carry it.
struct Nearest {
  dvec3 point = dvec3(0.0);
  std::array<dvec3, 3> carrier;
  int size = 0;
  double norm2 = std::numeric_limits<double>::infinity();

  void offer(const dvec3& p, std::span<const dvec3> points) {
    // Of a triangle and its side the triangle, where their points of least norm are one but for
    // rounding: only the former may prove that no direction lies lower.
    constexpr double same = 1 + 1e-6;
    if (!(glm::dot(p, p) < (int(points.size()) > size ? same : 1) * norm2)) return;
    point = p;
    norm2 = glm::dot(p, p);
    size = int(points.size());
    std::copy(points.begin(), points.end(), carrier.begin());
  }

  void offer_segment(const dvec3& a, const dvec3& b) {
    const dvec3 edge = b - a;
    const double t = -glm::dot(a, edge) / glm::dot(edge, edge);
    if (!(t > 0 && t < 1)) return;
    offer(a + t * edge, std::array{a, b});
  }

  /// The foot of the origin on the triangle's plane, if it lies in the triangle.
  void offer_triangle(const dvec3& a, const dvec3& b, const dvec3& c) {
    const dvec3 n = glm::cross(b - a, c - a);
    const double n2 = glm::dot(n, n);
    if (n2 == 0) return;
    const dvec3 foot = glm::dot(a, n) / n2 * n;
    // (q - p) x (foot - p) . n, whose part of the foot vanishes; a foot close to a side, as that of
    // a needle's normals is, would not be told from one beyond it.
    const auto inside = [&](const dvec3& p, const dvec3& q) {
      return glm::dot(glm::cross(p, q), n) >= 0;
    };
    if (inside(a, b) && inside(b, c) && inside(c, a)) offer(foot, std::array{a, b, c});
  }
};

/// The point of least norm on the boundary of the simplex of the carrier and one more point.
Nearest nearest_with(const Nearest& old, const dvec3& w) {
  Nearest result;
  result.offer(w, std::array{w});
  for (int i = 0; i < old.size; ++i) {
    const dvec3& a = old.carrier[std::size_t(i)];
    result.offer(a, std::array{a});
    result.offer_segment(a, w);
    for (int j = i + 1; j < old.size; ++j) {
      const dvec3& b = old.carrier[std::size_t(j)];
      result.offer_segment(a, b);
      result.offer_triangle(a, b, w);
    }
  }
  if (old.size == 3) result.offer_triangle(old.carrier[0], old.carrier[1], old.carrier[2]);
  return result;
}

}  // namespace

double cone_depth(std::span<const dvec3> directions) {
  constexpr double narrow = 0.95;
  constexpr int iterations = 64;
  // The lowest direction over x bounds the distance from below, |x| from above.
  const auto lowest = [&](const dvec3& x) {
    return *std::min_element(
        directions.begin(), directions.end(),
        [&](const dvec3& a, const dvec3& b) { return glm::dot(a, x) < glm::dot(b, x); });
  };
  struct Bound {
    dvec3 direction;
    double bound;
  };
  const auto bound_at = [&](const dvec3& x) -> Bound {
    const dvec3 w = lowest(x);
    return {w, glm::dot(w, unit(x)) - 8 * rounding_unit};
  };
  if (directions.empty()) return 1;
  dvec3 mean(0.0);
  for (const dvec3& d : directions) mean += d;
  mean = unit(mean);
  double best = bound_at(mean).bound;
  if (best > narrow) return best;

  Nearest nearest;
  nearest.offer(directions.front(), directions.first(1));
  for (int k = 0; k < iterations; ++k) {
    const double length = glm::length(nearest.point);
    if (!(length > 0)) break;
    const auto [w, bound] = bound_at(nearest.point);
    best = std::max(best, bound);
    if (length - bound < 0.01 * length) break;
    const Nearest next = nearest_with(nearest, w);
    const bool closer = next.norm2 < nearest.norm2;
    nearest = next;
    if (!closer) {  // the origin is inside, or rounding is reached
      best = std::max(best, bound_at(nearest.point).bound);
      break;
    }
  }
  return std::min(best, 1.0);
}

}  // namespace taut
