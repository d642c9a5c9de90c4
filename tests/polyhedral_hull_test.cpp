#include "taut/hull/polyhedral/polyhedral_hull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "hull_checks.h"
#include "taut/core/error.h"
#include "taut/core/tolerances.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/sample/sampled_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and checks

using Points = std::vector<dvec3>;

Model model_of(const Points& points) {
  Part part;
  part.add_points(points);
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  return model;
}

Hull exact_hull_of(const Points& points) { return polyhedral_hull(model_of(points)); }

/// Side n, along the axes, n^3 points.
Points grid(int n) {
  Points points;
  for (int k = 0; k < n * n * n; ++k) points.emplace_back(k % n, k / n % n, k / n / n);
  return points;
}

Points mapped_points(Points points, const dmat3& turn, const dvec3& shift = dvec3(0.0)) {
  for (dvec3& p : points) p = turn * p + shift;
  return points;
}

/// Exactly convex and closed, corners are points of the input, and none of these reaches out
/// farther than the bound (in long double, whose own rounding is allowed for).
void expect_hull_of(const Points& points, const Hull& hull) {
  const PolygonMesh mesh = polygons(hull.mesh);
  ASSERT_EQ(hull.kind, HullKind::solid);
  EXPECT_TRUE(mesh_facts(mesh).is_convex_polytope());
  std::set<std::array<double, 3>> known;
  for (const dvec3& p : points) known.insert({p.x, p.y, p.z});
  for (const dvec3& p : mesh.points) EXPECT_TRUE(known.contains({p.x, p.y, p.z}));
  real highest = 0;
  for (const auto& polygon : mesh.polygons) {
    const rvec3 a(mesh.points[std::size_t(polygon[0])]);
    rvec3 normal{};
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      normal += glm::cross(rvec3(mesh.points[std::size_t(polygon[k])]) - a,
                           rvec3(mesh.points[std::size_t(polygon[k + 1])]) - a);
    }
    normal = glm::normalize(normal);
    for (const dvec3& p : points) highest = std::max(highest, glm::dot(rvec3(p) - a, normal));
  }
  Box box;
  for (const dvec3& p : points) box.include(p);
  EXPECT_LE(highest, hull.distance_bound + 1e-17 * diagonal(box));
}

/// No point reaches out of the mesh by more than the bound, as seen in these directions.
void expect_within_bound(const Points& points, const Hull& hull, const Points& directions) {
  const PolygonMesh mesh = polygons(hull.mesh);
  Box box;
  for (const dvec3& p : points) box.include(p);
  const dvec3 origin = points.front();
  for (const dvec3& n : directions) {
    real highest = -std::numeric_limits<real>::infinity();
    for (const dvec3& p : points) {
      highest = std::max(highest, glm::dot(rvec3(p) - rvec3(origin), rvec3(n)));
    }
    EXPECT_LE(highest - mesh_support(mesh, n, origin),
              real(hull.distance_bound) + 1e-17L * diagonal(box));
  }
}

TEST(PolyhedralHull, CubeIsExact) {
  const Points cube = grid(2);
  const Hull hull = exact_hull_of(cube);
  expect_hull_of(cube, hull);
  EXPECT_EQ(hull.distance_bound, 0);
  EXPECT_EQ(hull.mesh.n_vertices(), 8U);
  EXPECT_EQ(hull.mesh.n_faces(), 6U);
}

TEST(PolyhedralHull, GridsAreCubesAnyWay) {
  for (const int n : {20, 50}) {
    for (const dvec3& shift : {dvec3(0.0), dvec3(100.3, -0.7, 1234.5)}) {
      for (const dmat3& turn : {dmat3(1.0), skew_rotation(), 0.1 * skew_rotation()}) {
        const Points points = mapped_points(grid(n), turn, shift);
        const Hull hull = exact_hull_of(points);
        expect_hull_of(points, hull);
        EXPECT_EQ(hull.mesh.n_vertices(), 8U);
        EXPECT_TRUE(hull.mesh.n_faces() == 6 || hull.mesh.n_faces() == 12);
        std::set<int> faces;
        for (const auto f : hull.mesh.faces()) faces.insert(hull.mesh.data(f).hull_face);
        EXPECT_EQ(faces.size(), 6U);
        EXPECT_LE(hull.distance_bound, 1e-11);
      }
    }
  }
}

