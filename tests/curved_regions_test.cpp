#include "taut/hull/decide/curved_regions.h"

#include <gtest/gtest.h>

#include <vector>

#include "judge/sweeps.h"
#include "models.h"
#include "taut/bounds/contact_geometry.h"

namespace {

using namespace taut_test;  // NOLINT: shapes
using taut::ContactGeometry;
using taut::CurvedRegions;
using taut::Interval;
using taut::MapPieces;
using taut::Scene;

/// z = a x^2 - y^2 over [-1, 1] x [-1, 1], its parameters stretched.
Shape sheet(double a) {
  std::vector<std::vector<dvec3>> rows;
  for (int i = 0; i < 3; ++i) {
    std::vector<dvec3> row;
    for (int j = 0; j < 3; ++j) {
      row.emplace_back(i - 1, j - 1, a * (i == 1 ? -1 : 1) - (j == 1 ? -1 : 1));
    }
    rows.push_back(row);
  }
  return {{spline(rows, 2, 2)}, {}, {}};
}

/// Directions of a small cell about one.
CurvedRegions::Cone around(const dvec3& n) {
  const auto [a, b] = taut::tangent_frame(n);
  return CurvedRegions::cone_of({n - 0.01 * a - 0.01 * b, n - 0.01 * a + 0.01 * b,
                                 n + 0.01 * a - 0.01 * b, n + 0.01 * a + 0.01 * b});
}

/// Whether the middle of the sheet is nearly concave, its curvature of 2 a against a bound.
bool is_nearly_concave(double a, const dvec3& n, double hollow, bool moved) {
  const dmat3 rotation = moved ? skew_rotation() : dmat3(1);
  const Scene scene = make_scene(mapped(sheet(a), rotation));
  const ContactGeometry geometry(scene);
  const MapPieces pieces(geometry, 1e-6);
  CurvedRegions regions(pieces);
  // Curvatures in the scene's frame are larger where that is smaller.
  const double scale = scene.frame().length_to_frame(1);
  return regions.are_nearly_concave(0, {0.49, 0.51}, {0.49, 0.51}, around(rotation * n),
                                    hollow / scale);
}

TEST(CurvedRegions, NearlyConcaveByTheCurvatureTowardsTheNormal) {
  const dvec3 up(0, 0, 1);
  for (const bool moved : {false, true}) {
    for (const double a : {1e-9, 1e-6, 1e-3, 0.1}) {
      EXPECT_TRUE(is_nearly_concave(a, up, 2.2 * a, moved)) << a;
      EXPECT_FALSE(is_nearly_concave(a, up, 1.8 * a, moved)) << a;
      EXPECT_FALSE(is_nearly_concave(a, -up, 1.8, moved)) << a;
      EXPECT_TRUE(is_nearly_concave(a, -up, 2.2, moved)) << a;
    }
    EXPECT_TRUE(is_nearly_concave(-0.1, up, 0, moved));
  }
}

/// Where no plane across the directions touches it does not matter how the sheet is curved: from
/// its middle to (1, 1) normals lean by 0 to 70 degrees.
TEST(CurvedRegions, CurvaturesMatterWhereNormalsAreDirections) {
  const Interval half{0.5, 1};
  for (const double a : {-1.0, 1.0}) {
    const Scene scene = make_scene(sheet(a));
    const ContactGeometry geometry(scene);
    const MapPieces pieces(geometry, 1e-6);
    CurvedRegions regions(pieces);
    const bool is_cap = a < 0;
    for (const dvec3& n : {dvec3(-2 * a * 0.4, 2 * 0.4, 1), dvec3(2 * a * 0.4, -2 * 0.4, -1)}) {
      EXPECT_EQ(regions.are_definite(0, half, half, around(unit(n))), is_cap) << a;
    }
    EXPECT_FALSE(regions.are_nearly_concave(0, half, half, around({0, 0, is_cap ? -1 : 1}), 1e-3));
    for (const dvec3& n : {dvec3(1, 0, 0), dvec3(2, 0, 1), dvec3(0, -1, 1)}) {
      EXPECT_TRUE(regions.are_definite(0, half, half, around(unit(n)))) << a;
      EXPECT_TRUE(regions.are_nearly_concave(0, half, half, around(unit(n)), 1e-3)) << a;
    }
  }
}

}  // namespace
