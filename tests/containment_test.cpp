#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "containment_checks.h"
#include "error_checks.h"
#include "taut/containment/contact_curvature.h"
#include "taut/containment/hull_containment.h"
#include "taut/containment/triangle_rays.h"
#include "taut/core/nearest_in_simplex.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and checks

/// The distance found, its bounds and the closed form agree.
void check_distance(const KnownHull& hull, const Scene& scene, const HullContainment& containment,
                    const dvec3& x) {
  const SignedDistance d = containment.distance(x);
  const real truth = hull.distance(rvec3(x));
  const real diagonal = scene.diagonal();
  const real rounding = 4e-16L * (diagonal + glm::length(x));
  EXPECT_NEAR(double(d.value - truth), 0, 1e-12 * scene.diagonal())
      << hull.name << " " << x.x << " " << x.y << " " << x.z;
  EXPECT_LE(d.lower, truth + rounding) << hull.name << " " << x.x << " " << x.y << " " << x.z;
  EXPECT_GE(d.upper, truth - rounding) << hull.name << " " << x.x << " " << x.y << " " << x.z;
  EXPECT_LE(d.lower, d.value);
  EXPECT_LE(d.value, d.upper + double(rounding));
}

TEST(HullContainment, DistancesAgreeWithClosedForms) {
  for (const KnownHull& hull : known_hulls()) {
    const Scene scene = make_scene(hull.shape);
    const HullContainment containment(scene);
    Random random(1);
    const Box& box = scene.box();
    std::vector<dvec3> points;
    for (int k = 0; k < 300; ++k) {
      const dvec3 share{uniform(random, -0.5, 1.5), uniform(random, -0.5, 1.5),
                        uniform(random, -0.5, 1.5)};
      points.push_back(box.lower + share * (box.upper - box.lower));
    }
    for (const BoundaryPoint& p : boundary_points(scene, random, 200)) {
      const double d = log_uniform(random, 1e-14, 10) * scene.diagonal();
      points.push_back(p.x + (pick(random, 0, 1) == 0 ? d : -d) * p.n);
    }
    int certified = 0;
    for (const dvec3& x : points) {
      check_distance(hull, scene, containment, x);
      const double reach = scene.diagonal() + glm::length(x);
      if (containment.distance(x).error_bound() <= 1.01e-12 * reach) ++certified;
    }
    EXPECT_GE(certified, 490) << hull.name;
  }
}

/// Where many or all directions are as near: the bounds may be wide there, but must hold.
TEST(HullContainment, DistancesOfPointsOnMedialAxesAgree) {
  for (const KnownHull& hull : known_hulls()) {
    const Scene scene = make_scene(hull.shape);
    const HullContainment containment(scene);
    check_distance(hull, scene, containment, scene.box().center());
    for (const double share : {0.3, 1e-3, 1e-9}) {
      const dvec3 half = share * 0.5 * (scene.box().upper - scene.box().lower);
      check_distance(hull, scene, containment, scene.box().center() + dvec3(0, 0, half.z));
      check_distance(hull, scene, containment, scene.box().center() + dvec3(half.x, 0, 0));
    }
  }
}

