#include "taut/hull/precise_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <ostream>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "boundary_checks.h"
#include "hull_checks.h"
#include "taut/core/error.h"
#include "taut/hull/exact_boundary.h"
#include "taut/hull/measure/boundary_measures.h"
#include "taut/hull/solve/solved_graph.h"
#include "taut/hull/solve/tolerant_places.h"
#include "taut/hull/stitch/stitch.h"
#include "truths.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and checks

/// How many of each an exact boundary has.
struct Counts {
  int patches = 0;
  int scrolls = 0;
  int facets = 0;
  int curves = 0;
  bool operator==(const Counts&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Counts& c) {
  return out << "patches " << c.patches << ", scrolls " << c.scrolls << ", facets " << c.facets
             << ", curves " << c.curves;
}

Counts counts(const HullBoundary& boundary) {
  return {boundary.count(FaceKind::patch), boundary.count(FaceKind::scroll),
          boundary.count(FaceKind::facet), int(boundary.curves.size())};
}

int curve_count(const HullBoundary& boundary, HullCurveKind kind) {
  return int(std::count_if(boundary.curves.begin(), boundary.curves.end(),
                           [&](const HullCurve& curve) { return curve.kind == kind; }));
}

HullOptions options(double relative = 1e-2, int threads = 1) {
  return {.relative = relative, .threads = threads, .progress = {}};
}

/// The boundary alone, without a mesh.
Hull boundary_of(const Scene& scene, int threads = 1) {
  Hull hull;
  hull.kind = HullKind::solid;
  hull.boundary = std::make_shared<const HullBoundary>(
      exact_boundary(scene, options(1e-2, threads), hull.statistics));
  return hull;
}

BoundaryMeasures measures_of(const Scene& scene, const Hull& hull) {
  return measure(scene, ContactGeometry(scene), *hull.boundary);
}

void expect_complete(const HullBoundary& boundary) {
  for (const Unresolved& spot : boundary.unresolved) {
    ADD_FAILURE() << spot.reason << " at (" << spot.n.x << ", " << spot.n.y << ", " << spot.n.z
                  << ")";
  }
}

Truth truth_named(const std::string& name) {
  for (const Truth& truth : truths()) {
    if (truth.name == name) return truth;
  }
  throw InvalidInput("no truth is called " + name);
}

struct ExactCase {
  const char* name;
  Counts counts;
  int edges = 0;    ///< of the curves
  int rulings = 0;  ///< of the curves; the others are bitangents
};

/// Of every truth.
const std::vector<ExactCase>& exact_cases() {
  static const std::vector<ExactCase> all = {
      {"spheres 1 and 1, 3 apart", {2, 1, 0, 2}},
      {"spheres 1 and 0.5, 3 apart", {2, 1, 0, 2}},
      {"spheres 1 and 0.5, 2 apart", {2, 1, 0, 2}},
      {"sphere and point", {1, 1, 0, 1}},
      {"torus 2, 0.5", {1, 0, 2, 2}},
      {"torus 1, 0.25", {1, 0, 2, 2}},
      {"oloid", {0, 1, 0, 2}, 2},
      // Half a circle each, from where they cross to where they cross again.
      {"perpendicular circles", {0, 4, 0, 4}, 4},
      {"tori like an oloid", {2, 1, 0, 2}},
      {"tori about one centre", {4, 4, 0, 8}},
      {"tori about one centre, one turned", {4, 4, 0, 8}},
      {"three spheres", {3, 3, 2, 12}, 0, 6},
      {"four spheres", {4, 6, 4, 24}, 0, 12},
      {"eight spheres", {8, 12, 6, 48}, 0, 24},
      {"ellipsoid", {1, 0, 0, 0}},
      {"two ellipsoids", {2, 1, 0, 2}},
      {"cylinder", {0, 1, 2, 2}, 2},
      {"solid cylinder", {0, 1, 2, 2}, 2},
      {"cone", {0, 1, 1, 1}, 1},
      {"frustum", {0, 1, 2, 2}, 2},
      {"box", {0, 0, 6, 12}, 0, 12},
      {"filleted box", {8, 12, 6, 48}, 0, 24},
      {"cap", {1, 0, 1, 1}, 1},
      {"sphere without a cap", {1, 0, 1, 1}, 1},
      // A parabola and its chord bound each wall; the four chords bound the top.
      {"paraboloid", {1, 0, 5, 8}, 4, 4},
      {"bilinear saddle", {0, 0, 4, 6}, 0, 6},
      // Parabolic cylinders z = x^2 - 1 and z = 1 - y^2 between walls as above.
      {"saddle", {0, 2, 4, 8}, 4, 4},
      {"twisted cubic", {0, 2, 0, 2}, 1, 1},
      {"teapot", {28, 15, 10, 116}, -1, -1},
      // The curves along both ends of the rulings meet in two free ends.
      {"dented ellipsoid", {1, 1, 0, 2}},
  };
  return all;
}

void expect_truth(const Scene& scene, const Hull& hull, const Truth& truth, real relative = 1e-9L) {
  const BoundaryMeasures measured = measures_of(scene, hull);
  const real known = truth.uncertainty;
  EXPECT_NEAR(double(measured.volume), double(truth.volume),
              double(relative * truth.volume + known));
  if (truth.area >= 0) {
    EXPECT_NEAR(double(measured.area), double(truth.area), double(relative * truth.area + known));
  }
  EXPECT_LE(measured.accuracy, relative);
}

TEST(PreciseHull, EveryTruthIsExact) {
  EXPECT_EQ(exact_cases().size(), truths().size());
  for (const ExactCase& exact : exact_cases()) EXPECT_NO_THROW(truth_named(exact.name));
}

void expect_structure(const HullBoundary& boundary, const ExactCase& exact) {
  expect_complete(boundary);
  EXPECT_EQ(counts(boundary), exact.counts);
  if (exact.edges < 0) return;
  EXPECT_EQ(curve_count(boundary, HullCurveKind::edge), exact.edges);
  EXPECT_EQ(curve_count(boundary, HullCurveKind::ruling), exact.rulings);
  EXPECT_EQ(curve_count(boundary, HullCurveKind::join), 0);
}

TEST(PreciseHull, ClosedFormsAndTheirStructure) {
  for (const ExactCase& exact : exact_cases()) {
    for (const bool turned : {false, true}) {
      SCOPED_TRACE(exact.name + std::string(turned ? ", turned" : ""));
      const Truth truth = truth_named(exact.name);
      const dmat3 turn = turned ? skew_rotation() : dmat3(1.0);
      const Scene scene = make_scene(mapped(truth.shape, turn));
      const Hull hull = boundary_of(scene);
      expect_structure(*hull.boundary, exact);
      expect_truth(scene, hull, truth);
      const BoundaryFacts facts = boundary_facts(scene, hull, 100);
      EXPECT_TRUE(facts.sound()) << facts;
    }
  }
}

/// Turned and at any size, the same counts and measures.
TEST(PreciseHull, StructureIsInvariant) {
  for (const ExactCase& exact : exact_cases()) {
    const Truth truth = truth_named(exact.name);
    for (const double s : {1e-6, 1e6}) {
      SCOPED_TRACE(std::string(exact.name) + " of size " + std::to_string(s));
      const Scene scene =
          make_scene(scaled(mapped(truth.shape, skew_rotation(), {0.1, -0.2, 0.3}), s));
      const Hull hull = boundary_of(scene);
      expect_structure(*hull.boundary, exact);
      const BoundaryMeasures measured = measures_of(scene, hull);
      const double known = double(truth.uncertainty);
      EXPECT_NEAR(measured.volume / (s * s * s), double(truth.volume),
                  1e-9 * double(truth.volume) + known);
      if (truth.area >= 0) {
        EXPECT_NEAR(measured.area / (s * s), double(truth.area), 1e-9 * double(truth.area) + known);
      }
    }
  }
}

/// Of a curve alone few directions are sampled: where these show its ends only, the mesh meets what
/// lies between them.
TEST(PreciseHull, TurnedCurvesAreFound) {
  const Truth truth = truth_named("twisted cubic");
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    const Scene scene = make_scene(mapped(truth.shape, random_rotation(random)));
    const Hull hull = precise_hull(scene, options());
    expect_complete(*hull.boundary);
    EXPECT_EQ(counts(*hull.boundary), (Counts{0, 2, 0, 2}));
    expect_truth(scene, hull, truth);
  }
}

