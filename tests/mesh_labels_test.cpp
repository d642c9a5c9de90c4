// Faces of meshes are parts of the hull's faces that they name, by distances from the model.

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "cages.h"
#include "models.h"
#include "taut/hull/precise_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and cages

/// Places of a patch from which the nearest one is sought, along each parameter, and steps.
constexpr int places_a_side = 8;
constexpr int steps = 20;

/// How far a point is from a patch, by brute force and Gauss and Newton.
double distance(const BezierPatch& patch, const dvec3& x) {
  dvec2 nearest(0.0);
  double least = infinity;
  const auto visit = [&](const dvec2& uv) {
    const double d = glm::distance(jet1(patch, uv.x, uv.y).S, x);
    if (d < least) {
      least = d;
      nearest = uv;
    }
  };
  // Not on the sides, which may be poles.
  for (int i = 0; i < places_a_side; ++i) {
    for (int k = 0; k < places_a_side; ++k) visit((dvec2(i, k) + 0.5) / double(places_a_side));
  }
  for (int step = 0; step < steps; ++step) {
    const PatchJet1 j = jet1(patch, nearest.x, nearest.y);
    const dvec3 r = x - j.S;
    const double a = glm::dot(j.Su, j.Su);
    const double b = glm::dot(j.Su, j.Sv);
    const double c = glm::dot(j.Sv, j.Sv);
    const double det = a * c - b * b;
    if (!(det > 0)) break;
    const dvec2 to(glm::dot(j.Su, r), glm::dot(j.Sv, r));
    const dvec2 next = nearest + dvec2(c * to.x - b * to.y, a * to.y - b * to.x) / det;
    visit(glm::clamp(next, dvec2(0.0), dvec2(1.0)));
  }
  return least;
}

/// Some patch is as near.
bool is_near(const Model& model, const dvec3& x, double most) {
  for (const Instance& instance : model.instances()) {
    const dvec3 local = glm::transpose(instance.pose.rotation) * (x - instance.pose.translation);
    for (const Patch& patch : model.parts()[std::size_t(instance.part)].patches()) {
      Box box;
      for (const dvec4& p : patch.bezier.points) box.include(euclidean(p));
      if (glm::any(glm::lessThan(local, box.lower - most))) continue;
      if (glm::any(glm::lessThan(box.upper + most, local))) continue;
      if (distance(patch.bezier, local) <= most) return true;
    }
  }
  return false;
}

/// Edges that are no longer, as a share of the diagonal, bridge nothing that can be seen.
constexpr double long_edge = 0.02;

/// What is labelled as part of a patch does not bridge gaps: the middles of its long edges are no
/// farther from the model than the mesh is from the hull.
void expect_patches_on_the_model(const Model& model) {
  const Scene scene(model);
  const Hull hull = precise_hull(scene, {.threads = 1, .progress = {}});
  for (const auto e : hull.mesh.edges()) {
    const auto h = hull.mesh.halfedge_handle(e, 0);
    const dvec3 a = position(hull.mesh, hull.mesh.from_vertex_handle(h));
    const dvec3 b = position(hull.mesh, hull.mesh.to_vertex_handle(h));
    if (glm::distance(a, b) <= long_edge * scene.diagonal()) continue;
    const auto in_patch = [&](unsigned side) {
      const auto f = hull.mesh.face_handle(hull.mesh.halfedge_handle(e, side));
      return hull.mesh.data(f).kind == FaceKind::patch;
    };
    if (!in_patch(0) && !in_patch(1)) continue;
    EXPECT_TRUE(is_near(model, 0.5 * (a + b), hull.distance_bound))
        << a.x << " " << a.y << " " << a.z << " to " << b.x << " " << b.y << " " << b.z;
  }
}

TEST(MeshLabels, OfATeapot) { expect_patches_on_the_model(make_model(teapot())); }

TEST(MeshLabels, OfSemiSharpIcosahedra) {
  const auto model = model_from_elsewhere("A18_osd_loop_icos_semisharp.obj", std::nullopt, 1e-9);
  if (!model) GTEST_SKIP() << "TAUT_MODELS names no folder with it";
  expect_patches_on_the_model(*model);
}

/// Two bodies at an angle, so that their scroll runs over many patches.
TEST(MeshLabels, OfTwoEllipsoids) {
  const Shape other = mapped(ellipsoid(0.5, 0.7, 1.4), skew_rotation(), {2, 1, 0.5});
  expect_patches_on_the_model(make_model(ellipsoid(1, 1.5, 0.6) + other));
}

TEST(MeshLabels, OfACapsule) { expect_patches_on_the_model(make_model(two_spheres(1, 1, 3))); }

TEST(MeshLabels, OfATurnedRoundedBox) {
  expect_patches_on_the_model(
      make_model(mapped(filleted_box(4, 3, 2, 0.5), skew_rotation(), {0.3, -1, 2})));
}

}  // namespace
}  // namespace taut
