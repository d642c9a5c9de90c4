#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exact_checks.h"
#include "freeform.h"
#include "judge/families.h"
#include "judge/sweeps.h"
#include "models.h"
#include "sound_hull.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/contact/region_outline.h"
#include "taut/hull/measure/boundary_measures.h"
#include "taut/hull/precise_hull.h"
#include "taut/io/document/boundary_document.h"
#include "truths.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

Hull solved_hull_of(const Scene& scene) {
  HullOptions options;
  options.relative = 1e-2;
  options.threads = 1;
  return precise_hull(scene, options);
}

/// Of equal spheres in one place the boundary has one: points of the other that support are as high
/// as some of it.
TEST(SolvedHull, OfCopiesWithOtherParametersLacksNothing) {
  const Scene scene = make_scene(sphere(1) + mapped(sphere(1), skew_rotation()));
  const Hull hull = solved_hull_of(scene);
  ASSERT_TRUE(hull.boundary);
  EXPECT_TRUE(hull.boundary->unresolved.empty());
  EXPECT_EQ(face_counts(*hull.boundary), (FaceCounts{1, 0, 0}));
}

/// A rim of a rounded wheel is told as the side of a patch where that supports as well: support
/// points on it are on the boundary.
TEST(SolvedHull, OfCurvesAlongSidesOfPatchesLacksNothing) {
  for (const Variant variant : {Variant::float32, Variant::decimals}) {
    const Hull hull = solved_hull_of(scene_of("wheel", variant));
    ASSERT_TRUE(hull.boundary);
    EXPECT_TRUE(hull.boundary->unresolved.empty());
    EXPECT_EQ(hull.boundary->count(FaceKind::facet), 2);
  }
}

/// Of a rounded box and a copy that is moved by less than the resolution, or by little more:
/// contacts on seams are not told now as one side's and now as the other's.
TEST(SolvedHull, OfCopiesAllButInPlaceIsThatOfOne) {
  for (const Variant variant : all_variants) {
    SCOPED_TRACE(name_of(variant));
    const Hull hull = solved_hull_of(scene_of("copies_all_but_in_place", variant));
    ASSERT_TRUE(hull.boundary);
    EXPECT_TRUE(hull.boundary->unresolved.empty());
    EXPECT_EQ(face_counts(*hull.boundary), (FaceCounts{8, 12, 6}));
  }
}

/// Half of a hull form and its mirror image, with the keel and the bow in common: facets' corners
/// are where arcs leave, beside which straight borders are in one plane, too.
TEST(SolvedHull, OfAShipAndItsMirrorImageIsWhole) {
  NurbsSurface half{3, 3, {0, 0, 0, 0, 1, 2, 2, 2, 2}, {0, 0, 0, 0, 1, 1, 1, 1}, {}};
  constexpr std::array<double, 5> beam = {0, 6, 8, 7, 5};
  constexpr std::array<std::array<double, 2>, 4> frame = {{{0, 0}, {0.6, 1}, {0.9, 3}, {1, 6}}};
  for (std::size_t i = 0; i < beam.size(); ++i) {
    for (const auto& [width, z] : frame) {
      half.points.emplace_back(25 * double(i), width * beam[i], z, 1);
    }
  }
  Shape shape;
  shape.surfaces.push_back(half);
  const Shape whole = shape + mapped(shape, {1, 0, 0, 0, -1, 0, 0, 0, 1});
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    const Hull hull = solved_hull_of(make_scene(mapped(whole, turn)));
    ASSERT_TRUE(hull.boundary);
    EXPECT_TRUE(hull.boundary->unresolved.empty());
    EXPECT_EQ(face_counts(*hull.boundary), (FaceCounts{2, 4, 4}));
  }
}

struct Ruled {
  const char* name;
  Shape shape;
  FaceCounts counts;
};

std::vector<Ruled> ruled_shapes() {
  return {{"box", box(3, 2, 1), {0, 0, 6}},
          {"cylinder", solid_cylinder(1, 2), {0, 1, 2}},
          {"cone", solid_cone(1, 2), {0, 1, 1}},
          {"filleted box", filleted_box(3, 2, 1, 0.25), {8, 12, 6}},
          {"torus", torus(2, 0.5), {1, 0, 2}}};
}

/// The counts of a hull that is closed, within the resolution and verified.
FaceCounts expect_verified(const Shape& shape) {
  const Scene scene = make_scene(shape);
  const Hull hull = solved_hull_of(scene);
  if (!hull.boundary) {
    ADD_FAILURE() << "no boundary";
    return {};
  }
  EXPECT_TRUE(hull.boundary->unresolved.empty());
  EXPECT_LE(deepest_tolerant(*hull.boundary), scene.frame().length_to_frame(hull.resolution.rho));
  HullDocument document = hull_document(scene, *hull.boundary);
  const auto tolerant = std::count_if(document.faces.begin(), document.faces.end(),
                                      [](const auto& face) { return face.tolerant > 0; });
  state(document, hull.resolution.rho, int(tolerant),
        scene.frame().length_to_model(deepest_tolerant(*hull.boundary)));
  const HullVerification found = verified(document, scene);
  // Borders of other degrees miss each other by what rounding has made of them.
  const double tolerance = std::max(1e-9, hull.resolution.rho / scene.diagonal());
  EXPECT_TRUE(found.is_hull(tolerance)) << text_of(found);
  return face_counts(*hull.boundary);
}

void expect_counts(const Shape& shape, const FaceCounts& counts) {
  EXPECT_EQ(expect_verified(shape), counts);
}

