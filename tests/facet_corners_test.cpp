#include "taut/hull/solve/facet_corners.h"

#include <gtest/gtest.h>

#include <vector>

#include "freeform.h"
#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// Of the first instance.
Contact on_edge(int piece, double u) { return {0, SourceKind::edge, piece, u, 0}; }

/// Two segments on the x axis, one behind the other, and others beside.
Scene segments() {
  Shape shape;
  shape.curves = {segment({0, 0, 0}, {1, 0, 0}), segment({1, 0, 0}, {3, 0, 0}),
                  segment({0, 1, 0}, {3, 1, 0}), segment({3, 0, 0}, {4, 0, 1})};
  return make_scene(shape);
}

TEST(FacetCorners, PiecesBetweenLeadFromPlaceToPlace) {
  const Scene scene = segments();
  const ContactGeometry geometry(scene);
  const std::vector<EdgeStretch> there =
      pieces_between(geometry, on_edge(0, 0.5), on_edge(1, 0.25), 1e-9);
  ASSERT_EQ(there.size(), 2U);
  EXPECT_EQ(there[0].piece, 0);
  EXPECT_EQ(there[0].from, 0.5);
  EXPECT_EQ(there[0].to, 1);
  EXPECT_EQ(there[1].piece, 1);
  EXPECT_EQ(there[1].from, 0);
  EXPECT_EQ(there[1].to, 0.25);
  const std::vector<EdgeStretch> back =
      pieces_between(geometry, on_edge(1, 0.25), on_edge(0, 0.5), 1e-9);
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[0].piece, 1);
  EXPECT_EQ(back[0].from, 0.25);
  EXPECT_EQ(back[0].to, 0);
  EXPECT_EQ(back[1].to, 0.5);
}

TEST(FacetCorners, NoPiecesLeadAcross) {
  const Scene scene = segments();
  const ContactGeometry geometry(scene);
  EXPECT_TRUE(pieces_between(geometry, on_edge(0, 0.5), on_edge(2, 0.5), 1e-9).empty());
  EXPECT_TRUE(pieces_between(geometry, on_edge(1, 0.5), on_edge(3, 1), 1e-9).empty());
}

/// Of the sides of a square those that a plane across n touches, the nearest.
TEST(FacetCorners, LevelBordersAreTheNearestThatAreHighEnough) {
  Shape shape;
  shape.surfaces.push_back(
      {1, 1, {0, 0, 1, 1}, {0, 0, 1, 1}, {{0, 0, 0, 1}, {0, 1, 0, 1}, {1, 0, 0, 1}, {1, 1, 0, 1}}});
  const Scene scene = make_scene(shape);
  const ContactGeometry geometry(scene);
  const Contact inside = {0, SourceKind::face, 0, 0.3, 0.1};
  const dvec3 x = geometry.point(inside);
  const auto level = [&](const dvec3& n) {
    return level_border(geometry, inside, n, glm::dot(x, n) - 1e-12);
  };
  const auto nearest = level({0, 0, 1});
  ASSERT_TRUE(nearest);
  const dvec3 corner = scene.frame().to_frame(dvec3(0.0));
  EXPECT_NEAR(glm::distance(nearest->x, x), x.y - corner.y, 1e-15);
  // Where that is lower, another.
  const auto other = level(unit(dvec3(0, 1, 1)));
  ASSERT_TRUE(other);
  EXPECT_NEAR(other->x.y, x.y, 1e-15);
  EXPECT_FALSE(level_border(geometry, inside, {0, 0, 1}, glm::dot(x, dvec3(0, 0, 1)) + 1e-3));
}

}  // namespace
}  // namespace taut
