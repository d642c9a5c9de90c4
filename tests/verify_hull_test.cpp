#include "taut/verify/verify_hull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "boundaries.h"
#include "sound_hull.h"
#include "taut/hull/convex_hull.h"
#include "taut/io/document/boundary_document.h"
#include "taut/io/document/polyhedral_document.h"
#include "taut/io/document/read_hull.h"
#include "taut/io/document/write_hull.h"
#include "taut/verify/closest_on_surface.h"
#include "truths.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// What boundaries that are put together by hand are held to.
constexpr double nearly_exact = 3e-14;

VerifyOptions quick() {
  VerifyOptions options;
  options.random_directions = 2000;
  return options;
}

HullVerification verified_boundary(const KnownBoundary& known) {
  return verify(hull_document(known.scene, known.boundary), known.scene, quick());
}

TEST(VerifyHull, ExactBoundariesPass) {
  for (const dvec3& shift : {dvec3(0.0), dvec3(3, -2, 1)}) {
    const HullVerification facets = verified_boundary(tetrahedron_boundary(shift));
    EXPECT_TRUE(facets.is_hull(nearly_exact)) << facets.euler << " " << facets.flatness;
    EXPECT_EQ(facets.directions, 4 + 2000);
    const HullVerification spheres =
        verified_boundary(two_spheres_boundary(skew_rotation(), shift));
    EXPECT_TRUE(spheres.is_hull(nearly_exact));
    EXPECT_EQ(spheres.euler, 2);
    EXPECT_EQ(spheres.uncovered, 0);
    EXPECT_GT(spheres.tangency + spheres.off_source, 0) << "something was measured";
  }
}

TEST(VerifyHull, FacetsWithCurvedSidesPass) {
  for (const KnownBoundary& known :
       {cylinder_boundary(), cylinder_boundary(skew_rotation(), dvec3(3, -2, 1)), cap_boundary(0.6),
        half_torus_boundary(2, 0.5), torus_boundary(2, 0.5), paraboloid_boundary()}) {
    const HullVerification found = verified_boundary(known);
    EXPECT_TRUE(found.is_hull(nearly_exact)) << found.euler << " " << found.uncovered;
    EXPECT_EQ(found.euler, 2);
  }
}

TEST(VerifyHull, DamagedSidesAreFound) {
  const KnownBoundary known = cap_boundary(0.6);
  const auto damaged = [&](auto damage) {
    HullDocument hull = hull_document(known.scene, known.boundary);
    damage(hull.faces[1].sides[1]);
    return verify(hull, known.scene, quick());
  };
  EXPECT_GT(damaged([](HullDocument::Side& side) { side.to = side.from; }).off_source, 0.1);
  EXPECT_GT(damaged([](HullDocument::Side& side) { side.from[0] = -1; }).off_source, 0.1);
  EXPECT_GT(damaged([](HullDocument::Side& side) {
              side.source = 0;
              side.from = side.to = {0.5, 0.5};
            }).flatness,
            0.1);
}

TEST(VerifyHull, PolyhedralHullsPass) {
  const std::vector<std::vector<dvec3>> sets = {
      {{1, 2, 3}},
      {{0, 0, 0}, {1, 2, 2}},
      {{0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}},
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0.2, 0.2, 0.2}},
  };
  for (const std::vector<dvec3>& points : sets) {
    const Scene scene = make_scene({{}, {}, points});
    const HullDocument hull = hull_document(scene.model(), convex_hull(scene.model()).mesh);
    EXPECT_TRUE(verify(hull, scene, quick()).is_hull(1e-15)) << points.size();
  }
}

/// Damages the document of the two spheres.
template <class Damage>
HullVerification damaged(const Damage& damage) {
  static const KnownBoundary known = two_spheres_boundary();
  HullDocument hull = hull_document(known.scene, known.boundary);
  damage(hull);
  const HullVerification found = verify(hull, known.scene, quick());
  EXPECT_FALSE(found.is_hull(1e-6));
  return found;
}

