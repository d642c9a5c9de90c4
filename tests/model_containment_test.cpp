#include "taut/containment/model_containment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "cages.h"
#include "containment_checks.h"
#include "error_checks.h"
#include "freeform.h"
#include "refined_cage.h"
#include "taut/containment/closed_surface.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and checks

real torus_distance(const rvec3& x) {
  return std::hypot(std::hypot(x.x, x.y) - 2, x.z) - real(0.5);
}

/// Signed distance from the ellipsoid with half axes 3, 2, 1: the nearest point is x_i a_i^2 /
/// (t + a_i^2) for the largest root t of sum (a_i x_i / (t + a_i^2))^2 = 1, by bisection (Eberly).
real ellipsoid_distance(const rvec3& x) {
  const rvec3 a(3, 2, 1);
  const auto value = [&](real t) {
    const rvec3 s = a * x / (t + a * a);
    return glm::dot(s, s) - 1;
  };
  real low = -1;  // the largest pole, since no coordinate of x vanishes
  real high = 100;
  for (int k = 0; k < 200; ++k) {
    const real t = (low + high) / 2;
    (value(t) > 0 ? low : high) = t;
  }
  const rvec3 nearest = a * a * x / (high + a * a);
  return std::copysign(glm::distance(x, nearest), high);
}

/// Random points about the model and next to its surface, against a signed distance.
void check_points(const Scene& scene, const std::function<real(const rvec3&)>& truth, int count) {
  const ModelContainment containment(scene);
  const double diagonal = scene.diagonal();
  Random random(1);
  std::vector<dvec3> points;
  const auto& patches = scene.model().parts()[0].patches();
  for (int k = 0; k < count; ++k) {
    const dvec3 share{uniform(random, -0.2, 1.2), uniform(random, -0.2, 1.2),
                      uniform(random, -0.2, 1.2)};
    points.push_back(scene.box().lower + share * (scene.box().upper - scene.box().lower));
    const BezierPatch& patch =
        patches[std::size_t(pick(random, 0, int(patches.size()) - 1))].bezier;
    // Borders and corners too.
    const auto parameter = [&] {
      return k % 3 == 0 ? pick(random, 0, 2) / 2.0 : uniform(random, 0, 1);
    };
    const dvec3 p = point(patch, parameter(), parameter());
    const double d = diagonal * probe_distance(random, k);
    points.push_back(p + d * random_direction(random));
    if (k % 10 == 0) points.push_back(p);
  }
  const std::vector<Location> found = containment.locate(points);
  const std::vector<SignedDistance> distances = containment.distances(points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const dvec3& x = points[k];
    const real d = truth(rvec3(x));
    SCOPED_TRACE(testing::Message() << x.x << " " << x.y << " " << x.z << ": " << double(d));
    EXPECT_NEAR(double(distances[k].value - d), 0, 1e-12 * diagonal);
    EXPECT_LE(distances[k].lower, d + 1e-15 * diagonal);
    EXPECT_GE(distances[k].upper, d - 1e-15 * diagonal);
    if (std::abs(d) < 0.5e-13 * diagonal) {
      EXPECT_EQ(found[k], Location::on);
    } else if (std::abs(d) > 2e-13 * diagonal) {
      EXPECT_EQ(found[k], d > 0 ? Location::outside : Location::inside);
      EXPECT_EQ(distances[k].location(containment.on_tolerance()), found[k]);
    }
  }
}

