#include "taut/surface/flatness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "freeform.h"
#include "models.h"
#include "taut/surface/model.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

TEST(Flatness, DistancesFromSegmentsAndPlanesAreBounds) {
  const BezierCurve straight_one = {{{0, 0, 0, 1}, {1, 1e-7, 0, 1}, {2, 0, 0, 1}}};
  EXPECT_DOUBLE_EQ(distance_from_segment(straight_one), 1e-7);
  const BezierCurve beyond = {{{0, 0, 0, 1}, {3, 0, 0, 1}, {2, 0, 0, 1}}};
  EXPECT_DOUBLE_EQ(distance_from_segment(beyond), 1);
  BezierPatch plane = {1, 1, {{0, 0, 0, 1}, {0, 1, 0, 1}, {1, 0, 0, 1}, {1, 1, 0, 1}}};
  EXPECT_EQ(distance_from_plane(plane), 0);
  plane = elevated(plane, 2, 2);
  plane.at(1, 1).z = 1e-7;
  EXPECT_NEAR(distance_from_plane(plane), 1e-7, 1e-15);
}

/// Numbers of six decimals.
Shape with_decimals(Shape shape) {
  for (NurbsSurface& surface : shape.surfaces) {
    for (dvec4& p : surface.points) {
      dvec3 x = euclidean(p);
      for (int i = 0; i < 3; ++i) x[i] = std::round(1e6 * x[i]) / 1e6;
      p = homogeneous(x, p.w);
    }
  }
  return shape;
}

int patches_that_may_be_ruled(const Model& model) {
  const std::vector<Patch>& patches = model.parts()[0].patches();
  return int(std::count_if(patches.begin(), patches.end(),
                           [](const Patch& patch) { return patch.may_be_ruled(); }));
}

/// What was ruled before its numbers were rounded is told, to within the resolution that the
/// numbers ask for; what is curved is not, be it as small as rounding hardly tells.
TEST(Flatness, RoundedPatchesMayBeRuled) {
  const Shape turned = mapped(with_higher_degrees(solid_cylinder(1, 2)), skew_rotation());
  const Model cylinders = make_model(with_decimals(turned));
  EXPECT_EQ(patches_that_may_be_ruled(cylinders), int(cylinders.parts()[0].patches().size()));
  for (const Patch& patch : cylinders.parts()[0].patches()) EXPECT_TRUE(patch.lines(2e-6).any());

  const Shape round = mapped(split(sphere(1), 0.98, 0.98), skew_rotation());
  EXPECT_EQ(patches_that_may_be_ruled(make_model(with_decimals(round))), 0);
}

}  // namespace
}  // namespace taut
