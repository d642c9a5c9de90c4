#include "taut/hull/planar/flat_boundary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "models.h"
#include "taut/core/tolerances.h"
#include "taut/hull/measure/boundary_measures.h"
#include "taut/hull/planar/planar_arcs.h"
#include "taut/hull/precise_hull.h"
#include "taut/hull/sample/sampled_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

struct KnownFlat {
  double area = 0;
  double perimeter = 0;
  int curves = 0;  ///< 0: not known
};

/// The hull with its boundary, the measures of which are known.
Hull expect_flat(const Shape& shape, const KnownFlat& known, double relative = 1e-11) {
  const Scene scene = make_scene(shape);
  Hull hull = precise_hull(scene, {.relative = 1e-3, .threads = 1, .progress = {}});
  EXPECT_EQ(hull.kind, HullKind::planar);
  EXPECT_LE(hull.distance_bound, 1e-3 * scene.diagonal());
  if (!hull.boundary) {
    ADD_FAILURE() << "no boundary";
    return hull;
  }
  EXPECT_EQ(hull.boundary->dimension, 2);
  EXPECT_EQ(hull.boundary->faces.size(), 1U);
  for (const HullCurve& curve : hull.boundary->curves) {
    EXPECT_EQ(curve.faces, (std::array{0, -1}));
  }
  if (known.curves > 0) {
    EXPECT_EQ(int(hull.boundary->curves.size()), known.curves);
  }
  const BoundaryMeasures m = measure(scene, ContactGeometry(scene), *hull.boundary);
  EXPECT_EQ(m.volume, 0);
  EXPECT_NEAR(m.area, known.area, relative * known.area);
  EXPECT_NEAR(m.mean_width, known.perimeter / 4, relative * known.perimeter);
  EXPECT_LE(m.accuracy, relative);
  return hull;
}

Shape ring(double r, const dvec3& center) {
  return {{}, {circle(center, {r, 0, 0}, {0, r, 0})}, {}};
}

Shape quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  return of_patch({1, 1, {dvec4(a, 1), dvec4(b, 1), dvec4(c, 1), dvec4(d, 1)}});
}

/// A belt about two circles.
TEST(FlatBoundary, CirclesAndSegments) {
  expect_flat(ring(2, {1, 2, 3}), {4 * pi, 4 * pi, 1});
  expect_flat(mapped(disc(2, 1), skew_rotation()), {4 * pi, 4 * pi, 1});
  const double R = 2, r = 1, d = 5;
  const double beta = std::asin((R - r) / d);
  const double tangent = std::sqrt(d * d - (R - r) * (R - r));
  const KnownFlat belt = {(R + r) * tangent + R * R * (pi / 2 + beta) + r * r * (pi / 2 - beta),
                          2 * tangent + R * (pi + 2 * beta) + r * (pi - 2 * beta), 4};
  const Shape circles = ring(R, {0, 0, 0}) + ring(r, {d, 0, 0});
  expect_flat(circles, belt);
  expect_flat(mapped(circles, skew_rotation(), {40, -30, 7}), belt);
}

TEST(FlatBoundary, FlatPatches) {
  const Shape square = quad({0, 0, 0}, {0, 3, 0}, {4, 0, 0}, {4, 3, 0});
  const Hull hull = expect_flat(mapped(square, skew_rotation()), {12, 14, 4});
  // It lies on its face, and all that is on it is exact.
  for (const HullFace& face : hull.boundary->faces) {
    EXPECT_EQ(face.source, 0);
    EXPECT_EQ(face.tolerant, 0);
  }
  expect_flat(square + shifted(square, {4, 0, 0}), {24, 22, 4});
}

