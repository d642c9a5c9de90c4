#include "taut/hull/solve/level_pieces.h"

#include <gtest/gtest.h>

#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// The rim of a lid, asked for in a direction that is a little off; and not the other one.
TEST(LevelPieces, OfALid) {
  const Scene scene = make_scene(solid_cylinder(1, 2));
  const ContactGeometry geometry(scene);
  SupportQuery query(scene);
  const LevelPieces level = level_pieces(geometry, query, unit(dvec3(1e-8, 2e-8, 1)), 1e-7);
  ASSERT_FALSE(level.pieces.empty());
  EXPECT_LE(glm::distance(level.n, dvec3(0, 0, 1)), 1e-14);
  EXPECT_LE(level.off, 1e-14);
  for (const Contact& piece : level.pieces) {
    EXPECT_NEAR(scene.frame().to_model(geometry.point(piece)).z, 2, 1e-14);
  }
}

/// None where nothing lies in the plane but straight edges, or nothing at all.
TEST(LevelPieces, OfBoxesAndSpheres) {
  for (const Shape& shape : {box(3, 2, 1), sphere()}) {
    const Scene scene = make_scene(shape);
    const ContactGeometry geometry(scene);
    SupportQuery query(scene);
    EXPECT_TRUE(level_pieces(geometry, query, dvec3(0, 0, 1), 1e-7).pieces.empty());
  }
}

}  // namespace
}  // namespace taut
