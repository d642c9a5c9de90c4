#include "taut/containment/nearest_in_simplex.h"

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
      offer(at(a), {a, -1, -1, -1}, {1, 0, 0, 0}, 1);
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

  void offer(const dvec3& point, const std::array<int, 4>& carrier,
             const std::array<double, 4>& weight, int size) {
    const double norm2 = glm::dot(point, point);
    // Of a triangle and its side the triangle, where rounding is all that makes a difference: its
    // normal tells the direction, which the side only bounds.
    if (!(norm2 < (size > best_.size ? 1 + 16 * rounding_unit : 1) * norm2_)) return;
    norm2_ = norm2;
    best_ = {point, carrier, weight, size, false};
  }

  void offer_segment(int a, int b) {
    const dvec3 side = at(b) - at(a);
    const double t = -glm::dot(at(a), side) / glm::dot(side, side);
    if (t > 0 && t < 1) offer(at(a) + t * side, {a, b, -1, -1}, {1 - t, t, 0, 0}, 2);
  }

  /// The foot of the origin on the triangle's plane, where it lies in the triangle.
  void offer_triangle(int a, int b, int c) {
    const dvec3 n = glm::cross(at(b) - at(a), at(c) - at(a));
    const double n2 = glm::dot(n, n);
    if (!(n2 > 0)) return;
    const double wa = glm::dot(glm::cross(at(b), at(c)), n);
    const double wb = glm::dot(glm::cross(at(c), at(a)), n);
    const double wc = glm::dot(glm::cross(at(a), at(b)), n);
    if (!(wa > 0 && wb > 0 && wc > 0)) return;
    const double sum = wa + wb + wc;
    offer(glm::dot(at(a), n) / n2 * n, {a, b, c, -1}, {wa / sum, wb / sum, wc / sum, 0}, 3);
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
