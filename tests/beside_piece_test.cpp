#include "taut/surface/beside_piece.h"

#include <gtest/gtest.h>

#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: shapes

TEST(BesidePiece, IsThePiecesPoint) {
  for (const Shape& shape : {solid_cylinder(1, 2), paraboloid(), spherical_cap(0.6)}) {
    const Model model = make_model(shape);
    const Part& part = model.parts()[0];
    ASSERT_FALSE(part.pieces().empty());
    for (int k = 0; k < int(part.pieces().size()); ++k) {
      for (const double t : {0.0, 0.3, 1.0}) {
        const PatchPlace place = beside_piece(part, k, t);
        ASSERT_GE(place.patch, 0);
        const BezierPatch& patch = part.patches()[std::size_t(place.patch)].bezier;
        const dvec3 x = point(part.pieces()[std::size_t(k)].bezier, t);
        EXPECT_LE(glm::distance(point(patch, place.uv.x, place.uv.y), x), 1e-15);
      }
    }
  }
}

TEST(BesidePiece, NothingBesideAFreeCurve) {
  const Model model = make_model({{}, {twisted_cubic()}, {}});
  EXPECT_EQ(beside_piece(model.parts()[0], 0, 0.5).patch, -1);
}

}  // namespace
}  // namespace taut
