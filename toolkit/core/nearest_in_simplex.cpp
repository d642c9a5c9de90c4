#include "taut/core/nearest_in_simplex.h"

#include <limits>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

class Search {
 public:
  explicit Search(std::span<const dvec3> points) : points_(points) {}

  NearestInSimplex run() {
    const int count = int(points_.size());
    for (int a = 0; a < count; ++a) {
      offer(at(a), unit(at(a)), {a, -1, -1, -1}, {1, 0, 0, 0}, 1);
      for (int b = a + 1; b < count; ++b) {
        offer_segment(a, b);
        for (int c = b + 1; c < count; ++c) offer_triangle(a, b, c);
      }
    }
    if (count == 4) offer_tetrahedron();
    return best_;
  }

 private:
  const dvec3& at(int i) const { return points_[std::size_t(i)]; }

  void offer(const dvec3& point, const dvec3& direction, const std::array<int, 4>& carrier,
             const std::array<double, 4>& weight, int size) {
    const double norm2 = glm::dot(point, point);
    // Of a triangle and its side the triangle, where rounding is all that makes a difference: its
    // normal tells the direction, which the side only bounds.
    if (!(norm2 < (size > best_.size ? 1 + 16 * rounding_unit : 1) * norm2_)) return;
    norm2_ = norm2;
    best_ = {point, direction, carrier, weight, size, false};
  }

  void offer_segment(int a, int b) {
    const dvec3 side = at(b) - at(a);
    const double t = -glm::dot(at(a), side) / glm::dot(side, side);
    if (!(t > 0 && t < 1)) return;
    const dvec3 point = at(a) + t * side;
    offer(point, unit(point), {a, b, -1, -1}, {1 - t, t, 0, 0}, 2);
  }

  /// The foot of the origin on the triangle's plane, where it lies in the triangle: by least
  /// squares in the two shorter sides, whose angle is the best to be had, and once more for what
  /// rounding has left.
  void offer_triangle(int a, int b, int c) {
    const std::array<int, 3> corner = {a, b, c};
    const auto side = [&](std::size_t from, std::size_t to) {
      return at(corner[to % 3]) - at(corner[from % 3]);
    };
    std::size_t apex = 0;  // opposite to the longest side
    for (std::size_t k = 1; k < 3; ++k) {
      if (glm::length(side(k + 1, k + 2)) > glm::length(side(apex + 1, apex + 2))) apex = k;
    }
    const dvec3 e = side(apex, apex + 1);
    const dvec3 f = side(apex, apex + 2);
    const dvec3& from = at(corner[apex]);
    const dvec3 n = glm::cross(e, f);
    const double ee = glm::dot(e, e);
    const double ef = glm::dot(e, f);
    const double ff = glm::dot(f, f);
    const double det = glm::dot(n, n);
    if (!(det > 0)) return;
    double s = 0;
    double t = 0;
    dvec3 point = from;
    for (int round = 0; round < 2; ++round) {
      const double pe = glm::dot(point, e);
      const double pf = glm::dot(point, f);
      s += (ef * pf - ff * pe) / det;
      t += (ef * pe - ee * pf) / det;
      point = from + s * e + t * f;
    }
    if (!(s > 0 && t > 0 && s + t < 1)) return;
    const dvec3 direction = (glm::dot(from, n) < 0 ? -1.0 : 1.0) * unit(n);
    offer(point, direction, {corner[apex], corner[(apex + 1) % 3], corner[(apex + 2) % 3], -1},
          {1 - s - t, s, t, 0}, 3);
  }

  void offer_tetrahedron() {
    // The origin is inside iff it lies on each face's side that the opposite corner is on.
    for (int k = 0; k < 4; ++k) {
      const dvec3& a = at((k + 1) % 4);
      const dvec3 n = glm::cross(at((k + 2) % 4) - a, at((k + 3) % 4) - a);
      if (!(glm::dot(n, at(k) - a) * glm::dot(n, -a) > 0)) return;
    }
    best_.contains_origin = true;
  }

  std::span<const dvec3> points_;
  NearestInSimplex best_;
  double norm2_ = std::numeric_limits<double>::infinity();
};

}  // namespace

NearestInSimplex nearest_in_simplex(std::span<const dvec3> points) { return Search(points).run(); }

}  // namespace taut
