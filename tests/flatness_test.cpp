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

/// A quarter of a cylinder, of degrees (3, 3), with one of its inner control points moved, and the
/// weight of another changed.
BezierPatch bent_cylinder(double moved, double reweighted) {
  BezierPatch patch = elevated(decompose(cylinder(1, 2).surfaces[0])[0].bezier, 3, 3);
  patch.at(1, 2) += dvec4(moved * patch.at(1, 2).w, 0, 0, 0);
  patch.at(2, 1) *= 1 + reweighted;
  return patch;
}

/// Largest distance of points of the patch from the segments between the ends of its lines.
double farthest_from_lines(const BezierPatch& patch, Direction direction) {
  constexpr int places = 24;
  double farthest = 0;
  for (int i = 0; i <= places; ++i) {
    for (int k = 0; k <= places; ++k) {
      const double s = double(i) / places, t = double(k) / places;
      const bool along_u = direction == Direction::u;
      const dvec3 a = along_u ? point(patch, 0, t) : point(patch, t, 0);
      const dvec3 b = along_u ? point(patch, 1, t) : point(patch, t, 1);
      const dvec3 x = along_u ? point(patch, s, t) : point(patch, t, s);
      const double share = std::clamp(glm::dot(x - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
      farthest = std::max(farthest, glm::distance(x, glm::mix(a, b, share)));
    }
  }
  return farthest;
}

/// The direction in which a patch of a cylinder is straight.
Direction straight(const BezierPatch& patch) {
  return farthest_from_lines(patch, Direction::u) < farthest_from_lines(patch, Direction::v)
             ? Direction::u
             : Direction::v;
}

TEST(Flatness, DistancesFromRuledPatchesAreBounds) {
  for (const double moved : {0.0, 1e-9, 1e-6, 1e-3}) {
    for (const double reweighted : {0.0, 1e-8, 1e-4}) {
      const BezierPatch patch = bent_cylinder(moved, reweighted);
      const Direction along = straight(patch);
      const double bound = distance_from_ruled(patch, along);
      EXPECT_GE(bound + 1e-15, farthest_from_lines(patch, along));
      EXPECT_LE(bound, 2 * moved + 10 * reweighted + 1e-14);
      EXPECT_NEAR(square_of_lines(patch, along), 4, 1e-2);
    }
  }
  const BezierPatch across = bent_cylinder(0, 0);
  const Direction other = straight(across) == Direction::u ? Direction::v : Direction::u;
  EXPECT_GE(distance_from_ruled(across, other), farthest_from_lines(across, other));
}

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
