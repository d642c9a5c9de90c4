#include "taut/core/geometry.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace taut
