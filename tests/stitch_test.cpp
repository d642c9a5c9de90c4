#include "taut/hull/stitch/stitch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "boundary_checks.h"
#include "models.h"
#include "taut/hull/solve/separating_graph.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

struct Stitched {
  Scene scene;
  std::shared_ptr<const HullBoundary> boundary;

  explicit Stitched(const Shape& shape) : scene(make_scene(shape)) {
    const ContactGeometry geometry(scene);
    SupportQuery query(scene);
    HullStatistics statistics;
    const DirectionMap map = directions_of(geometry, {}, statistics);
    boundary = std::make_shared<const HullBoundary>(
        stitch(geometry, query, solved_graph(geometry, query, map, {})));
  }

  /// Patches, scrolls, facets; bitangents, edges, joins, rulings.
  std::array<int, 7> counts() const {
    std::array<int, 7> all = {boundary->count(FaceKind::patch), boundary->count(FaceKind::scroll),
                              boundary->count(FaceKind::facet)};
    for (const HullCurve& c : boundary->curves) ++all[3 + std::size_t(c.kind)];
    return all;
  }

  /// `merging`: there are free ends, whose directions are extrapolated.
  void expect_sound(bool merging = false) const {
    for (const Unresolved& u : boundary->unresolved) ADD_FAILURE() << u.reason;
    Hull hull;
    hull.boundary = boundary;
    const BoundaryFacts facts = boundary_facts(scene, hull, 100);
    BoundaryFacts judged = facts;
    if (merging) judged.support = std::max(0.0, judged.support - 1e-7);
    EXPECT_TRUE(judged.sound()) << facts;
  }
};

using Counts = std::array<int, 7>;

TEST(Stitch, TwoSpheres) {
  const Stitched balls(two_spheres(1, 0.5, 3));
  balls.expect_sound();
  EXPECT_EQ(balls.counts(), (Counts{2, 1, 0, 2, 0, 0, 0}));
  for (const HullCurve& c : balls.boundary->curves) {
    EXPECT_TRUE(c.closed);
    EXPECT_EQ(c.points.front(), c.points.back());
    // The patch to the left, seen from outside: left of the way round is away from the scroll.
    ASSERT_EQ(balls.boundary->faces[std::size_t(c.faces[0])].kind, FaceKind::patch);
    const dvec3 center = 0.5 * (c.points[0] + c.points[c.points.size() / 2]);
    const dvec3 along = c.points[1] - c.points[0];
    const dvec3 left = glm::cross(c.points[0] - center, along);
    EXPECT_GT(left.z * center.z, 0);
  }
}

TEST(Stitch, ThreeSpheres) {
  const Shape ball = mapped(sphere(0.5), skew_rotation());
  const Stitched balls(ball + shifted(ball, {2, 0, 0.1}) + shifted(ball, {0.9, 1.7, -0.2}));
  balls.expect_sound();
  EXPECT_EQ(balls.counts(), (Counts{3, 3, 2, 6, 0, 0, 6}));
}

TEST(Stitch, SphereAndPoint) {
  const Stitched both(sphere(1) + Shape{{}, {}, {{0.1, 0.2, 3}}});
  both.expect_sound();
  EXPECT_EQ(both.counts(), (Counts{1, 1, 0, 1, 0, 0, 0}));
}

TEST(Stitch, StraightEdges) {
  // Segments between vertices are no scrolls.
  const Stitched points(
      {{}, {segment({0, 0, 0}, {1, 0, 0}), segment({0, 1, 0.1}, {0.1, 0.9, 1})}, {}});
  points.expect_sound();
  const Counts counts = points.counts();
  EXPECT_EQ(counts[1], 0);
  EXPECT_EQ(counts[2], 4);
  EXPECT_EQ(counts[6], 6);
}

/// Scrolls name the curves along their contacts on edges.
TEST(Stitch, Curves) {
  const Stitched cubic({{}, {twisted_cubic()}, {}});
  EXPECT_EQ(cubic.counts(), (Counts{0, 2, 0, 0, 1, 0, 1}));
  cubic.expect_sound(true);
  const Stitched both(oloid());
  EXPECT_EQ(both.counts(), (Counts{0, 1, 0, 0, 2, 0, 0}));
  both.expect_sound();
}

/// Borders of open patches that are on the hull in part.
TEST(Stitch, OpenPatches) {
  const dmat3 over(1, 0, 0, 0, -1, 0, 0, 0, -1);
  const Stitched bowls(spherical_cap(1) + shifted(mapped(spherical_cap(1), over), {0.3, 0.1, -1}));
  bowls.expect_sound();
  const Counts counts = bowls.counts();
  EXPECT_EQ(counts[0], 2);
  EXPECT_EQ(counts[1], 1);
  EXPECT_EQ(counts[2], 0);
  EXPECT_EQ(counts[5] + counts[6], 0);
  EXPECT_GE(counts[4], 2);
  for (const HullCurve& c : bowls.boundary->curves) {
    EXPECT_EQ(c.source >= 0, c.kind == HullCurveKind::edge);
  }
}

TEST(Stitch, SharpEdges) {
  // A cushion: two bulging sheets that meet in a sharp rim of four curved edges.
  const auto sheet = [](double bulge) {
    BezierPatch patch{2, 2, {}};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const bool inner = i == 1 && j == 1;
        const double rise = i == 1 || j == 1 ? 0.4 : 0;  // the rim is no plane curve
        patch.points.push_back(
            homogeneous(dvec3((i - 1) * (j == 1 ? 1.3 : 1), (j - 1) * (i == 1 ? 1.2 : 1),
                              inner ? bulge : rise * (i == 1 ? 0.5 : -0.5))));
      }
    }
    return of_patch(patch);
  };
  const Stitched cushion(sheet(1.5) + sheet(-1.5));
  EXPECT_EQ(cushion.boundary->count(FaceKind::patch), 2);
  EXPECT_GE(cushion.counts()[4], 4);
  for (const HullCurve& c : cushion.boundary->curves) {
    EXPECT_EQ(c.source >= 0, c.kind == HullCurveKind::edge);
    EXPECT_TRUE(c.faces[0] >= 0 && c.faces[1] >= 0);
  }
}

