#include "taut/bounds/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "freeform.h"
#include "hull_checks.h"
#include "support_checks.h"
#include "taut/bounds/model_support.h"
#include "taut/bounds/scene_content.h"
#include "taut/core/error.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and reference answers

void expect_box(const Scene& scene, const dvec3& lower, const dvec3& upper,
                const std::string& name) {
  const double length = diagonal({lower, upper});
  for (int i = 0; i < 3; ++i) {
    // A query's value may be below the truth by a share of the scene's size.
    EXPECT_NEAR(scene.box().lower[i], lower[i], 1e-12 * length) << name << " " << i;
    EXPECT_NEAR(scene.box().upper[i], upper[i], 1e-12 * length) << name << " " << i;
  }
  EXPECT_NEAR(scene.diagonal(), length, 1e-12 * length) << name;
}

void expect_frame(const Scene& scene, const std::string& name) {
  const SceneFrame& frame = scene.frame();
  int exponent = 0;
  EXPECT_EQ(std::frexp(frame.scale, &exponent), 0.5) << name;
  Box control;
  for (const Instance& instance : scene.model().instances()) {
    const Box& box = scene.model().parts()[std::size_t(instance.part)].control_box();
    for (int k = 0; k < 8; ++k) {
      const dvec3 corner((k & 1) != 0 ? box.upper.x : box.lower.x,
                         (k & 2) != 0 ? box.upper.y : box.lower.y,
                         (k & 4) != 0 ? box.upper.z : box.lower.z);
      control.include(frame.to_frame(instance.pose(corner)));
    }
  }
  const double size =
      std::max({std::abs(control.lower.x), std::abs(control.lower.y), std::abs(control.lower.z),
                std::abs(control.upper.x), std::abs(control.upper.y), std::abs(control.upper.z)});
  EXPECT_LE(size, 1 + 1e-12) << name;
  EXPECT_GE(size, 0.5 - 1e-12) << name;
}

TEST(SceneFrame, MapsThereAndBack) {
  const SceneFrame frame{{1, 2, 3}, 0.25};
  EXPECT_EQ(frame.to_frame({5, 2, -1}), dvec3(1, 0, -1));
  EXPECT_EQ(frame.to_model({1, 0, -1}), dvec3(5, 2, -1));
  EXPECT_EQ(frame.length_to_model(3), 12);
}

TEST(Scene, BoxAndDiagonalOfKnownModels) {
  struct Case {
    std::string name;
    Shape shape;
    dvec3 lower, upper;
  };
  const std::vector<Case> cases = {
      {"box", box(1, 2, 3), {0, 0, 0}, {1, 2, 3}},
      {"sphere", sphere(2), dvec3(-2), dvec3(2)},
      {"ellipsoid", ellipsoid(3, 2, 1), {-3, -2, -1}, {3, 2, 1}},
      {"torus", torus(2, 0.5), {-2.5, -2.5, -0.5}, {2.5, 2.5, 0.5}},
      {"cone", cone(1, 2), {-1, -1, 0}, {1, 1, 2}},
      {"oloid", oloid(), {-1, -1, -1}, {2, 1, 1}},
      {"twisted cubic", {{}, {twisted_cubic()}, {}}, {0, 0, 0}, {1, 1, 1}},
      // The control box reaches down to -2.
      {"paraboloid", paraboloid(), {-1, -1, 0}, {1, 1, 2}},
      {"saddle", saddle(), {-1, -1, -1}, {1, 1, 1}},
      {"points", {{}, {}, {{1, 5, 2}, {3, 4, 8}}}, {1, 4, 2}, {3, 5, 8}},
  };
  for (const Case& c : cases) {
    const Scene scene = make_scene(c.shape);
    expect_box(scene, c.lower, c.upper, c.name);
    expect_frame(scene, c.name);
    for (const double size : {1e-300, 1e-20, 1e20, 1e300}) {
      const Scene other = make_scene(scaled(c.shape, size));
      const std::string name = c.name + " times " + std::to_string(std::log10(size));
      expect_box(other, size * c.lower, size * c.upper, name);
      expect_frame(other, name);
    }
    const dvec3 shift(0x1p20, -0x1p21, 0x1p19);
    const Scene far = make_scene(shifted(c.shape, shift));
    expect_frame(far, c.name + " far");
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(far.box().lower[i], c.lower[i] + shift[i], 1e-9) << c.name;
      EXPECT_NEAR(far.box().upper[i], c.upper[i] + shift[i], 1e-9) << c.name;
    }
    EXPECT_NEAR(far.diagonal(), scene.diagonal(), 1e-9);
  }
}

