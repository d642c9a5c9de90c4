#include "taut/hull/sample/sampled_polytope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "models.h"
#include "taut/bounds/support_query.h"
#include "taut/core/integers.h"
#include "taut/hull/sample/sampled_start.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

struct StartedPolytope {
  Scene scene;
  SampledStart start;

  explicit StartedPolytope(const Shape& shape) : scene(make_scene(shape)) {
    SupportQuery query(scene);
    start = sampled_start(scene, query);
  }
  SampledPolytope at(double tolerance, int most = 100000, EdgeConstraints* edges = nullptr) const {
    HullOptions options;
    options.threads = 1;
    options.max_vertices = most;
    return sampled_polytope(scene, options, tolerance, start.samples, start.points, edges);
  }
  dvec3 point(const SampledPolytope& polytope, int k) const {
    return polytope.hull.point(k) / scene.frame().scale;
  }
};

/// How far the sphere of this radius about the origin reaches above the facets, the largest; their
/// gaps are as large.
double highest_above_facets(const StartedPolytope& at, const SampledPolytope& polytope, double r) {
  double highest_gap = 0;
  for (std::size_t f = 0; f < polytope.hull.facets().size(); ++f) {
    const PointHull::Facet& facet = polytope.hull.facets()[f];
    if (!facet.alive) continue;
    const double own = r - glm::dot(unit(facet.side.normal()), at.point(polytope, facet.vertex[0]));
    EXPECT_NEAR(polytope.gaps[f] / at.scene.frame().scale, own, 1e-11);
    for (const int v : facet.vertex) EXPECT_GE(polytope.vertex_bounds[to_size(v)], own);
    highest_gap = std::max(highest_gap, own);
  }
  return highest_gap;
}

/// The distance of a polytope in a sphere is that of its lowest facet.
TEST(SampledPolytope, ComesAsNearASphereAsItSays) {
  const StartedPolytope ball(sphere(3));
  ASSERT_NE(ball.scene.frame().scale, 1);
  std::size_t before = ball.start.samples.size();
  for (const double tolerance : {0.1, 0.02, 3e-3}) {
    const SampledPolytope polytope = ball.at(tolerance);
    EXPECT_EQ(polytope.failure, std::nullopt);
    EXPECT_LE(polytope.distance_bound, tolerance);
    const double distance = highest_above_facets(ball, polytope, 3);
    EXPECT_LE(distance, polytope.distance_bound);
    EXPECT_GE(distance, 0.5 * polytope.distance_bound);
    // The samples that it started from keep their numbers, and all lie on the sphere.
    ASSERT_EQ(polytope.samples.size(), polytope.hull.points().size());
    for (std::size_t k = 0; k < polytope.samples.size(); ++k) {
      const dvec3 x = ball.point(polytope, to_int(k));
      EXPECT_LT(glm::distance(x, 3.0 * polytope.samples[k].n), 1e-6);
      EXPECT_NEAR(glm::length(x), 3, 1e-14);
      if (k < ball.start.points.size()) {
        EXPECT_EQ(x, ball.start.points[k]);
      }
    }
    EXPECT_GT(polytope.samples.size(), before);
    before = polytope.samples.size();
  }
  // At best triangles are equilateral, the square of their sides six times radius and tolerance.
  EXPECT_LT(double(before), 2 * 4 * pi * 9 / (std::sqrt(0.75) * 6 * 3 * 3e-3));
}

TEST(SampledPolytope, OfABoxIsTheBox) {
  const StartedPolytope at(mapped(box(1, 2, 3), skew_rotation()));
  const SampledPolytope polytope = at.at(1e-9);
  EXPECT_EQ(polytope.failure, std::nullopt);
  EXPECT_EQ(polytope.hull.points().size(), 8U);
  EXPECT_LT(polytope.distance_bound, 1e-11);
  EXPECT_GT(polytope.distance_bound, 0);
  // Closer than rounding it cannot be told.
  const SampledPolytope finer = at.at(1e-18);
  EXPECT_EQ(finer.failure, tolerance_too_fine);
  EXPECT_LT(finer.distance_bound, 1e-11);
}

TEST(SampledPolytope, GivesUpAtTheLimitOfVertices) {
  const StartedPolytope ball(sphere(3));
  const SampledPolytope polytope = ball.at(1e-4, 100);
  EXPECT_EQ(polytope.failure, vertex_limit_met(100));
  EXPECT_GE(polytope.samples.size(), 100U);
  EXPECT_LE(polytope.samples.size(), 102U);
  EXPECT_GE(polytope.distance_bound, highest_above_facets(ball, polytope, 3));
}

/// Chords of the unit sphere's equator, to stay.
struct EquatorChords : EdgeConstraints {
  explicit EquatorChords(const Scene& scene) : query(scene), frame(scene.frame()) {}

