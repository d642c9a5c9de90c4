#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "freeform.h"
#include "support_checks.h"
#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/model_support.h"
#include "taut/core/error.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and reference answers

/// Rational quarter circles meet the circle to a few rounding units.
constexpr double circle_rounding = 1e-15;

std::vector<dvec3> directions(unsigned seed, int count) {
  Random random(seed);
  std::vector<dvec3> result = special_directions(random);
  const std::vector<dvec3> more = random_directions(random, count);
  result.insert(result.end(), more.begin(), more.end());
  return result;
}

real sphere_support(const rvec3& n) { return glm::length(n); }

TEST(SupportQuery, Sphere) {
  const Scene scene = make_scene(sphere());
  expect_support(scene, closed_form(scene, sphere_support), directions(1, 300), "sphere",
                 circle_rounding);
}

TEST(SupportQuery, Ellipsoid) {
  const Scene scene = make_scene(ellipsoid(3, 2, 1));
  const auto truth =
      closed_form(scene, [](const rvec3& n) { return glm::length(rvec3(3 * n.x, 2 * n.y, n.z)); });
  expect_support(scene, truth, directions(2, 300), "ellipsoid", circle_rounding);
}

/// What is left out does not count: of three spheres in a row of which the last is the largest.
TEST(SupportQuery, LeavesOutPatches) {
  const Scene all =
      make_scene(sphere(1) + shifted(sphere(1), {3, 0, 0}) + shifted(sphere(2), {6, 0, 0}));
  SupportQuery query(all);
  const ContactGeometry geometry(all);
  std::vector<Contact> last;
  for (int k = 0; k < int(geometry.part({0, SourceKind::face, 0, 0, 0}).patches().size()); ++k) {
    const Contact c{0, SourceKind::face, k, 0.5, 0.5};
    if (all.frame().to_model(geometry.point(c)).x > 3.9) last.push_back(c);
  }
  ASSERT_FALSE(last.empty());
  query.leave_out(last);
  for (const dvec3& n : directions(4, 300)) {
    const double h = std::max(0.0, 3 * n.x) + 1;
    const Support found = query(n, last.front());
    EXPECT_NEAR(glm::dot(all.frame().to_model(found.point), n), h, 1e-12);
  }
}

/// Lines of a cylinder whose numbers were rounded are bent, by little: without their insides the
/// answer is lower by no more than it says.
TEST(SupportQuery, LeavesOutInsidesOfBentLines) {
  Shape shape = mapped(with_higher_degrees(solid_cylinder(1, 2)), skew_rotation());
  for (NurbsSurface& surface : shape.surfaces) {
    for (dvec4& p : surface.points) {
      const dvec3 x = euclidean(p);
      p = homogeneous({double(float(x.x)), double(float(x.y)), double(float(x.z))}, p.w);
    }
  }
  const Scene scene = make_scene(shape);
  SupportQuery all(scene), rest(scene);
  const double off = 1e-6;
  rest.leave_out_lines(off);
  double most = 0;
  for (dvec3 n : directions(6, 300)) {
    for (const bool across : {false, true}) {
      const dvec3 axis = skew_rotation() * dvec3(0, 0, 1);
      if (across) n = unit(n - glm::dot(n, axis) * axis);
      const Support truth = all(n);
      const Support found = rest(n);
      EXPECT_EQ(truth.low, 0);
      EXPECT_LE(found.low, off);
      EXPECT_LE(found.h, truth.h_bound);
      EXPECT_GE(found.highest() + support_slack, truth.h);
      EXPECT_GE(found.h_bound, truth.h);
      most = std::max(most, found.low);
    }
  }
  EXPECT_GT(most, 0);
  EXPECT_LE(rest.cells(), all.cells());
}

