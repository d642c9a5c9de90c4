#include "taut/hull/polytope/point_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <set>

#include "models.h"
#include "reference.h"

namespace taut {
namespace {

using taut_test::log_uniform;
using taut_test::pick;
using taut_test::Random;
using taut_test::random_point;

using Coordinates = std::array<double, 3>;

Box box_of(const std::vector<dvec3>& points) {
  Box box;
  for (const dvec3& p : points) box.include(p);
  return box;
}

PointHull hull_of_points(const std::vector<dvec3>& points) {
  PointHull hull(box_of(points));
  hull.add(points);
  return hull;
}

std::set<Coordinates> extreme_points(const PointHull& hull) {
  std::set<Coordinates> result;
  for (const auto& loop : hull.merged_polygons().loops) {
    for (const int v : loop) result.insert({hull.point(v).x, hull.point(v).y, hull.point(v).z});
  }
  return result;
}

PolygonMesh mesh_of(const PointHull& hull, const std::vector<std::vector<int>>& loops) {
  PolygonMesh mesh;
  std::vector<int> number(hull.points().size(), -1);
  for (const auto& loop : loops) {
    mesh.polygons.emplace_back();
    for (const int v : loop) {
      int& k = number[std::size_t(v)];
      if (k < 0) {
        k = int(mesh.points.size());
        mesh.points.push_back(hull.point(v));
      }
      mesh.polygons.back().push_back(k);
    }
  }
  return mesh;
}

/// The class invariant, by brute force; `step` > 1 tries only some of the points.
void expect_triangulation(const PointHull& hull, std::size_t step = 1) {
  ASSERT_EQ(hull.dimension(), 3);
  std::vector<std::vector<int>> triangles;
  int alive = 0;
  for (std::size_t f = 0; f < hull.facets().size(); ++f) {
    const PointHull::Facet& facet = hull.facets()[f];
    if (!facet.alive) continue;
    ++alive;
    const auto [a, b, c] = facet.vertex;
    triangles.push_back({a, b, c});
    ASSERT_FALSE(collinear(hull.point(a), hull.point(b), hull.point(c)));
    for (std::size_t k = 0; k < 3; ++k) {
      const PointHull::Facet& other = hull.facet(facet.neighbor[k]);
      ASSERT_TRUE(other.alive);
      bool back = false;
      for (std::size_t j = 0; j < 3; ++j) {
        back =
            back || (other.neighbor[j] == int(f) && other.vertex[j] == facet.vertex[(k + 1) % 3] &&
                     other.vertex[(j + 1) % 3] == facet.vertex[k]);
      }
      ASSERT_TRUE(back);
    }
    for (std::size_t p = f % step; p < hull.points().size(); p += step) {
      ASSERT_NE(orientation(hull.point(a), hull.point(b), hull.point(c), hull.points()[p]),
                Sign::positive)
          << "point " << p << " above facet " << f;
    }
  }
  EXPECT_EQ(alive, hull.facet_count());
  const auto facts = taut_test::mesh_facts(mesh_of(hull, triangles));
  EXPECT_TRUE(facts.closed_manifold);
  EXPECT_EQ(facts.euler, 2);
  EXPECT_TRUE(facts.edges_convex);
  EXPECT_TRUE(facts.no_zero_area);
}

/// Polygons, of extreme points only: a strictly convex polytope.
void expect_polygons(const PointHull& hull) {
  const auto polygons = hull.merged_polygons();
  ASSERT_EQ(polygons.loops.size(), polygons.facets.size());
  const auto facts = taut_test::mesh_facts(mesh_of(hull, polygons.loops));
  EXPECT_TRUE(facts.is_convex_polytope());
  EXPECT_TRUE(facts.strictly);
  for (std::size_t k = 0; k < polygons.loops.size(); ++k) {
    const PointHull::Facet& facet = hull.facet(polygons.facets[k]);
    ASSERT_TRUE(facet.alive);
    for (const int v : polygons.loops[k]) EXPECT_EQ(facet.side.side(hull.point(v)), Sign::zero);
  }
}

/// With exact facts about polygons and no point above any plane, the hull is proven.
void expect_hull(const std::vector<dvec3>& points, std::size_t step = 1) {
  const PointHull hull = hull_of_points(points);
  ASSERT_NO_FATAL_FAILURE(expect_triangulation(hull, step));
  expect_polygons(hull);
}

std::vector<dvec3> point_grid(int n) {
  std::vector<dvec3> points;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) points.emplace_back(i, j, k);
    }
  }
  return points;
}

