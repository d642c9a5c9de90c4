#include <gtest/gtest.h>

#include <cmath>

#include "hull_checks.h"
#include "support_checks.h"
#include "taut/hull/sample/sampled_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and checks

/// Unit normals of all polygons, by long double.
std::vector<dvec3> facet_directions(const PolygonMesh& mesh) {
  std::vector<dvec3> result;
  for (const auto& polygon : mesh.polygons) {
    const auto at = [&](std::size_t k) { return rvec3(mesh.points[std::size_t(polygon[k])]); };
    rvec3 normal{};
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      normal += glm::cross(at(k) - at(0), at(k + 1) - at(0));
    }
    EXPECT_GT(glm::length(normal), 0);
    result.emplace_back(glm::normalize(normal));
  }
  return result;
}

/// The distance certified for sampled hulls of the teapot holds in random directions, by a
/// reference that shares nothing with support queries, and in those of all facets.
TEST(SampledSweep, CertifiedDistancesOfTheTeapotHold) {
  const Scene scene = make_scene(teapot());
  const dvec3 center = scene.frame().center;
  const real diagonal = scene.diagonal();
  const ReferenceSupport reference(scene.model(), center);
  Random random(1);
  const std::vector<dvec3> tried = random_directions(random, 10'000);
  std::vector<SupportRange> truth;
  for (const dvec3& n : tried) truth.push_back(reference(n, 1e-12L));
  std::size_t vertices = 0;

  for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
    SCOPED_TRACE(tolerance);
    const Hull hull = sampled_hull(
        scene, {.tolerance = tolerance * scene.diagonal(), .threads = 1, .progress = {}});
    EXPECT_LE(hull.distance_bound, tolerance * scene.diagonal());
    EXPECT_GT(hull.distance_bound, 0);
    const PolygonMesh mesh = polygons(hull.mesh);
    EXPECT_GT(mesh.points.size(), vertices);  // or one mesh serves all
    vertices = mesh.points.size();

    expect_strict_polytope(mesh_facts(mesh));

    MeshSupport support(mesh, center);
    real most = 0;
    real least = 0;
    for (std::size_t k = 0; k < tried.size(); ++k) {
      const real h = support(tried[k]);
      most = std::max(most, truth[k].lower - h);
      least = std::min(least, truth[k].upper - h);
    }
    EXPECT_LE(most, hull.distance_bound);
    EXPECT_GE(least, -2e-12L * diagonal);
    EXPECT_GT(most, hull.distance_bound / 1000);  // or the mesh is far finer than it need be

    // In the finest meshes' facets a query serves; support_sweep_test vouches for it.
    SupportQuery query(scene);
    Contact near;
    const std::vector<dvec3> facets = facet_directions(mesh);
    const std::size_t step = std::max<std::size_t>(1, facets.size() / 4000);
    for (std::size_t k = 0; k < facets.size(); ++k) {
      const Support s = query(facets[k], near);
      near = s.contact;
      const real h = support(facets[k]);
      real model = scene.frame().length_to_model(s.h);
      if (k % step == 0) {
        const SupportRange range = reference(facets[k], 1e-12L);
        EXPECT_NEAR(double(range.lower), double(model), 1e-12 * scene.diagonal());
        model = std::max(model, range.lower);
      }
      most = std::max(most, model - h);
      least = std::min(least, model - h);
    }
    EXPECT_LE(most, hull.distance_bound);
    EXPECT_GE(least, -2e-12L * diagonal);
  }
}

}  // namespace
}  // namespace taut
