#include "taut/envelope/cull/osculating_paraboloid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models.h"
#include "taut/core/tolerances.h"
#include "taut/envelope/cull/convex_cap.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// Coordinates of x - center in the map, squared.
double square_in(const OsculatingParaboloid& map, const dvec3& x) {
  return glm::dot(map(x), map(x));
}

/// The graph of a x^2 + b x y + c y^2 over the unit square.
Shape quadratic_graph(double a, double b, double c) {
  BezierPatch patch{2, 2, {}};
  for (int i = 0; i <= 2; ++i) {
    for (int j = 0; j <= 2; ++j) {
      const double z = (i == 2 ? a : 0) + (j == 2 ? c : 0) + 0.25 * b * i * j;
      patch.points.push_back(homogeneous({0.5 * i, 0.5 * j, z}));
    }
  }
  return of_patch(patch);
}

/// Of an affine image of such a graph, with the image of the z axis for an axis, the fall below a
/// tangent plane is half the square of the coordinates all over it, and steps are exact.
TEST(OsculatingParaboloid, OfAnyParaboloidIsExact) {
  Random random(1);
  for (int k = 0; k < 30; ++k) {
    const dmat3 matrix =
        random_rotation(random) * dmat3(1, 0, 0, 0.3, 1.2, 0, -0.2, 0.4, k % 2 == 0 ? 1 : -0.8);
    const double mixed = uniform(random, -1, 1);
    const Scene scene = make_scene(mapped(quadratic_graph(0.8, mixed, 1.1), matrix));
    ConcaveSurfaces surfaces(scene);
    const ConcavePatch& patch = surfaces.patch(0, 0);
    const dvec3 down = unit(matrix * dvec3(0, 0, -1));
    const double u = uniform(random, 0, 1);
    const dvec2 p(u, uniform(random, 0, 1));
    const dvec3 center = point(patch.bezier(), p.x, p.y);
    const dvec3 n = aligned(unit_normal(patch.bezier(), p.x, p.y), down);
    const auto map = OsculatingParaboloid::about(patch, p, down);
    ASSERT_TRUE(map);
    EXPECT_FALSE(OsculatingParaboloid::about(patch, p, -down));
    EXPECT_LT(glm::length((*map)(center + 3.0 * down)), 1e-12);
    for (int i = 0; i < 10; ++i) {
      const double to_u = uniform(random, 0, 1);
      const dvec2 q(to_u, uniform(random, 0, 1));
      const dvec3 x = point(patch.bezier(), q.x, q.y);
      EXPECT_NEAR(0.5 * square_in(*map, x), glm::dot(n, center - x), 1e-12);
      EXPECT_LT(glm::distance(map->step((*map)(x)), q - p), 1e-12);
    }
  }
}

/// Tangents are stretched by the roots of the principal curvatures, 1 along the meridian of a torus
/// of R = 3 and r = 1, and (d - 3) / d along the parallel at the distance d from its axis.
TEST(OsculatingParaboloid, OfATorusStretchesTangents) {
  const Scene scene = make_scene(torus(3, 1));
  const double scale = scene.frame().scale;
  ConcaveSurfaces surfaces(scene);
  Random random(2);
  int outer = 0;
  for (int k = 0; k < 100; ++k) {
    const int number = pick(random, 0, int(surfaces.patches(0).size()) - 1);
    const ConcavePatch& patch = surfaces.patch(0, number);
    const double u = uniform(random, 0, 1);
    const dvec2 p(u, uniform(random, 0, 1));
    const dvec3 center = point(patch.bezier(), p.x, p.y);
    const dvec3 x = scene.frame().to_model(center);
    const double from_axis = std::hypot(x.x, x.y);
    const double across = (from_axis - 3) / from_axis;
    const dvec3 n = unit(x - 3.0 * unit(dvec3(x.x, x.y, 0)));
    const auto map = OsculatingParaboloid::about(patch, p, n);
    EXPECT_EQ(map.has_value(), across > 0);
    EXPECT_FALSE(OsculatingParaboloid::about(patch, p, -n));
    if (!map) continue;
    ++outer;
    const dvec3 parallel = unit(dvec3(-x.y, x.x, 0));
    const dvec3 meridian = glm::cross(n, parallel);
    const double a = uniform(random, -1, 1);
    const double b = uniform(random, -1, 1);
    const double square = square_in(*map, center + a * parallel + b * meridian);
    EXPECT_NEAR(square * scale, a * a * across + b * b, 1e-12);
    // The axis is mapped to nothing, whatever it is, and the tangents as before.
    const dvec3 axis = unit(n + 0.7 * parallel - 0.4 * meridian);
    const auto oblique = OsculatingParaboloid::about(patch, p, axis);
    ASSERT_TRUE(oblique);
    const dvec3 shifted_by_axis = center + a * parallel + b * meridian + 0.8 * axis;
    EXPECT_NEAR(square_in(*oblique, shifted_by_axis), square, 1e-12);
  }
  EXPECT_GT(outer, 30);
}

TEST(OsculatingParaboloid, NoneOfWhatDoesNotFallToAllSides) {
  for (const Shape& shape : {saddle(), bilinear_saddle(), box(1, 2, 3), cylinder(1, 2)}) {
    const Scene scene = make_scene(shape);
    ConcaveSurfaces surfaces(scene);
    const ConcavePatch& patch = surfaces.patch(0, 0);
    for (const dvec2& p : {dvec2(0.5, 0.5), {0.2, 0.7}}) {
      const dvec3 n = unit_normal(patch.bezier(), p.x, p.y);
      EXPECT_FALSE(OsculatingParaboloid::about(patch, p, n));
      EXPECT_FALSE(OsculatingParaboloid::about(patch, p, -n));
    }
  }
}

/// However it is curved, tangents keep their lengths.
TEST(OsculatingParaboloid, OfAStandInTakesDistances) {
  const BezierPatch bezier{
      1, 1, {{-1, -1, 1, 1}, {-1, 1.5, -1, 1}, {1, -1, -1, 1}, {1.2, 1, 1.1, 1}}};
  Part part;
  part.add_patches({{bezier, {}, true}}, "face");
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  const Scene scene(std::move(model), {.threads = 1, .progress = {}});
  ConcaveSurfaces surfaces(scene);
  const ConcavePatch& patch = surfaces.patch(0, 0);
  ASSERT_TRUE(patch.stand_in());
  Random random(4);
  for (int k = 0; k < 20; ++k) {
    const double u = uniform(random, 0, 1);
    const dvec2 p(u, uniform(random, 0, 1));
    const PatchJet1 jet = jet1(patch.bezier(), p.x, p.y);
    for (const double sign : {1.0, -1.0}) {
      const dvec3 n = sign * unit(glm::cross(jet.Su, jet.Sv));
      const auto map = OsculatingParaboloid::about(patch, p, n);
      ASSERT_TRUE(map);
      const dvec2 step(uniform(random, -1, 1), 0.5);
      const dvec3 tangent = step.x * jet.Su + step.y * jet.Sv;
      EXPECT_NEAR(square_in(*map, jet.S + tangent), glm::dot(tangent, tangent), 1e-12);
      EXPECT_LT(glm::distance(map->step((*map)(jet.S + tangent)), step), 1e-12);
    }
  }
}

}  // namespace
}  // namespace taut