/// A rotation and uniform scaling with integer entries, by Rodrigues' quaternion formula.
dmat3 integer_rotation(double a, double b, double c, double d) {
  return {{a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)},
          {2 * (b * c - a * d), a * a - b * b + c * c - d * d, 2 * (c * d + a * b)},
          {2 * (b * d + a * c), 2 * (c * d - a * b), a * a - b * b - c * c + d * d}};
}

std::vector<dvec3> mapped(std::vector<dvec3> points, const dmat3& matrix, const dvec3& shift) {
  for (dvec3& p : points) p = matrix * p + shift;
  return points;
}

/// Integer points on one circle about the origin: products of Gaussian integers.
std::vector<dvec2> cocircular() {
  using Gaussian = std::complex<double>;
  std::vector<Gaussian> z = {{1, 0}};
  const auto multiply = [&](const Gaussian& prime, int power) {
    std::vector<Gaussian> next;
    for (const Gaussian& w : z) {
      for (int k = 0; k <= power; ++k) {
        Gaussian product = w;
        for (int j = 0; j < power; ++j) {
          const Gaussian f = j < k ? prime : std::conj(prime);
          product = {product.real() * f.real() - product.imag() * f.imag(),
                     product.real() * f.imag() + product.imag() * f.real()};
        }
        next.push_back(product);
      }
    }
    z = next;
  };
  multiply({2, 1}, 4);
  multiply({3, 2}, 4);
  multiply({4, 1}, 2);
  multiply({5, 2}, 2);
  std::vector<dvec2> points;
  for (const Gaussian& w : z) {
    const double x = w.real();
    const double y = w.imag();
    points.insert(points.end(), {{x, y}, {-y, x}, {-x, -y}, {y, -x}});
  }
  return points;
}

TEST(PointHull, Tetrahedron) {
  const std::vector<dvec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.1, 0.1}};
  const PointHull hull = hull_of_points(points);
  EXPECT_EQ(hull.facet_count(), 4);
  EXPECT_EQ(extreme_points(hull).size(), 4U);
  expect_hull(points);
}

TEST(PointHull, DimensionsBelowThree) {
  PointHull hull({dvec3(-10), dvec3(10)});
  EXPECT_EQ(hull.dimension(), -1);
  hull.add({});
  EXPECT_EQ(hull.dimension(), -1);
  hull.add(std::vector<dvec3>(3, dvec3(1, 2, 3)));
  EXPECT_EQ(hull.dimension(), 0);
  hull.add(std::vector<dvec3>{{2, 4, 6}, {-1, -2, -3}});
  EXPECT_EQ(hull.dimension(), 1);
  hull.add(std::vector<dvec3>{{0, 0, 1}, {0, 0, -1}});
  EXPECT_EQ(hull.dimension(), 2);
  EXPECT_EQ(hull.facet_count(), 0);
  EXPECT_TRUE(hull.merged_polygons().loops.empty());
  // All points count from the moment that they span space.
  hull.add(std::vector<dvec3>{{1, -1, 0}});
  EXPECT_EQ(hull.dimension(), 3);
  EXPECT_EQ(extreme_points(hull),
            (std::set<Coordinates>{{2, 4, 6}, {-1, -2, -3}, {0, 0, 1}, {0, 0, -1}, {1, -1, 0}}));
  expect_triangulation(hull);
  expect_polygons(hull);
}

TEST(PointHull, DimensionIsExact) {
  // A plane that rounding would lose: z = x + y on doubles that add up exactly, then one ulp aside.
  Random random(1);
  std::vector<dvec3> points;
  for (int k = 0; k < 200; ++k) {
    const double x = std::ldexp(pick(random, 1, 1 << 30), -20);
    const double y = std::ldexp(pick(random, 1, 1 << 30), -20);
    points.emplace_back(x, y, x + y);
  }
  EXPECT_EQ(hull_of_points(points).dimension(), 2);
  points[100].z = std::nextafter(points[100].z, 1e300);
  EXPECT_EQ(hull_of_points(points).dimension(), 3);
  expect_hull(points);
  // A line: multiples of one integer vector.
  for (dvec3& p : points) p = double(pick(random, -1000, 1000)) * dvec3(123457, 7, 1e9 + 1);
  EXPECT_EQ(hull_of_points(points).dimension(), 1);
}