/// Walls of one radius over each other: the rims that lie on the other wall are held by the two
/// that do not, also where rounding makes them reach a little farther.
TEST(SolvedHull, OfOverlappingWallsIsThatOfTheOuterRims) {
  for (const unsigned long seed : {1UL, 2UL, 3UL}) {
    for (const Variant variant : all_variants) {
      SCOPED_TRACE(std::to_string(seed) + " " + name_of(variant));
      const Scene scene = scene_of("overlapping_walls", variant, seed);
      const Hull hull = solved_hull_of(scene);
      ASSERT_TRUE(hull.boundary);
      EXPECT_TRUE(hull.boundary->unresolved.empty());
      EXPECT_EQ(face_counts(*hull.boundary), (FaceCounts{0, 1, 2}));
      EXPECT_EQ(hull.boundary->curves.size(), 2U);
      EXPECT_EQ(hull.resolution.raised_from, 0);
      EXPECT_LE(deepest_tolerant(*hull.boundary),
                scene.frame().length_to_frame(hull.resolution.rho));
    }
  }
}

/// Three equal shapes in a row, of which the middle one touches planes with the two others.
TEST(SolvedHull, OfThreeInARowIsThatOfTwo) {
  const std::vector<std::pair<std::string, FaceCounts>> families = {{"balls_in_a_row", {2, 1, 0}},
                                                                    {"domes_in_a_row", {2, 5, 5}}};
  for (const auto& [family, counts] : families) {
    for (const unsigned long seed : {1UL, 2UL, 3UL}) {
      for (const Variant variant : {Variant::clean, Variant::turned, Variant::float32}) {
        SCOPED_TRACE(family + " " + std::to_string(seed) + " " + name_of(variant));
        const Scene scene = scene_of(family, variant, seed);
        const Hull hull = solved_hull_of(scene);
        ASSERT_TRUE(hull.boundary);
        EXPECT_TRUE(hull.boundary->unresolved.empty());
        EXPECT_EQ(face_counts(*hull.boundary), counts);
        EXPECT_LE(deepest_tolerant(*hull.boundary),
                  scene.frame().length_to_frame(hull.resolution.rho));
      }
    }
  }
}

/// Planes, cylinders, cones and crests of patches whose inner control points rounding has moved are
/// what they were.
TEST(SolvedHull, OfHigherDegreesIsTheSameWhenRounded) {
  for (const Ruled& ruled : ruled_shapes()) {
    for (const Variant variant : all_variants) {
      SCOPED_TRACE(std::string(ruled.name) + " " + name_of(variant));
      taut_test::Random random(1);
      Natural natural;
      natural.shape = with_higher_degrees(ruled.shape);
      expect_counts(placed(natural, variant, random).shape, ruled.counts);
    }
  }
}

/// A quarter of a unit circle, to one side or the other of where it begins.
NurbsCurve quarter(const dvec3& shift, double side) {
  NurbsCurve curve{2, {0, 0, 0, 1, 1, 1}, {}};
  const std::array<dvec3, 3> corners = {dvec3(side, 0, 0), dvec3(side, 1, 0), dvec3(0, 1, 0)};
  for (std::size_t k = 0; k < 3; ++k) {
    const double w = k == 1 ? std::sqrt(0.5) : 1;
    curve.points.emplace_back(w * (corners[k] + shift), w);
  }
  return curve;
}

/// Edges that meet smoothly, or miss each other by less than the resolution, bound one half disc.
TEST(SolvedHull, OfEdgesThatMeetInASmoothCurve) {
  for (const double gap : {0.0, 1.7e-9, 6e-9}) {
    SCOPED_TRACE(gap);
    Shape shape{
        {}, {quarter(dvec3(0.0), 1), quarter({-gap, 0, 0}, -1)}, {{0.5, 0.2, 2}, {1, -0.3, 2}}};
    expect_counts(shape, {0, 2, 4});
    expect_counts(mapped(shape, skew_rotation()), {0, 2, 4});
  }
}

/// Where a facet's plane meets an edge in its end only, curves leave it about the vertex first,
/// however soon they go on along the edge.
TEST(SolvedHull, CurvesLeaveVerticesBeforeTheyRunAlongTheirEdges) {
  for (const double tilt : {1e-2, 1e-3, 1e-5}) {
    SCOPED_TRACE(tilt);
    const Shape shape{{},
                      {quarter(dvec3(0.0), 1)},
                      {{0.5, 0, 1}, {0.6, -0.5, 0.8 - tilt}, {0, 0, -1}, {-1, -0.5, 0}}};
    for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
      const Scene scene = make_scene(mapped(shape, turn));
      const Hull hull = solved_hull_of(scene);
      ASSERT_TRUE(hull.boundary);
      const BoundaryMeasures measured = measure(scene, ContactGeometry(scene), *hull.boundary);
      EXPECT_LT(measured.accuracy, 1e-9);
    }
  }
}

/// A scroll about a full circle begins and ends in one of its points: the curve along it does, too.
TEST(SolvedHull, OfACircleAndAHalfDisc) {
  const dvec3 up(0.2, 0.1, 2);
  const Shape shape{
      {}, {circle(dvec3(0.0), {1, 0, 0}, {0, 1, 0}), quarter(up, 1), quarter(up, -1)}, {}};
  expect_counts(shape, {0, 1, 3});
  expect_counts(mapped(shape, skew_rotation()), {0, 1, 3});
}

