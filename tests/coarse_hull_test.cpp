#include "taut/hull/polytope/coarse_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models.h"
#include "taut/core/integers.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

PointHull fine_hull(const std::vector<dvec3>& points) {
  Box box;
  for (const dvec3& p : points) box.include(p);
  PointHull hull(box);
  hull.add(points);
  return hull;
}

/// A cube of side two and points on its sides, out of the planes by up to `noise`.
std::vector<dvec3> noisy_cube(Random& random, int count, double noise) {
  std::vector<dvec3> points;
  for (int k = 0; k < 8; ++k) points.emplace_back(k % 2 * 2 - 1, k / 2 % 2 * 2 - 1, k / 4 * 2 - 1);
  for (int k = 0; k < count; ++k) {
    dvec3 p = 0.99 * random_point(random);
    p[k % 3] = (k % 2 == 0 ? 1 : -1) * (1 + uniform(random, 0, noise));
    points.push_back(p);
  }
  return points;
}

double highest_of(const std::vector<dvec3>& points, const dvec3& n) {
  double h = -infinity;
  for (const dvec3& p : points) h = std::max(h, glm::dot(p, n));
  return h;
}

/// What the coarse hull of all points, for this width and at most so far from theirs, promises;
/// its vertices.
std::vector<int> expect_coarse_hull(const std::vector<dvec3>& points, double left_out,
                                    double most) {
  const PointHull fine = fine_hull(points);
  const CoarseHull coarse = coarse_hull(fine, fine.simplex(), left_out, {});
  EXPECT_EQ(coarse.original.size(), coarse.hull.points().size());
  for (std::size_t k = 0; k < coarse.original.size(); ++k) {
    EXPECT_EQ(coarse.hull.points()[k], points[to_size(coarse.original[k])]);
  }
  std::vector<int> vertices;
  for (const PointHull::Facet& facet : coarse.hull.facets()) {
    if (!facet.alive) continue;
    for (const int v : facet.vertex) vertices.push_back(coarse.original[to_size(v)]);
    const dvec3 n = unit(facet.side.normal());
    const double own = glm::dot(coarse.hull.point(facet.vertex[0]), n);
    EXPECT_LE(highest_of(points, n) - own, left_out + 1e-14);
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  Random random(9);
  double apart = 0;
  for (int k = 0; k < 2000; ++k) {
    const dvec3 n = random_direction(random);
    apart = std::max(apart, highest_of(points, n) - highest_of(coarse.hull.points(), n));
  }
  EXPECT_LE(apart, coarse.distance_bound + 1e-14);
  EXPECT_LE(coarse.distance_bound, most);
  return vertices;
}

TEST(CoarseHull, OfANoisyCubeIsTheCube) {
  Random random(1);
  const std::vector<dvec3> points = noisy_cube(random, 200, 1e-9);
  EXPECT_GT(fine_hull(points).facet_count(), 50);
  const std::vector<int> vertices = expect_coarse_hull(points, 1e-8, 1e-7);
  EXPECT_EQ(vertices, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(CoarseHull, LeavesNoPointHigherThanTheWidth) {
  Random random(2);
  std::vector<dvec3> points;
  for (int k = 0; k < 1500; ++k) points.push_back(random_direction(random));
  std::size_t before = 0;
  for (const double width_above : {0.3, 0.1, 0.03}) {
    const auto vertices = expect_coarse_hull(points, width_above, 5 * width_above).size();
    EXPECT_GT(vertices, before);
    before = vertices;
  }
  EXPECT_LT(before, 300U);
  // Without a width nothing is left out.
  EXPECT_EQ(expect_coarse_hull(points, 0, 1e-12).size(), points.size());
}

/// The roof of height h over a square: each side's plane is 2 h / sqrt(1 + h^2) above the corner
/// beyond an edge that runs to the top.
TEST(CoarseHull, NearlyFlatEdgesAreThoseOfLowRoofs) {
  for (const double h : {0.1, 1e-3, 1e-9}) {
    const PointHull roof =
        fine_hull({{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {0, 0, h}, {0, 0, -1}});
    const double depth = 2 * h / std::sqrt(1 + h * h);
    EXPECT_TRUE(has_nearly_flat_edges(roof, 1.001 * depth));
    EXPECT_FALSE(has_nearly_flat_edges(roof, 0.999 * depth));
  }
  // The two triangles of a square are flat altogether.
  const PointHull cube = fine_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.5, 0.5, 1}});
  EXPECT_FALSE(has_nearly_flat_edges(cube, 0.1));
}

/// All facets of two pyramids on an n-gon, back to back, and both tips with n neighbours.
TEST(CoarseHull, WorkCountsTheMostNeighbors) {
  for (const int n : {4, 7, 50}) {
    std::vector<dvec3> points = {{0, 0, 1}, {0, 0, -1}};
    for (int k = 0; k < n; ++k) {
      points.emplace_back(std::cos(2 * pi * k / n), std::sin(2 * pi * k / n), 0);
    }
    EXPECT_EQ(coarsening_work(fine_hull(points)), 2.0 * n * n);
  }
}

}  // namespace
}  // namespace taut
