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
std::array<dvec3, 4> around(const dvec3& n) {
  const auto [a, b] = taut::tangent_frame(n);
  return {n - 0.01 * a - 0.01 * b, n - 0.01 * a + 0.01 * b, n + 0.01 * a - 0.01 * b,
          n + 0.01 * a + 0.01 * b};
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

/// Of directions on both sides of the surface none is told.
TEST(CurvedRegions, NearlyConcaveFromOneSideOnly) {
  EXPECT_FALSE(is_nearly_concave(-1, dvec3(1, 0, 0), 1e-3, false));
}

}  // namespace