  dvec3 between(int a, int b) const { return unit(points.at(a) + points.at(b)); }
  std::optional<Middle> middle(int a, int b) const override {
    if (!chords.contains(std::minmax(a, b))) return std::nullopt;
    const Support s = query(between(a, b));
    return Middle{{between(a, b), s.contact}, frame.to_model(s.point)};
  }
  std::vector<std::pair<int, int>> wanted() const override {
    return {chords.begin(), chords.end()};
  }
  double narrow() const override { return strip; }
  void bisect(int a, int b, int middle) override {
    EXPECT_EQ(chords.erase(std::minmax(a, b)), 1U);
    points[middle] = between(a, b);
    chords.insert({std::minmax(a, middle), std::minmax(b, middle)});
  }

  mutable SupportQuery query;
  SceneFrame frame;
  std::map<int, dvec3> points;
  std::set<std::pair<int, int>> chords;
  double strip = 0;
};

bool are_edges(const SampledPolytope& polytope, const std::set<std::pair<int, int>>& wanted) {
  std::set<std::pair<int, int>> edges;
  for (const PointHull::Facet& facet : polytope.hull.facets()) {
    for (std::size_t k = 0; facet.alive && k < 3; ++k) {
      edges.insert(std::minmax(facet.vertex[k], facet.vertex[(k + 1) % 3]));
    }
  }
  return std::includes(edges.begin(), edges.end(), wanted.begin(), wanted.end());
}

/// An octahedron, and points so near to its equator that they hide its sides.
void start_with_hidden_equator(StartedPolytope& ball, EquatorChords& equator) {
  ball.start.samples.clear();
  ball.start.points = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (int k = 0; k < 16; ++k) {
    const double angle = pi / 8 * (k + 0.4);
    const double height = k % 2 == 0 ? 0.02 : -0.03;
    ball.start.points.push_back(unit({std::cos(angle), std::sin(angle), height}));
  }
  for (const dvec3& n : ball.start.points) {
    ball.start.samples.push_back({n, equator.query(n).contact});
  }
  for (int k = 0; k < 4; ++k) {
    equator.points[k] = ball.start.points[to_size(k)];
    equator.chords.insert(std::minmax(k, (k + 1) % 4));
  }
}

TEST(SampledPolytope, RestoresEdgesThatAreHiddenFromTheStart) {
  StartedPolytope ball(sphere(1));
  EquatorChords equator(ball.scene);
  start_with_hidden_equator(ball, equator);
  const SampledPolytope polytope = ball.at(1e-2, 100000, &equator);
  EXPECT_EQ(polytope.failure, std::nullopt);
  EXPECT_TRUE(are_edges(polytope, equator.chords));
  EXPECT_GT(equator.chords.size(), 16U);
  EXPECT_LT(equator.chords.size(), 512U);
}

/// Chords of two curves so near to each other take turns; no finer ones would tell them apart.
TEST(SampledPolytope, EdgesMayBeHiddenByWhatIsNear) {
  StartedPolytope ball(sphere(1));
  EquatorChords equator(ball.scene);
  start_with_hidden_equator(ball, equator);
  equator.strip = 0.5;
  const SampledPolytope polytope = ball.at(1e-2, 100000, &equator);
  EXPECT_EQ(polytope.failure, std::nullopt);
  EXPECT_EQ(equator.chords.size(), 4U);
}

/// From an octahedron on.
TEST(SampledPolytope, KeepsEdgesThatAreToStay) {
  StartedPolytope ball(sphere(1));
  EquatorChords equator(ball.scene);
  ball.start.samples.clear();
  ball.start.points = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const dvec3& n : ball.start.points) {
    ball.start.samples.push_back({n, equator.query(n).contact});
  }
  for (int k = 0; k < 4; ++k) {
    equator.points[k] = ball.start.points[to_size(k)];
    equator.chords.insert(std::minmax(k, (k + 1) % 4));
  }
  const SampledPolytope polytope = ball.at(1e-3, 100000, &equator);
  EXPECT_EQ(polytope.failure, std::nullopt);
  EXPECT_LE(highest_above_facets(ball, polytope, 1), 1e-3);
  EXPECT_GT(equator.chords.size(), 16U);
  for (const auto& [number, x] : equator.points) {
    EXPECT_LT(glm::distance(ball.point(polytope, number), x), 1e-9);
  }
  std::set<std::pair<int, int>> edges;
  for (const PointHull::Facet& facet : polytope.hull.facets()) {
    for (std::size_t k = 0; facet.alive && k < 3; ++k) {
      edges.insert(std::minmax(facet.vertex[k], facet.vertex[(k + 1) % 3]));
    }
  }
  for (const auto& chord : equator.chords) EXPECT_TRUE(edges.contains(chord));
}

}  // namespace
}  // namespace taut