TEST(ModelContainment, AgreesWithTheTorus) {
  check_points(make_scene(torus(2, 0.5)), torus_distance, 1'000);
}

TEST(ModelContainment, AgreesWithTheEllipsoid) {
  check_points(make_scene(ellipsoid(3, 2, 1)), ellipsoid_distance, 1'000);
}

TEST(ModelContainment, AgreesWithTheBox) {
  check_points(
      make_scene(box(1, 2, 3)),
      [](const rvec3& x) {
        return distance_to_box(x, {1, 2, 3});
      },
      1'000);
}

/// How often the model's surface winds about x, from solid angles of a fine tessellation (van
/// Oosterom and Strackee 1983) in long double. @pre x is farther from it than that deviates
real winding_number(const Model& model, const dvec3& x, int grid) {
  real sum = 0;
  for (const Patch& patch : model.parts()[0].patches()) {
    std::vector<rvec3> points;
    for (int i = 0; i <= grid; ++i) {
      for (int j = 0; j <= grid; ++j) {
        points.push_back(reference_point(patch.bezier, real(i) / grid, real(j) / grid) - rvec3(x));
      }
    }
    const auto angle = [&](int k, int l, int m) {
      const rvec3& a = points[std::size_t(k)];
      const rvec3& b = points[std::size_t(l)];
      const rvec3& c = points[std::size_t(m)];
      const real la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
      return 2 * std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc +
                                                               glm::dot(b, c) * la +
                                                               glm::dot(c, a) * lb);
    };
    for (int i = 0; i < grid; ++i) {
      for (int j = 0; j < grid; ++j) {
        const int k = i * (grid + 1) + j;
        sum += angle(k, k + grid + 1, k + grid + 2) + angle(k, k + grid + 2, k + 1);
      }
    }
  }
  return sum / (4 * std::acos(real(-1)));
}

/// Points anywhere against winding numbers.
void check_winding(const Scene& scene, const ModelContainment& containment) {
  const double diagonal = scene.diagonal();
  Random random(3);
  const int grid = scene.model().patch_count() > 500 ? 2 : 6;
  int inside = 0;
  for (int k = 0; k < 12; ++k) {
    const dvec3 share{uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)};
    const dvec3 x = scene.box().lower + share * (scene.box().upper - scene.box().lower);
    if (std::abs(containment.distance(x).value) < 0.03 * diagonal) continue;
    const real winding = std::abs(winding_number(scene.model(), x, grid));
    ASSERT_LT(std::abs(winding - std::round(winding)), 0.01);
    const bool expected = std::round(winding) > 0;
    inside += expected;
    EXPECT_EQ(containment.locate(x), expected ? Location::inside : Location::outside);
  }
  EXPECT_GT(inside, 0);
}

/// That, and points next to points of the limit surface that OpenSubdiv's masks give.
void check_cage(const ControlCage& cage, double least_distance) {
  const Scene scene(cage_model(cage));
  const ModelContainment containment(scene);
  const double diagonal = scene.diagonal();
  check_winding(scene, containment);
  for (const LimitPoint& p : limit_points(cage, 1)) {
    for (const double d : {1e-4, 1e-6, 1e-9, 1e-12}) {
      if (d < least_distance) continue;
      const double length = d * diagonal;
      EXPECT_EQ(containment.locate(p.x + length * p.normal), Location::outside) << d;
      EXPECT_EQ(containment.locate(p.x - length * p.normal), Location::inside) << d;
      EXPECT_NEAR(containment.distance(p.x - length * p.normal).value, -length, 1e-8 * diagonal);
    }
  }
}

TEST(ModelContainment, AgreesWithLimitSurfacesOfClosedCages) {
  check_cage(torus_cage(8, 6), 1e-12);
  check_cage(cube_cage(), 1e-8);
}

/// Those too of which not all faces touch the hull.
TEST(ModelContainment, ClosedCagesAreClosed) {
  for (const auto& [name, cage] : closed_cages()) {
    if (name.find("50") != name.npos) continue;  // takes long
    const Scene scene(cage_model(cage, 1e-2));
    EXPECT_EQ(why_not_closed(scene.model()), "") << name;
    if (name != "loop of valence 9" && name != "catmark, sharp rim") continue;
    SCOPED_TRACE(name);
    check_winding(scene, ModelContainment(scene));
  }
}

TEST(ModelContainment, AgreesWithSemiSharpCagesFromAFile) {
  std::optional<Model> model =
      model_from_elsewhere("A18_osd_loop_icos_semisharp.obj", Scheme::loop, 1e-2);
  if (!model) GTEST_SKIP() << "TAUT_MODELS names no folder with it";
  ASSERT_EQ(why_not_closed(*model), "");
  const Scene scene(std::move(*model));
  check_winding(scene, ModelContainment(scene));
}

TEST(ModelContainment, AgreesWithTheTorusCageFromAFile) {
  const std::optional<Model> model =
      model_from_elsewhere("A19_torus_quad_smooth.off", Scheme::catmark, default_cage_accuracy);
  if (!model) GTEST_SKIP() << "TAUT_MODELS names no folder with it";
  ASSERT_EQ(why_not_closed(*model), "");
  check_cage(cage_of(*model), 1e-8);
}

TEST(ModelContainment, DentsAndHolesAreOutside) {
  const Scene dent = make_scene(dented_ellipsoid());
  const ModelContainment in_dent(dent);
  EXPECT_EQ(in_dent.locate({0, 1.6, 0}), Location::outside);
  EXPECT_EQ(in_dent.locate({0, -1.6, 0}), Location::inside);
  const Scene ring = make_scene(torus(2, 0.5));
  EXPECT_EQ(ModelContainment(ring).locate({0, 0, 0}), Location::outside);
  EXPECT_NEAR(ModelContainment(ring).distance({0, 0, 0}).value, 1.5, 1e-12);
}

TEST(ModelContainment, BodiesOfSeveralInstancesAreJoinedAndShellsInOneAreHollow) {
  Model model = make_model(sphere());
  model.add_instance(0, {dmat3(1.0), {1, 0, 0}});
  const Scene overlapping(std::move(model));
  const ModelContainment joined(overlapping);
  EXPECT_EQ(joined.locate({0.5, 0, 0}), Location::inside);
  EXPECT_EQ(joined.locate({-0.5, 0, 0}), Location::inside);
  EXPECT_EQ(joined.locate({1, 0, 0}), Location::inside) << "on one, inside the other";
  EXPECT_EQ(joined.locate({2.5, 0, 0}), Location::outside);
  const SignedDistance between = joined.distance({0.5, 0, 0});
  EXPECT_NEAR(between.value, -0.5, 1e-12);
  EXPECT_LE(between.lower, -std::sqrt(0.75));  // of the join
  EXPECT_GE(between.upper, -0.5 - 1e-12);

  const Scene shells = make_scene(sphere() + sphere(0.5));
  const ModelContainment hollow(shells);
  EXPECT_EQ(hollow.locate({0, 0.2, 0}), Location::outside);
  EXPECT_EQ(hollow.locate({0, 0.7, 0}), Location::inside);
  EXPECT_NEAR(hollow.distance({0, 0.6, 0}).value, -0.1, 1e-12);
}

/// A cube of squares, and one of its faces left out.
Model cube_of_polygons(int faces, double bend = 0) {
  PolygonMesh mesh;
  for (int k = 0; k < 8; ++k) mesh.points.emplace_back(k & 1, (k >> 1) & 1, k >> 2);
  mesh.points[7].z += bend;
  mesh.polygons = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                   {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  mesh.polygons.resize(std::size_t(faces));
  Part part;
  part.add_polygons(mesh);
  Model model;
  model.add_part(std::move(part), 0);
  return model;
}

TEST(ModelContainment, PolygonsAreExact) {
  const Scene scene(cube_of_polygons(6));
  const ModelContainment cube(scene);
  Random random(4);
  for (int k = 0; k < 500; ++k) {
    dvec3 x{uniform(random, 0, 1), uniform(random, 0, 1), pick(random, 0, 1)};
    const double d = log_uniform(random, 1e-12, 0.1) * (k % 2 == 0 ? 1 : -1);
    x.z += x.z > 0.5 ? d : -d;
    EXPECT_EQ(cube.locate(x), d > 0 ? Location::outside : Location::inside) << d;
    const double truth = double(distance_to_box(rvec3(x), {1, 1, 1}));
    EXPECT_NEAR(cube.distance(x).value, truth, 1e-14);
  }
  EXPECT_EQ(cube.locate({0.5, 0.5, 1}), Location::on);
  EXPECT_EQ(cube.locate({0, 0, 0}), Location::on);
}

/// Sides that agree within the join tolerance only leave gaps and overlaps, through which no ray
/// may slip.
TEST(ModelContainment, CracksDoNotLeak) {
  Random random(6);
  Shape cracked = box(1, 1, 1);
  for (NurbsSurface& face : cracked.surfaces) {
    for (dvec4& p : face.points) p += dvec4(1e-9 * random_point(random), 0);
  }
  const Scene scene = make_scene(cracked);
  ASSERT_EQ(why_not_closed(scene.model()), "");
  const ModelContainment containment(scene);
  EXPECT_GT(containment.on_tolerance(), 1e-10);
  EXPECT_LT(containment.on_tolerance(), 1e-8);
  for (int k = 0; k < 3'000; ++k) {
    // Next to an edge, inside or outside.
    dvec3 x{pick(random, 0, 1), pick(random, 0, 1), pick(random, 0, 1)};
    x[k % 3] = uniform(random, 0, 1);
    const double d = log_uniform(random, 1e-8, 1e-2);
    for (const int axis : {(k + 1) % 3, (k + 2) % 3}) {
      x[axis] += (k % 2 == 0) == (x[axis] > 0.5) ? d : -d;
    }
    EXPECT_EQ(containment.locate(x), k % 2 == 0 ? Location::outside : Location::inside) << d;
  }
}

TEST(ModelContainment, OpenModelsAreRefusedWithTheReason) {
  const auto refused = [](Model model, const std::string& reason) {
    const Scene scene(std::move(model));
    expect_invalid([&] { const ModelContainment containment(scene); }, reason);
  };
  refused(make_model(teapot()), "open along");
  refused(make_model(half_torus(2, 0.5)), "open along 8 sides of patches");
  refused(make_model(oloid()), "no surface");
  refused(cube_of_polygons(5), "open along 4 sides of polygons");
  refused(cube_of_polygons(6, 0.1), "not planar");
  EXPECT_EQ(why_not_closed(make_model(solid_cylinder(1, 2))), "");
  EXPECT_NE(why_not_closed(make_model(cylinder(1, 2))), "");
}

TEST(ModelContainment, PointsAndTolerancesThatAreNoneAreRefused) {
  const Scene scene = make_scene(sphere());
  const ModelContainment containment(scene);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_invalid([&] { containment.locate({0, nan, 0}); }, "not finite");
  expect_invalid([&] { containment.distance({nan, 0, 0}); }, "not finite");
  expect_invalid([&] { ModelContainment(scene, {.on_tolerance = nan, .progress = {}}); }, "number");
  EXPECT_EQ(containment.locate({0, 1e200, 0}), Location::outside);
  EXPECT_NEAR(containment.distance({0, 1e200, 0}).value / 1e200, 1, 1e-14);
  const ModelContainment loose(scene, {.on_tolerance = 0.1, .progress = {}});
  EXPECT_EQ(loose.locate({0.95, 0, 0}), Location::on);
  EXPECT_EQ(loose.locate({0.85, 0, 0}), Location::inside);
  EXPECT_EQ(loose.locate({1.15, 0, 0}), Location::outside);
}

TEST(ModelContainment, ThreadsDoNotMatter) {
  const Scene scene = make_scene(torus(2, 0.5));
  Random random(5);
  std::vector<dvec3> points(1'000);
  for (dvec3& x : points) x = 3.0 * random_point(random);
  const ModelContainment one(scene, {.threads = 1, .progress = {}});
  const ModelContainment many(scene, {.threads = 4, .progress = {}});
  EXPECT_EQ(one.locate(points), many.locate(points));
  const auto a = one.distances(points);
  const auto b = many.distances(points);
  for (std::size_t k = 0; k < points.size(); ++k) EXPECT_EQ(a[k].value, b[k].value);
}

}  // namespace
}  // namespace taut
