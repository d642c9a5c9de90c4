#include "taut/hull/solve/touching_plane.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

struct Placed {
  explicit Placed(const Shape& shape) : scene(make_scene(shape)), geometry(scene), query(scene) {}
  /// What supports in a direction.
  Contact contact(const dvec3& n) { return query(unit(n)).contact; }

  Scene scene;
  ContactGeometry geometry;
  SupportQuery query;
};

/// Of three equal spheres: parallel to that of their centres.
TEST(TouchingPlane, OfThreeSpheres) {
  Placed balls(sphere() + shifted(sphere(), {4, 0, 0}) + shifted(sphere(), {0, 3, 0.5}));
  const std::vector<Contact> contacts = {balls.contact({-1, -1, 2}), balls.contact({1, -1, 2}),
                                         balls.contact({-1, 1, 2})};
  const TouchingPlane plane =
      touching_plane(balls.geometry, balls.query, unit(dvec3(0.2, 0.1, 1)), contacts);
  const dvec3 right = unit(glm::cross(dvec3(4, 0, 0), dvec3(0, 3, 0.5)));
  EXPECT_LE(glm::distance(plane.n, right), 1e-12);
  EXPECT_LE(plane.off(), 1e-12);
  EXPECT_FALSE(plane.in_line);
}

/// Of more points than lie in one: the plane tells by how much it misses them.
TEST(TouchingPlane, TellsWhatItMisses) {
  Placed points({{}, {}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1e-3}, {0.5, 0.5, -1}}});
  std::vector<Contact> contacts(4, {0, SourceKind::vertex, 0, 0, 0});
  for (int k = 0; k < 4; ++k) contacts[std::size_t(k)].element = k;
  const TouchingPlane plane =
      touching_plane(points.geometry, points.query, dvec3(0, 0, 1), contacts);
  EXPECT_NEAR(plane.spread / points.scene.frame().scale, 5e-4, 1e-6);
}

/// Points in line leave it where it is about the line; what leaves the line tells where it is.
TEST(TouchingPlane, OfContactsInLine) {
  // A curve over the middle of a segment, which it touches where both are level.
  Shape shape = {{}, {}, {{-1, 0, 0}, {1, 0, 0}, {0, 0, -1}}};
  shape.curves.push_back(circle({0, 0, -1}, {0, 1, 0}, {0, 0, 1}));
  Placed placed(shape);
  const Contact on_circle = placed.contact({0, 0.3, 1});
  const std::vector<Contact> contacts = {
      {0, SourceKind::vertex, 0, 0, 0}, {0, SourceKind::vertex, 1, 0, 0}, on_circle};
  const TouchingPlane plane =
      touching_plane(placed.geometry, placed.query, unit(dvec3(0.1, 0.2, 1)), contacts);
  EXPECT_NEAR(plane.n.x, 0, 1e-12);
}

/// A surface that hardly bends beside a straight side of its own: z = -v^2 / 500 - u^2 v over
/// [-1, 1] x [0, 1], and a point below.
Shape flat_beside_its_side() {
  NurbsSurface surface{2, 2, {0, 0, 0, 1, 1, 1}, {0, 0, 0, 1, 1, 1}, {}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      // Control values of u^2 and of v^2.
      const double uu = i == 1 ? -1 : 1;
      const double vv = j == 2 ? 1 : 0;
      surface.points.emplace_back(i - 1, 0.5 * j, -vv / 500 - uu * 0.5 * j, 1);
    }
  }
  return {{surface}, {}, {{0, 0, -1}}};
}

/// The surface leaves the segment between its corners in the middle. Heights tell where to the root
/// of rounding, and rulings beside are known to the resolution: all of them may be where the
/// contact has left the segment.
TEST(TouchingPlane, WhereASurfaceLeavesASegment) {
  Placed placed(flat_beside_its_side());
  const Contact left = placed.contact({-1, -1, 1});
  const Contact right = placed.contact({1, -1, 1});
  for (const double turn : {1e-5, 1e-4}) {
    const dvec3 n = unit({0, turn, 1});
    const std::vector<Contact> contacts = {left, placed.contact(n), right};
    ASSERT_EQ(contacts[1].kind, SourceKind::face) << turn;
    TouchingPlane plane = touching_plane(placed.geometry, placed.query, n, contacts);
    if (plane.in_line) {
      const std::vector<dvec3> beside = {n, unit({0, 0.5 * turn, 1})};
      plane = turned_to_part(placed.geometry, placed.query, plane, contacts, beside, 1e-8);
    }
    EXPECT_LE(glm::distance(plane.n, dvec3(0, 0, 1)), 1e-12) << turn;
    EXPECT_LE(plane.off(), 1e-12) << turn;
    const dvec3 middle = 0.5 * (placed.geometry.point(left) + placed.geometry.point(right));
    EXPECT_LE(glm::distance(plane.contacts[1].x, middle), 1e-12) << turn;
  }
}

}  // namespace
}  // namespace taut