TEST(PointHull, RandomPoints) {
  Random random(2);
  for (const int count : {4, 5, 6, 8, 20, 100, 1000}) {
    std::vector<dvec3> points;
    for (int k = 0; k < count; ++k) points.push_back(random_point(random));
    expect_hull(points);
  }
  std::vector<dvec3> sphere;
  for (int k = 0; k < 1000; ++k) sphere.push_back(taut_test::random_direction(random));
  expect_hull(sphere);
  EXPECT_EQ(extreme_points(hull_of_points(sphere)).size(), 1000U);
}

TEST(PointHull, GridsMergeToSixSquares) {
  const std::vector<dvec3> points = point_grid(20);
  const dmat3 turn = integer_rotation(3, 1, 4, 2);
  for (const auto& moved :
       {points, mapped(points, dmat3(1.0), {1e6, -3e6, 7}), mapped(points, turn, dvec3(0.0)),
        mapped(points, turn, {1e9 + 1, 12345, -77}),
        mapped(points, turn * (1.0 / 1024), {8e5, 0, 1.0 / 4096})}) {
    const PointHull hull = hull_of_points(moved);
    const auto polygons = hull.merged_polygons();
    EXPECT_EQ(polygons.loops.size(), 6U);
    for (const auto& loop : polygons.loops) EXPECT_EQ(loop.size(), 4U);
    EXPECT_EQ(extreme_points(hull).size(), 8U);
    expect_triangulation(hull);
    expect_polygons(hull);
  }
}

TEST(PointHull, GridsWhoseRotationRounds) {
  // Faces are flat to rounding only, the worst mixture of exact and near coplanarity.
  Random random(3);
  for (int k = 0; k < 4; ++k) {
    expect_hull(mapped(point_grid(10), taut_test::random_rotation(random) * 0.1,
                       k % 2 == 0 ? dvec3(0.0) : 1e5 * random_point(random)),
                3);
  }
}

TEST(PointHull, ThousandsOnACircle) {
  const std::vector<dvec2> circle = cocircular();
  ASSERT_EQ(circle.size(), 900U);
  std::vector<dvec3> prism;
  for (const double z : {0.0, 1e4, 5e3}) {
    for (const dvec2& p : circle) prism.emplace_back(p, z);
  }
  const PointHull hull = hull_of_points(prism);
  const auto polygons = hull.merged_polygons();
  EXPECT_EQ(polygons.loops.size(), circle.size() + 2);
  EXPECT_EQ(extreme_points(hull).size(), 2 * circle.size());
  expect_hull(prism, 7);
  // In a tilted plane, with one point on either side.
  std::vector<dvec3> pyramid;
  for (const dvec2& p : circle) pyramid.push_back(integer_rotation(1, 2, 0, 1) * dvec3(p, 0));
  pyramid.push_back(integer_rotation(1, 2, 0, 1) * dvec3(0, 0, 3));
  EXPECT_EQ(hull_of_points(pyramid).merged_polygons().loops.size(), circle.size() + 1);
  expect_hull(pyramid);
}

TEST(PointHull, IntegerPointsOnASphere) {
  std::vector<dvec3> points;
  for (int x = -75; x <= 75; ++x) {
    for (int y = -75; y <= 75; ++y) {
      const double z = std::sqrt(double(5525 - x * x - y * y));
      if (z != std::floor(z)) continue;
      points.emplace_back(x, y, z);
      points.emplace_back(x, y, -z);
    }
  }
  ASSERT_GT(points.size(), 500U);
  expect_hull(points, 3);
}

TEST(PointHull, Duplicates) {
  Random random(4);
  std::vector<dvec3> once;
  for (int k = 0; k < 100; ++k) once.push_back(random_point(random));
  std::vector<dvec3> many;
  for (int k = 0; k < 5; ++k) many.insert(many.end(), once.begin(), once.end());
  std::shuffle(many.begin(), many.end(), random);
  expect_hull(many);
  EXPECT_EQ(extreme_points(hull_of_points(many)), extreme_points(hull_of_points(once)));
  // Zeros of either sign are one point.
  std::vector<dvec3> zeros = {{0.0, 0, 0}, {-0.0, 0, 0}, {1, 0, 0}, {0, 1, -0.0}, {0, 0, 1}};
  EXPECT_EQ(hull_of_points(zeros).merged_polygons().loops.size(), 4U);
}