TEST(Scene, BoxOfTheTeapot) {
  const Scene scene = make_scene(teapot());
  const ReferenceSupport truth(scene.model());
  dvec3 lower, upper;
  for (int i = 0; i < 3; ++i) {
    dvec3 n(0.0);
    n[i] = 1;
    upper[i] = double(truth(n).lower);
    lower[i] = -double(truth(-n).lower);
  }
  expect_box(scene, lower, upper, "teapot");
}

TEST(Scene, OnePointHasNoSize) {
  const Scene scene = make_scene({{}, {}, {{1, -2, 3}}});
  EXPECT_EQ(scene.diagonal(), 0);
  EXPECT_EQ(scene.box().lower, dvec3(1, -2, 3));
  EXPECT_EQ(scene.box().upper, dvec3(1, -2, 3));
  EXPECT_EQ(scene.point({0, SourceKind::vertex, 0, 0, 0}), dvec3(1, -2, 3));
}

/// Contacts anywhere: on all sides, at all corners, inside.
std::vector<Contact> contacts(const Scene& scene, Random& random) {
  std::vector<Contact> result;
  for (int i = 0; i < int(scene.model().instances().size()); ++i) {
    const Instance& instance = scene.model().instances()[std::size_t(i)];
    const Part& part = scene.model().parts()[std::size_t(instance.part)];
    const auto places = [&](SourceKind kind, int element, bool surface) {
      for (const double u : {0.0, 1.0, 0.5, uniform(random, 0, 1)}) {
        for (const double v : {0.0, 1.0, uniform(random, 0, 1)}) {
          result.push_back({i, kind, element, u, surface ? v : 0});
        }
      }
    };
    for (int k = 0; k < int(part.patches().size()); ++k) places(SourceKind::face, k, true);
    for (int k = 0; k < int(part.pieces().size()); ++k) {
      const int edge = part.pieces()[std::size_t(k)].edge;
      if (edge < 0) break;  // seams
      if (part.edges()[std::size_t(edge)].faces.empty()) places(SourceKind::edge, k, false);
    }
    for (int k = 0; k < part.point_count(); ++k) result.push_back({i, SourceKind::vertex, k, 0, 0});
  }
  return result;
}

/// point() and source() agree with de Casteljau on the model.
void expect_contacts(const Scene& scene, double accuracy, const std::string& name) {
  Random random(1);
  const dvec3 center = scene.frame().center;
  real point_error = 0;
  real source_error = 0;
  for (const Contact& contact : contacts(scene, random)) {
    const rvec3 x = contact_point(scene, contact) + rvec3(center);
    point_error = std::max(point_error, glm::length(rvec3(scene.point(contact)) - x));
    const SourceContact on = scene.source(contact);
    ASSERT_GE(on.source, 0) << name;
    ASSERT_LT(on.source, scene.model().source_count()) << name;
    const Source source = scene.model().source(on.source);
    EXPECT_EQ(source.instance, contact.instance) << name;
    EXPECT_EQ(source.kind, on.kind) << name;
    source_error =
        std::max(source_error, glm::length(source_point(scene.model(), on.source, on.u, on.v) - x));
  }
  EXPECT_LE(point_error, accuracy * scene.diagonal()) << name;
  EXPECT_LE(source_error, accuracy * scene.diagonal()) << name;
}

TEST(Scene, ContactsHavePointsAndSources) {
  const std::vector<std::pair<std::string, Shape>> shapes = {
      {"box", box(1, 2, 3)},
      {"sphere", sphere()},
      {"cone", cone(1, 2)},
      {"torus", torus(2, 0.5)},
      {"oloid", oloid()},
      {"filleted box", filleted_box(1, 2, 3, 0.2)},
      {"saddle", saddle()},
      {"points", {{}, {}, {{1, 2, 3}, {4, 5, 6}}}},
      {"mixed", box(1, 1, 1) + oloid() + Shape{{}, {twisted_cubic()}, {{5, 5, 5}}}}};
  for (const auto& [name, shape] : shapes) {
    expect_contacts(make_scene(shape), 1e-15, name);
    expect_contacts(make_scene(mapped(shape, skew_rotation(), {0.1, 0.2, 0.3})), 1e-14,
                    name + " turned");
  }
  // Borders of the teapot's patches that meet in an edge agree to a few rounding units only.
  expect_contacts(make_scene(teapot()), 1e-7, "teapot");
}

