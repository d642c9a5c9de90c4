#include "taut/hull/sample/sampled_hull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "hull_checks.h"
#include "taut/core/error.h"
#include "taut/core/tolerances.h"
#include "taut/hull/convex_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and checks

void expect_coarse_and_fine(const Shape& shape, const Known& known, const std::string& name) {
  const Scene scene = make_scene(shape);
  for (const double tolerance : {1e-2, 1e-3}) expect_sampled(scene, tolerance, known, name);
}

/// As it stands, and turned so that nothing is axis-parallel.
void expect_any_way(const Shape& shape, const Known& known, const std::string& name) {
  expect_coarse_and_fine(shape, known, name);
  expect_coarse_and_fine(mapped(shape, skew_rotation(), {0.1, -0.2, 0.3}), known,
                         name + ", turned");
}

TEST(SampledHull, BoxIsExact) {
  const Scene scene = make_scene(box(1, 2, 3));
  const Hull hull = expect_sampled(scene, 1e-3, {6, 22}, "box");
  EXPECT_EQ(hull.mesh.n_vertices(), 8U);
  EXPECT_EQ(hull.mesh.n_faces(), 6U);
  EXPECT_EQ(hull.mesh.n_edges(), 12U);
  EXPECT_LT(hull.distance_bound, 1e-11);
  for (const auto f : hull.mesh.faces()) EXPECT_EQ(hull.mesh.data(f).kind, FaceKind::facet);
  for (const auto e : hull.mesh.edges()) EXPECT_TRUE(hull.mesh.data(e).feature);
  expect_any_way(box(1, 2, 3), {6, 22}, "box");
}

TEST(SampledHull, Sphere) { expect_any_way(sphere(), {4 * pi / 3, 4 * pi}, "sphere"); }

TEST(SampledHull, Ellipsoid) {
  expect_any_way(ellipsoid(3, 2, 1), {25.13274122871835, 48.88214630258206}, "ellipsoid");
}

TEST(SampledHull, Torus) {
  expect_any_way(torus(2, 0.5), {18.02477159050215, 48.01354268448686}, "torus");
}

TEST(SampledHull, Cylinder) {
  expect_any_way(cylinder(1, 2), {6.283185307179586, 18.84955592153876}, "cylinder");
}

TEST(SampledHull, ConeAndFrustum) {
  expect_any_way(cone(1, 2), {2.094395102393195, 10.16640738463052}, "cone");
  expect_any_way(frustum(1, 0.5, 2), {3.665191429188092, 13.64182957454863}, "frustum");
}

TEST(SampledHull, TwoSpheres) {
  expect_any_way(two_spheres(1, 0.5, 2), {6.250460383704693, 17.86780821729195}, "two spheres");
  expect_coarse_and_fine(two_spheres(2, 1, 4), {50.00368306963754, 71.4712328691678}, "unequal");
  expect_coarse_and_fine(two_spheres(1, 0.3, 0.5), {4 * pi / 3, 4 * pi}, "one inside the other");
  expect_coarse_and_fine(sphere() + sphere(), {4 * pi / 3, 4 * pi}, "twice the same");
}

TEST(SampledHull, Circles) {
  expect_any_way(oloid(), {3.052418468424375, 4 * pi}, "oloid");
  expect_any_way(perpendicular_circles(), {8.0 / 3, 4 + 2 * pi}, "perpendicular circles");
}

TEST(SampledHull, TwistedCubic) {
  expect_any_way({{}, {twisted_cubic()}, {}}, {1.0 / 180, -1}, "twisted cubic");
}

TEST(SampledHull, OpenPatches) {
  expect_any_way(paraboloid(), {16.0 / 3, 16.7795900563457}, "paraboloid");
  expect_any_way(saddle(), {16.0 / 3, 17.16487619369011}, "saddle");
  expect_any_way(bilinear_saddle(), {8.0 / 3, 8 * std::sqrt(3.0)}, "bilinear saddle");
  expect_any_way(spherical_cap(0.6), {0.9047786842338605, 6.408849013323178}, "cap");
}

TEST(SampledHull, FilletedBox) {
  const double r = 0.2;
  const double a = 1 - 2 * r;
  const double b = 2 - 2 * r;
  const double c = 3 - 2 * r;
  const Known known = {a * b * c + 2 * (a * b + b * c + c * a) * r + pi * (a + b + c) * r * r +
                           4 * pi / 3 * r * r * r,
                       2 * (a * b + b * c + c * a) + 2 * pi * (a + b + c) * r + 4 * pi * r * r};
  expect_any_way(filleted_box(1, 2, 3, r), known, "filleted box");
}