/// A half sphere about the origin, over z = 0.
Shape half_sphere() {
  const BezierCurve arc{{{0, 0, 1, 1}, homogeneous({1, 0, 1}, std::sqrt(0.5)), {1, 0, 0, 1}}};
  return {{revolved(as_nurbs(arc))}, {}, {}};
}

Shape over(const Shape& shape) { return mapped(shape, {1, 0, 0, 0, -1, 0, 0, 0, -1}); }

/// What lies to the left and to the right of curves, as kinds in ascending order.
using Between = std::array<FaceKind, 2>;

struct CurveCase {
  const char* name;
  Shape shape;
  Counts counts;
  /// Of its curves, that are all alike.
  HullCurveKind kind;
  Between between;
  bool closed;
};

std::vector<CurveCase> curve_cases() {
  const Between scroll_facet = {FaceKind::scroll, FaceKind::facet};
  const Between patch_facet = {FaceKind::patch, FaceKind::facet};
  const Between patch_scroll = {FaceKind::patch, FaceKind::scroll};
  const Shape lid = disc(std::sqrt(1 - 0.4 * 0.4), 0.4);
  return {
      {"cylinder", cylinder(1, 2), {0, 1, 2, 0, 2, 0, 0}, HullCurveKind::edge, scroll_facet, true},
      {"solid cylinder",
       solid_cylinder(1, 2),
       {0, 1, 2, 0, 2, 0, 0},
       HullCurveKind::edge,
       scroll_facet,
       true},
      {"cone", solid_cone(1, 2), {0, 1, 1, 0, 1, 0, 0}, HullCurveKind::edge, scroll_facet, true},
      {"torus", torus(2, 0.5), {1, 0, 2, 2, 0, 0, 0}, HullCurveKind::bitangent, patch_facet, true},
      {"cap", spherical_cap(0.6), {1, 0, 1, 0, 1, 0, 0}, HullCurveKind::edge, patch_facet, true},
      {"cap on its lid",
       spherical_cap(0.6) + lid,
       {1, 0, 1, 0, 1, 0, 0},
       HullCurveKind::edge,
       patch_facet,
       true},
      {"capsule",
       cylinder(1, 2) + shifted(half_sphere(), {0, 0, 2}) + over(half_sphere()),
       {2, 1, 0, 2, 0, 0, 0},
       HullCurveKind::bitangent,
       patch_scroll,
       true},
      {"box",
       box(1, 2, 3),
       {0, 0, 6, 0, 0, 0, 12},
       HullCurveKind::ruling,
       {FaceKind::facet, FaceKind::facet},
       false},
      {"tori about one centre",
       torus(1, 0.25) + mapped(torus(1, 0.25), {1, 0, 0, 0, 0, -1, 0, 1, 0}),
       {4, 4, 0, 8, 0, 0, 0},
       HullCurveKind::bitangent,
       patch_scroll,
       false},
      {"perpendicular circles",
       perpendicular_circles(),
       {0, 4, 0, 0, 4, 0, 0},
       HullCurveKind::edge,
       {FaceKind::scroll, FaceKind::scroll},
       false},
  };
}

/// The kinds of faces about all curves, and whether they close up.
TEST(Stitch, CurvesBetweenRuledFacesAndFacets) {
  for (const CurveCase& each : curve_cases()) {
    for (const bool turned : {false, true}) {
      SCOPED_TRACE(each.name + std::string(turned ? ", turned" : ""));
      const Stitched s(turned ? mapped(each.shape, skew_rotation()) : each.shape);
      s.expect_sound();
      EXPECT_EQ(s.counts(), each.counts);
      for (const HullCurve& c : s.boundary->curves) {
        EXPECT_EQ(c.kind, each.kind);
        EXPECT_EQ(c.closed, each.closed);
        EXPECT_EQ(c.source >= 0, c.kind == HullCurveKind::edge);
        ASSERT_TRUE(c.faces[0] >= 0 && c.faces[1] >= 0);
        Between kinds = {s.boundary->faces[std::size_t(c.faces[0])].kind,
                         s.boundary->faces[std::size_t(c.faces[1])].kind};
        std::sort(kinds.begin(), kinds.end());
        EXPECT_EQ(kinds, each.between);
        if (c.closed) {
          EXPECT_EQ(c.points.front(), c.points.back());
        }
      }
    }
  }
}

/// A half sphere on a cylinder that goes on from it smoothly, with a sharp rim below.
TEST(Stitch, SeamsOfRuledFacesAreBitangents) {
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    const Stitched dome(mapped(cylinder(1, 2) + shifted(half_sphere(), {0, 0, 2}), turn));
    dome.expect_sound();
    EXPECT_EQ(dome.counts(), (Counts{1, 1, 1, 1, 1, 0, 0}));
  }
}

TEST(Stitch, OrderOfTheInputDoesNotMatter) {
  Shape forward = blob(2);
  Shape backward = forward;
  std::reverse(backward.surfaces.begin(), backward.surfaces.end());
  EXPECT_EQ(Stitched(forward).counts(), Stitched(backward).counts());
  EXPECT_EQ(Stitched(forward).counts(),
            Stitched(mapped(forward, skew_rotation(), {5, 6, 7})).counts());
}

}  // namespace
}  // namespace taut
