#include "taut/hull/result/hull_options.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "error_checks.h"
#include "models.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/sample/sampled_hull.h"

namespace taut_test::hull_options {
namespace {

using namespace taut;  // NOLINT: what is tested
using Source = ResolutionSource;

/// A sphere in no symmetric position whose coordinates have six decimals.
Shape rounded_sphere(double radius) {
  Shape shape = mapped(shapes::sphere(radius), skew_rotation(), radius * dvec3(0.3, -0.7, 0.2));
  const auto round = [](double x) { return std::round(1e6 * x) / 1e6; };
  for (dvec4& p : shape.surfaces[0].points) {
    const dvec3 x = euclidean(p);
    p = homogeneous(dvec3(round(x.x), round(x.y), round(x.z)), p.w);
  }
  return shape;
}

Model tetrahedron() { return make_model({{}, {}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}); }

TEST(HullOptions, HullsCarryTheResolutionOfTheModel) {
  const Hull sampled =
      sampled_hull(make_scene(rounded_sphere(1)), {.relative = 1e-2, .progress = {}});
  EXPECT_EQ(sampled.resolution.source, Source::coordinates);
  EXPECT_DOUBLE_EQ(sampled.resolution.rho, 2e-6);
  const Scene ball = make_scene(shapes::sphere());
  const Hull precise = convex_hull(ball, {.relative = 1e-2, .progress = {}});
  EXPECT_EQ(precise.resolution.source, Source::floor);
  EXPECT_DOUBLE_EQ(precise.resolution.rho, 1e-8 * std::sqrt(12.0));
  const Model disc = make_model(mapped(shapes::disc(1, 0), skew_rotation()));
  EXPECT_EQ(convex_hull(disc, {.relative = 1e-2, .progress = {}}).resolution.source, Source::floor);
  EXPECT_EQ(convex_hull(tetrahedron()).resolution.rho, 0x1p-49 * 3);
  EXPECT_EQ(convex_hull(Model()).resolution.rho, 0);
}

TEST(HullOptions, HullsCarryTheResolutionAskedFor) {
  const Scene ball = make_scene(rounded_sphere(1));
  for (const double share : {0.0, 1e-9, 1e-4}) {
    const Hull hull = sampled_hull(ball, {.relative = 1e-2, .resolution = share, .progress = {}});
    EXPECT_EQ(hull.resolution.source, Source::option);
    EXPECT_EQ(hull.resolution.rho, resolution_of(ball.model(), ball.diagonal(), share).rho);
  }
  EXPECT_EQ(convex_hull(tetrahedron(), {.resolution = 1e-3, .progress = {}}).resolution.rho,
            1e-3 * std::sqrt(3.0));
}

TEST(HullOptions, TheBestThatWasFoundCarriesItToo) {
  try {
    sampled_hull(make_scene(rounded_sphere(1)), {.max_vertices = 60, .progress = {}});
    FAIL();
  } catch (const HullNotConverged& error) {
    EXPECT_DOUBLE_EQ(error.best->resolution.rho, 2e-6);
  }
}

TEST(HullOptions, ResolutionIsAFractionOfTheDiagonal) {
  const Model disc = make_model(shapes::disc(1, 0));
  for (const Model& model : {tetrahedron(), disc, make_model(shapes::sphere()), Model()}) {
    for (const double wrong : {-1e-9, 1.5, infinity, std::nan("")}) {
      expect_invalid([&] { convex_hull(model, {.resolution = wrong, .progress = {}}); },
                     "from 0 to 1");
    }
  }
}

TEST(HullOptions, HullsWarnOnceOfACoarseModel) {
  const Shape flat = of_patch({1,
                               1,
                               {dvec4(0.0123, 0.004567, 0, 1), dvec4(0.0123, 0.014567, 0, 1),
                                dvec4(0.023456, 0.004567, 0, 1), dvec4(0.023456, 0.014567, 0, 1)}});
  for (const Shape& shape : {rounded_sphere(0.01), flat}) {
    const Scene scene = make_scene(shape);
    int warnings = 0;
    HullOptions options;
    options.relative = 0.05;
    options.progress.warn = [&](std::string_view code, std::string_view) {
      warnings += code == "coarse-resolution" ? 1 : 0;
    };
    EXPECT_DOUBLE_EQ(sampled_hull(scene, options).resolution.rho, 1e-5 * scene.diagonal());
    EXPECT_EQ(warnings, 1);
    options.resolution = 1e-9;
    sampled_hull(scene, options);
    EXPECT_EQ(warnings, 1);
  }
}

}  // namespace
}  // namespace taut_test::hull_options