TEST(SampledHull, Dented) { expect_any_way(dented(), {}, "dented"); }

TEST(SampledHull, Teapot) { expect_any_way(teapot(), {32.67038, 53.66226}, "teapot"); }

TEST(SampledHull, FreePoints) {
  Random random(1);
  Shape shape;
  for (int k = 0; k < 200; ++k) shape.points.push_back(random_point(random));
  const Scene scene = make_scene(shape);
  const Hull hull = expect_sampled(scene, 1e-9, {}, "points");
  EXPECT_LT(hull.distance_bound, 1e-11);
}

TEST(SampledHull, RandomPatches) {
  Random random(2);
  for (int k = 0; k < 14; ++k) {
    Shape shape = of_patch(random_patch(random, 1 + k % 7, pick(random, 2, 5), k % 2 ? 5 : 1));
    expect_sampled(make_scene(shape), 1e-3, {}, "random patch " + std::to_string(k));
  }
}

TEST(SampledHull, Needle) {
  const Known known = {4 * pi / 3 * 1e6, -1};
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    const Scene scene = make_scene(mapped(ellipsoid(1e6, 1, 1), turn));
    for (const double tolerance : {1e-2, 1e-5, 1e-7}) {
      expect_sampled(scene, tolerance, known, "needle");
    }
    expect_sampled(make_scene(mapped(box(1e6, 1, 1), turn)), 1e-3, {1e6, 4e6 + 2}, "thin box");
  }
}

TEST(SampledHull, BoundsCountBothSidesOfAPlane) {
  // Flat to 6e-12: the points of one corner are on either side of the others.
  const double z = 3e-12;
  const dvec3 twice(0.5, 0.5, z);
  const Shape shape = {{}, {}, {{-2, -2, 0}, {2, -2, 0}, {-2, 2, 0}, {0.5, 0.5, -z}, twice}};
  const Hull hull = sampled_hull(make_scene(shape), {.threads = 1, .progress = {}});
  ASSERT_EQ(hull.kind, HullKind::planar);
  double nearest = 10;
  for (const auto v : hull.mesh.vertices()) {
    nearest = std::min(nearest, glm::distance(position(hull.mesh, v), twice));
  }
  const double other = glm::distance(shape.points[3], twice);
  EXPECT_TRUE(nearest == 0 || nearest == other);
  EXPECT_LE(other, hull.distance_bound);
}

TEST(SampledHull, FlatWithinItsResolution) {
  for (const double thickness : {1e-9, 1e-8}) {
    const Scene scene = make_scene(mapped(ellipsoid(1, 2, thickness), skew_rotation()));
    const Hull hull = sampled_hull(scene, {.tolerance = 1e-4, .threads = 1, .progress = {}});
    EXPECT_EQ(hull.kind, HullKind::planar);
    EXPECT_LE(hull.distance_bound, 1e-4);
    const PolygonMesh mesh = polygons(hull.mesh);
    EXPECT_LE(gaps(scene, mesh, 1000).highest, hull.distance_bound);
    EXPECT_NEAR(measure(mesh).area, 4 * pi, 8 * pi * 1e-4);
    EXPECT_NEAR(measure(mesh).volume, 0, 1e-15);
  }
}

/// What is thinner than the resolution is flat, and farther off than the tolerance asks for: said,
/// be it a sheet, one of few vertices, or a needle.
TEST(SampledHull, ThinBodiesFartherOffThanTheTolerance) {
  const auto expect_said = [](const dvec3& axes, HullKind kind, const HullOptions& options) {
    const Scene scene = make_scene(mapped(ellipsoid(axes.x, axes.y, axes.z), skew_rotation()));
    try {
      const double bound = sampled_hull(scene, options).distance_bound;
      FAIL() << "within " << bound << " axes " << axes.x << " " << axes.y;
    } catch (const HullNotConverged& failure) {
      EXPECT_EQ(failure.best->kind, kind);
      EXPECT_GT(failure.best->distance_bound, options.tolerance);
    }
  };
  HullOptions options;
  options.tolerance = 1e-3;
  options.resolution = 0.02;
  options.threads = 1;
  expect_said({1, 2, 0.01}, HullKind::planar, options);
  expect_said({2, 0.01, 0.01}, HullKind::segment, options);
  options.vertex_budget = 50;
  expect_said({1, 2, 0.01}, HullKind::planar, options);
}

