#include "taut/hull/contact/contact_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <vector>

#include "models.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// A plane that is expected: its normal, a point in it and its number of pieces.
struct Plane {
  dvec3 n, x;
  std::size_t pieces;
};

/// The same with samples and without.
std::vector<ContactPlane> planes_of(const Scene& scene) {
  const ContactGeometry geometry(scene);
  SupportQuery query(scene);
  std::vector<ContactPlane> planes = contact_planes(geometry, query);
  Random random(7);
  std::vector<Sample> samples;
  for (int k = 0; k < 100; ++k) {
    const dvec3 n = random_direction(random);
    samples.push_back({n, query(n).contact});
  }
  const std::vector<ContactPlane> same = contact_planes(geometry, query, samples);
  EXPECT_EQ(planes.size(), same.size());
  for (std::size_t k = 0; k < std::min(planes.size(), same.size()); ++k) {
    EXPECT_EQ(planes[k].n, same[k].n);
    EXPECT_EQ(planes[k].pieces.size(), same[k].pieces.size());
  }
  return planes;
}

/// The pieces of a plane lie in it, are told once each and repeat none, and it supports.
void expect_sound(const Scene& scene, const ContactPlane& plane) {
  const ContactGeometry geometry(scene);
  SupportQuery query(scene);
  EXPECT_NEAR(glm::length(plane.n), 1, 1e-15);
  EXPECT_NEAR(query(plane.n).h, plane.offset, 2 * support_tie);
  std::set<std::tuple<int, int>> told;
  for (const Contact& piece : plane.pieces) {
    EXPECT_EQ(piece.kind, SourceKind::edge);
    EXPECT_EQ(piece.u, 0);
    EXPECT_FALSE(geometry.is_straight(piece));
    EXPECT_FALSE(geometry.is_repeated(piece));
    EXPECT_TRUE(told.emplace(piece.instance, piece.element).second);
    for (int k = 0; k <= 8; ++k) {
      Contact at = piece;
      at.u = k / 8.0;
      EXPECT_NEAR(glm::dot(geometry.point(at), plane.n), plane.offset, 2 * support_tie);
    }
  }
}

void expect_planes(const Scene& scene, const std::vector<Plane>& expected, const dmat3& turn) {
  const std::vector<ContactPlane> found = planes_of(scene);
  EXPECT_EQ(found.size(), expected.size());
  for (const ContactPlane& plane : found) expect_sound(scene, plane);
  for (const Plane& each : expected) {
    const dvec3 n = turn * each.n;
    const double offset = glm::dot(scene.frame().to_frame(turn * each.x), n);
    const auto match = std::count_if(found.begin(), found.end(), [&](const ContactPlane& p) {
      return glm::distance(p.n, n) < 1e-12 && std::abs(p.offset - offset) < 2 * support_tie &&
             p.pieces.size() == each.pieces;
    });
    EXPECT_EQ(match, 1) << each.n.x << ' ' << each.n.y << ' ' << each.n.z;
  }
}

Shape with_points(Shape shape, const std::vector<dvec3>& points) {
  return std::move(shape) + Shape{{}, {}, points};
}

/// A unit circle in the plane z = height, about (x, 0, height).
Shape ring(double x, double height) {
  return {{}, {circle({x, 0, height}, {1, 0, 0}, {0, 1, 0})}, {}};
}

/// A single quadratic arc from (-1, 0, 0) over (0, 1, 0) to (1, 0, 0).
Shape arc() {
  return {{}, {as_nurbs(BezierCurve{{{-1, 0, 0, 1}, {0, 2, 0, 1}, {1, 0, 0, 1}}})}, {}};
}

/// A cubic in the plane z = 0 but for one control point that is lifted.
Shape nearly_plane(double lift) {
  const BezierCurve curve{{{-1, 0, 0, 1}, {-1, 1, lift, 1}, {1, 1, 0, 1}, {1, 0, 0, 1}}};
  return {{}, {as_nurbs(curve)}, {{0, 0.3, -1}}};
}

struct PlanesCase {
  const char* name;
  Shape shape;
  std::vector<Plane> planes;
};