TEST(PointHull, ManyPointsOnEdgesAndFaces) {
  Random random(5);
  std::vector<dvec3> points = {{0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {0, 0, 8},
                               {8, 8, 0}, {8, 0, 8}, {0, 8, 8}, {8, 8, 8}};
  for (int k = 0; k < 600; ++k) {
    dvec3 p{pick(random, 0, 1024) / 128.0, pick(random, 0, 1024) / 128.0,
            pick(random, 0, 1024) / 128.0};
    p[pick(random, 0, 2)] = 8.0 * pick(random, 0, 1);
    if (k % 2 == 0) p[pick(random, 0, 2)] = 8.0 * pick(random, 0, 1);
    points.push_back(p);
  }
  for (int k = 0; k < 5; ++k) {
    std::shuffle(points.begin(), points.end(), random);
    expect_hull(points, 3);
    EXPECT_EQ(hull_of_points(points).merged_polygons().loops.size(), 6U);
    EXPECT_EQ(extreme_points(hull_of_points(points)).size(), 8U);
  }
}

TEST(PointHull, NearlyCollinearFarFromTheOrigin) {
  // Points about a line at 8e5, moved by units in the last place.
  Random random(6);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const dvec3 direction = taut_test::random_direction(random);
    std::vector<dvec3> points;
    for (int k = 0; k < 60; ++k) {
      const double t = repeat % 2 == 0 ? k : taut_test::uniform(random, 0, 1);
      dvec3 p = dvec3(8e5, -8e5, 8e5) + t * direction;
      for (int i = 0; i < 3; ++i) {
        for (int steps = pick(random, -2, 2); steps != 0; steps += steps < 0 ? 1 : -1) {
          p[i] = std::nextafter(p[i], steps < 0 ? -1e9 : 1e9);
        }
      }
      points.push_back(p);
    }
    expect_hull(points);
  }
}

TEST(PointHull, PointsOneUlpApart) {
  Random random(7);
  const double ulp = std::ldexp(1.0, -52);
  for (int repeat = 0; repeat < 50; ++repeat) {
    const int size = pick(random, 1, 3);
    std::vector<dvec3> points;
    for (int k = 0; k < 40; ++k) {
      points.push_back(dvec3(1) + ulp * dvec3{pick(random, 0, size), pick(random, 0, size),
                                              pick(random, 0, size)});
    }
    if (hull_of_points(points).dimension() == 3) expect_hull(points);
    // Such clusters at the corners of a cube.
    for (std::size_t k = 0; k < points.size(); ++k) {
      points[k] *= dvec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    }
    expect_hull(points);
  }
}

TEST(PointHull, NearlyFlat) {
  Random random(8);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const double thickness = log_uniform(random, 1e-17, 1e-3);
    const dmat3 turn = repeat % 2 == 0 ? dmat3(1.0) : taut_test::random_rotation(random);
    std::vector<dvec3> points;
    for (int k = 0; k < 200; ++k) {
      points.push_back(turn * (random_point(random) * dvec3(1, 1, thickness)));
    }
    expect_hull(points);
  }
}

TEST(PointHull, SizesAndMixturesOfSizes) {
  Random random(9);
  for (const double size : {1e-300, 1e-160, 1e-100, 1e-6, 1e6, 1e100, 1e150, 1e200, 1e300}) {
    std::vector<dvec3> points;
    for (int k = 0; k < 60; ++k) points.push_back(size * random_point(random));
    SCOPED_TRACE("size 1e" + std::to_string(std::lround(std::log10(size))));
    expect_hull(points);
  }
  for (int repeat = 0; repeat < 20; ++repeat) {
    const double range = repeat < 10 ? 1e50 : 1e140;
    std::vector<dvec3> points;
    for (int k = 0; k < 60; ++k) {
      dvec3 p = random_point(random);
      for (int i = 0; i < 3; ++i) p[i] *= log_uniform(random, 1 / range, range);
      points.push_back(p);
    }
    SCOPED_TRACE("range " + std::to_string(repeat));
    expect_hull(points);
  }
}

TEST(PointHull, SubnormalGrid) {
  std::vector<dvec3> points = point_grid(4);
  for (dvec3& p : points) p *= 5e-324;
  expect_hull(points);
  EXPECT_EQ(hull_of_points(points).merged_polygons().loops.size(), 6U);
}

TEST(PointHull, OrderDoesNotMatter) {
  Random random(10);
  std::vector<dvec3> points;
  for (int k = 0; k < 300; ++k) {
    points.emplace_back(pick(random, 0, 9), pick(random, 0, 9), pick(random, 0, 9));
  }
  const auto expected = extreme_points(hull_of_points(points));
  for (int k = 0; k < 10; ++k) {
    std::shuffle(points.begin(), points.end(), random);
    EXPECT_EQ(extreme_points(hull_of_points(points)), expected);
  }
}