TEST(SampledHull, NearlyFlat) {
  for (const double thickness : {1e-3, 1e-5, 1e-6}) {
    for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
      const std::string name = "thickness " + std::to_string(std::log10(thickness));
      expect_sampled(make_scene(mapped(ellipsoid(1, 2, thickness), turn)), 1e-2,
                     {8 * pi / 3 * thickness, -1, 0}, name);
      expect_sampled(make_scene(mapped(box(1, 2, thickness), turn)), 1e-3, {2 * thickness, -1, 0},
                     name);
    }
  }
}

TEST(SampledHull, FarFromTheOrigin) {
  for (const dvec3& far : {dvec3(1e8, -1e8, 1e8), dvec3(0, 3e7, 1e8 / 3)}) {
    const auto at = [&](const Shape& shape) {
      return make_scene(mapped(shape, skew_rotation(), far));
    };
    expect_sampled(at(sphere()), 1e-3, {}, "far sphere");
    expect_sampled(at(box(1, 2, 3)), 1e-3, {}, "far box");
    expect_sampled(at(teapot()), 1e-3, {}, "far teapot");
    expect_sampled(at(oloid()), 1e-5, {}, "far oloid");
  }
}

TEST(SampledHull, PosesFarFromTheOrigin) {
  Model model = make_model(sphere() + box(1, 2, 3));
  model.clear_instances();
  model.add_instance(0, {skew_rotation(), {1e8 + 0.3, -1e8 / 3, 1e8 / 7}});
  const Scene scene(model);
  expect_sampled(scene, 1e-3, {}, "far pose");
}

TEST(SampledHull, BoundIncludesTheRoundingOfVertices) {
  // Vertices near 1e8 are rounded by up to 7.5e-9 a coordinate: no bound below that is honest.
  Model model = make_model(box(1, 2, 3));
  model.clear_instances();
  model.add_instance(0, {dmat3(1.0), {1e8 + 1, 1e8 + 1, 1e8 + 1}});
  const Scene exact(model);
  EXPECT_LT(sampled_hull(exact, {.tolerance = 1e-3, .threads = 1, .progress = {}}).distance_bound,
            1e-7);
  model = make_model(box(1.0 / 3, 2.0 / 3, 3.1));
  model.clear_instances();
  model.add_instance(0, {skew_rotation(), {1e8 + 1, 1e8 + 1, 1e8 + 1}});
  const Scene scene(model);
  const Hull hull = sampled_hull(scene, {.tolerance = 1e-3, .threads = 1, .progress = {}});
  const PolygonMesh mesh = polygons(hull.mesh);
  const ReferenceSupport truth(model, scene.frame().center);
  Random random(3);
  real worst = 0;
  for (int k = 0; k < 1000; ++k) {
    const dvec3 n = random_direction(random);
    const real difference = truth(n).lower - mesh_support(mesh, n, scene.frame().center);
    worst = std::max(worst, std::abs(difference));
  }
  EXPECT_GT(worst, 1e-9);  // or this test shows nothing
  EXPECT_LE(worst, hull.distance_bound);
}

TEST(SampledHull, Sizes) {
  for (const double size : {1e-300, 1e-160, 1e-100, 1e-6, 1e6, 1e100, 1e200, 1e300}) {
    const Scene scene = make_scene(scaled(sphere() + box(1, 1, 1), size));
    expect_sampled(scene, 1e-2, {}, "size 1e" + std::to_string(std::lround(std::log10(size))), 100);
  }
}

TEST(SampledHull, InstancesOfAPart) {
  Random random(4);
  Model model = make_model(teapot());
  for (int k = 0; k < 6; ++k) {
    model.add_instance(0, {random_rotation(random), 6.0 * random_point(random)});
  }
  expect_sampled(Scene(model), 1e-3, {}, "teapots");
}

TEST(SampledHull, VolumeConvergesFromBelow) {
  const Scene scene = make_scene(mapped(two_spheres(1, 0.5, 2), skew_rotation()));
  double previous = std::numeric_limits<double>::infinity();
  for (const double tolerance : {3e-2, 1e-2, 3e-3, 1e-3, 3e-4}) {
    const Hull hull = sampled_hull(
        scene, {.tolerance = tolerance * scene.diagonal(), .threads = 1, .progress = {}});
    const double error = 6.250460383704693 - measure(polygons(hull.mesh)).volume;
    EXPECT_GT(error, 0);
    EXPECT_LT(error, previous);
    EXPECT_LE(error, 17.86780821729195 * hull.distance_bound * 1.01);
    previous = error;
  }
}

