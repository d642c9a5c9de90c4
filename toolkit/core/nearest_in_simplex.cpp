#include "taut/core/nearest_in_simplex.h"

#include <algorithm>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

class Search {
 public:
  explicit Search(std::span<const dvec3> points) : points_(points) {
    double farthest = 0;
    for (const dvec3& p : points) farthest = std::max(farthest, glm::length(p));
    rounding_ = 8 * rounding_unit * farthest;
  }

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
    const double norm = glm::length(point);
    const double ahead = size > best_.size ? -rounding_ : size < best_.size ? rounding_ : 0;
    // Nothing is nearer than the origin itself.
    if (best_.size > 0 && (norm_ == 0 || !(norm + ahead < norm_))) return;
    norm_ = norm;
    best_ = {point, direction, carrier, weight, size, false};
  }

  void offer_segment(int a, int b) {
    const dvec3 side = at(b) - at(a);
    const double t = -glm::dot(at(a), side) / glm::dot(side, side);
    if (!(t > 0 && t < 1)) return;
    const dvec3 point = at(a) + t * side;
    offer(point, unit(point), {a, b, -1, -1}, {1 - t, t, 0, 0}, 2);
  }

  /// The foot of the origin on the triangle's plane, where it lies in the triangle: from the corner
  /// opposite to the longest side along the longer one of the others and across it, and once more
  /// for what rounding has left.
  void offer_triangle(int a, int b, int c) {
    std::array<int, 3> corner = {a, b, c};
    const auto side = [&](std::size_t from, std::size_t to) {
      return at(corner[to % 3]) - at(corner[from % 3]);
    };
    std::size_t apex = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (glm::length(side(k + 1, k + 2)) > glm::length(side(apex + 1, apex + 2))) apex = k;
    }
    std::rotate(corner.begin(), corner.begin() + std::ptrdiff_t(apex), corner.end());
    if (glm::length(side(0, 1)) < glm::length(side(0, 2))) std::swap(corner[1], corner[2]);
    const dvec3& from = at(corner[0]);
    const dvec3 e = side(0, 1);
    const dvec3 f = side(0, 2);
    const dvec3 n = glm::cross(e, f);
    const double length = glm::length(e);
    const dvec3 along = unit(e);
    dvec3 height = f;
    for (int round = 0; round < 2; ++round) height -= glm::dot(height, along) * along;
    const dvec3 across = unit(height);
    if (n == dvec3(0.0) || across == dvec3(0.0)) return;
    double s = 0;
    double t = 0;
    dvec3 point = from;
    for (int round = 0; round < 2; ++round) {
      const double more = -glm::dot(point, across) / glm::length(height);
      s -= (glm::dot(point, along) + more * glm::dot(f, along)) / length;
      t += more;
      point = from + s * e + t * f;
    }
    if (!(s > 0 && t > 0 && s + t < 1)) return;
    offer(point, aligned(unit(n), point), {corner[0], corner[1], corner[2], -1},
          {1 - s - t, s, t, 0}, 3);
  }

  /// The origin is inside if it lies on each face's side that the opposite corner is on.
  void offer_tetrahedron() {
    std::array<double, 4> weight = {};
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
      const dvec3& a = at((k + 1) % 4);
      const dvec3 n = glm::cross(at((k + 2) % 4) - a, at((k + 3) % 4) - a);
      const double share = -glm::dot(n, a) / glm::dot(n, at(k) - a);
      if (!(share > 0)) return;
      weight[std::size_t(k)] = share;
      sum += share;
    }
    dvec3 point(0.0);
    for (int k = 0; k < 4; ++k) {
      weight[std::size_t(k)] /= sum;
      point += weight[std::size_t(k)] * at(k);
    }
    best_ = {point, best_.direction, {0, 1, 2, 3}, weight, 4, true};
  }

  std::span<const dvec3> points_;
  double rounding_ = 0;  ///< of the norm of a point in their hull
  NearestInSimplex best_;
  double norm_ = infinity;
};

}  // namespace

NearestInSimplex nearest_in_simplex(std::span<const dvec3> points) { return Search(points).run(); }

Corral::Corral(const dvec3& point)
    : points_{point}, nearest_(nearest_in_simplex(std::span(points_).first(1))) {}

void Corral::add(const dvec3& point) {
  const std::array<dvec3, 4> before = points_;
  const auto size = std::size_t(nearest_.size);
  for (std::size_t k = 0; k < size; ++k) {
    points_[k] = before[std::size_t(nearest_.carrier[k])];
  }
  points_[size] = point;
  nearest_ = nearest_in_simplex(std::span(points_).first(size + 1));
}

}  // namespace taut
