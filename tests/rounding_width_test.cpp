#include "taut/hull/polytope/rounding_width.h"

#include <gtest/gtest.h>

#include <vector>

#include "models.h"
#include "taut/hull/polyhedral/polyhedral_hull.h"

namespace taut_test::rounding_widths {
namespace {

using namespace taut;  // NOLINT: what is tested

TEST(RoundingWidth, IsNoneAlongAxesOfWholeNumbers) {
  const std::vector<dvec3> points = {{0, 0.1, 1}, {3, 0.2, -7}, {2, 1e6, 0.5}};
  const RoundingWidth width = rounding_width(points, 1e-9);
  EXPECT_EQ(width.half_axes, dvec3(0, 1e-9, 0));
  EXPECT_DOUBLE_EQ(width.along({0.6, 0.8, 0}), 0.8e-9);
  EXPECT_EQ(width.largest(), 1e-9);
  EXPECT_EQ(rounding_width(points, 0).largest(), 0);
  EXPECT_EQ(rounding_width({}, 1).largest(), 0);
  EXPECT_DOUBLE_EQ(RoundingWidth(2.0).along(unit(dvec3(1, 2, 3))), 2);
}

int vertex_count(const std::vector<dvec3>& points, std::optional<double> resolution = {}) {
  return int(
      polyhedral_hull(make_model({{}, {}, points}), {.resolution = resolution, .progress = {}})
          .mesh.n_vertices());
}

/// Corners that are far less extreme than the longest coordinate's rounding, across it.
TEST(RoundingWidth, CornersOfNeedlesAreKept) {
  for (const double length : {1e4, 1e8, 1e10, 1e8 + 0.3}) {
    const std::vector<dvec3> spike = {
        {0, 1, 0}, {1, length / 2, 0}, {2, length, 0}, {2, -1, 0}, {0, -1, 0}};
    EXPECT_EQ(vertex_count(spike), 4) << length;
    std::vector<dvec3> solid = spike;
    for (dvec3& p : solid) p.z = p.x;
    solid.push_back({1, 0, 5});
    EXPECT_EQ(vertex_count(solid), 5) << length;
  }
}

TEST(RoundingWidth, PointsLeftOutAreCounted) {
  const std::vector<dvec3> nearly_square = {
      {0.1, 0.1, 0}, {0.7, 0.1, 0}, {0.7, 0.7, 0}, {0.1, 0.7, 0}, {0.4, 0.1 - 0x1p-53, 0}};
  const Model model = make_model({{}, {}, nearly_square});
  const Hull rounded = polyhedral_hull(model, {});
  EXPECT_EQ(rounded.mesh.n_vertices(), 4U);
  EXPECT_EQ(rounded.points_left_out, 1);
  EXPECT_GE(rounded.distance_bound, 0x1p-53);
  const Hull whole = polyhedral_hull(model, {.resolution = 0, .progress = {}});
  EXPECT_EQ(whole.mesh.n_vertices(), 5U);
  EXPECT_EQ(whole.points_left_out, 0);
  EXPECT_EQ(whole.resolution.rho, 0);
}

/// What turning leaves of coplanar corners is still put down to rounding.
TEST(RoundingWidth, TurnedBoxesKeepTheirCorners) {
  std::vector<dvec3> points;
  for (int i = 0; i < 27; ++i) points.push_back(dvec3(i % 3, i / 3 % 3, i / 9));
  EXPECT_EQ(vertex_count(points), 8);
  for (dvec3& p : points) p = skew_rotation() * p;
  EXPECT_EQ(vertex_count(points), 8);
  EXPECT_GT(vertex_count(points, 0), 8);
}

}  // namespace
}  // namespace taut_test::rounding_widths