void expect_same_bits(const HullMesh& a, const HullMesh& b) {
  ASSERT_EQ(a.n_vertices(), b.n_vertices());
  ASSERT_EQ(a.n_faces(), b.n_faces());
  ASSERT_EQ(a.n_edges(), b.n_edges());
  for (const auto v : a.vertices()) {
    ASSERT_EQ(position(a, v), position(b, v));
    ASSERT_EQ(a.normal(v), b.normal(v));
    const auto& x = a.data(v);
    const auto& y = b.data(v);
    ASSERT_TRUE(x.source == y.source && x.u == y.u && x.v == y.v && x.quality == y.quality);
  }
  for (const auto f : a.faces()) {
    const auto& x = a.data(f);
    const auto& y = b.data(f);
    ASSERT_TRUE(x.kind == y.kind && x.source == y.source && x.hull_face == y.hull_face);
  }
  for (const auto e : a.edges()) ASSERT_EQ(a.data(e).feature, b.data(e).feature);
  EXPECT_EQ(polygons(a).polygons, polygons(b).polygons);
}

TEST(SampledHull, SameBitsForAnyNumberOfThreads) {
  for (const Shape& shape : {teapot(), mapped(torus(2, 0.5), skew_rotation()), oloid()}) {
    const Scene one = make_scene(shape, 1);
    const HullOptions options = {.tolerance = 1e-3 * one.diagonal(), .threads = 1, .progress = {}};
    const Hull expected = sampled_hull(one, options);
    for (const int threads : {2, 4, 0}) {
      const Scene scene = make_scene(shape, threads);
      HullOptions more = options;
      more.threads = threads;
      const Hull hull = sampled_hull(scene, more);
      EXPECT_EQ(hull.distance_bound, expected.distance_bound);
      EXPECT_EQ(hull.statistics.support_queries, expected.statistics.support_queries);
      expect_same_bits(hull.mesh, expected.mesh);
    }
  }
}

TEST(SampledHull, KindsOfFaces) {
  // A capsule: two half spheres, a scroll between them.
  const Scene scene = make_scene(mapped(two_spheres(0.5, 0.5, 3), skew_rotation()));
  const Hull hull = sampled_hull(scene, {.tolerance = 1e-3, .threads = 1, .progress = {}});
  double patch = 0;
  double scroll = 0;
  double facet = 0;
  for (const auto f : hull.mesh.faces()) {
    std::vector<dvec3> p;
    for (const auto v : hull.mesh.fv_range(f)) p.push_back(position(hull.mesh, v));
    double area = 0;
    for (std::size_t k = 1; k + 1 < p.size(); ++k) {
      area += 0.5 * glm::length(glm::cross(p[k] - p[0], p[k + 1] - p[0]));
    }
    const FaceKind kind = hull.mesh.data(f).kind;
    (kind == FaceKind::patch ? patch : kind == FaceKind::scroll ? scroll : facet) += area;
  }
  EXPECT_NEAR(patch, pi, 0.1);
  EXPECT_NEAR(scroll, 3 * pi, 0.2);
  EXPECT_LT(facet, 0.05);
}

/// The kind at any place and in any position, and a certificate that holds.
void expect_kind(HullKind kind, const Shape& shape, const std::string& name) {
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    for (const dvec3& shift : {dvec3(0.0), dvec3(0.1, 0.7, -3), dvec3(1e4, 1e4, 3)}) {
      SCOPED_TRACE(name + ", moved by " + std::to_string(shift.z));
      const Scene scene = make_scene(mapped(shape, turn, shift));
      const Hull hull = sampled_hull(scene, {.relative = 1e-4, .threads = 1, .progress = {}});
      EXPECT_EQ(hull.kind, kind);
      EXPECT_LE(hull.distance_bound, 1e-4 * scene.diagonal() + 1e-11);
      if (kind == HullKind::planar) {
        const MeshFacts facts = mesh_facts(polygons(hull.mesh));
        EXPECT_TRUE(facts.closed_manifold);
        EXPECT_EQ(facts.euler, 2);
        EXPECT_EQ(hull.mesh.n_faces(), 2U);
      } else {
        EXPECT_EQ(hull.mesh.n_vertices(), kind == HullKind::segment ? 2U : 1U);
        EXPECT_EQ(hull.mesh.n_edges(), kind == HullKind::segment ? 1U : 0U);
      }
      EXPECT_LE(gaps(scene, polygons(hull.mesh), 1000).highest, hull.distance_bound);
    }
  }
}

