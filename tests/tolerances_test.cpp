#include "taut/core/tolerances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models.h"
#include "reference.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

double reach_of(const std::vector<dvec3>& points) {
  dvec3 largest(0.0);
  for (const dvec3& p : points) largest = glm::max(largest, glm::abs(p));
  return largest.x + largest.y + largest.z;
}

/// How far the points lie from the plane through the first three, as a share of their reach.
double off_plane(const std::vector<dvec3>& points) {
  const rvec3 a(points[0]);
  const rvec3 n = glm::normalize(glm::cross(rvec3(points[1]) - a, rvec3(points[2]) - a));
  real off = 0;
  for (const dvec3& p : points) off = std::max(off, std::abs(glm::dot(rvec3(p) - a, n)));
  return double(off) / reach_of(points);
}

/// Points of a square in the x-y plane, three corners first, turned and moved in double precision.
TEST(Tolerances, CoordinateRoundingCoversTurnedAndMovedPlanes) {
  Random random(1);
  double worst = 0;
  for (int round = 0; round < 3000; ++round) {
    const dmat3 turn = random_rotation(random);
    const double far = log_uniform(random, 1e-3, 1e4);
    const dvec3 shift = far * random_point(random);
    std::vector<dvec3> points = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}};
    for (int k = 0; k < 60; ++k) {
      points.emplace_back(uniform(random, -1, 1), uniform(random, -1, 1), 0);
    }
    for (dvec3& p : points) p = turn * p + shift;
    worst = std::max(worst, off_plane(points));
  }
  EXPECT_LE(worst, coordinate_rounding);
  // Not by orders of magnitude either.
  EXPECT_GE(worst, coordinate_rounding / 32);
}

/// Homogeneous points of a plane far away, as surfaces hold them.
TEST(Tolerances, FlatCoordinateWidthCoversWeightedPlanes) {
  Random random(2);
  double worst = 0;
  for (int round = 0; round < 3000; ++round) {
    const dmat3 turn = random_rotation(random);
    const dvec3 shift = log_uniform(random, 1e2, 1e6) * random_point(random);
    std::vector<dvec3> points = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}};
    for (int k = 0; k < 20; ++k) {
      points.emplace_back(uniform(random, -1, 1), uniform(random, -1, 1), 0);
    }
    for (dvec3& p : points) {
      p = euclidean(homogeneous(turn * p + shift, uniform(random, 0.5, 2)));
    }
    worst = std::max(worst, off_plane(points));
  }
  EXPECT_LE(worst, flat_coordinate_width);
  EXPECT_GE(worst, flat_coordinate_width / 32);
}

}  // namespace
}  // namespace taut