/// Far away the surfaces' pieces no longer meet exactly: the structure stays where it does not
/// depend on that.
TEST(PreciseHull, StructureHoldsFarAway) {
  for (const char* name : {"oloid", "twisted cubic"}) {
    SCOPED_TRACE(name);
    const Truth truth = truth_named(name);
    const double D = make_scene(truth.shape).diagonal();
    const Scene scene = make_scene(
        shifted(mapped(truth.shape, skew_rotation()), 1e6 * D * dvec3(0.48, -0.6, 0.64)));
    const Hull hull = boundary_of(scene);
    expect_complete(*hull.boundary);
    const double rounding = 32 * 1e6 * std::numeric_limits<double>::epsilon();
    expect_truth(scene, hull, truth, 100 * rounding);
  }
}

TEST(PreciseHull, Teapot) {
  const Scene scene = make_scene(teapot());
  const Hull hull = precise_hull(scene, options(1e-3));
  expect_complete(*hull.boundary);
  EXPECT_EQ(counts(*hull.boundary), (Counts{28, 15, 10, 116}));
  const BoundaryFacts facts = boundary_facts(scene, hull, 300);
  EXPECT_TRUE(facts.sound()) << facts;
  const BoundaryMeasures measured = measures_of(scene, hull);
  EXPECT_LE(measured.accuracy, 1e-12);
  EXPECT_NEAR(measured.volume, 32.67038, 1e-5);
  EXPECT_NEAR(measured.area, 53.66226, 1e-5);
  expect_certified(scene, hull, 1e-3, {measured.volume, measured.area, 1e-9});
}