TEST(SampledHull, FlatModelsHaveTheirKind) {
  const dmat3 onto_plane(1, 0, 0, 0, 1, 0, 0, 0, 0);
  const dmat3 onto_line(1, 0, 0, 0, 0, 0, 0, 0, 0);
  const NurbsCurve unit_circle = circle(dvec3(0.0), {1, 0, 0}, {0, 1, 0});
  expect_kind(HullKind::point, {{}, {}, {{1, 2, 3}}}, "point");
  expect_kind(HullKind::point, {{}, {}, {{1, 2, 3}, {1, 2, 3}}}, "point twice");
  expect_kind(HullKind::segment, {{}, {}, {{1, 2, 3}, {4, 1, 0}}}, "two points");
  expect_kind(HullKind::planar, {{}, {}, {{1, 2, 3}, {4, 1, 0}, {1, 0, 2}}}, "three points");
  expect_kind(HullKind::segment, {{}, {segment({1, 2, 3}, {4, 1, 0})}, {}}, "segment");
  expect_kind(HullKind::planar, {{}, {unit_circle}, {}}, "circle");
  expect_kind(HullKind::planar, {{}, {circle(dvec3(0.0), {1, 0, 0}, {0, 1e-3, 0})}, {}}, "ellipse");
  expect_kind(HullKind::planar, {{}, {unit_circle}, {{4, 1, 0}, {0.5, 0, 0}}}, "circle and points");
  Shape face = box(1, 2, 3);
  face.surfaces.resize(1);
  expect_kind(HullKind::planar, face, "one flat face");
  Random random(5);
  const Shape patch = of_patch(random_patch(random, 3, 4, 2));
  expect_kind(HullKind::planar, mapped(patch, onto_plane), "flat patch");
  expect_kind(HullKind::segment, mapped(patch, onto_line), "patch on a line");
  expect_kind(HullKind::point, mapped(patch, dmat3(0.0)), "patch in a point");
}

/// Compared with places on a grid.
/// The one that is found, be it within the tolerance or not.
Hull best_hull(const Scene& scene) {
  try {
    return convex_hull(scene);
  } catch (const taut::HullNotConverged& failure) {
    return *failure.best;
  }
}

TEST(SampledHull, PlanesThatFoldBeyondTheirBorders) {
  const double x[3][3] = {{0, 0, 0}, {0.5, 3, 0.5}, {1, 1, 1}};
  taut::BezierPatch folded{2, 2, {}};
  for (const auto& row : x) {
    for (int j = 0; j < 3; ++j) folded.points.emplace_back(row[j], 0.5 * j, 0, 1);
  }
  std::vector<dvec3> places;
  for (int k = 0; k < 201 * 201; ++k) {
    places.push_back(point(folded, k / 201 / 200.0, k % 201 / 200.0));
  }
  for (const bool solid : {false, true}) {
    Shape shape = of_patch(folded);
    if (solid) shape.points.push_back({0.5, 0.5, 1});
    const Hull hull = best_hull(make_scene(shape));
    std::vector<dvec3> vertices;
    for (const auto v : hull.mesh.vertices()) vertices.push_back(taut::position(hull.mesh, v));
    const auto support = [](const std::vector<dvec3>& points, const dvec3& n) {
      double h = -taut::infinity;
      for (const dvec3& p : points) h = std::max(h, glm::dot(p, n));
      return h;
    };
    for (int k = 0; k < 128; ++k) {
      const dvec3 n(std::cos(k * pi / 64), std::sin(k * pi / 64), 0);
      EXPECT_GE(support(vertices, n), support(places, n) - hull.distance_bound) << k;
    }
  }
}

TEST(SampledHull, OutlineOfACircleConverges) {
  const Scene scene = make_scene(
      mapped(Shape{{}, {circle(dvec3(0.0), {1, 0, 0}, {0, 1, 0})}, {}}, skew_rotation()));
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8}) {
    const Hull hull = sampled_hull(scene, {.tolerance = tolerance, .threads = 1, .progress = {}});
    EXPECT_LE(hull.distance_bound, tolerance);
    // Both sides; the sagitta of a chord of n is 1 - cos(pi / n).
    EXPECT_NEAR(measure(polygons(hull.mesh)).area, 2 * pi, 4 * pi * tolerance);
    EXPECT_LE(double(hull.mesh.n_vertices()), 2.5 * pi / std::sqrt(2 * tolerance));
  }
}