/// Two balls that are as high as each other: their common curve passes their poles, at an angle to
/// the borders of their patches.
TEST(SolvedHull, ArcsThatPassPolesAreExact) {
  const dvec3 c(3, 1, 0.5);
  const double R = 1, r = 0.5, L = glm::length(c);
  const double sine = (R - r) / L, cosine = std::sqrt(1 - sine * sine), pi = std::numbers::pi;
  const double area =
      2 * pi * (R * R * (1 + sine) + r * r * (1 - sine)) + pi * (R + r) * cosine * L * cosine;
  const double width = R * (1 + sine) + r * (1 - sine) + 0.5 * cosine * cosine * L;
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    const Scene scene = make_scene(mapped(sphere(R) + shifted(sphere(r), c), turn));
    const Hull hull = solved_hull_of(scene);
    ASSERT_TRUE(hull.boundary);
    EXPECT_EQ(face_counts(*hull.boundary), (FaceCounts{2, 1, 0}));
    const BoundaryMeasures measured = measure(scene, ContactGeometry(scene), *hull.boundary);
    EXPECT_NEAR(measured.area, area, 1e-10 * area);
    EXPECT_NEAR(measured.mean_width, width, 1e-9 * width);
  }
}

/// Whatever rounding does to a truth, its boundary is closed and as near as it says.
class RoundedTruths : public testing::TestWithParam<Truth> {};