/// What is lower than a value that is given is not told apart; lines that are left out do not count
/// for more than they miss.
TEST(SupportQuery, HighestAboveAValue) {
  const double off = 1e-6;
  for (const Shape& shape : {teapot(), mapped(solid_cylinder(1, 2), skew_rotation())}) {
    const Scene scene = make_scene(shape);
    SupportQuery query(scene), rest(scene);
    rest.leave_out_lines(off);
    for (const dvec3& n : directions(7, 100)) {
      const Support truth = query(n);
      for (const double beside : {-1.0, -1e-3, -1e-9, 0.0, 1e-9, 1e-3}) {
        const double least = truth.h + beside;
        const double highest = std::max(least, truth.h);
        EXPECT_NEAR(query.highest_above(least, n, truth.contact), highest, support_slack);
        EXPECT_NEAR(query.highest_above(least, n, {}), highest, support_slack);
        EXPECT_GE(rest.highest_above(least, n, {}), highest - support_slack);
        EXPECT_LE(rest.highest_above(least, n, {}), std::max(least, truth.h_bound + off));
      }
    }
  }
}

/// Along the circle on which a torus lies.
TEST(SupportQuery, LessIsToldAboveAValue) {
  const Scene scene = make_scene(mapped(torus(2, 0.5), skew_rotation()));
  const dvec3 n = skew_rotation() * dvec3(0, 0, 1);
  SupportQuery query(scene);
  const Support truth = query(n);
  const long whole = query.cells();
  const double least = truth.h + 1e-9;
  EXPECT_EQ(query.highest_above(least, n, truth.contact), least);
  EXPECT_LT(query.cells() - whole, whole);
}

TEST(SupportQuery, Torus) {
  const Scene scene = make_scene(torus(2, 0.5));
  const auto truth = closed_form(scene, [](const rvec3& n) {
    return 2 * std::sqrt(n.x * n.x + n.y * n.y) + 0.5L * glm::length(n);
  });
  expect_support(scene, truth, directions(3, 300), "torus", circle_rounding);
}

TEST(SupportQuery, ManySmallPatches) {
  Shape shape = torus(2, 0.5);
  for (int k = 0; k < 4; ++k) shape = split(shape, 0.5, 0.5);
  const Scene scene = make_scene(shape);
  const auto truth = closed_form(scene, [](const rvec3& n) {
    return 2 * std::sqrt(n.x * n.x + n.y * n.y) + 0.5L * glm::length(n);
  });
  // Control points of halves of halves are rounded each time.
  expect_support(scene, truth, directions(13, 300), "torus of many patches", 4 * circle_rounding);
}

TEST(SupportQuery, Circles) {
  const Scene scene = make_scene(oloid());
  const auto truth = closed_form(scene, [](const rvec3& n) {
    return std::max(std::hypot(n.x, n.y), n.x + std::hypot(n.x, n.z));
  });
  expect_support(scene, truth, directions(4, 500), "oloid circles", circle_rounding);
}

TEST(SupportQuery, BoxesHaveWholeFacesAndEdgesAsSupport) {
  const Scene scene = make_scene(box(1, 2, 3));
  const auto truth = closed_form(scene, [](const rvec3& n) {
    return std::max(n.x, 0.0L) + 2 * std::max(n.y, 0.0L) + 3 * std::max(n.z, 0.0L);
  });
  expect_support(scene, truth, directions(5, 500), "box");
}

TEST(SupportQuery, CylindersAndCones) {
  const Scene tube = make_scene(cylinder(1, 2));
  expect_support(
      tube,
      closed_form(tube,
                  [](const rvec3& n) { return std::hypot(n.x, n.y) + 2 * std::max(n.z, 0.0L); }),
      directions(6, 300), "cylinder", circle_rounding);
  const Scene tip = make_scene(cone(1, 2));
  expect_support(
      tip, closed_form(tip, [](const rvec3& n) { return std::max(std::hypot(n.x, n.y), 2 * n.z); }),
      directions(7, 300), "cone", circle_rounding);
  // Directions across a ruling touch along all of it.
  std::vector<dvec3> across;
  Random random(8);
  for (int k = 0; k < 50; ++k) {
    const double t = uniform(random, 0, 7);
    across.push_back(unit({2 * std::cos(t), 2 * std::sin(t), 1}));
  }
  expect_support(
      tip, closed_form(tip, [](const rvec3& n) { return std::max(std::hypot(n.x, n.y), 2 * n.z); }),
      across, "cone, rulings", circle_rounding);
}

