#include "taut/hull/polytope/outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// In the plane z = 1, seen from above; small integers, of which many are equal or in line.
std::vector<dvec3> grid_points(Random& random, int count, int size) {
  std::vector<dvec3> points;
  for (int i = 0; i < count; ++i) {
    const int x = pick(random, 0, size);
    points.emplace_back(x, pick(random, 0, size), 1);
  }
  return points;
}

const PlaneView from_above({0, 0, 1}, {1, 0, 1}, {0, 1, 1});

double turn(const dvec3& a, const dvec3& b, const dvec3& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// A point is a corner if it is no convex combination of others: of none on a segment, of none in a
/// triangle (Caratheodory).
bool is_corner(const std::vector<dvec3>& points, const dvec3& p) {
  for (const dvec3& a : points) {
    for (const dvec3& b : points) {
      if (a == p || b == p) continue;
      if (turn(a, b, p) == 0 && glm::dot(a - p, b - p) < 0) return false;
      for (const dvec3& c : points) {
        if (turn(a, b, p) > 0 && turn(b, c, p) > 0 && turn(c, a, p) > 0) return false;
      }
    }
  }
  return true;
}

TEST(ConvexOutline, HasTheCornersCounterclockwise) {
  Random random(1);
  for (int trial = 0; trial < 60; ++trial) {
    const std::vector<dvec3> points = grid_points(random, pick(random, 1, 18), trial % 6);
    const std::vector<int> outline = convex_outline(points, from_above);
    for (const dvec3& p : points) {
      const auto same = [&](int i) { return points[std::size_t(i)] == p; };
      EXPECT_EQ(std::count_if(outline.begin(), outline.end(), same), is_corner(points, p) ? 1 : 0);
    }
    const std::size_t n = outline.size();
    for (std::size_t k = 0; n >= 3 && k < n; ++k) {
      const auto at = [&](std::size_t i) { return points[std::size_t(outline[i % n])]; };
      EXPECT_GT(turn(at(k), at(k + 1), at(k + 2)), 0);
    }
  }
}

TEST(ConvexOutline, IsThatOfTheViewFromTheOtherSide) {
  const std::vector<dvec3> square = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0}};
  const PlaneView from_below(square[0], square[3], square[1]);
  std::vector<int> outline = convex_outline(square, from_below);
  std::rotate(outline.begin(), std::find(outline.begin(), outline.end(), 0), outline.end());
  EXPECT_EQ(outline, (std::vector<int>{0, 3, 2, 1}));
}

double distance_to_segment(const dvec3& p, const dvec3& a, const dvec3& b) {
  const double s = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
  return glm::distance(p, a + s * (b - a));
}

/// Noise on a square's sides goes, its corners stay.
TEST(SimplifiedOutline, LeavesOutWhatLiesWithinTheWidth) {
  constexpr double width = 1e-9;
  Random random(2);
  std::vector<dvec3> points = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (int i = 0; i < 40; ++i) {
    const double s = uniform(random, 0.01, 0.99);
    points.emplace_back(s, -uniform(random, 0, width / 4), 1);
  }
  const std::vector<int> outline = convex_outline(points, from_above);
  EXPECT_GT(outline.size(), 4U);
  const std::vector<int> simplified = simplified_outline(outline, points, width);
  EXPECT_EQ(simplified.size(), 4U);
  for (const int i : outline) {
    double nearest = 1;
    for (std::size_t k = 0; k < simplified.size(); ++k) {
      const int a = simplified[k];
      const int b = simplified[(k + 1) % simplified.size()];
      nearest =
          std::min(nearest, distance_to_segment(points[std::size_t(i)], points[std::size_t(a)],
                                                points[std::size_t(b)]));
    }
    EXPECT_LE(nearest, width);
  }
}

TEST(SimplifiedOutline, KeepsTwoCornersOfWhatIsALine) {
  const std::vector<dvec3> points = {{0, 0, 1}, {1, -1e-12, 1}, {2, 0, 1}, {1, 1e-12, 1}};
  const std::vector<int> outline = convex_outline(points, from_above);
  ASSERT_EQ(outline.size(), 4U);
  std::vector<int> simplified = simplified_outline(outline, points, 1e-9);
  std::sort(simplified.begin(), simplified.end());
  EXPECT_EQ(simplified, (std::vector<int>{0, 2}));
}

}  // namespace
}  // namespace taut
