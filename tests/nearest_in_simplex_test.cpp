#include "taut/core/nearest_in_simplex.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

TEST(NearestInSimplex, LiesInTheSimplexAndNoCornerIsNearerToTheOrigin) {
  taut_test::Random random(11);
  for (int k = 0; k < 10'000; ++k) {
    std::vector<dvec3> points(std::size_t(pick(random, 1, 4)));
    const double size = log_uniform(random, 1e-9, 1);
    for (dvec3& p : points) p = dvec3(0.5, 0, 0) + size * random_point(random);
    const NearestInSimplex nearest = nearest_in_simplex(points);
    dvec3 sum(0.0);
    double weights = 0;
    for (int i = 0; i < nearest.size; ++i) {
      const auto at = std::size_t(i);
      EXPECT_GT(nearest.weight[at], 0);
      weights += nearest.weight[at];
      sum += nearest.weight[at] * points[std::size_t(nearest.carrier[at])];
    }
    EXPECT_NEAR(weights, 1, 1e-15);
    if (nearest.contains_origin) continue;
    EXPECT_NEAR(glm::distance(sum, nearest.point), 0, 1e-14);
    // No corner is below the plane across the nearest point: it is the nearest of all.
    for (const dvec3& p : points) {
      EXPECT_GE(glm::dot(p - nearest.point, unit(nearest.point)), -1e-13);
    }
  }
}

TEST(NearestInSimplex, KnowsTheOriginInATetrahedron) {
  const std::vector<dvec3> about = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  EXPECT_TRUE(nearest_in_simplex(about).contains_origin);
  std::vector<dvec3> beside = about;
  for (dvec3& p : beside) p.x += 1.2;
  EXPECT_FALSE(nearest_in_simplex(beside).contains_origin);
  EXPECT_FALSE(nearest_in_simplex(std::span(about).first(3)).contains_origin);
  const std::vector<dvec3> flat = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  EXPECT_FALSE(nearest_in_simplex(flat).contains_origin);
  EXPECT_EQ(glm::length(nearest_in_simplex(flat).point), 0);
}

/// Wide triangles next to the origin: the direction is the normal's, far more exact than the point
/// would tell, and slender ones do not lose the foot.
TEST(NearestInSimplex, KnowsTheDirectionNextToTheOrigin) {
  taut_test::Random random(12);
  for (int k = 0; k < 1000; ++k) {
    const dmat3 placed = random_rotation(random);
    const double below = log_uniform(random, 1e-14, 1e-6);
    const double width = log_uniform(random, 1e-4, 1);
    std::vector<dvec3> points = {{1, -0.3 * width, below}, {-1, -0.3 * width, below}};
    points.emplace_back(uniform(random, -0.9, 0.9), 0.7 * width, below);
    for (dvec3& p : points) p = placed * p;
    std::shuffle(points.begin(), points.end(), random);
    const NearestInSimplex nearest = nearest_in_simplex(points);
    EXPECT_EQ(nearest.size, 3);
    EXPECT_LT(glm::distance(nearest.direction, placed * dvec3(0, 0, 1)), 4e-15 / width) << below;
    EXPECT_NEAR(glm::length(nearest.point), below, 1e-15);
  }
}

TEST(NearestInSimplex, WritesTheOriginAsASumOfFour) {
  taut_test::Random random(13);
  int inside = 0;
  for (int k = 0; k < 1000; ++k) {
    std::vector<dvec3> points(4);
    for (dvec3& p : points) p = random_direction(random);
    const NearestInSimplex nearest = nearest_in_simplex(points);
    if (!nearest.contains_origin) continue;
    ++inside;
    EXPECT_EQ(nearest.size, 4);
    EXPECT_LT(glm::length(nearest.point), 1e-12);
    for (const double w : nearest.weight) EXPECT_GT(w, 0);
  }
  EXPECT_GT(inside, 80);  // one in eight
}

}  // namespace
}  // namespace taut
