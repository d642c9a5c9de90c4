// Sampled hulls against closed forms (see truths.h).
//
// Let P be the mesh, H the true hull and d the mesh's certified distance: P lies in H up to
// rounding, and H in P + d B. Then
//   V(H) - V(P) <= d A(H): the level sets of the distance from P that fill H \ P are boundaries of
//     convex bodies P + t B, 0 < t < d, as far as they lie in H. Those parts have at most the
//     area of (P + t B) n H, a convex body inside H.
//   A(H) - A(P) <= 4 pi D d + 4 pi d^2 with the diagonal D of P's box: by Steiner's formula
//     A(P + d B) = A(P) + 2 M d + 4 pi d^2, where M is 2 pi times the mean width, which is at most
//     the diameter, thus D.
// Rounding moves points by some e: volumes change by e A, areas by 4 pi D e to first order.

#include "truths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "taut/core/tolerances.h"
#include "taut/hull/result/measures.h"
#include "taut/hull/sample/sampled_hull.h"
#include "taut/verify/verify.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: truths and models

constexpr real real_pi = std::numbers::pi_v<real>;

struct Errors {
  real volume = 0;
  real area = 0;
  PolygonMesh mesh;
};

/// The truth of the shape scaled by s.
Truth scaled_truth(Truth truth, real s) {
  truth.shape = scaled(truth.shape, double(s));
  truth.volume *= s * s * s;
  truth.area *= s * s;
  return truth;
}

/// How far rounded coordinates may lie from those that the formula means.
double rounding_of(const Scene& scene) {
  double size = 0;
  for (int i = 0; i < 3; ++i) {
    size = std::max({size, std::abs(scene.box().lower[i]), std::abs(scene.box().upper[i])});
  }
  return 16 * rounding_unit * size + support_slack * scene.diagonal();
}

Errors expect_true(const Scene& scene, const Truth& truth, double relative) {
  SCOPED_TRACE(truth.name + " at " + std::to_string(relative));
  Errors errors;
  Hull hull;
  try {
    hull = sampled_hull(scene,
                        {.tolerance = relative * scene.diagonal(), .threads = 1, .progress = {}});
  } catch (const Error& error) {
    ADD_FAILURE() << error.what();
    return errors;
  }
  errors.mesh = polygons(hull.mesh);
  const real bound = hull.distance_bound;
  EXPECT_GT(bound, 0);
  EXPECT_LE(bound, relative * scene.diagonal());
  const real D = scene.diagonal();
  const real e = rounding_of(scene);

  const Verification found =
      verify(errors.mesh, scene, {.random_directions = 2000, .progress = {}});
  EXPECT_TRUE(found.closed && found.manifold && found.oriented && found.topological_sphere);
  EXPECT_TRUE(found.convex);
  EXPECT_TRUE(found.no_zero_area);
  EXPECT_LE(found.model_outside, bound);
  EXPECT_LE(found.mesh_outside, e);

  const Measures measures = measure(errors.mesh);
  const real area_gap = 4 * real_pi * D * bound + 4 * real_pi * bound * bound;
  const real A = truth.area >= 0 ? truth.area : measures.area + area_gap;
  const real volume_slack = e * A + truth.uncertainty * (truth.volume > 0 ? 1 : 0);
  errors.volume = truth.volume - measures.volume;
  EXPECT_GE(errors.volume, -volume_slack);
  EXPECT_LE(errors.volume, bound * A + volume_slack);
  if (truth.area < 0) return errors;
  const real area_slack = 4 * real_pi * D * e + truth.uncertainty;
  errors.area = truth.area - measures.area;
  EXPECT_GE(errors.area, -area_slack);
  EXPECT_LE(errors.area, area_gap + area_slack);
  return errors;
}

/// A tenth of the tolerance leaves about a tenth of the error, down to what the truth is known to.
/// Where all of the hull refines alike, its pieces are halved, and the step is one of four or
/// sixteen, less what is of higher order.
void expect_converging(const Scene& scene, const Truth& truth,
                       const std::vector<double>& tolerances) {
  Errors before;
  for (std::size_t k = 0; k < tolerances.size(); ++k) {
    const Errors now = expect_true(scene, truth, tolerances[k]);
    const real D = scene.diagonal();
    const real known = 4 * truth.uncertainty + 8 * rounding_of(scene) * D * D;
    if (k > 0) {
      EXPECT_LE(now.volume, std::max(before.volume / 3.9L, known)) << truth.name;
      EXPECT_LE(now.area, std::max(before.area / 3.9L, known / D)) << truth.name;
    }
    before = now;
  }
}

Scene scene_of(const Shape& shape) { return make_scene(shape); }

