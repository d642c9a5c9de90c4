#include "taut/core/geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace taut {
namespace {

/// Also where it is bent, or small, or not convex at the corner that it begins at.
TEST(Geometry, NormalsOfPolygons) {
  EXPECT_EQ(polygon_normal({{0, 0, 7}, {4, 0, 7}, {1, 1, 7}, {0, 4, 7}}), dvec3(0, 0, 1));
  EXPECT_EQ(polygon_normal({{1, 1, 7}, {0, 4, 7}, {0, 0, 7}, {4, 0, 7}}), dvec3(0, 0, 1));
  EXPECT_EQ(polygon_normal({{4, 0, 7}, {0, 0, 7}, {0, 4, 7}, {1, 1, 7}}), dvec3(0, 0, -1));
  EXPECT_EQ(polygon_normal({{0, 0, 0}, {1e-200, 0, 0}, {0, 0, 1e-110}}), dvec3(0, -1, 0));
  const dvec3 n = polygon_normal({{0, 0, 0.1}, {1, 0, -0.1}, {1, 1, 0.1}, {0, 1, -0.1}});
  EXPECT_LT(glm::distance(n, dvec3(0, 0, 1)), 1e-15);
  EXPECT_EQ(polygon_normal({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}), dvec3(0.0));
  EXPECT_EQ(polygon_normal({}), dvec3(0.0));
}

/// A sliver 1e-8 wide far from the origin: its corners lie in the plane that the normal tells.
TEST(Geometry, NormalsOfSliversArePerpendicularToThem) {
  const dvec3 a(-1.333991, -3.243868, -0.743447), b(0.801432, -7.283211, -1.388824);
  const dvec3 c(2.936855, -11.322555, -2.034201);
  const dvec3 n = plane_normal({a, b, c});
  EXPECT_NEAR(glm::length(n), 1, 1e-15);
  EXPECT_LT(std::abs(glm::dot(n, b - a)), 1e-14);
  EXPECT_LT(std::abs(glm::dot(n, c - a)), 1e-14);
  EXPECT_EQ(plane_normal({a, b, a}), dvec3(0.0));
  EXPECT_EQ(plane_normal({{0, 0, 7}, {4, 0, 7}, {4, 1, 7}, {0, 1, 7}}), dvec3(0, 0, 1));
}

/// What corners are off a plane by, as they are where coordinates round, counts no more than thirty
/// times, whatever the polygon's width and the number of its sides.
TEST(Geometry, NormalsOfPolygonsThatAreNotQuitePlane) {
  constexpr double off = 1e-11;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> share(-1, 1);
  double worst = 0;
  for (const double width : {1.0, 1e-3, 1e-6}) {
    for (const int count : {3, 4, 5, 20, 1000}) {
      std::vector<dvec3> points;
      for (int k = 0; k < count; ++k) {
        const double angle = 2 * std::numbers::pi * k / count;
        points.emplace_back(std::cos(angle), width * std::sin(angle), off * share(random));
      }
      const dvec3 n = plane_normal(points);
      for (const dvec3& p : points) worst = std::max(worst, std::abs(glm::dot(p - points[0], n)));
    }
  }
  EXPECT_LT(worst, 30 * off);
}

/// Over a sliver between two faces angles add up to that without it, whatever its normal.
TEST(Geometry, ExteriorAngles) {
  const dvec3 along(0, 0, 1);
  EXPECT_NEAR(exterior_angle({1, 0, 0}, {0, 1, 0}, along), std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(exterior_angle({1, 0, 0}, {-1, 0, 0}, along), std::numbers::pi, 1e-15);
  EXPECT_NEAR(exterior_angle({1, 0, 0}, {-1, -0.0, 0}, -along), std::numbers::pi, 1e-15);
  EXPECT_NEAR(exterior_angle({1, 0, 0}, {std::cos(1e-9), -std::sin(1e-9), 0}, along), -1e-9, 1e-20);
  const dvec3 between = unit({0.6, -0.1, 0.3});
  EXPECT_NEAR(exterior_angle({1, 0, 0}, between, along) + exterior_angle(between, {0, 1, 0}, along),
              std::numbers::pi / 2, 1e-15);
}

}  // namespace
}  // namespace taut