std::vector<PlanesCase> planes_cases() {
  const dvec3 up(0, 0, 1);
  const dvec3 down(0, 0, -1);
  const dvec3 o(0.0);
  const std::vector<Plane> lids = {{up, {0, 0, 2}, 4}, {down, o, 4}};
  return {
      {"sphere", sphere(), {}},
      {"cylinder", cylinder(1, 2), lids},
      {"solid cylinder", solid_cylinder(1, 2), lids},
      {"frustum", frustum(1, 0.5, 2), lids},
      {"cone", cone(1, 2), {{down, o, 4}}},
      {"torus", torus(2, 0.5), {{up, {0, 0, 0.5}, 4}, {down, {0, 0, -0.5}, 4}}},
      {"cap", spherical_cap(0.6), {{down, {0, 0, 0.4}, 4}}},
      // The rim lies beneath the equator.
      {"sphere without a cap", spherical_cap(1.4), {{down, {0, 0, -0.4}, 4}}},
      {"paraboloid",
       paraboloid(),
       {{{1, 0, 0}, {1, 0, 1}, 1},
        {{-1, 0, 0}, {-1, 0, 1}, 1},
        {{0, 1, 0}, {0, 1, 1}, 1},
        {{0, -1, 0}, {0, -1, 1}, 1}}},
      {"saddle",
       saddle(),
       {{{1, 0, 0}, {1, 0, 0}, 1},
        {{-1, 0, 0}, {-1, 0, 0}, 1},
        {{0, 1, 0}, {0, 1, 0}, 1},
        {{0, -1, 0}, {0, -1, 0}, 1}}},
      {"straight edges alone", box(1, 2, 3), {}},
      {"saddle of lines", bilinear_saddle(), {}},
      {"twisted cubic", {{}, {twisted_cubic()}, {}}, {}},
      {"circles across each other", perpendicular_circles(), {}},
      {"oloid", oloid(), {}},
      {"points above and below a circle", with_points(ring(0, 0), {{0, 0, 1}, {0, 0, -1}}), {}},
      {"a point above a circle", with_points(ring(0, 0), {{0, 0, 1}}), {{down, o, 4}}},
      {"a point in the plane", with_points(ring(0, 0), {{3, 0, 0}, {0, 0, 1}}), {{down, o, 4}}},
      {"a circle within another",
       with_points(ring(0, 0) + scaled(ring(0, 0), 0.5), {{0, 0, 1}}),
       {{down, o, 8}}},
      {"two circles in one plane",
       with_points(ring(0, 0) + ring(3, 0), {{0, 0, 1}}),
       {{down, o, 8}}},
      {"two circles in parallel planes",
       ring(0, 0) + ring(3, 1),
       {{down, o, 4}, {up, {0, 0, 1}, 4}}},
      {"three storeys", ring(0, 0) + ring(0, 1) + ring(0, 2), lids},
      // One disc of four pieces twice: of a lid and a rim there is one.
      {"a circle twice", with_points(ring(0, 0) + ring(0, 0), {{0, 0, 1}}), {{down, o, 4}}},
      {"a flat scene", arc(), {{up, o, 1}, {down, o, 1}}},
      {"one arc", with_points(arc(), {{0, 0.3, 1}}), {{down, o, 1}}},
      {"a nearly plane curve", nearly_plane(1e-9), {}},
      {"one that bends the other way", nearly_plane(-1e-9), {}},
      {"one that is plane to rounding", nearly_plane(1e-14), {{up, o, 1}}},
  };
}

TEST(ContactPlanes, OfShapesInAnyPlace) {
  for (const PlanesCase& each : planes_cases()) {
    for (const bool turned : {false, true}) {
      SCOPED_TRACE(std::string(each.name) + (turned ? ", turned" : ""));
      const dmat3 turn = turned ? skew_rotation() : dmat3(1.0);
      expect_planes(make_scene(mapped(each.shape, turn)), each.planes, turn);
    }
  }
}

TEST(ContactPlanes, SizeAndDistanceDoNotMatter) {
  for (const PlanesCase& each : planes_cases()) {
    for (const double s : {1e-6, 1e6}) {
      SCOPED_TRACE(each.name);
      const Scene scene = make_scene(shifted(scaled(each.shape, s), 3 * s * dvec3(1, 2, 3)));
      EXPECT_EQ(planes_of(scene).size(), each.planes.size());
    }
  }
}

/// A curve that supports nearly: as far from it as support_tie it does no more.
TEST(ContactPlanes, CurvesThatDoNotSupport) {
  for (const double height : {1e-3, 1e-9, 1e-11}) {
    const Scene scene = make_scene(with_points(ring(0, 0), {{0, 0, 1}, {0, 0, -height}}));
    EXPECT_TRUE(planes_of(scene).empty()) << height;
  }
  EXPECT_EQ(planes_of(make_scene(with_points(ring(0, 0), {{0, 0, 1}, {0, 0, -1e-14}}))).size(), 1U);
  // Inside of the hull.
  EXPECT_TRUE(planes_of(make_scene(sphere(2) + ring(0, 0.5))).empty());
}

TEST(ContactPlanes, OfInstances) {
  Model model = make_model(solid_cylinder(1, 2));
  model.add_instance(0, {dmat3(1.0), {3, 0, 0}});
  // One on top: its circle there lies in no supporting plane any more.
  const dmat3 I(1.0);
  expect_planes(Scene(model, {.threads = 1, .progress = {}}),
                {{{0, 0, 1}, {0, 0, 2}, 8}, {{0, 0, -1}, {0, 0, 0}, 8}}, I);
  Model stacked = model;
  stacked.add_instance(0, {I, {0, 0, 2}});
  expect_planes(Scene(stacked, {.threads = 1, .progress = {}}),
                {{{0, 0, 1}, {0, 0, 4}, 4}, {{0, 0, -1}, {0, 0, 0}, 8}}, I);
  // In one place: told once.
  Model twice = make_model(solid_cylinder(1, 2));
  twice.add_instance(0, {I, {0, 0, 0}});
  expect_planes(Scene(twice, {.threads = 1, .progress = {}}),
                {{{0, 0, 1}, {0, 0, 2}, 4}, {{0, 0, -1}, {0, 0, 0}, 4}}, I);
  // Turned over, into the planes of the other.
  Model over = make_model(cylinder(1, 2));
  over.add_instance(0, {{1, 0, 0, 0, -1, 0, 0, 0, -1}, {2.5, 0, 2}});
  expect_planes(Scene(over, {.threads = 1, .progress = {}}),
                {{{0, 0, 1}, {0, 0, 2}, 8}, {{0, 0, -1}, {0, 0, 0}, 8}}, I);
}

}  // namespace
}  // namespace taut