TEST(PreciseHull, Blobs) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    SCOPED_TRACE(seed);
    const Scene scene = make_scene(blob(seed));
    const Hull hull = precise_hull(scene, options(1e-3));
    expect_complete(*hull.boundary);
    const BoundaryFacts facts = boundary_facts(scene, hull, 200);
    EXPECT_TRUE(facts.sound()) << facts;
    const BoundaryMeasures measured = measures_of(scene, hull);
    EXPECT_LE(measured.accuracy, 1e-9);
    expect_certified(scene, hull, 1e-3, {measured.volume, measured.area, 1e-9}, 300);
  }
}

/// Every number that the boundary holds.
std::vector<double> bits_of(const Hull& hull) {
  std::vector<double> all;
  const auto add = [&](const dvec3& x) { all.insert(all.end(), {x.x, x.y, x.z}); };
  for (const SeparatingArc& arc : hull.boundary->arcs) {
    for (const ArcPiece& piece : arc.pieces) {
      for (const Ruling& r : piece.rulings) {
        add(r.n);
        for (const Contact& c : r.contact) all.insert(all.end(), {double(c.element), c.u, c.v});
        for (const dvec3& x : r.point) add(x);
      }
    }
  }
  for (const HullFace& face : hull.boundary->faces) {
    all.push_back(double(face.kind));
    all.push_back(face.source);
    add(face.n);
    for (const dvec3& x : face.points) add(x);
    for (const PatchRegion& region : face.regions) {
      all.insert(all.end(), {double(region.instance), double(region.patch)});
      for (const auto& loop : region.loops) {
        for (const TrimStretch& s : loop) {
          all.insert(all.end(), {double(s.arc), double(s.piece), double(s.curve), s.from, s.to});
        }
      }
    }
  }
  for (const HullCurve& curve : hull.boundary->curves) {
    all.insert(all.end(), {double(curve.kind), double(curve.faces[0]), double(curve.faces[1])});
    for (const dvec3& x : curve.points) add(x);
  }
  return all;
}

TEST(PreciseHull, SameBitsForAnyNumberOfThreads) {
  const Shape shape = blob(2) + shifted(blob(3), {1, 0.5, 0.2});
  const Scene scene = make_scene(shape);
  const Hull one = precise_hull(scene, options(1e-2, 1));
  const Hull four = precise_hull(scene, options(1e-2, 4));
  EXPECT_FALSE(bits_of(one).empty());
  EXPECT_TRUE(bits_of(one) == bits_of(four));
  EXPECT_EQ(one.distance_bound, four.distance_bound);
  EXPECT_TRUE(polygons(one.mesh).points == polygons(four.mesh).points);
  EXPECT_TRUE(polygons(one.mesh).polygons == polygons(four.mesh).polygons);
}