TEST(SupportQuery, Teapot) {
  const Scene scene = make_scene(teapot());
  expect_support(scene, reference(scene), directions(9, 60), "teapot");
}

TEST(SupportQuery, RandomPatches) {
  Random random(10);
  for (int k = 0; k < 42; ++k) {
    const double weights = k % 3 == 0 ? 1 : log_uniform(random, 1.1, 30);
    const BezierPatch patch = random_patch(random, 1 + k % 7, pick(random, 1, 7), weights);
    const Scene scene = make_scene(of_patch(patch));
    expect_support(scene, reference(scene), random_directions(random, 10),
                   "patch " + std::to_string(k));
  }
}

TEST(SupportQuery, ExtremeWeights) {
  Random random(11);
  for (int k = 0; k < 40; ++k) {
    const double weights = log_uniform(random, 1e2, k % 2 == 0 ? 1e3 : 1e6);
    const BezierPatch patch = random_patch(random, {1, 9}, weights);
    const Scene scene = make_scene(of_patch(patch));
    expect_support(scene, reference(scene), random_directions(random, 5),
                   "weights up to " + std::to_string(weights));
  }
}

TEST(SupportQuery, HighDegrees) {
  Random random(12);
  for (const int degree : {9, 15, 25, 31}) {
    Shape shape = of_patch(random_patch(random, degree, 2, 1));
    shape.curves.push_back(as_nurbs(random_curve(random, degree, 2)));
    const Scene scene = make_scene(shape);
    expect_support(scene, reference(scene), random_directions(random, 10),
                   "degree " + std::to_string(degree));
  }
}

TEST(SupportQuery, MixedKindsOfElements) {
  Random random(13);
  Shape shape = sphere(0.5);
  for (int k = 0; k < 6; ++k) {
    shape.curves.push_back(as_nurbs(random_curve(random, pick(random, 1, 7), 3)));
    shape.points.push_back(random_point(random));
  }
  const Scene scene = make_scene(shape);
  expect_support(scene, reference(scene), directions(14, 100), "mixed", circle_rounding);
}

TEST(SupportQuery, OnePoint) {
  const Scene scene = make_scene({{}, {}, {{3, -4, 12}}});
  EXPECT_EQ(scene.diagonal(), 0);
  SupportQuery query(scene);
  const ModelSupport s = support(query, scene, {0, 0, 2});
  EXPECT_DOUBLE_EQ(s.h, 12);
  EXPECT_GE(s.h_bound, 12);
  EXPECT_LE(s.h_bound, 12 + 1e-11);
  EXPECT_EQ(s.point, dvec3(3, -4, 12));
  EXPECT_EQ(s.contact.kind, SourceKind::vertex);
}

TEST(SupportQuery, CollapsedToAPointOrASegment) {
  BezierPatch point{3, 3, std::vector<dvec4>(16, dvec4(1, 2, 3, 1))};
  const Scene one = make_scene(of_patch(point));
  SupportQuery query(one);
  EXPECT_NEAR(support(query, one, {1, 0, 0}).h, 1, 1e-15);
  EXPECT_NEAR(support(query, one, {0, 0, -1}).h, -3, 1e-15);
  Random random(15);
  BezierPatch flat = random_patch(random, 3, 3, 2);
  for (dvec4& p : flat.points) p.z = 0;
  const Scene plane = make_scene(of_patch(flat));
  expect_support(plane, reference(plane), random_directions(random, 20), "flat");
  for (dvec4& p : flat.points) p.y = 0;
  const Scene line = make_scene(of_patch(flat));
  // Across the line all points are equal: no more may be asked of the reference.
  expect_support(line, reference(line), random_directions(random, 5), "on a line");
}

