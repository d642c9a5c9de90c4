#include "taut/subdivision/touch_test.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace taut {
namespace {

std::size_t to_size(int n) { return static_cast<std::size_t>(n); }

/// The direction through (a, b) of [-1, 1]^2 on a side of a cube.
dvec3 through(int side, double a, double b) {
  const double sign = side % 2 == 0 ? 1 : -1;
  dvec3 x(0.0);
  x[side / 2] = sign;
  x[(side / 2 + 1) % 3] = a;
  x[(side / 2 + 2) % 3] = b;
  return unit(x);
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
  if (points.empty()) return;
  empty_ = false;
  const auto update = [](Cell& cell, const dvec3& p) {
    const double height = glm::dot(cell.axis, p);
    if (height <= cell.height) return;
    cell.height = height;
    cell.farthest = p;
  };
  // The finest cells take what is farthest in those before them, and all points of small sets.
  constexpr std::size_t few = 4096;
  const std::size_t exact_levels = points.size() <= few ? level_count : level_count - 1;
  for (std::size_t level = 0; level < exact_levels; ++level) {
    for (Cell& cell : levels_[level]) {
      for (const dvec3& p : points) update(cell, p);
    }
  }
  if (exact_levels == level_count) return;
  for (Cell& cell : levels_.back()) {
    for (const Cell& coarse : levels_[level_count - 2]) update(cell, coarse.farthest);
  }
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
    const dvec3 d = p - cell.farthest;
    const double along = glm::dot(d, cell.axis);
    const double across = std::sqrt(std::max(0.0, glm::dot(d, d) - along * along));
    return along * cell.cos_angle + across * cell.sin_angle < 0 &&
           across * cell.cos_angle > along * cell.sin_angle;
  });
  if (below) return false;
  if (level + 1 == level_count) return true;
  const std::size_t n = std::size_t{1} << level;
  const std::size_t side = index / (n * n);
  const std::size_t i = index / n % n;
  const std::size_t j = index % n;
  for (const std::size_t a : {0U, 1U}) {
    for (const std::size_t b : {0U, 1U}) {
      if (may_touch(points, level + 1, (side * 2 * n + 2 * i + a) * 2 * n + 2 * j + b)) return true;
    }
  }
  return false;
}

}  // namespace taut