TEST(PolyhedralHull, TypedResults) {
  EXPECT_EQ(convex_hull(Model()).kind, HullKind::empty);
  EXPECT_EQ(polyhedral_hull(Model()).mesh.n_vertices(), 0U);
  for (const dvec3& at : {dvec3(0.0), dvec3(1, 2, 3), dvec3(1e300, -1e300, 1e-300)}) {
    const Hull point = exact_hull_of(Points(7, at));
    EXPECT_EQ(point.kind, HullKind::point);
    ASSERT_EQ(point.mesh.n_vertices(), 1U);
    EXPECT_EQ(position(point.mesh, OpenMesh::VertexHandle(0)), at);
    EXPECT_EQ(point.distance_bound, 0);
  }
  const Points line = {{1, 1, 1}, {3, 3, 3}, {2, 2, 2}, {1, 1, 1}, {-4, -4, -4}};
  const Hull segment = exact_hull_of(line);
  EXPECT_EQ(segment.kind, HullKind::segment);
  EXPECT_EQ(segment.mesh.n_vertices(), 2U);
  EXPECT_EQ(segment.mesh.n_edges(), 1U);
  EXPECT_EQ(segment.distance_bound, 0);
  // A grid in a plane, askew but exact: only its four corners are left.
  Points plane;
  for (int i = 0; i < 100; ++i) plane.emplace_back(i % 10, i / 10, 2 * (i % 10) - 3 * (i / 10));
  const Hull planar = exact_hull_of(plane);
  EXPECT_EQ(planar.kind, HullKind::planar);
  EXPECT_EQ(planar.mesh.n_vertices(), 4U);
  EXPECT_EQ(planar.mesh.n_faces(), 2U);
  EXPECT_EQ(planar.distance_bound, 0);
  EXPECT_EQ(mesh_facts(polygons(planar.mesh)).euler, 2);
}

TEST(PolyhedralHull, RoundedPlanesAndLinesAreFlat) {
  Points plane, line;
  for (int i = 0; i < 400; ++i) {
    plane.emplace_back(i % 20, i / 20, 0);
    line.emplace_back(i, 0, 0);
  }
  for (const dvec3& shift : {dvec3(0.0), dvec3(10, -200, 3000)}) {
    const Hull planar = exact_hull_of(mapped_points(plane, skew_rotation(), shift));
    EXPECT_EQ(planar.kind, HullKind::planar);
    EXPECT_EQ(planar.mesh.n_vertices(), 4U);
    EXPECT_LE(planar.distance_bound, 2e-11);
    EXPECT_EQ(exact_hull_of(mapped_points(line, skew_rotation(), shift)).kind, HullKind::segment);
  }
}

/// All that is extreme of the solid counts, also where two corners are one in the plane.
TEST(PolyhedralHull, PointsLeftOutOfFlatSolidsAreCounted) {
  const double thick = 1e-15;
  const Points rectangle = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}};
  Points plate = rectangle;
  for (const dvec3& p : rectangle) plate.push_back(p + dvec3(0, 0, thick));
  EXPECT_EQ(exact_hull_of(plate).points_left_out, 4);
  Points tent = rectangle;
  tent.emplace_back(1, 1, thick);
  const Hull hull = exact_hull_of(tent);
  EXPECT_EQ(hull.kind, HullKind::planar);
  EXPECT_EQ(hull.points_left_out, 1);
  const Hull line = exact_hull_of({{0, 0, 0}, {4, 0, 0}, {1, thick, 0}, {1, 0, thick}});
  EXPECT_EQ(line.kind, HullKind::segment);
  EXPECT_EQ(line.points_left_out, 2);
}

TEST(PolyhedralHull, BoundsCountBothSidesOfAPlane) {
  // One corner of a planar outline lies as deep below the plane as another point, behind it along
  // an axis, lies above.
  const dvec3 n = unit(dvec3(1, 1, 1));
  const dvec3 a = unit(dvec3(1, -1, 0));
  const dvec3 b = glm::cross(n, a);
  Random random(1);
  Points directions;
  for (int k = 0; k < 60; ++k)
    directions.push_back(std::sin(0.05 * k) * n - std::cos(0.05 * k) * b);
  int planar = 0;
  for (int k = 0; k < 200; ++k) {
    const double depth = 34 * uniform(random, 0.8, 1.2) * rounding_unit;
    Points points = {-a, a, 0.9 * b, -0.3 * b - depth * n};
    points.push_back(points.back());
    points.back()[k % 3] += 3.2 * depth;
    const Hull hull = exact_hull_of(points);
    planar += hull.kind == HullKind::planar ? 1 : 0;
    expect_within_bound(points, hull, directions);
  }
  EXPECT_GT(planar, 20);
}