/// The mesh of a model that has the same hull: as good, and about as large. (Not the same points:
/// the last bits of a contact depend on the way that a query takes through the model.)
void expect_as_good(const Errors& now, const Errors& alone, const Truth& truth) {
  SCOPED_TRACE(truth.name);
  const auto count = double(alone.mesh.points.size());
  EXPECT_NEAR(double(now.mesh.points.size()), count, 0.03 * count);
  const real known = 2 * truth.uncertainty + 1e-11L * truth.volume;
  EXPECT_NEAR(double(now.volume), double(alone.volume), double(alone.volume / 20 + known));
}

class Truths : public testing::TestWithParam<Truth> {};

TEST_P(Truths, SampledHullsConverge) {
  const Truth& truth = GetParam();
  std::vector<double> tolerances = {1e-3, 1e-4};
  if (truth.fine) tolerances.push_back(1e-5);
  expect_converging(scene_of(truth.shape), truth, tolerances);
}

TEST_P(Truths, HoldInAnyPlace) {
  Truth truth = GetParam();
  const double D = scene_of(truth.shape).diagonal();
  truth.shape = mapped(truth.shape, skew_rotation(), {0.1, -0.2, 0.3});
  truth.name += ", turned";
  expect_converging(scene_of(truth.shape), truth, {1e-3, 1e-4});
  truth.shape = shifted(truth.shape, 1e6 * D * dvec3(0.48, -0.6, 0.64));
  truth.name += " and far";
  expect_converging(scene_of(truth.shape), truth, {1e-3, 1e-4});
}

TEST_P(Truths, HoldAtAnySize) {
  for (const double s : {1e-6, 1e6}) {
    Truth truth = scaled_truth(GetParam(), s);
    truth.uncertainty *= real(s) * s * std::max(real(1), real(s));
    truth.name += " of size " + std::to_string(s);
    expect_true(scene_of(truth.shape), truth, 1e-3);
  }
}

/// What adds nothing to the hull changes it by nothing but rounding.
TEST_P(Truths, CopiesAndWhatLiesInsideChangeNothing) {
  const Truth& truth = GetParam();
  const Errors alone = expect_true(scene_of(truth.shape), truth, 1e-3);

  Model twice = make_model(truth.shape);
  twice.add_instance(0, {});
  const Scene pair(std::move(twice), {.threads = 1, .progress = {}});
  expect_as_good(expect_true(pair, truth, 1e-3), alone, truth);

  const Scene doubled = scene_of(truth.shape + truth.shape);
  expect_as_good(expect_true(doubled, truth, 1e-3), alone, truth);

  const dvec3 center = measure(alone.mesh).centroid;
  const Shape inner = shifted(scaled(shifted(truth.shape, -center), 0.5), center);
  const Scene filled = scene_of(truth.shape + inner);
  expect_as_good(expect_true(filled, truth, 1e-3), alone, truth);
}

INSTANTIATE_TEST_SUITE_P(Hulls, Truths, testing::ValuesIn(truths()),
                         [](const auto& info) { return test_name(info.param); });

TEST(TruthsOfNeedles, SampledHullsConverge) {
  const real a = 1e6L;
  const real eccentricity = std::sqrt(1 - 1 / (a * a));
  const Truth needle = {"needle",
                        ellipsoid(double(a), 1, 1),
                        4 * real_pi / 3 * a,
                        2 * real_pi * (1 + a / eccentricity * std::asin(eccentricity)),
                        0,
                        false};
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    const Scene scene = scene_of(mapped(needle.shape, turn));
    for (const double relative : {1e-3, 1e-6, 1e-8}) expect_true(scene, needle, relative);
  }
}

/// The integrals of mean curvature that truths.cpp has as numbers are those of h over the sphere.
TEST(TruthsThemselves, MeanCurvatureOfCircles) {
  const auto mean_curvature = [](double shift) {
    constexpr int n = 600;
    real sum = 0;
    for (int i = 0; i < n; ++i) {
      const real z = -1 + (2 * i + 1) / real(n);
      const real r = std::sqrt(1 - z * z);
      for (int k = 0; k < 2 * n; ++k) {
        const real x = r * std::cos((2 * k + 1) * real_pi / (2 * n));
        sum += std::max(r, shift * x + std::sqrt(x * x + z * z));
      }
    }
    return double(sum * 4 * real_pi / (2 * n * n));
  };
  EXPECT_NEAR(mean_curvature(1), 13.76442932700307, 1e-4);
  EXPECT_NEAR(mean_curvature(0), 11.74812872262842, 1e-4);
}

}  // namespace
}  // namespace taut
