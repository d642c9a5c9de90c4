// A million points next to the boundaries of hulls.

#include <cstdio>

#include "containment_checks.h"
#include "freeform.h"
#include "taut/containment/hull_containment.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and checks

constexpr int points_each = 200'000;

class KnownHulls : public testing::TestWithParam<std::string> {};

TEST_P(KnownHulls, NoPointNextToTheBoundaryIsWrong) {
  for (const KnownHull& hull : known_hulls()) {
    if (hull.name != GetParam()) continue;
    const Scene scene = make_scene(hull.shape);
    const HullContainment containment(scene);
    Random random(1);
    EXPECT_EQ(wrong_answers(containment, known_probes(hull, scene, random, points_each)), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(ContainmentSweep, KnownHulls,
                         testing::Values("sphere", "box", "capsule", "torus"),
                         [](const auto& suite) { return suite.param; });

TEST(ContainmentSweep, NoPointNextToTheOloidIsWrong) {
  const Scene scene = make_scene(oloid());
  const HullContainment containment(scene);
  Random random(2);
  EXPECT_EQ(wrong_answers(containment, oloid_probes(scene, random, points_each)), 0);
}

TEST(ContainmentSweep, NoPointNextToTheTeapotsHullIsWrong) {
  const Scene scene = make_scene(teapot());
  const HullContainment containment(scene);
  Random random(3);
  EXPECT_EQ(wrong_answers(containment, probes_of(scene, {0, 0, 1}, 0.9, random, points_each)), 0);
}

/// Bodies of every kind and size, in every place. Those far from the origin are as exact as their
/// coordinates.
TEST(ContainmentSweep, NoPointNextToAnyBodyIsWrong) {
  Random random(4);
  Shape points;
  for (int k = 0; k < 20'000; ++k) points.points.push_back(random_direction(random));
  const dmat3 flat(1, 0, 0, 0, 1e-3, 0, 0, 0, 1e-6);
  const std::vector<std::pair<std::string, Shape>> shapes = {
      {"needle", box(1e6, 1, 1)},
      {"flat ellipsoid", mapped(sphere(), flat)},
      {"far box", shifted(box(1, 1, 1), {1e8, -1e8, 1e8})},
      {"turned torus", shifted(mapped(torus(2, 0.5), skew_rotation()), {1e4, 1e4, 1e4})},
      {"tiny teapot", scaled(teapot(), 1e-9)},
      {"huge teapot", scaled(teapot(), 1e9)},
      {"cone", cone(1, 2)},
      {"cylinder", cylinder(1, 2)},
      {"filleted box", filleted_box(3, 2, 1, 0.2)},
      {"dented ellipsoid", dented_ellipsoid()},
      {"sphere twice", sphere() + sphere()},
      {"two spheres", two_spheres(1, 0.5, 3)},
      {"paraboloid", paraboloid()},
      {"saddle", saddle()},
      {"twisted cubic", {{}, {twisted_cubic()}, {}}},
      {"tied curve", tied_curve(0.1)},
      {"lemon", lemon()},
      {"ogive", ogive()},
      {"bean", bean()},
      {"cap", spherical_cap(0.6)},
      {"circles", perpendicular_circles()},
      {"points", points},
  };
  for (const auto& [name, shape] : shapes) {
    SCOPED_TRACE(name);
    const Scene scene = make_scene(shape);
    const HullContainment containment(scene);
    SupportQuery query(scene);
    dvec3 middle(0.0);
    for (int k = 0; k < 200; ++k) {
      middle += support(query, scene, random_direction(random)).point / 200.0;
    }
    const double radius = -containment.distance(middle).upper;
    ASSERT_GT(radius, 0);
    const double coordinates = glm::length(scene.box().lower) + glm::length(scene.box().upper);
    const double rounding = 4e-15 * coordinates;
    std::vector<Probe> probes;
    for (const BoundaryPoint& p : boundary_points(scene, random, 3'000)) {
      // Rounding moves points: what is known of them is known of those far enough off.
      const double d = scene.diagonal() * probe_distance(random, pick(random, 0, 99));
      if (d < rounding || d > 0.5 * radius) continue;
      const Probe next = probe(p, middle, radius, d, pick(random, 0, 99));
      if (next.truth == Location::on && rounding > 1e-13 * scene.diagonal()) continue;
      if (next.truth == Location::inside && d < 2e-12 * scene.diagonal()) continue;
      probes.push_back(next);
    }
    EXPECT_GT(probes.size(), 500U);
    EXPECT_EQ(wrong_answers(containment, probes), 0);
  }
}

TEST(ContainmentSweep, NoPointNextToRandomBodiesIsWrong) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const double size = log_uniform(random, 1e-6, 1e6);
    const Scene scene = make_scene(scaled(mapped(blob(seed), random_rotation(random)), size));
    const HullContainment containment(scene);
    const dvec3 middle = scene.box().center();
    EXPECT_EQ(wrong_answers(containment, probes_of(scene, middle, 0.1 * size, random, 5'000)), 0);
  }
}

/// The bounds of distances hold, and nearly all are as narrow as asked for.
TEST(ContainmentSweep, DistancesAndTheirBoundsHold) {
  for (const KnownHull& hull : known_hulls()) {
    SCOPED_TRACE(hull.name);
    const Scene scene = make_scene(hull.shape);
    const HullContainment containment(scene);
    Random random(7);
    std::vector<dvec3> points;
    for (const BoundaryPoint& p : boundary_points(scene, random, 5'000)) {
      const double d = log_uniform(random, 1e-15, 3) * scene.diagonal();
      points.push_back(p.x + (pick(random, 0, 1) == 0 ? d : -d) * p.n);
    }
    const std::vector<SignedDistance> found = containment.distances(points);
    const real diagonal = scene.diagonal();
    real worst = 0;
    int narrow = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const real truth = hull.distance(rvec3(points[k]));
      const real rounding = 4e-16L * (diagonal + glm::length(points[k]));
      worst = std::max(worst, std::abs(found[k].value - truth) / diagonal);
      EXPECT_LE(found[k].lower, truth + rounding);
      EXPECT_GE(found[k].upper, truth - rounding);
      narrow += found[k].error_bound() <= 1.1e-12L * (diagonal + glm::length(points[k]));
    }
    std::printf("%-8s worst error of a distance: %.2e of the diagonal; certified %d of %zu\n",
                hull.name.c_str(), double(worst), narrow, points.size());
    EXPECT_LE(worst, 1e-12L);
    EXPECT_GE(narrow, 4'950);
  }
}

}  // namespace
}  // namespace taut