TEST(PreciseHull, OrderOfInstancesDoesNotMatter) {
  const Model model = posed_teapots(3, 4);
  Model turned = model;
  std::vector<Instance> instances(model.instances().begin(), model.instances().end());
  turned.clear_instances();
  for (auto i = instances.rbegin(); i != instances.rend(); ++i) {
    turned.add_instance(i->part, i->pose);
  }
  const Scene scene(model, {.threads = 1, .progress = {}});
  const Scene other(turned, {.threads = 1, .progress = {}});
  const Hull a = boundary_of(scene);
  const Hull b = boundary_of(other);
  expect_complete(*a.boundary);
  expect_complete(*b.boundary);
  EXPECT_EQ(counts(*a.boundary), counts(*b.boundary));
  const double volume = measures_of(scene, a).volume;
  EXPECT_NEAR(measures_of(other, b).volume, volume, 1e-11 * volume);
}

/// What a hull took, but for the time.
std::array<long, 5> efforts(const HullStatistics& s) {
  return {s.support_queries, s.newton_iterations, s.map_cells, s.map_candidates, s.map_contacts};
}

/// The same hull, of the first of the copies, at the same effort.
TEST(PreciseHull, OfExactCopies) {
  const Model once = make_model(teapot());
  const Hull hull = precise_hull(Scene(once, {.threads = 1, .progress = {}}), options());
  Model instances = once;
  instances.add_instance(0, RigidMotion{});
  instances.add_instance(0, RigidMotion{});
  Model parts = once;
  parts.add_part(once.parts()[0], 0);
  for (const Model& model : {instances, parts}) {
    const Hull copied = precise_hull(Scene(model, {.threads = 1, .progress = {}}), options());
    EXPECT_EQ(efforts(copied.statistics), efforts(hull.statistics));
    EXPECT_EQ(copied.distance_bound, hull.distance_bound);
    EXPECT_EQ(counts(*copied.boundary), counts(*hull.boundary));
    expect_complete(*copied.boundary);
    ASSERT_EQ(copied.mesh.n_vertices(), hull.mesh.n_vertices());
    for (const auto v : hull.mesh.vertices()) EXPECT_EQ(copied.mesh.point(v), hull.mesh.point(v));
    for (std::size_t k = 0; k < hull.boundary->faces.size(); ++k) {
      EXPECT_EQ(copied.boundary->faces[k].source, hull.boundary->faces[k].source);
    }
  }
}

/// Those of the map of directions, of solving and of stitching.
TEST(ExactBoundary, CountsAllQueries) {
  const Scene scene = make_scene(teapot());
  HullStatistics decided;
  const ContactGeometry geometry(scene, {}, same_elements_of(scene, options()));
  const DirectionMap directions = directions_of(geometry, options(), decided);
  EXPECT_GT(decided.support_queries, 0);
  HullStatistics statistics;
  exact_boundary(geometry, directions, options(), statistics);
  SupportQuery query(scene);
  SeparatingGraph graph = solved_graph(geometry, query, directions, {});
  HullBoundary boundary = stitch(geometry, query, std::move(graph));
  find_tolerant_places(ContactSystem(geometry), query, boundary, directions.resolution);
  EXPECT_EQ(statistics.support_queries, query.queries());
}

TEST(PreciseHull, Cancelled) {
  const Scene scene = make_scene(blob(1));
  std::stop_source source;
  source.request_stop();
  HullOptions stopped = options();
  stopped.progress.stop = source.get_token();
  EXPECT_THROW(precise_hull(scene, stopped), Cancelled);
  // Asked for as soon as each step begins.
  for (const std::string name : {"cull", "trace", "stitch"}) {
    std::stop_source later;
    bool reached = false;
    HullOptions interrupted = options();
    interrupted.progress.stop = later.get_token();
    interrupted.progress.report = [&](std::string_view step, double /*share*/) {
      if (step != name) return;
      reached = true;
      later.request_stop();
    };
    EXPECT_THROW(precise_hull(scene, interrupted), Cancelled) << name;
    EXPECT_TRUE(reached) << name;
  }
}

TEST(PreciseHull, RejectsWrongTolerances) {
  const Scene scene = make_scene(sphere());
  EXPECT_THROW(precise_hull(scene, {.tolerance = -1, .progress = {}}), InvalidInput);
  EXPECT_THROW(precise_hull(scene, {.relative = 0, .progress = {}}), InvalidInput);
}