TEST(SupportQuery, HintsOfAnyKindGiveTheSameAnswer) {
  Random random(16);
  Shape shape = teapot();
  shape.curves.push_back(as_nurbs(random_curve(random, 5, 3)));
  shape.points.push_back({3.4, 0, 2});
  const Scene scene = make_scene(shape);
  const Part& part = scene.model().parts()[0];
  const SupportTruth truth = reference(scene);
  for (const SupportBounds bounds : {SupportBounds::bezier_nets, SupportBounds::coons}) {
    SupportQuery query(scene, {}, bounds);
    SupportErrors errors;
    for (int k = 0; k < 40; ++k) {
      const dvec3 n = k < 6 ? special_directions(random)[std::size_t(k)] : random_direction(random);
      const Support cold = query(n);
      const SupportRange range = truth(n);
      const SupportTruth known = [&](const dvec3&) { return range; };
      const auto check = [&](const Contact& hint) {
        check_support(scene, known, n, query(n, hint), errors);
      };
      check(cold.contact);
      check({0, SourceKind::vertex, 0, 0, 0});
      check({0, SourceKind::edge, 0, uniform(random, 0, 1), 0});
      check(query(-n).contact);
      for (int j = 0; j < 10; ++j) {
        const double u = pick(random, 0, 3) == 0 ? pick(random, 0, 1) : uniform(random, 0, 1);
        check({0, SourceKind::face, pick(random, 0, int(part.patches().size()) - 1), u,
               uniform(random, 0, 1)});
      }
      Contact slightly_off = cold.contact;
      slightly_off.u = std::clamp(slightly_off.u + uniform(random, -1e-3, 1e-3), 0.0, 1.0);
      check(slightly_off);
    }
    expect_correct(errors, "hints");
  }
}

TEST(SupportQuery, HintsHelp) {
  const Scene scene = make_scene(teapot());
  SupportQuery cold(scene);
  SupportQuery warm(scene);
  Contact near;
  for (int k = 0; k < 1000; ++k) {
    const double t = 1e-3 * k;
    const dvec3 n = unit({std::cos(t), std::sin(t), 0.3});
    cold(n);
    near = warm(n, near).contact;
  }
  EXPECT_EQ(cold.queries(), 1000);
  EXPECT_EQ(warm.queries(), 1000);
  EXPECT_LT(warm.newton_iterations(), cold.newton_iterations());
  EXPECT_LE(warm.cells(), cold.cells());
}

TEST(SupportQuery, EarlierQueriesLeaveNoTrace) {
  const Scene scene = make_scene(teapot());
  Random random(17);
  SupportQuery used(scene);
  for (int k = 0; k < 50; ++k) {
    const dvec3 n = random_direction(random);
    SupportQuery fresh(scene);
    const Support a = used(n);
    const Support b = fresh(n);
    EXPECT_EQ(a.h, b.h);
    EXPECT_EQ(a.h_bound, b.h_bound);
    EXPECT_EQ(a.contact.element, b.contact.element);
    EXPECT_EQ(a.contact.u, b.contact.u);
    EXPECT_EQ(a.contact.v, b.contact.v);
  }
}

Model placed(const Shape& shape, const std::vector<RigidMotion>& poses) {
  Model model = make_model(shape);
  model.clear_instances();
  for (const RigidMotion& pose : poses) model.add_instance(0, pose);
  return model;
}

TEST(SupportQuery, InstancesMovedAndRotated) {
  Random random(18);
  std::vector<RigidMotion> poses = {{}};
  for (int k = 0; k < 8; ++k) {
    poses.push_back({k == 0 ? dmat3(1.0) : random_rotation(random), 10.0 * random_point(random)});
  }
  const Scene scene(placed(teapot(), poses));
  expect_support(scene, reference(scene), directions(19, 10), "nine teapots");
}

TEST(SupportQuery, InstancesFarApartAndFarFromTheOrigin) {
  Random random(20);
  const BezierPatch patch = random_patch(random, 3, 3, 2);
  const Scene apart(placed(of_patch(patch), {{random_rotation(random), {1e8, 0, 3}},
                                             {random_rotation(random), {-1e8, 1e7, 0}}}));
  expect_support(apart, reference(apart), random_directions(random, 20), "1e8 apart");
  const Scene far(placed(of_patch(patch), {{random_rotation(random), {1e8, -3e7, 0.3}}}));
  expect_support(far, reference(far), random_directions(random, 20), "one at 1e8");
  const Scene pair(placed(of_patch(patch), {{random_rotation(random), {1e8, -3e7, 0.3}},
                                            {random_rotation(random), {1e8 + 1.1, -3e7, 0.3}}}));
  expect_support(pair, reference(pair), random_directions(random, 20), "two at 1e8");
}