TEST(HullContainment, PointsNextToTheBoundaryAreRight) {
  for (const KnownHull& hull : known_hulls()) {
    const Scene scene = make_scene(hull.shape);
    const HullContainment containment(scene);
    Random random(5);
    EXPECT_EQ(wrong_answers(containment, known_probes(hull, scene, random, 2'000)), 0) << hull.name;
  }
  Random random(6);
  const Scene round = make_scene(oloid());
  EXPECT_EQ(wrong_answers(HullContainment(round), oloid_probes(round, random, 2'000)), 0);
  const Scene pot = make_scene(teapot());
  EXPECT_EQ(wrong_answers(HullContainment(pot), probes_of(pot, {0, 0, 1}, 0.9, random, 2'000)), 0);
}

/// Location and distance are two ways to the same answer.
TEST(HullContainment, DistancesTellTheLocation) {
  const Scene scene = make_scene(teapot());
  const HullContainment containment(scene);
  Random random(7);
  for (const Probe& probe : probes_of(scene, {0, 0, 1}, 0.9, random, 500)) {
    EXPECT_EQ(containment.distance(probe.x).location(containment.on_tolerance()), probe.truth);
  }
}

TEST(HullContainment, TheMeshDecidesPointsFarFromTheBoundary) {
  const Scene scene = make_scene(teapot());
  const HullContainment containment(scene);
  EXPECT_LE(containment.mesh_distance(), 1.01e-4 * scene.diagonal());
  Random random(8);
  std::vector<dvec3> points;
  for (const BoundaryPoint& p : boundary_points(scene, random, 2'000)) {
    points.push_back(p.x + 1e-3 * scene.diagonal() * p.n);
    points.push_back(p.x + 2e-3 * (dvec3(0, 0, 1) - p.x));
  }
  ContainmentCounts counts;
  const std::vector<Location> found = containment.locate(points, &counts);
  EXPECT_EQ(counts.points, 4'000);
  EXPECT_LE(counts.searched, 40);
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_EQ(found[k], k % 2 == 0 ? Location::outside : Location::inside);
  }
}

/// Support points about the corner of a flat face are near each other, but not the same.
TEST(HullContainment, ProvesPointsNextToTheCornerOfAFlatFace) {
  const Scene scene = make_scene(filleted_box(3, 2, 1, 0.2));
  const HullContainment containment(scene);
  const SignedDistance d =
      containment.distance({1.499999810039651, 0.79999991215084021, -0.29999996754693559});
  EXPECT_NEAR(d.value, 1.499999810039651 - 1.5, 1e-15);
  EXPECT_LE(d.upper, 0.99 * d.value);
}

TEST(HullContainment, FlatHullsHaveNoInside) {
  Shape disc;
  disc.curves = {circle(dvec3(0.0), {1, 0, 0}, {0, 1, 0})};
  const Scene scene = make_scene(disc);
  const HullContainment containment(scene);
  EXPECT_EQ(containment.locate({0.2, 0.1, 0}), Location::on);
  EXPECT_EQ(containment.locate({1, 0, 0}), Location::on);
  EXPECT_EQ(containment.locate({0.2, 0.1, 1e-11}), Location::outside);
  EXPECT_NEAR(containment.distance({0.2, 0.1, -0.3}).value, 0.3, 1e-12);
  EXPECT_NEAR(containment.distance({3, 4, 0}).value, 4, 1e-12);
  EXPECT_NEAR(containment.distance({0, 2, 1}).value, std::sqrt(2.0), 1e-12);

  Shape line;
  line.points = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}};
  const Scene thin = make_scene(line);
  EXPECT_EQ(HullContainment(thin).locate({0.3, 0, 0}), Location::on);
  EXPECT_NEAR(HullContainment(thin).distance({2, 1, 0}).value, std::sqrt(2.0), 1e-12);

  Shape dot;
  dot.points = {{1, 2, 3}};
  const Scene tiny = make_scene(dot);
  EXPECT_EQ(HullContainment(tiny).locate({1, 2, 3}), Location::on);
  EXPECT_NEAR(HullContainment(tiny).distance({1, 2, 5}).value, 2, 1e-12);
}

/// The foot of a point above a plane of curves is inside of what they bound.
TEST(HullContainment, PointsAbovePlanarCurves) {
  const dmat3 turn = skew_rotation();
  const Shape circles = {
      {}, {circle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), circle({4, 0, 0}, {1, 0, 0}, {0, 1, 0})}, {}};
  for (const bool turned : {false, true}) {
    const Scene scene = make_scene(turned ? mapped(circles, turn) : circles);
    const HullContainment hull(scene);
    const auto distance = [&](const dvec3& x) { return hull.distance(turned ? turn * x : x); };
    for (const double height : {0.0, 1e-6, 0.3, 2.0, -5.0}) {
      for (const dvec3& foot : {dvec3(0.3, 0.2, 0), dvec3(2, 0.7, 0), dvec3(4.5, -0.4, 0)}) {
        const SignedDistance d = distance(foot + dvec3(0, 0, height));
        EXPECT_NEAR(d.value, std::abs(height), 1e-12);
        EXPECT_EQ(d.location(hull.on_tolerance()), height == 0 ? Location::on : Location::outside);
      }
      EXPECT_NEAR(distance({2, 1.5, height}).value, std::hypot(0.5, height), 1e-12);
      EXPECT_NEAR(distance({6, 0, height}).value, std::hypot(1, height), 1e-12);
    }
  }
}

TEST(HullContainment, PointsThatAreNoneAreRefused) {
  const Scene scene = make_scene(sphere());
  const HullContainment containment(scene);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_invalid([&] { containment.locate({0, nan, 0}); }, "not finite");
  expect_invalid([&] { containment.distance({0, 0, infinity}); }, "not finite");
  const std::vector<dvec3> points = {{0, 0, 0}, {infinity, 0, 0}};
  expect_invalid([&] { containment.locate(points); }, "not finite");
  expect_invalid([&] { HullContainment(scene, {.on_tolerance = nan, .progress = {}}); }, "number");
  expect_invalid([&] { HullContainment(scene, {.mesh_relative = 0, .progress = {}}); },
                 "tolerance");
}

TEST(HullContainment, PointsFarAwayAreOutside) {
  const Scene scene = make_scene(sphere());
  const HullContainment containment(scene);
  for (const double far : {1e3, 1e9, 1e30, 1e120, 1e300}) {
    EXPECT_EQ(containment.locate({0, far, 0}), Location::outside);
    const SignedDistance d = containment.distance({0, 0.6 * far, 0.8 * far});
    EXPECT_NEAR(d.value / far, 1 - 1 / far, 1e-14);
    EXPECT_LE(d.lower, d.value);
    EXPECT_GE(d.upper, d.value);
    EXPECT_LE(d.error_bound(), 1e-13 * far);
  }
}

TEST(HullContainment, TheToleranceDecidesWhatIsOn) {
  const Scene scene = make_scene(sphere());
  const HullContainment exact(scene);
  const HullContainment loose(scene, {.on_tolerance = 0.1, .progress = {}});
  EXPECT_DOUBLE_EQ(exact.on_tolerance(), 1e-13 * scene.diagonal());
  EXPECT_EQ(loose.on_tolerance(), 0.1);
  EXPECT_EQ(exact.locate({0, 0.95, 0}), Location::inside);
  EXPECT_EQ(loose.locate({0, 0.95, 0}), Location::on);
  EXPECT_EQ(loose.locate({0, 1.05, 0}), Location::on);
  EXPECT_EQ(loose.locate({0, 0.89, 0}), Location::inside);
  EXPECT_EQ(loose.locate({0, 1.11, 0}), Location::outside);
}

TEST(HullContainment, ThreadsDoNotMatter) {
  const Scene scene = make_scene(teapot());
  Random random(9);
  std::vector<dvec3> points;
  for (const Probe& probe : probes_of(scene, {0, 0, 1}, 0.9, random, 3'000)) {
    points.push_back(probe.x);
  }
  const HullContainment one(scene, {.threads = 1, .progress = {}});
  const HullContainment many(scene, {.threads = 4, .progress = {}});
  EXPECT_EQ(one.locate(points), many.locate(points));
  const auto a = one.distances(points);
  const auto b = many.distances(points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_EQ(a[k].value, b[k].value);
    EXPECT_EQ(a[k].lower, b[k].lower);
    EXPECT_EQ(a[k].upper, b[k].upper);
    EXPECT_EQ(a[k].value, one.distance(points[k]).value);
  }
}

TEST(HullContainment, SizeAndPlaceDoNotMatter) {
  const dmat3 turn = skew_rotation();
  for (const double size : {1e-6, 1.0, 1e6}) {
    const dvec3 shift = size * dvec3(3, -4, 5);
    const Scene scene = make_scene(shifted(scaled(mapped(torus(2, 0.5), turn), size), shift));
    const HullContainment containment(scene);
    const KnownHull hull = known_hulls()[3];
    Random random(10);
    for (int k = 0; k < 100; ++k) {
      const dvec3 x = 3.0 * random_point(random);
      const double d = containment.distance(size * (turn * x) + shift).value;
      EXPECT_NEAR(d / size, double(hull.distance(rvec3(x))), 1e-11) << size;
    }
  }
}

TEST(HullContainment, CanBeCancelled) {
  const Scene scene = make_scene(sphere());
  std::stop_source source;
  HullContainmentOptions options;
  options.progress.stop = source.get_token();
  const HullContainment containment(scene, options);
  source.request_stop();
  const std::vector<dvec3> points(10, dvec3(0.0));
  EXPECT_THROW(containment.locate(points), Cancelled);
  EXPECT_THROW(HullContainment(scene, options), Cancelled);
}

/// Against differences of support points.
TEST(ContactCurvature, IsTheDerivativeOfTheSupportPoint) {
  Random random(14);
  for (const Shape& shape : {ellipsoid(3, 2, 1), torus(2, 0.5), oloid(), box(1, 2, 3)}) {
    const Scene scene = make_scene(mapped(shape, skew_rotation(), {1, 2, 3}));
    SupportQuery query(scene);
    int compared = 0;
    for (int k = 0; k < 200; ++k) {
      const dvec3 n = random_direction(random);
      const dvec3 t = tangent_frame(n)[0];
      constexpr double step = 1e-5;
      const Support middle = query(n);
      const Support before = query(unit(n - step * t), middle.contact);
      const Support after = query(unit(n + step * t), middle.contact);
      if (!same_element(before.contact, middle.contact)) continue;
      if (!same_element(after.contact, middle.contact)) continue;
      const auto hessian = support_hessian(scene, middle.contact, n);
      ASSERT_TRUE(hessian);
      const dvec3 expected = (after.point - before.point) / (2 * step);
      EXPECT_NEAR(glm::distance(*hessian * t, expected), 0, 1e-4 * (1 + glm::length(expected)));
      EXPECT_NEAR(glm::length(*hessian * n), 0, 1e-12);
      ++compared;
    }
    EXPECT_GT(compared, 100);
  }
}

TEST(ContactCurvature, ProjectionStepsSquareTheError) {
  const Scene scene = make_scene(ellipsoid(3, 2, 1));
  SupportQuery query(scene);
  Random random(15);
  for (int k = 0; k < 100; ++k) {
    const dvec3 foot_normal = random_direction(random);
    const dvec3 x = query(foot_normal).point + 0.3 * foot_normal;
    dvec3 n = unit(foot_normal + 0.05 * random_point(random));
    double error = glm::distance(n, foot_normal);
    for (int step = 0; step < 5 && error > 1e-7; ++step) {
      const Support s = query(n);
      const CurvedContact contact{n, s.point, support_hessian(scene, s.contact, n).value(), 1};
      const auto next = projection_step(std::array{contact}, x, n, 0);
      ASSERT_TRUE(next);
      n = *next;
      EXPECT_LE(glm::distance(n, foot_normal), 10 * error * error);
      error = glm::distance(n, foot_normal);
    }
    EXPECT_LE(error, 1e-7);
  }
}

/// x beside the side of a capsule: the ruling of both contacts, whose weights tell where it is.
TEST(ContactCurvature, ProjectionStepsFindTheRulingOfTwoContacts) {
  const dvec3 a(0, 0, -1);
  const dvec3 b(0, 0, 1);
  const auto ball = [](const dvec3& middle, const dvec3& n) {
    return CurvedContact{n, middle + n, dmat3(1.0) - glm::outerProduct(n, n), 0.5};
  };
  const dvec3 n = unit({0.3, 1, 0.1});
  const dvec3 x(0.2, 1.7, 0.4);
  dvec3 next = n;
  for (int step = 0; step < 6; ++step) {
    const auto found = projection_step(std::array{ball(a, next), ball(b, next)}, x, next, 0);
    ASSERT_TRUE(found);
    next = *found;
  }
  EXPECT_NEAR(glm::distance(next, unit({0.2, 1.7, 0})), 0, 1e-14);
  // Beyond its end the other ball alone is nearest.
  next = n;
  for (int step = 0; step < 6; ++step) {
    const auto found =
        projection_step(std::array{ball(a, next), ball(b, next)}, {0.2, 1.7, 1.4}, next, 0);
    ASSERT_TRUE(found);
    next = *found;
  }
  EXPECT_NEAR(glm::distance(next, unit({0.2, 1.7, 0.4})), 0, 1e-14);
}

/// An octahedron, far from the origin and small.
struct Octahedron {
  dvec3 middle = dvec3(100, 200, 300);
  double size = 0.01;
  std::vector<dvec3> points;
  std::vector<Triangle> triangles;

  Octahedron() {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {size, -size}) {
        points.push_back(middle);
        points.back()[axis] += side;
      }
    }
    for (const int x : {0, 1}) {
      for (const int y : {2, 3}) {
        for (const int z : {4, 5}) triangles.push_back({x, y, z});
      }
    }
  }
};

TEST(TriangleRays, FindTheTrianglesTheyMeet) {
  const Octahedron body;
  const TriangleRays rays(body.points, body.triangles);
  Random random(12);
  TriangleRays::Hits hits;
  for (int k = 0; k < 1000; ++k) {
    const dvec3 d = random_direction(random);
    const int expected = (d.x > 0 ? 0 : 4) + (d.y > 0 ? 0 : 2) + (d.z > 0 ? 0 : 1);
    rays.all_hits(body.middle, d, hits);
    if (hits.doubtful) continue;
    EXPECT_EQ(hits.triangles, std::vector<int>{expected});
    EXPECT_EQ(rays.first_hit(body.middle, d), expected);
    rays.all_hits(body.middle + 3 * body.size * d, d, hits);
    EXPECT_TRUE(hits.triangles.empty());
    EXPECT_EQ(rays.first_hit(body.middle + 3 * body.size * d, d), -1);
  }
  // Through an edge, and through a vertex.
  rays.all_hits(body.middle, unit({1, 1, 0}), hits);
  EXPECT_TRUE(hits.doubtful || hits.triangles.empty());
}

TEST(TriangleRays, NearestIsThatOfDoublePrecision) {
  const Octahedron body;
  const TriangleRays rays(body.points, body.triangles);
  Random random(13);
  for (int k = 0; k < 300; ++k) {
    const dvec3 x = body.middle + log_uniform(random, 1e-5, 1) * random_direction(random);
    const auto distance = [&](int triangle) {
      std::vector<dvec3> corners;
      for (const int v : body.triangles[std::size_t(triangle)]) {
        corners.push_back(body.points[std::size_t(v)] - x);
      }
      return glm::length(nearest_in_simplex(corners).point);
    };
    double expected = 10;
    for (int t = 0; t < 8; ++t) expected = std::min(expected, distance(t));
    EXPECT_EQ(rays.nearest(x, 10, distance), expected);
    EXPECT_EQ(rays.nearest(x, 0.5 * expected, distance), 0.5 * expected);
  }
}

}  // namespace
}  // namespace taut
