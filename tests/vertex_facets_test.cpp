#include "taut/hull/sample/vertex_facets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "models.h"
#include "taut/core/integers.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// Of points on a sphere, and of some inside of it.
struct GrowingPolytope {
  PointHull hull{Box{dvec3(-1.0), dvec3(1.0)}};

  explicit GrowingPolytope(Random& random) {
    std::vector<dvec3> points;
    for (int k = 0; k < 40; ++k) points.push_back(random_direction(random));
    for (int k = 0; k < 10; ++k) points.push_back(0.1 * random_direction(random));
    hull.add(points);
  }
  /// Of the vertex, by brute force.
  std::set<int> facets(int vertex) const {
    std::set<int> result;
    for (int f = 0; f < int(hull.facets().size()); ++f) {
      const PointHull::Facet& own = hull.facet(f);
      const bool has = std::find(own.vertex.begin(), own.vertex.end(), vertex) != own.vertex.end();
      if (own.alive && has) result.insert(f);
    }
    return result;
  }
  void expect_same(const VertexFacets& found) const {
    for (int v = 0; v < int(hull.points().size()); ++v) {
      const std::vector<int> about = found.about(v);
      ASSERT_EQ(std::set<int>(about.begin(), about.end()), facets(v)) << v;
      for (const int f : about) {
        for (const int w : hull.facet(f).vertex) ASSERT_EQ(found.joined(v, w), true);
      }
    }
  }
};

TEST(VertexFacets, AreThoseOfAGrowingPolytope) {
  Random random(1);
  GrowingPolytope polytope(random);
  VertexFacets facets(polytope.hull);
  polytope.expect_same(facets);
  for (int k = 0; k < 20; ++k) {
    const dvec3 x = 1.2 * random_direction(random);
    const int facet = facets.below(x, *polytope.hull.facet(0).vertex.begin());
    if (facet < 0) continue;  // the facet was free, or its place dead
    ASSERT_TRUE(polytope.hull.insert(x, facet));
    facets.update();
    polytope.expect_same(facets);
  }
  EXPECT_FALSE(facets.joined(40, 0));
}

TEST(VertexFacets, BelowPointsIsOneThatTheyAreAbove) {
  Random random(2);
  GrowingPolytope polytope(random);
  const VertexFacets facets(polytope.hull);
  for (int k = 0; k < 200; ++k) {
    const int vertex = pick(random, 0, 39);
    const dvec3 x = log_uniform(random, 0.2, 10) * random_direction(random);
    const int facet = facets.below(x, vertex);
    bool above = false;
    for (int f = 0; f < int(polytope.hull.facets().size()); ++f) {
      above = above || (polytope.hull.facet(f).alive && !polytope.hull.visible(x, f).empty());
    }
    ASSERT_EQ(facet >= 0, above);
    if (above) {
      ASSERT_FALSE(polytope.hull.visible(x, facet).empty());
    }
  }
  EXPECT_EQ(facets.below({2, 0, 0}, 40), -1);
}

}  // namespace
}  // namespace taut
