#include "taut/hull/polytope/polytope_support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

double highest(const std::vector<dvec3>& points, const dvec3& n) {
  double h = glm::dot(points[0], n);
  for (const dvec3& p : points) h = std::max(h, glm::dot(p, n));
  return h;
}

PointHull hull_of(const std::vector<dvec3>& points) {
  Box box;
  for (const dvec3& p : points) box.include(p);
  PointHull hull(box);
  hull.add(points);
  return hull;
}

/// From any start a climb ends as high as any point lies.
void expect_highest(const std::vector<dvec3>& points, Random& random) {
  const PointHull hull = hull_of(points);
  const PolytopeSupport support(hull);
  std::set<int> vertices;
  for (const PointHull::Facet& facet : hull.facets()) {
    if (facet.alive) vertices.insert(facet.vertex.begin(), facet.vertex.end());
  }
  const std::vector<int> starts(vertices.begin(), vertices.end());
  for (int k = 0; k < 200; ++k) {
    dvec3 n = random_direction(random);
    // Also across facets, where several points are highest.
    if (k % 4 == 0) n = unit(dvec3(pick(random, -1, 1), pick(random, -1, 1), 1));
    const int start = starts[std::size_t(pick(random, 0, int(starts.size()) - 1))];
    const double h = highest(points, n);
    EXPECT_GE(glm::dot(hull.point(support(n, start)), n), h - 1e-14);
    EXPECT_GE(glm::dot(hull.point(support(n)), n), h - 1e-14);
  }
}

TEST(PolytopeSupport, IsTheHighestPoint) {
  Random random(1);
  for (const int count : {4, 10, 100, 1000}) {
    std::vector<dvec3> points;
    for (int i = 0; i < count; ++i) points.push_back(random_point(random));
    expect_highest(points, random);
    for (dvec3& p : points) p = unit(p);
    expect_highest(points, random);
  }
}

TEST(PolytopeSupport, OfAGridWithManyCoplanarPoints) {
  Random random(2);
  std::vector<dvec3> points;
  for (int i = 0; i < 125; ++i) points.emplace_back(i % 5, i / 5 % 5, i / 25);
  expect_highest(points, random);
}

TEST(PolytopeSupport, NeighborsAreThoseOfEdges) {
  const std::vector<dvec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const PointHull hull = hull_of(points);
  const PolytopeSupport support(hull);
  for (int v = 0; v < 4; ++v) {
    std::set<int> neighbors;
    support.for_each_neighbor(v, [&](int w) { EXPECT_TRUE(neighbors.insert(w).second); });
    EXPECT_EQ(neighbors.size(), 3U);
    EXPECT_FALSE(neighbors.contains(v));
  }
}

}  // namespace
}  // namespace taut
