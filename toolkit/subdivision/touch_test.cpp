#include "taut/subdivision/touch_test.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "taut/core/integers.h"

namespace taut {
namespace {

/// The direction through (a, b) of [-1, 1]^2 on a side of a cube.
dvec3 through(int side, double a, double b) {
  const double sign = side % 2 == 0 ? 1 : -1;
  dvec3 x(0.0);
  x[side / 2] = sign;
  x[(side / 2 + 1) % 3] = a;
  x[(side / 2 + 2) % 3] = b;
  return unit(x);
}

/// The largest (p - q) . n for directions n within an angle of an axis.
double may_rise(const dvec3& p, const dvec3& q, const dvec3& axis, double cos_angle,
                double sin_angle) {
  const dvec3 d = p - q;
  const double along = glm::dot(d, axis);
  const double length = glm::length(d);
  const double across = std::sqrt(std::max(0.0, length * length - along * along));
  return across * cos_angle <= along * sin_angle ? length : along * cos_angle + across * sin_angle;
}

/// The four quarters of a cell, on the next level.
std::array<std::size_t, 4> children(int level, std::size_t index) {
  const std::size_t n = std::size_t{1} << level;
  const std::size_t side = index / (n * n);
  const std::size_t i = 2 * (index / n % n);
  const std::size_t j = 2 * (index % n);
  const auto number = [&](std::size_t a, std::size_t b) {
    return (side * 2 * n + i + a) * 2 * n + j + b;
  };
  return {number(0, 0), number(0, 1), number(1, 0), number(1, 1)};
}

}  // namespace

TouchTest::TouchTest() {
  for (int level = 0; level < level_count; ++level) {
    const int n = 1 << level;
    levels_[to_size(level)].reserve(6 * to_size(n) * to_size(n));
    for (int k = 0; k < 6 * n * n; ++k) {
      const int side = k / (n * n);
      const auto at = [&](double i, double j) {
        return through(side, 2 * i / n - 1, 2 * j / n - 1);
      };
      const double i = k / n % n;
      const double j = k % n;
      Cell cell;
      cell.axis = at(i + 0.5, j + 0.5);
      for (const double a : {0.0, 1.0}) {
        for (const double b : {0.0, 1.0}) {
          cell.cos_angle = std::min(cell.cos_angle, glm::dot(cell.axis, at(i + a, j + b)));
        }
      }
      cell.sin_angle = std::sqrt(1 - cell.cos_angle * cell.cos_angle);
      cell.height = -std::numeric_limits<double>::infinity();
      levels_[to_size(level)].push_back(cell);
    }
  }
}

void TouchTest::add(std::span<const dvec3> points) {
  empty_ = empty_ && points.empty();
  for (const dvec3& p : points) {
    for (std::size_t side = 0; side < 6; ++side) add(p, 0, side);
  }
}

/// Goes down where the point may be farther than what is known in some direction.
void TouchTest::add(const dvec3& p, int level, std::size_t index) {
  Cell& cell = levels_[to_size(level)][index];
  const double height = glm::dot(cell.axis, p);
  if (height > cell.height) {
    cell.height = height;
    cell.farthest = p;
  } else if (may_rise(p, cell.farthest, cell.axis, cell.cos_angle, cell.sin_angle) <= 0) {
    return;
  }
  if (level + 1 == level_count) return;
  for (const std::size_t child : children(level, index)) add(p, level + 1, child);
}

bool TouchTest::may_touch(std::span<const dvec3> points) const {
  if (empty_) return true;
  for (std::size_t side = 0; side < 6; ++side) {
    if (may_touch(points, 0, side)) return true;
  }
  return false;
}

bool TouchTest::may_touch(std::span<const dvec3> points, int level, std::size_t index) const {
  const Cell& cell = levels_[to_size(level)][index];
  const bool below = std::all_of(points.begin(), points.end(), [&](const dvec3& p) {
    return may_rise(p, cell.farthest, cell.axis, cell.cos_angle, cell.sin_angle) < 0;
  });
  if (below) return false;
  if (level + 1 == level_count) return true;
  const auto next = children(level, index);
  return std::any_of(next.begin(), next.end(),
                     [&](std::size_t child) { return may_touch(points, level + 1, child); });
}

}  // namespace taut