/// Facets of thin bodies are nearly opposite about their rims.
TEST(SampledHull, ThinBodiesAreAsNearAsAsked) {
  for (const double thin : {1e-9, 1e-7, 1e-5, 1e-3}) {
    SCOPED_TRACE(thin);
    for (const Shape& shape :
         {ellipsoid(1, 1, thin), ellipsoid(1, 10 * thin, 10 * thin), solid_cylinder(1, thin),
          box(1, 0.75, thin), filleted_box(1, 0.75, thin, 0.3 * thin)}) {
      const Scene scene = make_scene(mapped(shape, skew_rotation()));
      const Hull hull =
          sampled_hull(scene, {.tolerance = 1e-4, .resolution = 0., .threads = 1, .progress = {}});
      EXPECT_EQ(hull.kind, HullKind::solid);
      EXPECT_LE(hull.distance_bound, 1e-4);
      EXPECT_LE(gaps(scene, polygons(hull.mesh), 1000).highest, hull.distance_bound);
      EXPECT_LE(hull.mesh.n_vertices(), 1000U);
    }
  }
}

TEST(SampledHull, RefusesTolerancesThatAreNone) {
  const Scene scene = make_scene(sphere());
  for (const double tolerance : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(sampled_hull(scene, {.tolerance = tolerance, .threads = 1, .progress = {}}),
                 InvalidInput);
  }
}

TEST(SampledHull, AnyLargeToleranceGivesAPolytope) {
  for (const double tolerance : {1.0, 1e3, 1e300, std::numeric_limits<double>::infinity()}) {
    const Scene scene = make_scene(sphere());
    const Hull hull = sampled_hull(scene, {.tolerance = tolerance, .threads = 1, .progress = {}});
    EXPECT_TRUE(mesh_facts(polygons(hull.mesh)).is_convex_polytope());
    EXPECT_LE(gaps(scene, polygons(hull.mesh), 1000).highest, hull.distance_bound);
    EXPECT_TRUE(std::isfinite(hull.distance_bound));
  }
}

TEST(SampledHull, AbsurdToleranceIsNotConverged) {
  const auto reached = [](const Shape& shape, double tolerance, int max_vertices) {
    try {
      sampled_hull(
          make_scene(shape),
          {.tolerance = tolerance, .threads = 1, .max_vertices = max_vertices, .progress = {}});
    } catch (const HullNotConverged& error) {
      // The best hull comes with it.
      EXPECT_EQ(error.best->distance_bound, error.reached);
      EXPECT_TRUE(mesh_facts(polygons(error.best->mesh)).is_convex_polytope());
      EXPECT_LE(int(error.best->mesh.n_vertices()), std::max(max_vertices, 40));
      return error.reached;
    }
    return -1.0;
  };
  const double exact = reached(mapped(box(1, 2, 3), skew_rotation()), 1e-20, 1000);
  EXPECT_GT(exact, 1e-20);
  EXPECT_LT(exact, 1e-11);
  const double cut_short = reached(sphere(), 1e-9, 1000);
  EXPECT_GT(cut_short, 1e-9);
  EXPECT_LT(cut_short, 0.1);
  EXPECT_GT(reached(sphere(), 1e-9, 4), 0.1);
}

TEST(SampledHull, CancelAndProgress) {
  const Scene scene = make_scene(teapot());
  std::stop_source before;
  before.request_stop();
  HullOptions options = {.tolerance = 1e-3, .threads = 2, .progress = {}};
  options.progress.stop = before.get_token();
  EXPECT_THROW(sampled_hull(scene, options), Cancelled);

  std::stop_source during;
  int reports = 0;
  options.progress.stop = during.get_token();
  options.progress.report = [&](std::string_view step, double share) {
    EXPECT_FALSE(step.empty());
    EXPECT_GE(share, 0);
    EXPECT_LE(share, 1);
    if (++reports == 2) during.request_stop();
  };
  EXPECT_THROW(sampled_hull(scene, options), Cancelled);
  EXPECT_EQ(reports, 2);
}

}  // namespace
}  // namespace taut