TEST_P(RoundedTruths, AreClosedAndNear) {
  const Truth& truth = GetParam();
  for (const bool elevated : {false, true}) {
    for (const Variant variant : {Variant::float32, Variant::decimals}) {
      SCOPED_TRACE(std::string(elevated ? "elevated " : "") + name_of(variant));
      taut_test::Random random(1);
      Natural natural;
      natural.shape = elevated ? with_higher_degrees(truth.shape) : truth.shape;
      const Scene scene = make_scene(placed(natural, variant, random).shape);
      const Hull hull = solved_hull_of(scene);
      ASSERT_TRUE(hull.boundary);
      EXPECT_TRUE(hull.boundary->unresolved.empty());
      const double rho = hull.resolution.rho;
      EXPECT_LE(deepest_tolerant(*hull.boundary), scene.frame().length_to_frame(rho));
      const BoundaryMeasures measured = measure(scene, ContactGeometry(scene), *hull.boundary);
      EXPECT_NEAR(double(measured.volume), double(truth.volume),
                  rho * measured.area + double(truth.uncertainty));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(SolvedHull, RoundedTruths, testing::ValuesIn(truths()),
                         [](const auto& info) { return test_name(info.param); });

/// Arcs run along joins of a sphere's patches, which rounding has given kinks: contacts stay there.
TEST(SolvedHull, OfSpheresIsTheSameWhenRounded) {
  const Shape spheres = sphere(1) + shifted(sphere(1), {3, 0, 0}) + shifted(sphere(1), {1, 2.5, 0});
  Shape rounded = mapped(spheres, skew_rotation());
  for (NurbsSurface& surface : rounded.surfaces) {
    for (dvec4& p : surface.points) {
      dvec3 x = euclidean(p);
      for (int i = 0; i < 3; ++i) x[i] = std::round(1e6 * x[i]) / 1e6;
      p = homogeneous(x, p.w);
    }
  }
  expect_counts(rounded, {3, 3, 2});
  for (const unsigned long seed : {1UL, 2UL, 3UL}) {
    for (const Variant variant : all_variants) {
      SCOPED_TRACE(std::to_string(seed) + " " + name_of(variant));
      taut_test::Random random(seed);
      Natural natural;
      natural.shape = spheres;
      expect_counts(placed(natural, variant, random).shape, {3, 3, 2});
    }
  }
}

/// Rulings go on from one patch to the next, though rounding has turned them.
TEST(SolvedHull, OfSplitPatchesIsTheSameWhenRounded) {
  for (const Ruled& ruled : ruled_shapes()) {
    if (ruled.counts == FaceCounts{8, 12, 6}) continue;  // its edges are cut where others are not
    for (const Variant variant : all_variants) {
      SCOPED_TRACE(std::string(ruled.name) + " " + name_of(variant));
      taut_test::Random random(1);
      Natural natural;
      natural.shape = split(ruled.shape, 0.37, 0.61);
      expect_counts(placed(natural, variant, random).shape, ruled.counts);
    }
  }
}

/// All of it is exact, and what is measured is as accurate as that is stated.
void expect_exact_measures(const Shape& shape, const char* name) {
  SCOPED_TRACE(name);
  const Scene scene = make_scene(shape);
  const Hull hull = solved_hull_of(scene);
  ASSERT_TRUE(hull.boundary);
  for (const HullFace& face : hull.boundary->faces) EXPECT_EQ(face.tolerant, 0);
  const BoundaryFacts facts = boundary_facts(scene, hull, 300);
  EXPECT_TRUE(facts.sound()) << facts;
  EXPECT_LE(measures_of(scene, hull).accuracy, 1e-9);
}

/// An arc ends along a join where its contacts are so near that what is between them is less than
/// the resolution deep; another one just beyond the end of a curve, which lets go of it.
TEST(SolvedHull, ArcsGoOnToTheirFreeEnds) {
  expect_exact_measures(blob(394), "blob");
  Random random(5);
  Shape curve;
  for (int k = 0; k <= 28; ++k) {
    const int degree = pick(random, 3, 7);
    curve = {{}, {as_nurbs(random_curve(random, degree, 1))}, {}};
  }
  expect_exact_measures(curve, "curve");
  expect_exact_measures(mapped(curve, skew_rotation()), "curve, turned");
}

/// A contact passes a vertex between two rulings with the same elements.
TEST(SolvedHull, RulingsLieInTheirElements) {
  Random random(4);
  Shape shape;
  for (int k = 0; k < 2; ++k) {
    shape.surfaces.push_back(as_nurbs(random_patch(random, 2, 3, 3)));
    shape.curves.push_back(as_nurbs(random_curve(random, 3, 1)));
    shape.points.push_back(random_point(random));
  }
  expect_exact_measures(shape, "patches, curves and points");
}

/// Parameters about poles are rounding however the parts are ordered.
TEST(SolvedHull, RulingsAtPolesAreMeasured) {
  Shape box = filleted_box(1, 2, 3, 0.2);
  expect_exact_measures(box, "filleted box");
  std::reverse(box.surfaces.begin(), box.surfaces.end());
  expect_exact_measures(box, "in the other order");
  expect_exact_measures(with_exchanged_parameters(box), "with exchanged parameters");
}

/// Also where all of the rim is within the resolution of one plane.
TEST(SolvedHull, DentsAreNoPartOfPatches) {
  const Shape dented = mapped(dented_sheet(0.02), skew_rotation());
  const dvec3 up = skew_rotation() * dvec3(0, 0, 1);
  const Scene scene = make_scene(dented);
  const ContactGeometry geometry(scene);
  SupportQuery query(scene);
  const dvec3 middle = geometry.point({0, SourceKind::face, 7 * 14 + 7, 0, 0});
  const double depth = glm::dot(query(up).point - middle, up);
  HullOptions options;
  options.relative = 1e-2;
  for (const double share : {4.0, 16.0, 64.0}) {
    SCOPED_TRACE(share);
    options.resolution = depth / share / scene.frame().length_to_frame(scene.diagonal());
    const Hull hull = precise_hull(scene, options);
    EXPECT_TRUE(hull.boundary->unresolved.empty());
    EXPECT_LE(deepest_tolerant(*hull.boundary), depth / share);
    EXPECT_GT(hull.boundary->count(FaceKind::scroll), 0);
    for (const HullFace& face : hull.boundary->faces) {
      for (const PatchRegion& region : face.regions) {
        const int row = region.patch / 14;
        const int column = region.patch % 14;
        if (row < 6 || row > 7 || column < 6 || column > 7) continue;
        const dvec2 corner(row == 6 ? 1 : 0, column == 6 ? 1 : 0);
        EXPECT_LT(depth_in(outline_of(ContactSystem(geometry), *hull.boundary, region), corner), 0)
            << region.patch;
      }
    }
  }
}

/// Of a rounded box and a copy moved by any length: one of them, or both with strips as wide as the
/// way between patches, edges and faces that are cut along it.
TEST(SolvedHull, OfCopiesIsThatOfOneOrOfTwo) {
  const Shape one = mapped(filleted_box(40, 30, 20, 3), skew_rotation());
  for (const double way : {1e-7, 1e-6, 3e-6, 1e-4, 1e-2}) {
    SCOPED_TRACE(way);
    const Scene scene = make_scene(one + shifted(one, way * unit({0.34, -0.73, -0.59})));
    const Hull hull = solved_hull_of(scene);
    ASSERT_TRUE(hull.boundary);
    EXPECT_TRUE(hull.boundary->unresolved.empty());
    EXPECT_LE(hull.boundary->frame.length_to_model(deepest_tolerant(*hull.boundary)),
              hull.resolution.rho);
    EXPECT_EQ(face_counts(*hull.boundary),
              way <= 4 * hull.resolution.rho ? (FaceCounts{8, 12, 6}) : (FaceCounts{14, 24, 12}));
  }
}

/// What one map has as one contact, so that no boundary is closed, finer ones tell apart.
TEST(SolvedHull, IsWithinTheResolutionByFinerMaps) {
  for (const auto& [name, variant] :
       {std::pair{"thread", Variant::float32}, {"overlapping_balls", Variant::decimals}}) {
    SCOPED_TRACE(name);
    const Scene scene = scene_of(name, variant);
    const Hull hull = solved_hull_of(scene);
    EXPECT_TRUE(hull.boundary->unresolved.empty());
    EXPECT_LE(hull.boundary->frame.length_to_model(deepest_tolerant(*hull.boundary)),
              hull.resolution.rho);
  }
}

/// Planes of three contacts that climbs have found.
TEST(SolvedHull, NodesAreTangent) {
  const Scene scene(posed_teapots(5, 5), {.threads = 1, .progress = {}});
  const BoundaryFacts facts = boundary_facts(scene, solved_hull_of(scene), 300);
  EXPECT_TRUE(facts.sound()) << facts;
}

/// Contacts that leave a rounded border come back within some resolutions of it: no place is off by
/// more than the resolution that is told, which is the model's own only where it is stated.
TEST(SolvedHull, IsToldAtACoarserResolutionWhereTheModelsDoesNotDo) {
  const Scene scene = scene_of("domes_in_a_row", Variant::decimals);
  HullOptions options;
  options.relative = 1e-2;
  options.threads = 1;
  std::vector<std::string> warnings;
  options.progress.warn = [&](std::string_view code, std::string_view) {
    warnings.emplace_back(code);
  };
  const Hull hull = precise_hull(scene, options);
  const double own = resolution_of(scene.model(), scene.diagonal()).rho;
  EXPECT_EQ(hull.resolution.raised_from, own) << "it is exact by now: take another";
  EXPECT_GT(hull.resolution.rho, own);
  EXPECT_EQ(hull.resolution.source, ResolutionSource::coordinates);
  EXPECT_EQ(warnings, std::vector<std::string>{"coarser-resolution"});
  EXPECT_LE(hull.boundary->frame.length_to_model(deepest_tolerant(*hull.boundary)),
            hull.resolution.rho);
  EXPECT_EQ(face_counts(*hull.boundary), (FaceCounts{2, 5, 5}));
  options.resolution = own / scene.diagonal();
  EXPECT_THROW(precise_hull(scene, options), HullNotConverged);
}

BoundaryMeasures measured(const Scene& scene, const Hull& hull) {
  return measure(scene, ContactGeometry(scene), *hull.boundary);
}

/// A cubic in a plane, that bends in before its end by less than the resolution or more, and a
/// point: its plane's facet closes with what it spans, and the cone has no other face.
TEST(SolvedHull, OfACurveThatBendsInBeforeItsEndAndAPoint) {
  Random random(7);
  for (const double in : {1e-5, 1e-4, 3e-4, 1e-3, 2e-3}) {
    SCOPED_TRACE(in);
    const NurbsCurve curve = {3,
                              {0, 0, 0, 0, 1, 1, 1, 1},
                              {{0, 0, 0, 1}, {1, 0, 1, 1}, {2, 0, 0.6, 1}, {3, 0, 0.2 + in, 1}}};
    // Above the chord, but for the dent.
    const double base = 3 * (1 + 0.6 + 0.2 + in) / 4 - 1.5 * (0.2 + in);
    for (const Variant variant : all_variants) {
      SCOPED_TRACE(name_of(variant));
      Natural cone;
      cone.shape = {{}, {curve}, {{1, 3, 0}}};
      const Scene scene = make_scene(placed(cone, variant, random).shape);
      const Hull hull = solved_hull_of(scene);
      ASSERT_TRUE(hull.boundary);
      EXPECT_EQ(face_counts(*hull.boundary), (FaceCounts{0, 1, 2}));
      EXPECT_LE(hull.boundary->frame.length_to_model(deepest_tolerant(*hull.boundary)),
                hull.resolution.rho);
      EXPECT_NEAR(measured(scene, hull).volume, base, rounds(variant) ? 1e-5 : 1e-7);
    }
  }
}

/// A profile that is closed in a corner: the wall is one scroll, which begins and ends there, and
/// the curves along it do.
TEST(SolvedHull, OfAWallThatIsClosedInACorner) {
  // (12 t (1 - t), 9 t (1 - t) (1 - 2 t)), in one piece and in two.
  NurbsCurve whole = {3, {0, 0, 0, 0, 1, 1, 1, 1}, {}};
  for (const dvec2& p : {dvec2(0, 0), {4, 3}, {4, -3}, {0, 0}}) whole.points.emplace_back(p, 0, 1);
  NurbsCurve halves = {3, {0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2}, {}};
  for (const dvec2& p : {dvec2(0, 0), {2, 1.5}, {3, 0.75}, {3, 0}, {3, -0.75}, {2, -1.5}, {0, 0}}) {
    halves.points.emplace_back(p, 0, 1);
  }
  Random random(7);
  for (int k = 0; k < 2 * int(std::size(all_variants)); ++k) {
    const Variant variant = all_variants[std::size_t(k / 2)];
    const Shape wall = {{extruded(k % 2 == 0 ? whole : halves, dvec3(0, 0, 2))}, {}, {}};
    SCOPED_TRACE(name_of(variant));
    const Scene scene = make_scene(placed({wall, {}, {}}, variant, random).shape);
    const Hull hull = solved_hull_of(scene);
    ASSERT_TRUE(hull.boundary);
    EXPECT_EQ(face_counts(*hull.boundary), (FaceCounts{0, 1, 2}));
    ASSERT_EQ(hull.boundary->curves.size(), 3U);
    for (const HullCurve& curve : hull.boundary->curves) EXPECT_FALSE(curve.closed);
    EXPECT_NEAR(measured(scene, hull).volume, 2 * 3.6, rounds(variant) ? 1e-5 : 1e-10);
  }
}

/// A profile of one curve with straight parts, as files have it: rounding bends these.
TEST(SolvedHull, OfStraightPartsOfCurvesIsTheSameWhenRounded) {
  const std::vector<dvec2> profile = {{3, 0},   {3, 2},  {0, 2},    {-1.5, 2}, {-3, 2}, {-3, 0},
                                      {-3, -2}, {0, -2}, {1.5, -2}, {3, -2},   {3, 0}};
  NurbsCurve slot = {2, {0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9}, {}};
  for (const dvec2& p : profile) slot.points.emplace_back(p, 0, 1);
  const Shape shape = {{extruded(slot, dvec3(0, 0, 4))}, {}, {}};
  Random random(7);
  std::optional<FaceCounts> counts;
  for (const Variant variant : all_variants) {
    SCOPED_TRACE(name_of(variant));
    const Hull hull = solved_hull_of(make_scene(placed({shape, {}, {}}, variant, random).shape));
    ASSERT_TRUE(hull.boundary);
    if (!counts) counts = face_counts(*hull.boundary);
    EXPECT_EQ(face_counts(*hull.boundary), *counts);
    EXPECT_EQ(hull.statistics.map_undecided, 0);
    EXPECT_LE(hull.boundary->frame.length_to_model(deepest_tolerant(*hull.boundary)),
              hull.resolution.rho);
  }
}

/// A slot of which one side is off the other's direction by an angle that joins leave smooth: along
/// half a great circle its hull's facet there turns about one ruling, which ends in the kink.
TEST(SolvedHull, OfASlotWithASmallKinkIsFoundAtOnce) {
  NurbsCurve slot = {2, {0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9}, {}};
  for (const dvec2& p : {dvec2(-1, -0.5),
                         {1, -0.4999},
                         {1.6, -0.4999},
                         {1.6, 0},
                         {1.6, 0.5},
                         {1, 0.5},
                         {-1, 0.5},
                         {-1.6, 0.5},
                         {-1.6, 0},
                         {-1.6, -0.5},
                         {-1, -0.5}}) {
    slot.points.emplace_back(p, 0, 1);
  }
  const Shape shape = {{extruded(slot, dvec3(0, 0, 0.5))}, {}, {}};
  Random random(7);
  for (const Variant variant : {Variant::clean, Variant::turned}) {
    SCOPED_TRACE(name_of(variant));
    const Hull hull = solved_hull_of(make_scene(placed({shape, {}, {}}, variant, random).shape));
    ASSERT_TRUE(hull.boundary);
    EXPECT_EQ(face_counts(*hull.boundary), (FaceCounts{0, 4, 6}));
    EXPECT_LE(hull.boundary->frame.length_to_model(deepest_tolerant(*hull.boundary)),
              hull.resolution.rho);
  }
}

/// A closed profile that turns sharply where it is the lowest, spun about an axis: crests are
/// inside of patches, and those that are next to each other differ by rounding.
TEST(SolvedHull, OfASpunProfileIsTheSameWhenRounded) {
  NurbsCurve profile = {3, {0, 0, 0, 0, 1, 2, 3, 4, 5, 5, 5, 5}, {}};
  for (const dvec2& p : {dvec2(0.8573, 0),
                         {0.7085, 0.4177},
                         {0.2157, 0.5425},
                         {1.0366, 0.3033},
                         {1.276, -0.3026},
                         {0.186, -0.5929},
                         {0.6787, -0.4858},
                         {0.8573, 0}}) {
    profile.points.emplace_back(p.x, 0, p.y, 1);
  }
  const Shape shape = {{revolved(profile)}, {}, {}};
  Random random(7);
  for (const Variant variant : all_variants) {
    SCOPED_TRACE(name_of(variant));
    expect_counts(placed({shape, {}, {}}, variant, random).shape, {3, 2, 2});
  }
}

/// From the equator of a sphere to its pole.
NurbsCurve quarter_of_a_meridian(double radius) {
  const double w = std::sqrt(0.5);
  return {2,
          {0, 0, 0, 1, 1, 1},
          {{radius, 0, 0, 1}, {w * radius, 0, w * radius, w}, {0, 0, radius, 1}}};
}

/// Over a rectangle in the plane z = 0, biquadratic: highest in its middle.
Shape dome(double a, double b, double height) {
  BezierPatch patch{2, 2, {}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      patch.points.emplace_back(0.5 * i * a, 0.5 * j * b, i == 1 && j == 1 ? 4 * height : 0, 1);
    }
  }
  return of_patch(patch);
}
Shape rectangle(const dvec3& corner, const dvec3& a, const dvec3& b) {
  const dvec3 corners[] = {corner, corner + b, corner + a, corner + a + b};
  BezierPatch patch{1, 1, {}};
  for (const dvec3& x : corners) patch.points.emplace_back(x, 1);
  return of_patch(patch);
}

/// Contacts in line, of which planes along edges have more than arcs that pass: however they are
/// turned.
TEST(SolvedHull, OfContactsInLineIsTheSameTurned) {
  const dmat3 along_x(dvec3(0, 1, 0), dvec3(0, 0, 1), dvec3(1, 0, 0));
  const dmat3 along_y(dvec3(0, 0, 1), dvec3(1, 0, 0), dvec3(0, 1, 0));
  const struct {
    const char* name;
    Shape shape;
    FaceCounts counts;
  } cases[] = {
      {"an arc that leaves a node's cell and comes back",
       shifted(dome(3, 3, 1), {-1, -1, 1}) + shifted(disc(4, -2), {0, 1, 0}),
       {1, 10, 9}},
      {"a disc beside the edge of a rectangle, in one plane",
       mapped(disc(1, 0) + disc(1, 5), along_y, {-3, -2, 1}) +
           mapped(dome(6, 6, 2), along_y, {0, -3, -4}) +
           rectangle({-4, -4, -3}, {2, 0, 0}, {0, 0, 4}) +
           rectangle({-4, -3, -3}, {2, 0, 0}, {0, 0, 4}),
       {1, 10, 14}},
      {"cylinders that cross and touch one plane",
       mapped(solid_cylinder(3, 5), along_x, {-2, 1, -1}) +
           shifted(solid_cylinder(4, 1), {-2, 0, 2}),
       {0, 5, 5}},
      {"a corner in line with a cylinder's ruling",
       rectangle({-3, 2, -2}, {3, 0, 0}, {0, 0, 4}) + mapped(cylinder(1, 6), along_x, {1, 2, 1}) +
           mapped({{revolved(quarter_of_a_meridian(2))}, {}, {}}, along_x, {2, -1, -3}),
       {1, 9, 8}},
      {"a segment that supports while planes turn about it",
       mapped(dome(2, 2, 3), dmat3(dvec3(1, 0, 0), dvec3(0, 0, 1), dvec3(0, 1, 0)), {3, 3, -4}) +
           mapped(cylinder(1, 5), along_y, {-2, 1, -4}) + shifted(disc(2, 4), {-1, 4, 0}) +
           Shape{{}, {circle({2, 2, 0}, {0, 0, 4}, {4, 0, 0})}, {}},
       {1, 12, 10}},
      {"a frustum in line with the rims of two discs in whose planes its own are",
       mapped({{revolved(quarter_of_a_meridian(3))}, {}, {}}, along_x, {0, -3, 3}) +
           mapped(disc(4, 0) + disc(4, 2), along_y, {1, 4, -4}) +
           mapped(frustum(2, 3, 2), along_y, {-2, 4, -2}) +
           Shape{{}, {circle({3, -3, -4}, {0, 0, 2}, {2, 0, 0})}, {}},
       {1, 10, 9}},
  };
  std::vector<dmat3> turns = {dmat3(1.0)};
  for (const unsigned seed : {3u, 7u}) {
    Random random(seed);
    turns.push_back(random_rotation(random));
  }
  // Of many these are some for which cells tell contacts in line apart in one place and not in the
  // next, or a facet's cell just misses its arcs.
  for (const double k : {7.0, 8.0, 18.0}) {
    const dvec3 axis = unit({0.3 + 0.1 * k, 0.5 - 0.07 * k, 0.7});
    turns.emplace_back(glm::mat3_cast(glm::angleAxis(0.5 + 0.37 * k, axis)));
  }
  for (const auto& [name, shape, counts] : cases) {
    SCOPED_TRACE(name);
    for (const dmat3& turn : turns) EXPECT_NO_THROW(expect_counts(mapped(shape, turn), counts));
    // Rounding may make contacts that are in line ones that are not.
    Random random(3);
    Natural natural;
    natural.shape = shape;
    EXPECT_NO_THROW(expect_verified(placed(natural, Variant::float32, random).shape));
  }
}

/// Two circles of one radius touch planes 1.4e-7 beside where their arcs meet.
TEST(SolvedHull, OfCirclesThatMeetPlanesBesideTheirEndsIsExact) {
  const Shape shape = {{},
                       {circle({0.2, 0.1, 2}, {1, 0, 0}, {0, 1, 0}),
                        circle({0.7, 0.1 - 1.42e-7, 2}, {1, 0, 0}, {0, 1, 0}), twisted_cubic()},
                       {}};
  const Hull hull = solved_hull_of(make_scene(shape));
  ASSERT_TRUE(hull.boundary);
  EXPECT_EQ(deepest_tolerant(*hull.boundary), 0);
  expect_verified(shape);
}

/// Two pieces of a wing that is ruled between two profiles: one profile turns back within 1e-7 of
/// its end, where speeds are next to nothing.
TEST(SolvedHull, OfProfilesThatTurnBackAtTheirEnds) {
  const std::vector<dvec3> tail = {{62.25102785299672, -82.05630820819383, 37.73411072066309},
                                   {64.10871893308918, -82.44078995431194, 37.93698298135693},
                                   {65.1320848212016, -82.65370816794676, 38.04302294908497},
                                   {65.11822553372379, -82.65075128429595, 38.04196322925065},
                                   {33.018852369693754, -243.05371274936897, 61.34782087705557},
                                   {33.34425350610678, -243.11881733658095, 61.39486288833548},
                                   {33.52354551924457, -243.15488555808426, 61.41977493707341},
                                   {33.52111510092865, -243.1543837066495, 61.419503536261715}};
  const std::vector<dvec3> nose = {{49.638696065711585, -79.45820387674536, 36.29397413483569},
                                   {51.33744844658865, -79.80583812782086, 36.49976482371651},
                                   {53.002259750722196, -80.14821228480702, 36.692796455817884},
                                   {54.564708333124344, -80.46993559346373, 36.8719052877386},
                                   {102.95429107183843, 73.4544412214288, -0.5941233213967758},
                                   {103.25172823842061, 73.39562787938804, -0.5475516277160194},
                                   {103.5432753178526, 73.33768209216737, -0.5034263823406976},
                                   {103.8169088300951, 73.2832261140436, -0.4623743140296608}};
  Shape wing;
  for (const std::vector<dvec3>& points : {tail, nose}) {
    NurbsSurface piece{1, 3, {0, 0, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}, {}};
    for (const dvec3& p : points) piece.points.emplace_back(p, 1.0);
    wing.surfaces.push_back(piece);
  }
  expect_counts(wing, {0, 10, 11});
}

/// The point is above a half ball's rim: the curve in which the cone from there touches the ball
/// touches the rim.
TEST(SolvedHull, OfCurvesThatTouchABorder) {
  const Shape half = {{revolved(quarter_of_a_meridian(1))}, {}, {}};
  const Shape shape = half + Shape{{}, {}, {{-1, 0, 1.0 / 3}}};
  expect_counts(shape, {1, 1, 1});
  expect_counts(mapped(shape, skew_rotation()), {1, 1, 1});
}

/// A contact comes to the border of a patch and turns there, to run back along its edge: the place
/// is beyond the chord to the next ruling.
TEST(SolvedHull, OfAnArcThatTurnsAtABorder) {
  const std::vector<dvec3> points = {{-0.19377402710574154, -0.5930895186477008, 5.023643249400513},
                                     {-0.475373319116301, 10.500729345260105, 5.90092739265187},
                                     {-0.43918248402792015, 19.97038194886327, 4.288319225439268},
                                     {0.9614743996024773, 30.923314387327572, 5.8972988942744875},
                                     {10.449579881547066, 0.08245371109486843, 4.623662904020971},
                                     {9.553782408090742, 9.321304017550254, 3.6094235630857456},
                                     {10.939850826432265, 20.03213717109576, 4.418175852781477},
                                     {9.23173122494154, 30.246979511075, 4.818398272738323},
                                     {20.553366228684595, 0.22600660210608092, 5.099187375346119},
                                     {20.834595409581805, 9.079185753328407, 2.8178888916267306},
                                     {20.057178526520044, 19.918671765770807, 4.2697968824902075},
                                     {19.12469915829975, 30.28265633827875, 5.076286626438557},
                                     {30.705265676961314, 0.18588203620856802, 4.6594634329981846},
                                     {29.520194895474447, 10.679763042062817, 5.576857406856808},
                                     {30.01899176304302, 20.021777768933067, 4.60638965858329},
                                     {30.506060415404356, 29.295844071569913, 4.906995778961303}};
  BezierPatch patch{3, 3, {}};
  for (const dvec3& x : points) patch.points.emplace_back(x, 1);
  expect_counts(of_patch(patch), {1, 15, 6});
  expect_counts(mapped(of_patch(patch), skew_rotation()), {1, 15, 6});
}

/// The sphericon: one closed scroll, which runs along each of two half circles there and back, and
/// begins in a vertex that is not its apex. (Wikipedia, "Sphericon".)
TEST(SolvedHull, OfTwoHalfCirclesIsASphericon) {
  const Shape shape = {{},
                       {half_circle(dvec3(0.0), {0, 1, 0}, {1, 0, 0}),
                        half_circle(dvec3(0.0), {0, -1, 0}, {0, 0, 1})},
                       {}};
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    const Scene scene = make_scene(mapped(shape, turn));
    const Hull hull = solved_hull_of(scene);
    ASSERT_TRUE(hull.boundary);
    EXPECT_EQ(face_counts(*hull.boundary), (FaceCounts{0, 1, 0}));
    const BoundaryMeasures m = measured(scene, hull);
    EXPECT_NEAR(m.volume, 2 * pi / 3, 1e-11);
    EXPECT_NEAR(m.area, 2 * std::sqrt(2.0) * pi, 1e-11);
  }
}

/// Contacts of equal spheres run along a join on both, and those of others all but in one place are
/// told by the shapes.
TEST(SolvedHull, OfSpheresNextToEachOther) {
  for (const double way : {1e-6, 1e-3}) {
    SCOPED_TRACE(way);
    const Scene scene = make_scene(sphere(1) + shifted(sphere(1), dvec3(0, 0, way)));
    const Hull hull = solved_hull_of(scene);
    ASSERT_TRUE(hull.boundary);
    EXPECT_EQ(face_counts(*hull.boundary), (FaceCounts{2, 1, 0}));
    EXPECT_NEAR(measured(scene, hull).volume, 4 * pi / 3 + pi * way, 1e-11);
  }
  const Hull hull = solved_hull_of(make_scene(sphere(1) + shifted(sphere(1 - 1e-6), {0, 0, 1e-5})));
  ASSERT_TRUE(hull.boundary);
  EXPECT_TRUE(hull.boundary->unresolved.empty());
  EXPECT_EQ(face_counts(*hull.boundary), (FaceCounts{2, 1, 0}));
}

/// Planes of three of them are far from the cells in which they are the highest.
TEST(SolvedHull, OfSpheresNearlyInARow) {
  const Scene scene = make_scene(
      shifted(sphere(1), dvec3(5, 0.05, 0.045)) + shifted(sphere(1), dvec3(7.5, 0.065, 0.079)) +
      shifted(sphere(1), dvec3(10, 0.009, 0.003)) + shifted(sphere(1), dvec3(12.5, 0.084, 0.043)));
  const Hull hull = solved_hull_of(scene);
  ASSERT_TRUE(hull.boundary);
  EXPECT_TRUE(hull.boundary->unresolved.empty());
  EXPECT_EQ(face_counts(*hull.boundary), (FaceCounts{4, 6, 4}));
}

/// It is told, and there is a closed boundary with its depth all the same.
TEST(SolvedHull, IsClosedWhereItIsNotExact) {
  const Scene scene = scene_of("cut_by_edges", Variant::float32);
  HullOptions options;
  options.relative = 1e-2;
  options.threads = 1;
  // Rounding has moved edges off their faces by more.
  options.resolution = 1e-9;
  try {
    precise_hull(scene, options);
    FAIL() << "it is exact by now: take another";
  } catch (const HullNotConverged& stopped) {
    const Hull& hull = *stopped.best;
    ASSERT_TRUE(hull.boundary);
    const HullBoundary& boundary = *hull.boundary;
    EXPECT_TRUE(boundary.unresolved.empty());
    ASSERT_EQ(boundary.faces.size(), hull.mesh.n_faces());
    EXPECT_EQ(
        int(hull.mesh.n_vertices()) - int(boundary.curves.size()) + int(boundary.faces.size()), 2);
    SupportQuery query(scene);
    for (const HullFace& face : boundary.faces) {
      EXPECT_GT(face.tolerant, 0);
      EXPECT_LE(boundary.frame.length_to_model(face.tolerant), 2 * hull.distance_bound);
      const double h = query(face.n).h;
      for (const dvec3& x : face.points) {
        EXPECT_GE(glm::dot(x, face.n), h - face.tolerant);
        EXPECT_LE(glm::dot(x, face.n), face.offset);
      }
    }
    for (const HullCurve& curve : boundary.curves) {
      for (const int face : curve.faces) EXPECT_GE(face, 0);
    }
    for (const auto f : hull.mesh.faces()) EXPECT_EQ(hull.mesh.data(f).hull_face, f.idx());
  }
}

}  // namespace
}  // namespace taut
