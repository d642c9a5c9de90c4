#include "taut/hull/decide/round_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "models.h"
#include "taut/core/tolerances.h"

namespace {

using namespace taut_test;  // NOLINT: shapes
using taut::ContactGeometry;
using taut::MapPieces;
using taut::RoundShape;
using taut::Scene;

/// A model's elements, in the scene's frame.
struct Elements {
  explicit Elements(const Shape& shape)
      : scene(make_model(shape)), geometry(scene), pieces(geometry, taut::resolution_floor) {}
  std::vector<RoundShape> rounds(double distance = taut::resolution_floor) const {
    return taut::round_shapes(pieces, distance);
  }
  double scale() const { return scene.frame().length_to_frame(1); }

  Scene scene;
  ContactGeometry geometry;
  MapPieces pieces;
};

std::array<double, 3> sorted_radii(const RoundShape& shape) {
  std::array<double, 3> radii = {shape.radii.x, shape.radii.y, shape.radii.z};
  std::sort(radii.begin(), radii.end());
  return radii;
}

TEST(RoundShapes, OfAnEllipsoid) {
  const Elements elements(mapped(ellipsoid(3, 2, 1), skew_rotation()));
  const std::vector<RoundShape> found = elements.rounds();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].elements.size(), 8u);
  for (const int k : {0, 1, 2}) {
    EXPECT_NEAR(sorted_radii(found[0])[std::size_t(k)], (k + 1) * elements.scale(), 1e-13);
  }
  EXPECT_LE(found[0].inside, 1e-13);
}

TEST(RoundShapes, OfTheRimsOfAWall) {
  const Elements elements(mapped(cylinder(1, 2), skew_rotation()));
  const std::vector<RoundShape> found = elements.rounds();
  ASSERT_EQ(found.size(), 2u);
  for (const RoundShape& shape : found) {
    EXPECT_TRUE(shape.is_flat());
    EXPECT_EQ(sorted_radii(shape)[0], 0);
    EXPECT_NEAR(sorted_radii(shape)[1], elements.scale(), 1e-13);
    EXPECT_NEAR(sorted_radii(shape)[2], elements.scale(), 1e-13);
  }
}

TEST(RoundShapes, NoneOfWhatIsOpenOrNoQuadric) {
  EXPECT_TRUE(Elements(torus(2, 0.5)).rounds().empty());
  EXPECT_TRUE(Elements(blob(1)).rounds().empty());
  for (const RoundShape& shape : Elements(spherical_cap(1.5)).rounds()) {
    EXPECT_TRUE(shape.is_flat());
  }
  Shape arc;
  arc.curves.push_back(half_circle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  EXPECT_TRUE(Elements(arc).rounds().empty());
}

/// A circle by as many arcs, passed so many times.
NurbsCurve circle_of(int arcs, int turns) {
  const double half = pi * turns / arcs;
  NurbsCurve curve{2, {0, 0, 0}, {{1, 0, 0, 1}}};
  for (int k = 0; k < arcs; ++k) {
    const auto at = [&](double angle, double radius) {
      return dvec3(radius * std::cos(angle), radius * std::sin(angle), 0);
    };
    const double w = std::cos(half);
    curve.points.push_back(taut::homogeneous(at((2 * k + 1) * half, 1 / w), w));
    curve.points.push_back(taut::homogeneous(at((2 * k + 2) * half, 1)));
    curve.knots.insert(curve.knots.end(), 2, k + 1.0);
  }
  curve.knots.push_back(arcs);
  return curve;
}

/// A ray meets the one that is passed twice twice: that it is passed all around is not told.
TEST(RoundShapes, OfACircleByTheTurns) {
  for (const int turns : {1, 2, 3}) {
    Shape shape;
    shape.curves.push_back(circle_of(7, turns));
    EXPECT_EQ(Elements(shape).rounds().size(), turns % 2 == 1 ? 1u : 0u) << turns;
  }
}

TEST(RoundShapes, NoneFartherThanTheDistance) {
  Random random(1);
  Shape rough = sphere();
  const double off = 1e-6;
  for (dvec4& p : rough.surfaces[0].points) p += dvec4(off * random_direction(random), 0);
  EXPECT_TRUE(Elements(rough).rounds(1e-9).empty());
}

/// Points of a net that is off a shape by up to some distance are no farther from it than the
/// bounds, and these not far more.
TEST(RoundShapes, DistancesBoundThoseOfPoints) {
  Random random(2);
  double tightest = 0;
  double loosest = taut::infinity;
  for (int trial = 0; trial < 200; ++trial) {
    const dvec3 radii(log_uniform(random, 0.1, 1), log_uniform(random, 0.1, 1), 1);
    RoundShape shape;
    shape.radii = radii;
    const double off = log_uniform(random, 1e-9, 1e-5);
    BezierPatch octant{2, 2, {}};
    // Of quarters of circles, x, y and weight.
    const std::array<dvec3, 3> arc = {dvec3(1, 0, 1), dvec3(1, 1, std::sqrt(0.5)), dvec3(0, 1, 1)};
    for (const dvec3& a : arc) {
      for (const dvec3& b : arc) {
        const dvec3 place = radii * dvec3(a.x * b.x, a.y * b.x, b.y) + off * random_point(random);
        octant.points.push_back(taut::homogeneous(place, a.z * b.z));
      }
    }
    const RoundShape::Distances bound = shape.distances({2, 2}, octant.points);
    double farthest = 0;
    for (int k = 0; k < 400; ++k) {
      const dvec3 x = point(octant, uniform(random, 0, 1), uniform(random, 0, 1));
      const dvec3 y = x / radii;
      // To second order in the distance.
      const double distance = (glm::dot(y, y) - 1) / (2 * glm::length(y / radii));
      const double rounding = 1e-13 + distance * distance / (0.1 * 0.1);
      EXPECT_LE(distance, bound.outwards + rounding);
      EXPECT_LE(-distance, bound.inwards + rounding);
      farthest = std::max(farthest, std::abs(distance));
    }
    const double ratio = farthest / std::max(bound.inwards, bound.outwards);
    tightest = std::max(tightest, ratio);
    loosest = std::min(loosest, ratio);
  }
  RecordProperty("tightest", std::to_string(tightest));
  EXPECT_GT(tightest, 0.5);
  EXPECT_GT(loosest, 0.05);
}

/// What is between two equal discs is in their mean; what is beside it is as far from it as it is.
TEST(RoundShapes, MeansHoldWhatIsBetween) {
  const Elements elements(cylinder(1, 2));
  const std::vector<RoundShape> found = elements.rounds();
  ASSERT_EQ(found.size(), 2u);
  const std::array<const RoundShape*, 2> two = {&found[0], &found[1]};
  const std::array<double, 2> weights = {0.5, 0.5};
  const RoundShape mean = mean_of(two, weights);
  const double radius = mean.greatest_radius();
  const auto distance = [&](double share) {
    const std::vector<dvec4> at = {taut::homogeneous(mean.center + share * radius * mean.axes[0])};
    return mean.distances({0, 0}, at).outwards;
  };
  EXPECT_LE(distance(0.5), 1e-14);
  EXPECT_LE(distance(1), 1e-14);
  EXPECT_NEAR(distance(1 + 1e-4), 1e-4 * radius, 1e-7 * radius);
}

}  // namespace