TEST(VerifyHull, EveryDamageIsFound) {
  EXPECT_FALSE(damaged([](HullDocument& hull) { hull.curves[0].faces[0] = -1; }).complete);
  EXPECT_FALSE(damaged([](HullDocument& hull) { hull.faces[0].loops.clear(); }).closed);
  EXPECT_FALSE(
      damaged([](HullDocument& hull) { hull.faces[2].curves[0] = {}; }).topological_sphere());
  EXPECT_FALSE(damaged([](HullDocument& hull) { hull.faces[2].curves[0] = {1}; }).closed);
  EXPECT_FALSE(damaged([](HullDocument& hull) { hull.curves[0].points.pop_back(); }).closed);
  EXPECT_FALSE(damaged([](HullDocument& hull) {
                 std::swap(hull.curves[0].faces[0], hull.curves[0].faces[1]);
               }).closed);
  EXPECT_NEAR(damaged([](HullDocument& hull) {
                hull.faces[2].rulings[20].b.p.z += 1e-3 * hull.diagonal;
              }).off_source,
              1e-3, 1e-9);
  EXPECT_GT(damaged([](HullDocument& hull) { hull.faces[2].rulings[20].a.uv[1] += 1e-3; }).tangency,
            1e-5);
  EXPECT_EQ(
      damaged([](HullDocument& hull) { hull.faces[2].rulings[20].a.uv[1] = -0.5; }).off_source,
      std::numeric_limits<double>::infinity());
  EXPECT_GT(damaged([](HullDocument& hull) {
              for (HullDocument::Ruling& r : hull.faces[2].rulings) r.n = -r.n;
            }).model_outside,
            0.1);
  EXPECT_GT(damaged([](HullDocument& hull) {
              for (HullDocument::Ruling& r : hull.faces[2].rulings) r.b.p += 1e-3 * r.n;
            }).hull_outside,
            1e-5);
  EXPECT_GT(damaged([](HullDocument& hull) { hull.faces[1].regions.pop_back(); }).uncovered, 50);
  EXPECT_GT(damaged([](HullDocument& hull) {
              for (HullDocument::Region& region : hull.faces[0].regions) {
                for (dvec2& p : region.loops[0]) p.y = 1 + 0.8 * (p.y - 1);
              }
            }).uncovered,
            20);
}

/// What taut hull writes of a model passes taut verify.
void expect_written_hull_passes(const Shape& shape) {
  const Sound sound = sound_hull(shape);
  for (const DocumentEncoding encoding : {DocumentEncoding::json, DocumentEncoding::cbor}) {
    const HullDocument read = read_hull(to_document(sound.hull, encoding), "hull", encoding);
    const HullVerification found = verified(read, sound.scene);
    EXPECT_TRUE(found.is_hull(exact)) << text_of(found);
  }
}

class VerifyTruths : public testing::TestWithParam<Truth> {};

TEST_P(VerifyTruths, Pass) { expect_written_hull_passes(GetParam().shape); }
TEST_P(VerifyTruths, TurnedPass) {
  expect_written_hull_passes(mapped(GetParam().shape, skew_rotation(), {0.1, -0.2, 0.3}));
}

INSTANTIATE_TEST_SUITE_P(Hulls, VerifyTruths, testing::ValuesIn(truths()),
                         [](const auto& info) { return test_name(info.param); });

template <class Jet>
double distance_to(const dvec3& p, const Jet& jet) {
  return closest_on_surface(p, jet, {6, 6}).distance;
}

/// A curve that turns so sharply that samples beside a point are all farther than one across.
TEST(VerifyHull, FindsPointsBesideSharpTurns) {
  const BezierCurve turn = {{{1.3, 0.94, 0, 1},
                             {0.8, 0.3, 0, 1},
                             {1.53, 0.31, 0, 1},
                             {1.99, 0.16, 0, 1},
                             {1.96, 0.134, 0, 1},
                             {0.24, 0.59, 0, 1}}};
  const auto along = [&](double s) {
    const CurveJet j = jet(turn, s);
    return SourceJet{1, j.c, {j.ct, dvec3(0.0)}, j.ctt};
  };
  const auto wall = [&](const dvec2& t) {
    const CurveJet j = jet(turn, t.x);
    return SourceJet{2, j.c + dvec3(0, 0, 5 * t.y), {j.ct, dvec3(0, 0, 5)}};
  };
  for (int k = 0; k <= 200; ++k) {
    const double s = k / 200.0;
    EXPECT_LE(closest_on_curve(along(s).x, 0, 1, along).distance, 1e-13) << s;
    EXPECT_LE(closest_on_surface(wall({s, 0.3}).x, wall, {10, 6}).distance, 1e-13) << s;
  }
}

