#include "taut/hull/contact/local_curvature.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

Contact on_patch(int patch, double u, double v) { return {0, SourceKind::face, patch, u, v}; }
Contact on_piece(int piece, double t) { return {0, SourceKind::edge, piece, t, 0}; }

/// Lengths are in the scene's frame; `scale` is what they are multiplied by there.
TEST(SurfaceCurvature, OfATorus) {
  const Scene scene = make_scene(mapped(torus(3, 1), skew_rotation()));
  const ContactGeometry geometry(scene);
  const double scale = scene.frame().scale;
  const int patches = int(scene.model().parts()[0].patches().size());
  Random random(1);
  for (int k = 0; k < 200; ++k) {
    const Contact c =
        on_patch(pick(random, 0, patches - 1), uniform(random, 0, 1), uniform(random, 0, 1));
    const std::optional<SurfaceCurvature> bend = surface_curvature(geometry, c);
    ASSERT_TRUE(bend.has_value());
    const dvec3 x = glm::transpose(skew_rotation()) * scene.frame().to_model(bend->x);
    // Across the meridian the curvature is cos t / (R + r cos t), seen from outside.
    const double across = (std::hypot(x.x, x.y) - 3) / std::hypot(x.x, x.y);
    EXPECT_NEAR(bend->steep * scale, -1, 1e-11);
    EXPECT_NEAR(bend->flat * scale, -across, 1e-11);
    EXPECT_NEAR(bend->gauss_curvature() * scale * scale, across, 1e-11);
    EXPECT_NEAR(glm::dot(bend->along, bend->n), 0, 1e-13);
    const PatchJet3 j = geometry.patch_jet(c);
    const dvec3 e = bend->rate.x * j.Su + bend->rate.y * j.Sv;
    EXPECT_LT(glm::distance(e, bend->along), 1e-12);
    EXPECT_NEAR(bend->area, glm::length(glm::cross(j.Su, j.Sv)), 1e-12);
    EXPECT_LE(std::abs(bend->cubic), bend->third * (1 + 1e-12));
  }
}

/// z = x^3 - y^2 over [0, 1]^2, bent at the origin along x with the cubic 6.
TEST(SurfaceCurvature, OnAParabolicCurve) {
  BezierPatch patch{3, 2, {}};
  for (int i = 0; i <= 3; ++i) {
    for (int j = 0; j <= 2; ++j) {
      patch.points.push_back(homogeneous({i / 3.0, 0.5 * j, (i == 3) - (j == 2)}));
    }
  }
  const Scene scene = make_scene(of_patch(patch));
  const ContactGeometry geometry(scene);
  const double scale = scene.frame().scale;
  const std::optional<SurfaceCurvature> bend = surface_curvature(geometry, on_patch(0, 0, 0));
  ASSERT_TRUE(bend.has_value());
  EXPECT_LT(glm::distance(bend->n, dvec3(0, 0, 1)), 1e-15);
  EXPECT_NEAR(bend->flat, 0, 1e-15);
  EXPECT_NEAR(bend->steep * scale, -2, 1e-13);
  EXPECT_NEAR(std::abs(bend->along.x), 1, 1e-15);
  EXPECT_NEAR(bend->cubic * scale * scale, 6 * bend->along.x, 1e-12);
}

TEST(SurfaceCurvature, NoneAtPoles) {
  const Scene scene = make_scene(sphere());
  const ContactGeometry geometry(scene);
  EXPECT_FALSE(surface_curvature(geometry, on_patch(0, 0.3, 0)).has_value());
}

/// (t, t^2, t^3): first derivatives (1, 2t, 3t^2), (0, 2, 6t), (0, 0, 6), with determinant 12.
TEST(CurveCurvature, OfATwistedCubic) {
  const dmat3 turn = skew_rotation();
  const Scene scene = make_scene(mapped({{}, {twisted_cubic()}, {}}, turn));
  const ContactGeometry geometry(scene);
  const double scale = scene.frame().scale;
  for (int k = 0; k <= 10; ++k) {
    const double t = 0.1 * k;
    const std::optional<CurveCurvature> bend = curve_curvature(geometry, on_piece(0, t));
    ASSERT_TRUE(bend.has_value());
    const dvec3 first(1, 2 * t, 3 * t * t);
    const dvec3 second(0, 2, 6 * t);
    const double speed = glm::length(first);
    EXPECT_LT(glm::distance(bend->along, turn * glm::normalize(first)), 1e-14);
    const dvec3 cross = glm::cross(first, second);
    EXPECT_LT(glm::distance(bend->binormal, turn * glm::normalize(cross)), 1e-13);
    EXPECT_NEAR(bend->curvature * scale, glm::length(cross) / std::pow(speed, 3), 1e-13);
    EXPECT_NEAR(bend->twist * std::pow(scale, 3), 12 / std::pow(speed, 6), 1e-12);
    EXPECT_LT(glm::distance(scale * bend->second, turn * second / (speed * speed)), 1e-12);
    EXPECT_LT(
        glm::distance(scale * scale * bend->third, turn * dvec3(0, 0, 6) / std::pow(speed, 3)),
        1e-12);
  }
}

TEST(CurveCurvature, HasNoBinormalWhereItIsStraight) {
  const Scene scene = make_scene({{}, {segment({0, 0, 0}, {1, 2, 3}), twisted_cubic()}, {}});
  const std::optional<CurveCurvature> bend =
      curve_curvature(ContactGeometry(scene), on_piece(0, 0.3));
  ASSERT_TRUE(bend.has_value());
  EXPECT_EQ(bend->curvature, 0);
  EXPECT_EQ(bend->binormal, dvec3(0.0));
}

}  // namespace
}  // namespace taut