/// Numbers of contacts by the kind of their source.
struct Kinds {
  std::set<int> faces, edges, vertices;
};

Kinds kinds(const Scene& scene) {
  Random random(2);
  Kinds result;
  for (const Contact& contact : contacts(scene, random)) {
    const SourceContact on = scene.source(contact);
    (on.kind == SourceKind::face   ? result.faces
     : on.kind == SourceKind::edge ? result.edges
                                   : result.vertices)
        .insert(on.source);
  }
  return result;
}

TEST(Scene, BordersBelongToEdgesAndCornersToVertices) {
  const Kinds of_box = kinds(make_scene(box(1, 2, 3)));
  EXPECT_EQ(of_box.faces.size(), 6U);
  EXPECT_EQ(of_box.edges.size(), 12U);
  EXPECT_EQ(of_box.vertices.size(), 8U);
  // Smooth everywhere, poles included.
  const Kinds of_sphere = kinds(make_scene(sphere()));
  EXPECT_EQ(of_sphere.faces.size(), 1U);
  EXPECT_TRUE(of_sphere.edges.empty());
  EXPECT_TRUE(of_sphere.vertices.empty());
  const Kinds of_cone = kinds(make_scene(cone(1, 2)));
  EXPECT_EQ(of_cone.faces.size(), 1U);
  EXPECT_EQ(of_cone.edges.size(), 1U);
  EXPECT_EQ(of_cone.vertices.size(), 1U);
  const Kinds of_cylinder = kinds(make_scene(cylinder(1, 2)));
  EXPECT_EQ(of_cylinder.faces.size(), 1U);
  EXPECT_EQ(of_cylinder.edges.size(), 2U);
  EXPECT_TRUE(of_cylinder.vertices.empty());
}

TEST(Scene, SourcesOfAPatchByHand) {
  const Scene scene = make_scene(bilinear_saddle());
  const Model& model = scene.model();
  const SourceContact inside = scene.source({0, SourceKind::face, 0, 0.25, 0.75});
  EXPECT_EQ(inside.kind, SourceKind::face);
  EXPECT_EQ(inside.source, model.source_id({SourceKind::face, 0, 0}));
  EXPECT_EQ(inside.u, 0.25);
  EXPECT_EQ(inside.v, 0.75);
  EXPECT_EQ(scene.point({0, SourceKind::face, 0, 0.25, 0.75}), dvec3(-0.5, 0.5, -0.25));
  EXPECT_EQ(scene.source({0, SourceKind::face, 0, 0, 0.75}).kind, SourceKind::edge);
  EXPECT_EQ(scene.source({0, SourceKind::face, 0, 5e-324, 0.75}).kind, SourceKind::face);
  const SourceContact corner = scene.source({0, SourceKind::face, 0, 0, 1});
  EXPECT_EQ(corner.kind, SourceKind::vertex);
  const Source vertex = model.source(corner.source);
  EXPECT_EQ(model.parts()[0].vertices()[std::size_t(vertex.index)], dvec3(-1, 1, -1));
}

TEST(Scene, ParametersOfMultiplePatchesAreTheFaces) {
  // Four quarters about the axis, over [0, 4], and two up, over [0, 2].
  const Scene scene = make_scene(sphere());
  std::set<double> whole_u, whole_v;
  for (int k = 0; k < 8; ++k) {
    const SourceContact on = scene.source({0, SourceKind::face, k, 0.5, 0.5});
    EXPECT_EQ(on.kind, SourceKind::face);
    whole_u.insert(on.u);
    whole_v.insert(on.v);
  }
  EXPECT_EQ(whole_u, (std::set<double>{0.5, 1.5, 2.5, 3.5}));
  EXPECT_EQ(whole_v, (std::set<double>{0.5, 1.5}));
}

TEST(Scene, QueriesAtCornersEdgesAndFaces) {
  const Scene scene = make_scene(box(1, 2, 3));
  SupportQuery query(scene);
  const auto kind = [&](const dvec3& n) { return support(query, scene, n).contact.kind; };
  EXPECT_EQ(kind({1, 1, 1}), SourceKind::vertex);
  EXPECT_EQ(kind({-1, 1e-3, 1}), SourceKind::vertex);
  EXPECT_NE(kind({1, 1, 0}), SourceKind::face);
  const Scene round = make_scene(filleted_box(1, 2, 3, 0.2));
  SupportQuery round_query(round);
  EXPECT_EQ(support(round_query, round, {1, 2, 3}).contact.kind, SourceKind::face);
}

