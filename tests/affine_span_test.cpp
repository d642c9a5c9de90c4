#include "taut/hull/polytope/affine_span.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

constexpr double width = 1e-6;

/// Points of a part of space of this dimension, turned, some off it by less than a quarter of the
/// width.
std::vector<dvec3> spread(Random& random, int dimension) {
  const dmat3 turn = random_rotation(random);
  const dvec3 origin = random_point(random);
  std::vector<dvec3> points;
  for (int i = 0; i < 50; ++i) {
    dvec3 p = 0.2 * width * random_direction(random);
    for (int k = 0; k < dimension; ++k) p += uniform(random, -1, 1) * turn[k];
    points.push_back(origin + p);
  }
  return points;
}

TEST(AffineSpan, HasTheDimensionOfWhatPointsSpan) {
  Random random(1);
  for (int dimension = 0; dimension <= 3; ++dimension) {
    for (int trial = 0; trial < 20; ++trial) {
      EXPECT_EQ(affine_span(spread(random, dimension), width).dimension, dimension);
    }
  }
}

TEST(AffineSpan, WitnessesAreDifferentPointsThatSpanIt) {
  Random random(2);
  for (int dimension = 0; dimension <= 3; ++dimension) {
    const std::vector<dvec3> points = spread(random, dimension);
    const AffineSpan span = affine_span(points, width);
    const std::set<int> witnesses(span.witnesses.begin(), span.witnesses.begin() + dimension + 1);
    EXPECT_EQ(int(witnesses.size()), dimension + 1);
    EXPECT_GE(*witnesses.begin(), 0);
    EXPECT_LT(*witnesses.rbegin(), int(points.size()));
  }
}

TEST(AffineSpan, PointsDeviateByLessThanTheWidth) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<dvec3> on_line = spread(random, 1);
    const AffineSpan line = affine_span(on_line, width);
    const std::vector<dvec3> on_plane = spread(random, 2);
    const AffineSpan plane = affine_span(on_plane, width);
    EXPECT_NEAR(glm::length(line.line), 1, 1e-14);
    EXPECT_NEAR(glm::length(plane.normal), 1, 1e-14);
    for (const dvec3& p : on_line) {
      const dvec3 d = p - on_line[std::size_t(line.witnesses[0])];
      EXPECT_LT(glm::length(d - glm::dot(d, line.line) * line.line), width * (1 + 1e-9));
    }
    for (const dvec3& p : on_plane) {
      const dvec3 d = p - on_plane[std::size_t(plane.witnesses[0])];
      EXPECT_LT(std::abs(glm::dot(d, plane.normal)), width * (1 + 1e-9));
    }
  }
}

TEST(AffineSpan, DirectionsAcrossLeaveIt) {
  Random random(4);
  const std::array<std::size_t, 4> count = {26, 8, 2, 0};
  for (int dimension = 0; dimension <= 3; ++dimension) {
    const AffineSpan span = affine_span(spread(random, dimension), width);
    const std::vector<dvec3> directions = directions_across(span);
    EXPECT_EQ(directions.size(), count[std::size_t(dimension)]);
    for (const dvec3& n : directions) {
      EXPECT_NEAR(glm::length(n), 1, 1e-14);
      const double off_line = glm::dot(n, span.line);
      const double off_plane = std::abs(glm::dot(n, span.normal));
      EXPECT_TRUE(dimension != 1 || std::abs(off_line) <= 1e-14) << off_line;
      EXPECT_TRUE(dimension != 2 || off_plane >= 1 - 1e-14) << off_plane;
    }
  }
}

}  // namespace
}  // namespace taut