TEST(PolyhedralHull, BoundsOfSharpCones) {
  // Of facets so narrow, normals are rounded beyond use.
  Random random(2);
  for (int k = 0; k < 1000; ++k) {
    const double slope = log_uniform(random, 1e-16, 1e-3);
    Points points = {dvec3(0.0)};
    for (int i = pick(random, 4, 40); i > 0; --i) {
      const double x = uniform(random, 0, 1);
      const double t = uniform(random, 0, 7);
      points.emplace_back(x, slope * x * std::cos(t), slope * x * std::sin(t));
    }
    const dmat3 turn = random_rotation(random);
    Points directions;
    for (int i = 0; i < 60; ++i) {
      directions.push_back(turn * dvec3(0, std::cos(0.1 * i), std::sin(0.1 * i)));
    }
    points = mapped_points(points, turn);
    expect_within_bound(points, exact_hull_of(points), directions);
  }
}

TEST(PolyhedralHull, BoundCoversWhatPlacingCancels) {
  Part part;
  part.add_points(mapped_points(grid(2), dmat3(0.1), dvec3(1e9)));
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  model.clear_instances();
  const RigidMotion pose = {skew_rotation(), -(skew_rotation() * dvec3(1e9))};
  model.add_instance(0, pose);
  const Hull hull = polyhedral_hull(model);
  real farthest = 0;
  for (const auto v : hull.mesh.vertices()) {
    const rvec3 x = source_point(model, hull.mesh.data(v).source, 0, 0);
    farthest = std::max(farthest, glm::length(x - rvec3(position(hull.mesh, v))));
  }
  EXPECT_GT(farthest, 1e-9);
  EXPECT_LE(farthest, hull.distance_bound);
}

TEST(PolyhedralHull, MixedSizesAreExact) {
  // A pyramid whose base is folded along a diagonal by next to nothing.
  for (const double size : {1e70, 1e300}) {
    for (const double fold : {1e-250, 1e-320}) {
      const Points points = {
          {0, 0, 0}, {size, 0, fold}, {size, size, 0}, {0, size, fold}, {0, 0, size}};
      const Hull hull = exact_hull_of(points);
      EXPECT_TRUE(mesh_facts(polygons(hull.mesh)).is_convex_polytope());
      EXPECT_EQ(hull.mesh.n_vertices(), 5U);
      EXPECT_EQ(hull.mesh.n_faces(), 6U);
      EXPECT_EQ(hull.distance_bound, 0);
      for (const auto v : hull.mesh.vertices()) {
        const auto& n = hull.mesh.normal(v);
        EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-6);
      }
    }
  }
}

TEST(PolyhedralHull, PointsOneUlpApartAreAHull) {
  const double ulp = std::numeric_limits<double>::epsilon();
  for (const double at : {1.0, 8e5, 1e15}) {
    Points points;
    for (const dvec3& p : grid(5)) points.push_back(at * (dvec3(1.0) + 2 * ulp * p));
    const Hull hull = exact_hull_of(points);
    expect_hull_of(points, hull);
    EXPECT_EQ(hull.mesh.n_vertices(), 8U);
    EXPECT_EQ(hull.distance_bound, 0);
  }
}

TEST(PolyhedralHull, AnySizeAndPlace) {
  Random random(3);
  Points ball;
  for (int i = 0; i < 500; ++i) ball.push_back(random_point(random));
  const std::size_t vertices = exact_hull_of(ball).mesh.n_vertices();
  for (const double size : {1e-300, 1e-150, 1e-6, 1e6, 1e150, 1e300}) {
    Points points = ball;
    for (dvec3& p : points) p *= size;
    const Hull hull = exact_hull_of(points);
    EXPECT_EQ(hull.mesh.n_vertices(), vertices) << size;
    EXPECT_TRUE(mesh_facts(polygons(hull.mesh)).is_convex_polytope()) << size;
  }
  for (const double far : {1e8, 1e15}) {
    Points points = ball;
    for (dvec3& p : points) p = 10. * p + far;
    expect_hull_of(points, exact_hull_of(points));
  }
  const Points needle = mapped_points(grid(2), dmat3(1e6, 0, 0, 0, 1, 0, 0, 0, 1));
  expect_hull_of(needle, exact_hull_of(needle));
  expect_hull_of(mapped_points(needle, skew_rotation()),
                 exact_hull_of(mapped_points(needle, skew_rotation())));
}