/// A quarter of a cylinder of radius 1 and height 2.
TEST(VerifyHull, DistancesFromSurfaces) {
  const auto jet = [](const dvec2& t) {
    const double angle = std::numbers::pi / 2 * t.x;
    const dvec3 x(std::cos(angle), std::sin(angle), 2 * t.y);
    const dvec3 along = std::numbers::pi / 2 * dvec3(-x.y, x.x, 0);
    return SourceJet{2, x, {along, dvec3(0, 0, 2)}};
  };
  for (const double angle : {0.0, 0.3, 1.2}) {
    const dvec3 on(std::cos(angle), std::sin(angle), 1.37);
    EXPECT_LE(distance_to(on, jet), 4e-16);
    for (const double off : {-1e-3, 1e-9, 0.1}) {
      const dvec3 p((1 + off) * on.x, (1 + off) * on.y, on.z);
      EXPECT_NEAR(distance_to(p, jet), std::abs(off), 1e-15) << angle;
    }
  }
  EXPECT_NEAR(distance_to({1, 0, 5}, jet), 3, 1e-15) << "beyond its border";
  EXPECT_NEAR(distance_to({1, -2, 2}, jet), 2, 1e-15);
}

/// Near a point that a side is collapsed to, whatever meridian the nearest sample is on.
TEST(VerifyHull, FindsPointsOfPatchesNearPoles) {
  for (const NurbsSurface& surface : mapped(sphere(1), skew_rotation()).surfaces) {
    for (const PatchPiece& piece : decompose(surface)) {
      const auto at = [&](const dvec2& t) {
        const PatchJet1 j = jet1(piece.bezier, t.x, t.y);
        return SourceJet{2, j.S, {j.Su, j.Sv}};
      };
      for (const double u : {0.0014, 0.109, 0.5, 0.8906, 0.9986}) {
        for (const double v : {0.0001, 0.0105, 0.05, 0.9506, 0.9895, 0.9999}) {
          EXPECT_LE(distance_to(at({u, v}).x, at), 1e-12) << u << " " << v;
        }
      }
    }
  }
}

/// A hull may name any of the copies in one place, though queries know the first only.
TEST(VerifyHull, AnyOfExactCopiesMayBeNamed) {
  for (const Shape& shape : {two_spheres(1, 0.5, 3), filleted_box(3, 2, 1, 0.25)}) {
    const Model once = make_model(shape);
    const Scene one(once, {.threads = 1, .progress = {}});
    const Hull hull = convex_hull(one, {.relative = 1e-2, .threads = 1, .progress = {}});
    const HullDocument document = hull_document(one, *hull.boundary);
    Model twice = once;
    twice.add_instance(0, RigidMotion{});
    const Scene scene(twice, {.threads = 1, .progress = {}});
    for (const int first_source : {0, once.source_count()}) {
      HullDocument named = document;
      for (HullDocument::Source& source : named.sources) source.id += first_source;
      const HullVerification found = verify(named, scene, quick());
      EXPECT_TRUE(found.is_hull(1e-9)) << first_source;
      EXPECT_EQ(found.uncovered, 0);
    }
  }
}

TEST(VerifyHull, OfAnotherModelFails) {
  const KnownBoundary known = two_spheres_boundary();
  const HullDocument hull = hull_document(known.scene, known.boundary);
  const HullVerification larger = verify(hull, make_scene(two_spheres(1.01, 0.5, 3)), quick());
  EXPECT_GT(larger.model_outside, 1e-3);
  EXPECT_FALSE(larger.is_hull(1e-4));
  EXPECT_GT(verify(hull, make_scene(two_spheres(0.99, 0.49, 3)), quick()).hull_outside, 1e-3);
  EXPECT_FALSE(verify(hull, make_scene(torus(2, 0.5)), quick()).is_hull(0.1));
}

}  // namespace
}  // namespace taut
