#include "taut/hull/decide/rectangle_sides.h"

#include <gtest/gtest.h>

#include <vector>

#include "models.h"
#include "taut/bounds/contact_geometry.h"

namespace {

using namespace taut_test;  // NOLINT: shapes
using taut::BezierPatch;
using taut::CellView;
using taut::ContactGeometry;
using taut::MapPieces;
using taut::RectangleSides;
using taut::Scene;
using taut::Side;

/// Heights over [0, 1] x [0, 1], alike for all x but for a bulge, by their Bernstein coefficients
/// along y.
Shape sheet(const std::vector<double>& heights) {
  BezierPatch patch{2, int(heights.size()) - 1, {}};
  for (const double x : {0.0, 0.5, 1.0}) {
    const double bulge = x == 0.5 ? 0.3 : 0;
    for (std::size_t k = 0; k < heights.size(); ++k) {
      patch.points.emplace_back(x, double(k) / double(heights.size() - 1), heights[k] + bulge, 1);
    }
  }
  return {{as_nurbs(patch)}, {}, {}};
}

/// Of the side x = 0, in directions about (0, lean, 1).
bool have_no_low(const Shape& shape, double lean) {
  const Scene scene = make_scene(shape);
  const ContactGeometry geometry(scene);
  const MapPieces pieces(geometry, 1e-9);
  CellView view(pieces, 1e-14);
  const double d = 1e-3;
  view.turn_to({dvec3(-d, lean - d, 1), dvec3(-d, lean + d, 1), dvec3(d, lean - d, 1),
                dvec3(d, lean + d, 1)},
               dvec3(0.0), {});
  EXPECT_EQ(pieces.element(0).contact.kind, taut::SourceKind::face);
  RectangleSides sides(pieces);
  sides.turn_to(0, {0, 1}, {0, 1});
  return sides.have_no_low(view, Side::u0);
}

/// z = -y^3: heights grow from where the side is straight, and fall from the top on.
TEST(RectangleSides, AreStraightInOneEnd) {
  const Shape cubic = sheet({0, 0, 0, -1});
  for (const double lean : {-0.1, 0.01, 0.3, 1.0, 2.9, 3.1}) {
    EXPECT_TRUE(have_no_low(cubic, lean)) << lean;
  }
}

/// z = y^3, and waves: a low behind a top, or before one.
TEST(RectangleSides, HaveALow) {
  EXPECT_FALSE(have_no_low(sheet({0, 0, 0, 1}), -0.3));
  EXPECT_TRUE(have_no_low(sheet({0, 0, 0, 1}), 0.1));
  const Shape wave = sheet({0, 1, -1, 0});
  for (const double lean : {-0.5, 0.0, 0.5}) EXPECT_FALSE(have_no_low(wave, lean)) << lean;
  for (const double lean : {-4.0, 4.0}) EXPECT_TRUE(have_no_low(wave, lean)) << lean;
  EXPECT_FALSE(have_no_low(sheet({0, -1, 1, 0}), 0));
}

}  // namespace