TEST(Scene, Instances) {
  Random random(3);
  Model model = make_model(box(1, 2, 3));
  Part ball;
  ball.add_surface(sphere().surfaces[0], "ball");
  const int second = model.add_part(std::move(ball), smooth_join_angle);
  model.clear_instances();
  model.add_instance(0, {dmat3(1.0), {10, 0, 0}});
  model.add_instance(second, {random_rotation(random), {0, 20, 0}});
  // A quarter turn about z takes (x, y) to (-y, x).
  model.add_instance(0, {dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1), {-5, 0, 0}});
  const Scene scene(model);
  expect_box(scene, {-7, -0.0, -1}, {11, 21, 3}, "instances");
  expect_frame(scene, "instances");
  expect_contacts(scene, 1e-15, "instances");
  const Kinds found = kinds(scene);
  EXPECT_EQ(found.faces.size(), 13U);
  EXPECT_EQ(found.edges.size(), 24U);
  EXPECT_EQ(found.vertices.size(), 16U);
}

TEST(Scene, PartsWithoutInstancesDoNotCount) {
  Model model = make_model(shifted(sphere(), {100, 0, 0}));
  model.clear_instances();
  Part part;
  part.add_point({1, 2, 3});
  part.add_point({2, 4, 6});
  model.add_part(std::move(part), smooth_join_angle);
  const Scene scene(model);
  expect_box(scene, {1, 2, 3}, {2, 4, 6}, "two points");
}

/// Largest x . n over the control points of a part's cell.
double highest(const ScenePart& part, int cell, const dvec3& n) {
  const SceneNet& net = part.cells[std::size_t(cell)].net;
  double result = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < net.x.size(); ++k) {
    result = std::max(result, glm::dot(dvec3(net.x[k], net.y[k], net.z[k]), n) / net.w[k]);
  }
  return result;
}

/// The same over all cells below a node, all of which the node's slab must bound.
double expect_bound_below(const ScenePart& part, std::size_t index, const dvec3& n) {
  const BoxTree& tree = part.tree;
  const BoxTree::Node& node = tree.nodes[index];
  const auto first = std::size_t(node.first);
  double result = -std::numeric_limits<double>::infinity();
  if (node.count == 0) {
    for (const std::size_t k : {first, first + 1}) {
      result = std::max(result, expect_bound_below(part, k, n));
    }
  }
  for (std::size_t k = first; k < first + std::size_t(node.count); ++k) {
    const double own = highest(part, tree.items[k], n);
    EXPECT_GE(tree.slab_bound(k, n), own);
    result = std::max(result, own);
  }
  EXPECT_GE(node.slab_bound(n), result);
  return result;
}

TEST(Scene, SlabsBoundWhatIsBelowThem) {
  Random random(7);
  Dent dent;
  dent.direction = random_direction(random);
  for (Shape shape : {torus(2, 0.5), dented_body({dent})}) {
    for (int k = 0; k < 4; ++k) shape = split(shape, 0.5, 0.5);
    const Scene scene = make_scene(shape);
    const ScenePart& part = scene.content().parts.at(0);
    ASSERT_EQ(part.tree.slabs.size(), part.cells.size());
    std::vector<dvec3> normals = special_directions(random);
    for (const dvec3& n : random_directions(random, 30)) normals.push_back(n);
    for (const dvec3& n : normals) expect_bound_below(part, 0, n);
  }
}

/// Across the plane of a small piece of surface its slab is far thinner than its box.
TEST(Scene, SlabsAreThin) {
  Shape shape = torus(2, 0.5);
  for (int k = 0; k < 4; ++k) shape = split(shape, 0.5, 0.5);
  const Scene scene = make_scene(shape);
  const BoxTree& tree = scene.content().parts.at(0).tree;
  int thin = 0;
  for (std::size_t k = 0; k < tree.slabs.size(); ++k) {
    const Slab& slab = tree.slabs[k];
    const dvec3 half(tree.half[0][k], tree.half[1][k], tree.half[2][k]);
    thin += 10 * (slab.upper - slab.lower) < 2 * glm::dot(half, glm::abs(slab.normal)) ? 1 : 0;
  }
  EXPECT_GT(10 * thin, 9 * int(tree.slabs.size()));
}

