#include "taut/envelope/cull/concave_patch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models.h"
#include "taut/envelope/cull/convex_cap.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

constexpr int root = 0;

/// Outward of a surface about the origin of the scene's frame, in the middle of the patch.
dvec3 middle_of(const ConcavePatch& patch) { return point(patch.bezier(), 0.5, 0.5); }

TEST(ConcavePatch, OfASphereIsConcaveFromOutsideAlone) {
  const Scene scene = make_scene(sphere(2));
  ConcaveSurfaces surfaces(scene);
  const double radius = 2 * scene.frame().scale;
  for (int k = 0; k < int(surfaces.patches(0).size()); ++k) {
    ConcavePatch& patch = surfaces.patch(0, k);
    const dvec3 out = unit(middle_of(patch));
    EXPECT_TRUE(patch.is_concave(root, out)) << k;
    EXPECT_FALSE(patch.is_concave(root, -out)) << k;
    // Normals of an eighth are not all within a right angle of one that lies across.
    EXPECT_FALSE(patch.is_concave(root, unit(glm::cross(out, dvec3(0.3, 0.2, 1))))) << k;
    EXPECT_NEAR(patch.curvature({0.5, 0.5}) * radius * radius, 1, 1e-12) << k;
  }
}

/// Whatever is curved two ways, or is planar, is not concave however it is divided.
TEST(ConcavePatch, OfASaddleOrAPlaneIsNotConcave) {
  for (const Shape& shape : {saddle(), bilinear_saddle(), box(1, 2, 3)}) {
    const Scene scene = make_scene(shape);
    ConcaveSurfaces surfaces(scene);
    ConcavePatch& patch = surfaces.patch(0, 0);
    const dvec3 n = unit_normal(patch.bezier(), 0.5, 0.5);
    std::vector<int> nodes = {root};
    for (std::size_t i = 0; i < nodes.size() && i < 31; ++i) {
      EXPECT_FALSE(patch.is_concave(nodes[i], n)) << i;
      EXPECT_FALSE(patch.is_concave(nodes[i], -n)) << i;
      for (const int half : {0, 1}) nodes.push_back(patch.child(nodes[i], half));
    }
  }
}

/// On one of the rectangles that five halvings give.
bool is_concave_somewhere(ConcavePatch& patch, const dvec3& m) {
  std::vector<int> nodes = {root};
  for (std::size_t i = 0; i < 31; ++i) {
    if (patch.is_concave(nodes[i], m)) return true;
    for (const int half : {0, 1}) nodes.push_back(patch.child(nodes[i], half));
  }
  return false;
}

/// Along its rims, which bound the outer side, the curvature vanishes.
TEST(ConcavePatch, OfATorusIsConcaveOnItsOuterSide) {
  const Scene scene = make_scene(torus(2, 0.5));
  ConcaveSurfaces surfaces(scene);
  int outer = 0;
  for (int k = 0; k < int(surfaces.patches(0).size()); ++k) {
    ConcavePatch& patch = surfaces.patch(0, k);
    const dvec3 x = scene.frame().to_model(middle_of(patch));
    const double from_axis = std::hypot(x.x, x.y);
    const dvec3 center = 2.0 / from_axis * dvec3(x.x, x.y, 0);
    EXPECT_EQ(is_concave_somewhere(patch, unit(x - center)), from_axis > 2) << k;
    outer += from_axis > 2 ? 1 : 0;
  }
  EXPECT_EQ(outer, 8);
}

TEST(ConcavePatch, HalvesTileTheirRectangleAndItsPointsHoldTheSurface) {
  const Scene scene = make_scene(ellipsoid(3, 2, 1));
  ConcaveSurfaces surfaces(scene);
  ConcavePatch& patch = surfaces.patch(0, 0);
  std::vector<int> nodes = {root};
  for (std::size_t i = 0; i < 15; ++i) {
    const int node = nodes[i];
    const ParameterRectangle whole = patch.cell(node);
    double area = 0;
    for (const int k : {0, 1}) {
      const int half = patch.child(node, k);
      const ParameterRectangle cell = patch.cell(half);
      EXPECT_TRUE(whole.contains(cell));
      EXPECT_EQ(patch.level(half), patch.level(node) + 1);
      area += (cell.u.upper - cell.u.lower) * (cell.v.upper - cell.v.lower);
      nodes.push_back(half);
    }
    EXPECT_DOUBLE_EQ(area, (whole.u.upper - whole.u.lower) * (whole.v.upper - whole.v.lower));
    Box box;
    for (const dvec3& p : patch.points(node)) box.include(p);
    const dvec2 middle = patch.cell(node).middle();
    const dvec3 x = point(patch.bezier(), middle.x, middle.y);
    EXPECT_TRUE(glm::all(glm::lessThanEqual(box.lower - 1e-14, x)));
    EXPECT_TRUE(glm::all(glm::lessThanEqual(x, box.upper + 1e-14)));
  }
}

}  // namespace
}  // namespace taut