TEST(SupportQuery, PartsFarFromTheirOwnOrigin) {
  Random random(21);
  for (const double far : {1e3, 1e8, 1e12}) {
    const Shape shape =
        shifted(of_patch(random_patch(random, 3, 4, 3)) + box(0.5, 0.6, 0.7), {far, -far, far / 7});
    const Scene scene = make_scene(shape);
    // The contact's point is evaluated in long double, 2^-64 of the coordinates' size.
    expect_support(scene, reference(scene), directions(22, 10), "at " + std::to_string(far), 0,
                   1e-14 + 2 * far * 0x1p-63);
  }
}

TEST(SupportQuery, SizesFromTinyToHuge) {
  Random random(23);
  const Shape shape = of_patch(random_patch(random, 3, 4, 3)) + sphere(0.9);
  for (const double size : {1e-300, 1e-200, 1e-6, 1e6, 1e200, 1e300}) {
    const Scene scene = make_scene(scaled(shape, size));
    const std::string name = "size 1e" + std::to_string(int(std::lround(std::log10(size))));
    ASSERT_TRUE(std::isfinite(scene.diagonal())) << name;
    ASSERT_GT(scene.diagonal(), 1.5 * size) << name;
    expect_support(scene, reference(scene), directions(24, 10), name);
  }
}

TEST(SupportQuery, SubnormalSize) {
  const Scene scene = make_scene({{}, {}, {{0, 0, 0}, {5e-324, 0, 0}, {0, 1e-323, 0}}});
  SupportQuery query(scene);
  const ModelSupport s = support(query, scene, {0, 1, 0});
  EXPECT_EQ(s.h, 1e-323);
  EXPECT_EQ(s.point, dvec3(0, 1e-323, 0));
}

TEST(SupportQuery, Needle) {
  const Scene scene = make_scene(mapped(ellipsoid(1e6, 1, 1), skew_rotation()));
  expect_support(scene, reference(scene), directions(25, 20), "needle");
}

TEST(SupportQuery, InModelCoordinates) {
  const Shape shape = shifted(ellipsoid(3, 2, 1), {10, 20, 30});
  const Scene scene = make_scene(shape);
  SupportQuery query(scene);
  Random random(26);
  for (int k = 0; k < 200; ++k) {
    // Any length will do.
    const dvec3 d = log_uniform(random, 1e-300, 1e300) * random_direction(random);
    const rvec3 n = glm::normalize(rvec3(unit(d)));
    const real truth = glm::dot(n, rvec3(10, 20, 30)) + glm::length(rvec3(3, 2, 1) * n);
    const ModelSupport s = support(query, scene, d);
    EXPECT_NEAR(double(s.h - truth), 0, 1e-13);
    EXPECT_GE(s.h_bound, truth - 1e-15L);
    EXPECT_LE(s.h_bound, truth + 1e-11L);
    EXPECT_NEAR(double(glm::dot(rvec3(s.point), n) - truth), 0, 1e-13);
    EXPECT_GE(s.contact.source, 0);
  }
}

TEST(SupportQuery, RefusesDirectionsThatAreNone) {
  const Scene scene = make_scene(sphere());
  SupportQuery query(scene);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinite = std::numeric_limits<double>::infinity();
  EXPECT_THROW(support(query, scene, {0, 0, 0}), InvalidInput);
  EXPECT_THROW(support(query, scene, {nan, 0, 1}), InvalidInput);
  EXPECT_THROW(support(query, scene, {0, infinite, 1}), InvalidInput);
  EXPECT_NO_THROW(support(query, scene, {5e-324, 0, 0}));
}

}  // namespace
}  // namespace taut