KnownFlat hull_of_points(std::vector<dvec2> points) {
  std::sort(points.begin(), points.end(),
            [](const dvec2& a, const dvec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  KnownFlat known;
  for (const int turn : {0, 1}) {
    std::vector<dvec2> chain;
    for (const dvec2& p : points) {
      while (chain.size() > 1 &&
             cross(chain.back() - chain[chain.size() - 2], p - chain.back()) <= 0)
        chain.pop_back();
      chain.push_back(p);
    }
    for (std::size_t k = 1; k < chain.size(); ++k) {
      known.area += cross(chain[k - 1], chain[k]) / 2;
      known.perimeter += glm::distance(chain[k - 1], chain[k]);
    }
    if (turn == 0) std::reverse(points.begin(), points.end());
  }
  return known;
}

/// The hull of points along a curve, which lie in z = 0.
KnownFlat hull_of_points(const BezierCurve& curve) {
  constexpr int count = 20000;
  std::vector<dvec2> points;
  for (int k = 0; k <= count; ++k) points.emplace_back(point(curve, double(k) / count));
  return hull_of_points(std::move(points));
}

/// Likewise of a patch.
KnownFlat hull_of_points(const BezierPatch& patch) {
  constexpr int count = 400;
  std::vector<dvec2> points;
  for (int i = 0; i <= count; ++i) {
    for (int j = 0; j <= count; ++j) {
      points.emplace_back(point(patch, double(i) / count, double(j) / count));
    }
  }
  return hull_of_points(std::move(points));
}

/// Curves that bend both ways and touch their hull in several places and with their ends.
TEST(FlatBoundary, WigglyCurves) {
  for (const unsigned seed : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}) {
    SCOPED_TRACE(seed);
    Random random(seed);
    BezierCurve curve = random_curve(random, pick(random, 3, 6), 1);
    for (dvec4& p : curve.points) p.z = 0;
    const KnownFlat known = hull_of_points(curve);
    expect_flat(mapped({{}, {as_nurbs(curve)}, {}}, skew_rotation()), known, 1e-7);
  }
}

/// The outline reaches the end of a curve over a straight side, and leaves it along the curve.
TEST(FlatBoundary, BothSidesOfAnEnd) {
  const BezierCurve curve = {{{0, 0, 0, 1},
                              {1.1, 0, 0, 1},
                              {0.75, 0.07, 0, 1},
                              {-0.24, -0.44, 0, 1},
                              {0.94, -0.28, 0, 1}}};
  KnownFlat known = hull_of_points(curve);
  known.curves = 5;
  expect_flat({{}, {as_nurbs(curve)}, {}}, known, 1e-7);
}

/// The width of a plate is below the resolution: its corners are in pairs that are one in the
/// plane.
TEST(FlatBoundary, ThinPlates) {
  const Shape plate = mapped(box(4, 3, 2e-8), skew_rotation());
  expect_flat(plate, {12, 14, 4}, 1e-8);
}

/// Corners that are off a plane, and off a line, by less than the resolution.
TEST(FlatBoundary, WithinTheResolution) {
  const double off = 2e-8;
  const Shape warped = quad({0, 0, off}, {0, 3, -off}, {4, 0, -off}, {4, 3, off}) +
                       quad({4, 0, -off}, {4, 3, off}, {8, off, off}, {8, 3, 0});
  const Hull hull = expect_flat(mapped(warped, skew_rotation()), {24, 22, 4}, 1e-7);
  for (const HullFace& face : hull.boundary->faces) {
    EXPECT_GT(face.tolerant, 0);
    EXPECT_LE(hull.boundary->frame.length_to_model(face.tolerant), hull.resolution.rho);
  }
  // A finer one tells them.
  const Scene scene = make_scene(warped);
  EXPECT_EQ(sampled_hull(scene, {.resolution = 1e-10, .threads = 1, .progress = {}}).kind,
            HullKind::solid);
}

/// What is off a plane by less than that it is flat, but by more than rounding.
TEST(FlatBoundary, NextToRounding) {
  const double off = 2e-12;
  const Hull hull =
      expect_flat(quad({0, 0, off}, {0, 3, -off}, {4, 0, -off}, {4, 3, off}), {12, 14, 4}, 1e-7);
  const HullFace& face = hull.boundary->faces.front();
  EXPECT_GE(hull.boundary->frame.length_to_model(face.tolerant), 2 * off);
  EXPECT_LE(hull.boundary->frame.length_to_model(face.tolerant), 5 * off);
}

TEST(FlatBoundary, ToleranceBelowTheResolutionIsNotConverged) {
  const double off = 2e-8;
  const Scene scene = make_scene(quad({0, 0, off}, {0, 3, -off}, {4, 0, -off}, {4, 3, off}));
  try {
    precise_hull(scene, {.tolerance = 1e-9, .threads = 1, .progress = {}});
    FAIL() << "it is as flat as that";
  } catch (const HullNotConverged& failure) {
    EXPECT_EQ(failure.best->kind, HullKind::planar);
    EXPECT_GT(failure.best->distance_bound, 1e-9);
    EXPECT_LT(failure.best->distance_bound, 1e-6);
  }
}

/// A patch that folds over beyond its border has no edge there: the outline goes along the fold.
TEST(FlatBoundary, FoldsAreFollowed) {
  BezierPatch patch{2, 2, {}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) patch.points.emplace_back(i, j, 0, 1);
  }
  patch.at(1, 1).x = 8;
  const Hull hull =
      expect_flat(mapped(of_patch(patch), skew_rotation()), hull_of_points(patch), 1e-5);
  const HullFace& face = hull.boundary->faces.front();
  EXPECT_GT(face.tolerant, 0);
  EXPECT_LE(hull.boundary->frame.length_to_model(face.tolerant), hull.resolution.rho);
  EXPECT_TRUE(std::any_of(face.contacts.begin(), face.contacts.end(),
                          [](const Contact& c) { return c.kind == SourceKind::face; }));
}

/// The outline turns around so sharply that its speed all but vanishes there.
TEST(FlatBoundary, PerimetersOfThinEllipses) {
  for (const double b : {1e-2, 1e-4}) {
    const Shape ellipse = {{}, {circle({0, 0, 0}, {1, 0, 0}, {0, b, 0})}, {}};
    // By arithmetic and geometric means (Gauss).
    double a = 1, g = b, sum = 1 - (1 - b * b) / 2, power = 0.5;
    while (a - g > 1e-16) {
      const double c = (a - g) / 2;
      power *= 2;
      sum -= power * c * c;
      const double mean = (a + g) / 2;
      g = std::sqrt(a * g);
      a = mean;
    }
    expect_flat(mapped(ellipse, skew_rotation()), {pi * b, 2 * pi * sum / a, 1}, 1e-11);
  }
}

/// A face in the plane is told, though its parameters fold.
TEST(FlatBoundary, LiesOnAFaceThatFolds) {
  const Shape folded = quad({0, 0, 0}, {0, 3, 0}, {4, 3, 0}, {4, 0, 0}) +
                       quad({0, 0, 0}, {0, 3, 0}, {4, 1, 0}, {1, 1, 0});
  const Shape curved = of_patch(
      {1,
       2,
       {{0, 0, 0, 1}, {3, 3, 0, 1}, {0, 2, 0, 1}, {2, 0, 0, 1}, {-1, 3, 0, 1}, {2, 2, 0, 1}}});
  for (const Shape& shape : {folded, curved}) {
    const Hull hull = precise_hull(make_scene(mapped(shape, skew_rotation())),
                                   {.relative = 1e-3, .threads = 1, .progress = {}});
    ASSERT_TRUE(hull.boundary);
    EXPECT_EQ(hull.boundary->faces.front().source, 0);
  }
}

}  // namespace
}  // namespace taut