TEST(PreciseHull, OnlyPlanarOnesOfFlatScenesHaveABoundary) {
  const Shape flat = {{}, {circle({0, 0, 0}, {1, 0, 0}, {0, 2, 0})}, {}};
  const Shape line = {{}, {segment({0, 0, 0}, {1, 2, 3})}, {}};
  const Shape point = {{}, {}, {{1, 2, 3}}};
  const auto hull_of = [](const Shape& shape) {
    return precise_hull(make_scene(mapped(shape, skew_rotation())), options());
  };
  const Hull planar = hull_of(flat);
  EXPECT_EQ(planar.kind, HullKind::planar);
  ASSERT_NE(planar.boundary, nullptr);
  EXPECT_EQ(planar.boundary->dimension, 2);
  EXPECT_EQ(hull_of(line).kind, HullKind::segment);
  EXPECT_EQ(hull_of(line).boundary, nullptr);
  EXPECT_EQ(hull_of(point).kind, HullKind::point);
  EXPECT_EQ(hull_of(point).boundary, nullptr);
}

/// Whatever the input, the mesh is a certified hull, and a boundary that claims to be complete is
/// sound and has the right measures. `accuracy`: of these, as they tell it themselves.
void expect_no_false_claim(const Shape& shape, double volume, const std::string& name,
                           double accuracy = 1e-9) {
  SCOPED_TRACE(name);
  const Scene scene = make_scene(shape);
  const Hull hull = precise_hull(scene, options(1e-2));
  expect_certified(scene, hull, 1e-2, {volume, -1, 1e-9}, 100);
  ASSERT_NE(hull.boundary, nullptr);
  if (!hull.boundary->unresolved.empty()) return;
  const BoundaryFacts facts = boundary_facts(scene, hull, 50);
  EXPECT_TRUE(facts.sound(1e-11)) << facts;
  const BoundaryMeasures measured = measures_of(scene, hull);
  EXPECT_LE(measured.accuracy, accuracy);
  if (volume >= 0) {
    EXPECT_NEAR(measured.volume, volume, 1e-9 * volume);
  }
}

TEST(PreciseHull, DegenerateInputIsNeverClaimedWrongly) {
  const double ball = 4 * pi / 3;
  expect_no_false_claim(sphere() + sphere(), ball, "identical spheres");
  expect_no_false_claim(sphere() + scaled(sphere(), 0.5), ball, "a sphere inside another");
  expect_no_false_claim(sphere() + shifted(sphere(0.5), {0, 0, 0.5}), ball,
                        "spheres tangent from inside");
  expect_no_false_claim(sphere() + shifted(sphere(), {2, 0, 0}), ball + 2 * pi,
                        "spheres tangent from outside");
  expect_no_false_claim(blob(1) + blob(1), -1, "identical blobs");
}

/// A patch of which all four borders are in one point: rectangles that reach across it are as long
/// as it is, and their ends coincide. Quadratures near the point converge slowly.
TEST(PreciseHull, OfAPatchAllBordersOfWhichAreInOnePoint) {
  BezierPatch patch{3, 3, std::vector<dvec4>(16, homogeneous({0, 0, 1}))};
  for (const int i : {1, 2}) {
    for (const int j : {1, 2})
      patch.points[patch.index(i, j)] = homogeneous(dvec3(i - 1, j - 1, 0));
  }
  const Shape clean = of_patch(patch);
  const Shape turned = mapped(clean, skew_rotation());
  Shape rounded = turned;
  for (dvec4& p : rounded.surfaces.front().points) p = dvec4(glm::vec4(p));
  expect_no_false_claim(clean, -1, "clean", 1e-4);
  expect_no_false_claim(turned, -1, "turned", 1e-4);
  expect_no_false_claim(rounded, -1, "turned and rounded", 1e-4);
}

/// A pose in which refinement met vertices once more, but for the rounding of the rotation.
TEST(PreciseHull, OfATurnedConeHasAFineMesh) {
  Model model = make_model(solid_cone(1, 2));
  model.clear_instances();
  const dmat3 rows(0.4574805953920079, 0.5243635715458594, 0.7181603927225757,  //
                   0.7092906121736027, -0.702277437210167, 0.06093626726273654, 0.5363005988456191,
                   0.48150726476470745, -0.6932044587685802);
  model.add_instance(0, {glm::transpose(rows), {0.1, -0.2, 0.3}});
  const Scene scene(std::move(model));
  const Hull hull = precise_hull(scene, {.threads = 1, .progress = {}});
  EXPECT_TRUE(hull.boundary->unresolved.empty());
  EXPECT_LE(hull.distance_bound, 1e-4 * scene.diagonal());
}

}  // namespace
}  // namespace taut