TEST(PointHull, TheBoxDecidesSpeedOnly) {
  Random random(11);
  std::vector<dvec3> points;
  for (int k = 0; k < 200; ++k) points.push_back(random_point(random));
  PointHull narrow({dvec3(0.5), dvec3(0.5)});
  narrow.add(points);
  expect_triangulation(narrow);
  EXPECT_EQ(extreme_points(narrow), extreme_points(hull_of_points(points)));
}

TEST(PointHull, AddInPortions) {
  Random random(12);
  for (int repeat = 0; repeat < 10; ++repeat) {
    std::vector<dvec3> points;
    for (int k = 0; k < 200; ++k) {
      points.push_back(repeat % 2 == 0
                           ? random_point(random)
                           : dvec3{pick(random, 0, 5), pick(random, 0, 5), pick(random, 0, 5)});
    }
    PointHull hull(box_of(points));
    const std::span<const dvec3> all(points);
    for (std::size_t k = 0; k < points.size();) {
      const auto n = std::min(points.size() - k, std::size_t(pick(random, 1, 30)));
      hull.add(all.subspan(k, n));
      k += n;
    }
    expect_triangulation(hull);
    expect_polygons(hull);
    EXPECT_EQ(extreme_points(hull), extreme_points(hull_of_points(points)));
  }
}

/// A facet that the point is strictly above, or -1.
int facet_below(const PointHull& hull, const dvec3& p) {
  for (std::size_t f = 0; f < hull.facets().size(); ++f) {
    const PointHull::Facet& facet = hull.facets()[f];
    if (facet.alive && orientation(hull.point(facet.vertex[0]), hull.point(facet.vertex[1]),
                                   hull.point(facet.vertex[2]), p) == Sign::positive) {
      return int(f);
    }
  }
  return -1;
}

TEST(PointHull, InsertOneByOneEqualsAdd) {
  Random random(13);
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::vector<dvec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int k = 0; k < 150; ++k) {
      switch (repeat % 4) {
        case 0:
          points.push_back(random_point(random));
          break;
        case 1:
          points.push_back(taut_test::random_direction(random));
          break;
        case 2:
          points.emplace_back(pick(random, -3, 3), pick(random, -3, 3), pick(random, -3, 3));
          break;
        default:
          points.push_back(random_point(random) * dvec3(1, 1e-8, 1e-16));
      }
    }
    PointHull hull(box_of(points));
    hull.add(std::span(points).first(4));
    for (std::size_t k = 4; k < points.size(); ++k) {
      const int f = facet_below(hull, points[k]);
      if (f < 0) {
        const int before = hull.facet_count();
        const std::size_t known = hull.points().size();
        for (std::size_t g = 0; g < hull.facets().size(); ++g) {
          if (hull.facets()[g].alive) {
            EXPECT_FALSE(hull.insert(points[k], int(g)));
          }
        }
        EXPECT_EQ(hull.facet_count(), before);
        EXPECT_EQ(hull.points().size(), known);
        continue;
      }
      const int before = hull.facet_count();
      ASSERT_TRUE(hull.insert(points[k], f));
      EXPECT_EQ(hull.facet_count(),
                before + int(hull.created().size()) - int(hull.replaced().size()));
      EXPECT_NE(std::find(hull.replaced().begin(), hull.replaced().end(), f),
                hull.replaced().end());
      const int apex = int(hull.points().size()) - 1;
      for (const int g : hull.created()) {
        EXPECT_TRUE(hull.facet(g).alive);
        const auto& v = hull.facet(g).vertex;
        EXPECT_NE(std::find(v.begin(), v.end(), apex), v.end());
      }
    }
    expect_triangulation(hull);
    expect_polygons(hull);
    EXPECT_EQ(extreme_points(hull), extreme_points(hull_of_points(points)));
  }
}

TEST(PointHull, InsertAndAddMixed) {
  Random random(14);
  std::vector<dvec3> points;
  PointHull hull({dvec3(-2), dvec3(2)});
  for (int k = 0; k < 20; ++k) {
    std::vector<dvec3> some;
    for (int j = 0; j < 10; ++j) some.push_back(random_point(random));
    hull.add(some);
    points.insert(points.end(), some.begin(), some.end());
    const dvec3 p = 1.5 * taut_test::random_direction(random);
    points.push_back(p);
    const int f = facet_below(hull, p);
    if (f >= 0) {
      ASSERT_TRUE(hull.insert(p, f));
    }
  }
  expect_triangulation(hull);
  EXPECT_EQ(extreme_points(hull), extreme_points(hull_of_points(points)));
}

}  // namespace
}  // namespace taut
