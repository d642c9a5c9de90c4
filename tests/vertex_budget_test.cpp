// Budgets of vertices: the best mesh of so many.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "error_checks.h"
#include "models.h"
#include "support_checks.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/sample/sampled_hull.h"

namespace taut_test::vertex_budget {
namespace {

using namespace taut;  // NOLINT: what is tested

/// Directions spread over the sphere, Fibonacci's.
std::vector<dvec3> spread_directions(int count) {
  std::vector<dvec3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count;
    const double angle = i * 2.399963229728653;
    const double r = std::sqrt(1 - z * z);
    directions.push_back({r * std::cos(angle), r * std::sin(angle), z});
  }
  return directions;
}

/// What support queries say of a scene in many directions.
struct Seen {
  std::vector<dvec3> directions = spread_directions(4000);
  std::vector<double> heights;
  std::vector<dvec3> points;

  explicit Seen(const Scene& scene) {
    SupportQuery query(scene);
    for (const dvec3& n : directions) {
      points.push_back(scene.frame().to_model(query(n).point));
      heights.push_back(glm::dot(n, points.back()));
    }
  }
  /// The direction that is farthest above the points, and how far.
  std::pair<double, std::size_t> farthest(const std::vector<dvec3>& vertices) const {
    std::pair<double, std::size_t> best = {-1, 0};
    for (std::size_t i = 0; i < directions.size(); ++i) {
      double highest = -infinity;
      for (const dvec3& v : vertices) highest = std::max(highest, glm::dot(directions[i], v));
      best = std::max(best, {heights[i] - highest, i});
    }
    return best;
  }
  /// The distance that so many points reach, each the farthest from those before.
  double greedy_distance(int count) const {
    std::vector<dvec3> vertices = {points.front()};
    while (int(vertices.size()) < count) vertices.push_back(points[farthest(vertices).second]);
    return farthest(vertices).first;
  }
};

std::vector<dvec3> vertices_of(const Hull& hull) {
  std::vector<dvec3> vertices;
  for (const auto v : hull.mesh.vertices()) vertices.push_back(position(hull.mesh, v));
  return vertices;
}

const std::vector<Shape>& budget_shapes() {
  static const std::vector<Shape> all = {
      mapped(shapes::sphere(2), skew_rotation()),
      mapped(shapes::torus(2, 0.5), skew_rotation(), dvec3(5, -3, 1))};
  return all;
}

TEST(VertexBudget, IsKeptWithNearlyTheDistanceOfGreedyInsertion) {
  for (const Shape& shape : budget_shapes()) {
    const Scene scene = make_scene(shape);
    const Seen seen(scene);
    double before = infinity;
    for (const int budget : {4, 5, 8, 20, 60}) {
      const Hull hull =
          sampled_hull(scene, {.threads = 1, .vertex_budget = budget, .progress = {}});
      EXPECT_LE(int(hull.mesh.n_vertices()), budget);
      const double distance = seen.farthest(vertices_of(hull)).first;
      EXPECT_LE(distance, hull.distance_bound) << budget;
      EXPECT_LE(hull.distance_bound, 1.5 * seen.greedy_distance(budget)) << budget;
      EXPECT_LE(hull.distance_bound, before) << budget;
      before = hull.distance_bound;
    }
  }
}

TEST(VertexBudget, IsNeverWorseThanASmallerOne) {
  const Shape flat = mapped({{}, {shapes::twisted_cubic()}, {}}, dmat3(1, 0, 0, 0, 1, 0, 0, 0, 0));
  for (const Shape& shape : {shapes::torus(2, 0.5), shapes::box(1, 2, 3), flat}) {
    const Scene scene = make_scene(shape);
    double before = infinity;
    for (int budget = 4; budget <= 50; ++budget) {
      const Hull hull =
          sampled_hull(scene, {.threads = 1, .vertex_budget = budget, .progress = {}});
      EXPECT_LE(hull.distance_bound, before) << budget;
      before = hull.distance_bound;
    }
  }
}

TEST(VertexBudget, OfThePreciseHullLeavesItsBoundaryExact) {
  const Scene scene = make_scene(budget_shapes()[1]);
  const Hull hull = convex_hull(scene, {.threads = 1, .vertex_budget = 30, .progress = {}});
  EXPECT_LE(hull.mesh.n_vertices(), 30U);
  ASSERT_TRUE(hull.boundary);
  EXPECT_EQ(hull.boundary->count(FaceKind::patch), 1);
  EXPECT_EQ(hull.boundary->count(FaceKind::facet), 2);
  EXPECT_LE(Seen(scene).farthest(vertices_of(hull)).first, hull.distance_bound);
}

TEST(VertexBudget, WithAToleranceEndsWhereThatIsReached) {
  const Scene scene = make_scene(budget_shapes()[0]);
  const Hull hull =
      sampled_hull(scene, {.tolerance = 0.2, .threads = 1, .vertex_budget = 500, .progress = {}});
  EXPECT_LT(hull.mesh.n_vertices(), 100U);
  EXPECT_LE(hull.distance_bound, 0.2);
  try {
    sampled_hull(scene, {.tolerance = 1e-4, .threads = 1, .vertex_budget = 50, .progress = {}});
    FAIL();
  } catch (const HullNotConverged& error) {
    EXPECT_EQ(error.best->mesh.n_vertices(), 50U);
  }
}

TEST(VertexBudget, OfFlatHulls) {
  const Scene scene = make_scene(mapped(shapes::disc(2, 0), skew_rotation()));
  double before = infinity;
  for (const int budget : {4, 8, 32, 100}) {
    const Hull hull = convex_hull(scene, {.threads = 1, .vertex_budget = budget, .progress = {}});
    EXPECT_EQ(hull.kind, HullKind::planar);
    EXPECT_LE(int(hull.mesh.n_vertices()), budget);
    EXPECT_LE(hull.distance_bound, before);
    before = hull.distance_bound;
    // Points that halve arcs, as many as there are, reach this.
    const double halvings = std::floor(std::log2(budget));
    EXPECT_LE(hull.distance_bound,
              1.5 * 2 * (1 - std::cos(std::numbers::pi / std::exp2(halvings))));
  }
}

TEST(VertexBudget, IsFourOrMore) {
  const Scene scene = make_scene(budget_shapes()[0]);
  for (const int wrong : {3, 0, -1}) {
    expect_invalid([&] { sampled_hull(scene, {.vertex_budget = wrong, .progress = {}}); },
                   "four or more");
  }
}

}  // namespace
}  // namespace taut_test::vertex_budget