TEST(PolyhedralHull, CoplanarAndCocircularPoints) {
  // A drum of two regular 3,000-gons, and a pyramid over points all over a square.
  Points drum, pyramid = {{0.5, 0.5, 1}};
  for (int k = 0; k < 6000; ++k) {
    const double t = 2 * std::numbers::pi * (k / 2) / 3000;
    drum.emplace_back(std::cos(t), std::sin(t), k % 2);
  }
  Random random(8);
  for (int k = 0; k < 5000; ++k)
    pyramid.emplace_back(uniform(random, 0, 1), uniform(random, 0, 1), 0);
  for (const Points& points : {drum, pyramid}) {
    for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
      const Points moved = mapped_points(points, turn);
      const Hull hull = exact_hull_of(moved);
      expect_hull_of(moved, hull);
    }
  }
}

TEST(PolyhedralHull, InstancesDuplicatesAndNestedParts) {
  const Points cube = grid(3);
  Model model = model_of(cube);
  model.add_instance(0, {});
  model.add_instance(0, {dmat3(1.0), {5, 0, 0}});
  Part inner;
  inner.add_points(mapped_points(grid(2), 0.5 * dmat3(1.0), {0.5, 0.5, 0.5}));
  model.add_part(std::move(inner), smooth_join_angle);
  model.add_part(Part(), smooth_join_angle);
  const Hull hull = polyhedral_hull(model);
  EXPECT_EQ(hull.mesh.n_vertices(), 8U);
  EXPECT_EQ(hull.mesh.n_faces(), 6U);
  EXPECT_NEAR(measure(polygons(hull.mesh)).volume, 28, 1e-12);
  // The same by sampling, where support queries find the points.
  const Hull sampled = sampled_hull(Scene(model), {.threads = 1, .progress = {}});
  EXPECT_EQ(sampled.mesh.n_vertices(), 8U);
}

TEST(PolyhedralHull, FacesNameThePolygonsThatLieInThem) {
  PolygonMesh box = {grid(2), {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7}}};
  Part part;
  part.add_polygons(box);
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  EXPECT_EQ(model.face_count(), 4);
  const Hull hull = convex_hull(model);
  std::multiset<int> sources;
  for (const auto f : hull.mesh.faces()) sources.insert(hull.mesh.data(f).source);
  EXPECT_EQ(sources, (std::multiset<int>{-1, -1, 0, 1, 2, 3}));
  for (const auto v : hull.mesh.vertices()) {
    const Source source = model.source(hull.mesh.data(v).source);
    EXPECT_EQ(source.kind, SourceKind::vertex);
    EXPECT_EQ(model.parts()[0].vertices()[std::size_t(source.index)], position(hull.mesh, v));
  }
}

TEST(PolyhedralHull, AllTrianglesOfATurnedFaceNameItsPolygon) {
  PolygonMesh box = {
      mapped_points(grid(2), skew_rotation(), {0.3, 0.1, 0.7}),
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  Part part;
  part.add_polygons(box);
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  const Hull hull = polyhedral_hull(model);
  EXPECT_EQ(hull.mesh.n_faces(), 12U);
  std::set<std::pair<int, int>> sources;
  for (const auto f : hull.mesh.faces()) {
    EXPECT_GE(hull.mesh.data(f).source, 0);
    sources.emplace(hull.mesh.data(f).hull_face, hull.mesh.data(f).source);
  }
  EXPECT_EQ(sources.size(), 6U);
}

TEST(PolyhedralHull, RefusesWrongTolerancesAndCanBeCancelled) {
  const Model model = model_of(grid(2));
  EXPECT_THROW(polyhedral_hull(model, {.tolerance = -1, .progress = {}}), InvalidInput);
  EXPECT_THROW(convex_hull(model, {.relative = 0, .progress = {}}), InvalidInput);
  std::stop_source stop;
  stop.request_stop();
  HullOptions options;
  options.progress.stop = stop.get_token();
  EXPECT_THROW(polyhedral_hull(model, options), Cancelled);
}

}  // namespace
}  // namespace taut