TEST(Scene, MemoryIsSharedByInstances) {
  const Scene point = make_scene({{}, {}, {{1, 2, 3}}});
  EXPECT_GT(point.memory(), 0U);
  const Scene one = make_scene(teapot());
  EXPECT_GT(one.memory(), 32 * 16 * 3 * sizeof(double));  // the control points alone
  EXPECT_LT(one.memory(), 100'000'000U);
  EXPECT_LT(10 * point.memory(), one.memory());
  Model model = make_model(teapot());
  for (int k = 0; k < 99; ++k) model.add_instance(0, {dmat3(1.0), {k, 0, 0}});
  EXPECT_LT(Scene(model).memory(), 2 * one.memory());
}

/// The teapot at rest and turned, each of them more than once: as instances and as parts.
Model copied_teapots() {
  const Model one = make_model(teapot());
  Model model = one;
  const RigidMotion turned{{0.6, 0.8, 0, -0.8, 0.6, 0, 0, 0, 1}, {9, 2, 3}};
  RigidMotion same = turned;
  same.rotation[0][2] = -0.0;
  model.add_instance(0, turned);
  model.add_part(one.parts()[0], 0);
  model.add_instance(1, same);
  model.add_instance(0, RigidMotion{});
  return model;
}

TEST(Scene, ExactCopiesAreThereOnce) {
  const Scene one = make_scene(teapot());
  const Scene scene(copied_teapots(), {.threads = 1, .progress = {}});
  EXPECT_EQ(scene.distinct_instances(), (std::vector<int>{0, 1}));
  for (int k = 0; k < 5; ++k) EXPECT_EQ(scene.first_instance(k), std::vector({0, 1, 0, 1, 0})[k]);
  EXPECT_EQ(scene.patch_count(), 64);
  EXPECT_EQ(scene.model().patch_count(), 5 * 32);
  EXPECT_LT(scene.memory(), 1.01 * double(one.memory()));
  const Scene all(posed_teapots(1, 7), {.threads = 1, .progress = {}});
  EXPECT_EQ(all.distinct_instances().size(), 7U);
  EXPECT_EQ(all.patch_count(), all.model().patch_count());
}

/// They keep their points and sources, but queries answer with the first, whatever they begin with.
TEST(Scene, ContactsOnExactCopies) {
  const Scene scene(copied_teapots(), {.threads = 1, .progress = {}});
  const Model& model = scene.model();
  SupportQuery query(scene);
  Random random(3);
  for (int k = 0; k < 200; ++k) {
    const int patch = pick(random, 0, 31);
    const double u = uniform(random, 0, 1);
    const Contact first{pick(random, 0, 1), SourceKind::face, patch, u, 0.25};
    Contact copy = first;
    copy.instance += 2;
    EXPECT_EQ(scene.point(first), scene.point(copy));
    EXPECT_EQ(model.source(scene.source(copy).source).instance, copy.instance);
    EXPECT_EQ(model.source(scene.source(copy).source).index,
              model.source(scene.source(first).source).index);
    const dvec3 n = random_direction(random);
    const Support s = query(n, copy);
    EXPECT_LT(s.contact.instance, 2);
    EXPECT_EQ(s.h, query(n, first).h);
  }
}

TEST(Scene, SameForAnyNumberOfThreads) {
  const Scene one = make_scene(teapot(), 1);
  for (const int threads : {2, 0}) {
    const Scene other = make_scene(teapot(), threads);
    EXPECT_EQ(one.memory(), other.memory());
    EXPECT_EQ(one.box().lower, other.box().lower);
    EXPECT_EQ(one.box().upper, other.box().upper);
    EXPECT_EQ(one.diagonal(), other.diagonal());
  }
}

TEST(Scene, MovedScenesKeepTheirContent) {
  Scene scene = make_scene(box(1, 2, 3));
  const Scene moved = std::move(scene);
  expect_box(moved, {0, 0, 0}, {1, 2, 3}, "moved");
  scene = make_scene(sphere());
  expect_box(scene, dvec3(-1), dvec3(1), "assigned");
}

TEST(Scene, RefusesModelsWithoutGeometry) {
  EXPECT_THROW(Scene{Model{}}, InvalidInput);
  Model without_instances = make_model(sphere());
  without_instances.clear_instances();
  EXPECT_THROW(Scene{without_instances}, InvalidInput);
  Model with_empty_part;
  with_empty_part.add_part(Part{}, smooth_join_angle);
  EXPECT_THROW(Scene{with_empty_part}, InvalidInput);
}

TEST(Scene, CanBeCancelled) {
  std::stop_source stop;
  stop.request_stop();
  SceneOptions options{.threads = 1, .progress = {}};
  options.progress.stop = stop.get_token();
  EXPECT_THROW(Scene(make_model(sphere()), options), Cancelled);
}

}  // namespace
}  // namespace taut
