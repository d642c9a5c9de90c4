// Documents whose faces state that they are below their supporting planes, and by how much.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "boundaries.h"
#include "cages.h"
#include "judge/families.h"
#include "judge/judge.h"
#include "sound_hull.h"
#include "taut/core/tolerances.h"
#include "taut/hull/convex_hull.h"
#include "taut/io/document/boundary_document.h"
#include "taut/io/document/polyhedral_document.h"
#include "taut/io/report/report.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// What natural models are held to.
constexpr double nearly = 1e-9;

double largest_bound(const HullDocument& hull) {
  double largest = 0;
  for (const HullDocument::Face& face : hull.faces) largest = std::max(largest, face.tolerant);
  return largest;
}

int tolerant_faces(const HullDocument& hull) {
  return int(std::count_if(hull.faces.begin(), hull.faces.end(),
                           [](const HullDocument::Face& face) { return face.tolerant > 0; }));
}

/// A natural model's hull, solved, with a report.
Sound solved(const std::string& name, Variant variant) {
  for (const FamilyGroup& group : family_groups()) {
    for (const Family& family : group.families) {
      if (family.name != name) continue;
      taut_test::Random random(1);
      const Natural natural = family.make(random);
      Sound sound{make_scene(placed(natural, variant, random).shape), {}};
      HullOptions options;
      options.relative = 1e-2;
      options.threads = 1;
      const Hull hull = convex_hull(sound.scene, options);
      sound.hull = hull_document(sound.scene, *hull.boundary);
      state(sound.hull, hull.resolution.rho, tolerant_faces(sound.hull), largest_bound(sound.hull));
      return sound;
    }
  }
  throw std::logic_error("no such family");
}

struct Rounded {
  const char* family;
  Variant variant;
  /// Bounds are depths that were found; else the resolution, where no ruling is found between two,
  /// or what a patch that bends up at its outline amounts to.
  bool is_found = true;
};

class VerifyRounded : public testing::TestWithParam<Rounded> {};

/// Planes, cylinders and spheres that rounding has bent: with the bounds that they state, and with
/// no less.
TEST_P(VerifyRounded, HullsPassWithTheirBoundsOnly) {
  const Sound sound = solved(GetParam().family, GetParam().variant);
  ASSERT_GT(tolerant_faces(sound.hull), 0);
  const HullVerification whole = verified(sound.hull, sound.scene);
  EXPECT_TRUE(whole.is_hull(nearly)) << text_of(whole);

  const double largest = largest_bound(sound.hull) / sound.hull.diagonal;
  ASSERT_GT(largest, 4 * nearly);
  HullDocument less = sound.hull;
  for (HullDocument::Face& face : less.faces) face.tolerant *= 0.5;
  state(less, sound.hull.diagonal * resolution_floor, tolerant_faces(less), largest_bound(less));
  const HullVerification found = verified(less, sound.scene);
  EXPECT_FALSE(found.is_hull(nearly));
  if (GetParam().is_found) {
    EXPECT_GE(found.worst_length(), 0.4 * largest) << text_of(found);
  }
}

INSTANTIATE_TEST_SUITE_P(Natural, VerifyRounded,
                         testing::Values(Rounded{"box", Variant::float32},
                                         Rounded{"rounded_box", Variant::float32, false},
                                         Rounded{"cylinder", Variant::decimals},
                                         Rounded{"torus", Variant::float32, false}),
                         [](const auto& info) {
                           return std::string(info.param.family) + "_" +
                                  name_of(info.param.variant);
                         });

struct Stated {
  const char* family;
  Variant variant;
  unsigned long seed = 1;
};

class VerifyStated : public testing::TestWithParam<Stated> {};

/// What hulls of natural models and their reports state holds to 1e-12 of the diagonal: measures
/// where rulings end within kinks (ball_of_two_seams, gear, capsule), depths between rulings (wing,
/// open_cage) and along facets' sides (bolt, propeller), contacts that leave edges by their ends
/// (blade), pieces of one ruling or none (thread), edges off their faces (cut_by_edges), rulings to
/// and fro in a plane (wing, thread), widths (balls_in_a_row), labels (filleted_plate), stand-ins
/// (loop_cage), arcs that leave a cell and come back (bolt_circle), edges that turn sharply
/// (wires), ends of curved sides beside other places, and contacts that come back to a place of an
/// edge (terrain), points of copies that the hull does not name (copies_...), scrolls whose normals
/// turn where contacts pass over kinks (fuselage).
TEST_P(VerifyStated, HoldsWhatIsStated) {
  taut_test::Random random(GetParam().seed);
  for (const FamilyGroup& group : family_groups()) {
    for (const Family& family : group.families) {
      if (family.name != GetParam().family) continue;
      const Natural natural = placed(family.make(random), GetParam().variant, random);
      const Scene scene =
          natural.cage ? Scene(cage_model(*natural.cage)) : make_scene(natural.shape);
      HullOptions options;
      options.relative = 1e-2;
      options.threads = 1;
      const Hull hull = convex_hull(scene, options);
      ASSERT_TRUE(hull.boundary);
      EXPECT_TRUE(hull.boundary->unresolved.empty());
      const HullVerification found = verified(document_of(scene, hull), scene);
      EXPECT_TRUE(found.is_hull(1e-12)) << text_of(found);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Natural, VerifyStated,
    testing::Values(
        Stated{"gear", Variant::float32}, Stated{"capsule", Variant::float32},
        Stated{"wing", Variant::float32}, Stated{"wing", Variant::decimals},
        Stated{"bolt", Variant::decimals}, Stated{"propeller", Variant::decimals},
        Stated{"blade", Variant::float32}, Stated{"cut_by_edges", Variant::clean},
        Stated{"cut_by_edges", Variant::turned}, Stated{"thread", Variant::turned},
        Stated{"balls_in_a_row", Variant::float32}, Stated{"filleted_plate", Variant::float32},
        Stated{"loop_cage", Variant::clean}, Stated{"bolt_circle", Variant::clean, 2},
        Stated{"wires", Variant::turned, 2}, Stated{"terrain", Variant::turned, 2},
        Stated{"terrain", Variant::float32}, Stated{"copies_all_but_in_place", Variant::float32},
        Stated{"copies_all_but_in_place", Variant::clean, 2},
        Stated{"copies_all_but_in_place", Variant::turned},
        Stated{"copies_turned_a_little", Variant::decimals},
        Stated{"cut_by_edges", Variant::float32}, Stated{"plate_of_bosses", Variant::float32},
        Stated{"cup", Variant::float32}, Stated{"car_body", Variant::float32},
        Stated{"car_body", Variant::decimals}, Stated{"car_body", Variant::float32, 2},
        Stated{"car_body", Variant::decimals, 2}, Stated{"thread", Variant::float32},
        Stated{"thread", Variant::decimals}, Stated{"dome", Variant::float32, 2},
        Stated{"terrain", Variant::decimals}, Stated{"filleted_plate", Variant::decimals, 2},
        Stated{"gear", Variant::decimals, 2}, Stated{"open_cage", Variant::turned},
        Stated{"open_cage", Variant::float32}, Stated{"domes_in_a_row", Variant::decimals},
        Stated{"overlapping_walls", Variant::float32, 2},
        Stated{"balls_in_a_row", Variant::decimals, 3},
        Stated{"overlapping_walls", Variant::decimals, 3},
        Stated{"mirrored_domes", Variant::decimals, 2},
        Stated{"grid_of_points", Variant::decimals, 2}, Stated{"fuselage", Variant::float32},
        Stated{"fuselage", Variant::decimals}, Stated{"shaft", Variant::float32, 3}),
    [](const auto& info) {
      const std::string name = std::string(info.param.family) + "_" + name_of(info.param.variant);
      return info.param.seed == 1 ? name : name + "_of_seed_" + std::to_string(info.param.seed);
    });

/// Where edges and patches lie in one place a hull names one of them.
TEST(VerifyTolerant, OneOfSeveralInOnePlaceIsNamed) {
  const Sound duct = solved("duct", Variant::clean);
  EXPECT_EQ(verified(duct.hull, duct.scene).uncovered, 0);
}

/// The outlines of two domes over one square touch at its sides, between facets without area.
TEST(VerifyTolerant, PartsThatTouchInAPointAreOneSurface) {
  const Sound domes = solved("mirrored_domes", Variant::clean);
  const HullVerification found = verified(domes.hull, domes.scene);
  EXPECT_TRUE(found.closed);
  EXPECT_EQ(found.euler, 2);
}

/// A point beside a corner, above a facet, of which the document knows nothing.
TEST(VerifyTolerant, TheModelReachesNoFartherThanTheResolution) {
  std::vector<dvec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Scene known = make_scene({{}, {}, points});
  HullDocument hull = hull_document(known.model(), convex_hull(known.model()).mesh);
  points.emplace_back(1 - 1e-8, 2e-8, 0);
  const Scene scene = make_scene({{}, {}, points});
  const double height = 1e-8 / std::sqrt(3.0);
  EXPECT_EQ(failed(verified(hull, scene)), (std::set<std::string>{"covered", "model_outside"}));
  for (HullDocument::Face& face : hull.faces) {
    if (face.offset > 0.5) face.tolerant = 1.001 * height;
  }
  EXPECT_EQ(failed(verified(hull, scene)), std::set<std::string>{"covered"});
  state(hull, 3e-9, 1, 1.001 * height);
  EXPECT_EQ(failed(verified(hull, scene)), std::set<std::string>{"covered"});
  state(hull, 1e-8, 1, 1.001 * height);
  EXPECT_TRUE(verified(hull, scene).is_hull(exact)) << text_of(verified(hull, scene));
}

/// A tetrahedron with a facet's plane lowered.
Sound lowered(double depth, double bound) {
  KnownBoundary known = tetrahedron_boundary();
  HullDocument hull = hull_document(known.scene, known.boundary);
  hull.faces[0].offset -= depth * hull.diagonal;
  hull.faces[0].tolerant = bound * hull.diagonal;
  return {std::move(known.scene), hull};
}

TEST(VerifyTolerant, FacetsBelowTheirPlanes) {
  const Sound told = lowered(1e-7, 1e-7 + 1e-15);
  EXPECT_TRUE(verified(told.hull, told.scene).is_hull(exact));
  const Sound half = lowered(1e-7, 5e-8);
  EXPECT_EQ(failed(verified(half.hull, half.scene)),
            (std::set<std::string>{"flatness", "model_outside"}));
  EXPECT_NEAR(verified(half.hull, half.scene).model_outside, 5e-8, 1e-14);
  const Sound above = lowered(-1e-7, 1e-7 + 1e-15);
  EXPECT_EQ(failed(verified(above.hull, above.scene)), std::set<std::string>{"hull_outside"});
}

/// All else is held to the bounds, which must not be stated at will.
TEST(VerifyTolerant, BoundsHaveToBeWithinTheResolution) {
  const std::set<std::string> bounds = {"bounds"};
  EXPECT_EQ(failed(verified(lowered(0, 1e-4).hull, lowered(0, 0).scene)), bounds);
  EXPECT_EQ(failed(verified(lowered(0, -1e-9).hull, lowered(0, 0).scene)).count("bounds"), 1U);
  Sound stated = lowered(0, 1e-7);
  state(stated.hull, 3e-8 * stated.hull.diagonal, 1, stated.hull.faces[0].tolerant);
  EXPECT_TRUE(verified(stated.hull, stated.scene).is_hull(exact));
  state(stated.hull, 2e-8 * stated.hull.diagonal, 1, stated.hull.faces[0].tolerant);
  EXPECT_EQ(failed(verified(stated.hull, stated.scene)), bounds);
}

TEST(VerifyTolerant, ReportsTellTheFacesAndTheirBound) {
  const std::set<std::string> report = {"report"};
  Sound stated = lowered(0, 1e-7);
  const double bound = stated.hull.faces[0].tolerant;
  const double resolution = bound;
  state(stated.hull, resolution, 2, bound);
  EXPECT_EQ(failed(verified(stated.hull, stated.scene)), report);
  state(stated.hull, resolution, 1, 0.9 * bound);
  EXPECT_EQ(failed(verified(stated.hull, stated.scene)), report);
  state(stated.hull, resolution, 1, bound);
  EXPECT_TRUE(failed(verified(stated.hull, stated.scene)).empty());
}

/// A sliver across one of the tetrahedron's edges, whose corners run the wrong way about: told
/// apart or not by the resolution alone.
TEST(VerifyTolerant, SliversWithinTheResolutionHaveNoSense) {
  const auto faults = [](double width, double resolution, double bound) {
    KnownBoundary known = tetrahedron_boundary();
    HullDocument hull = hull_document(known.scene, known.boundary);
    HullDocument::Face& facet = hull.faces[0];
    const dvec3 a = facet.boundary[0];
    const dvec3 b = facet.boundary[1];
    const dvec3 inward = unit(glm::cross(facet.normal, b - a));
    facet.boundary.insert(facet.boundary.begin() + 1,
                          0.5 * (a + b) + width * hull.diagonal * inward);
    facet.tolerant = bound * hull.diagonal;
    if (resolution > 0) state(hull, resolution * hull.diagonal, 1, facet.tolerant);
    return failed(verified(hull, known.scene));
  };
  EXPECT_TRUE(faults(1e-8, 0, 0).contains("outlines"));
  EXPECT_TRUE(faults(1e-8, 1e-7, 0).contains("outlines"));
  EXPECT_FALSE(faults(1e-8, 1e-7, 1e-9).contains("outlines"));
  EXPECT_TRUE(faults(1e-6, 1e-7, 1e-9).contains("outlines"));
}

/// Rulings beside each other whose order is changed: their contacts are one to the resolution or
/// not.
TEST(VerifyTolerant, RulingsWithOneContactHaveNoOrder) {
  const KnownBoundary known = two_spheres_boundary();
  const auto faults = [&](double resolution, double bound) {
    HullDocument hull = hull_document(known.scene, known.boundary);
    HullDocument::Face& scroll = hull.faces[2];
    std::swap(scroll.rulings[4], scroll.rulings[5]);
    scroll.tolerant = bound * hull.diagonal;
    state(hull, resolution * hull.diagonal, tolerant_faces(hull), scroll.tolerant);
    return failed(verified(hull, known.scene));
  };
  const HullDocument sound = hull_document(known.scene, known.boundary);
  const HullDocument::Ruling& from = sound.faces[2].rulings[4];
  const HullDocument::Ruling& to = sound.faces[2].rulings[5];
  const double depth =
      std::max(glm::dot(from.a.p - to.a.p, from.n), glm::dot(from.b.p - to.b.p, from.n)) /
      sound.diagonal;
  EXPECT_TRUE(faults(1.001 * depth, 0).contains("order"));
  EXPECT_TRUE(faults(0.999 * depth, 1e-9).contains("order"));
  EXPECT_FALSE(faults(1.001 * depth, 1e-9).contains("order"));
}

/// Contacts of tolerant faces need not be tangent, others may be off by the resolution.
TEST(VerifyTolerant, TangencyIsNotAskedBelowTheResolution) {
  const KnownBoundary known = two_spheres_boundary();
  const auto turned = [&](double angle, double resolution, double bound) {
    HullDocument hull = hull_document(known.scene, known.boundary);
    HullDocument::Face& scroll = hull.faces[2];
    scroll.tolerant = bound * hull.diagonal;
    for (HullDocument::Ruling& r : scroll.rulings) r.n = unit(r.n + angle * dvec3(0, 0, 1));
    if (resolution > 0) {
      state(hull, resolution * hull.diagonal, tolerant_faces(hull), scroll.tolerant);
    }
    return failed(verified(hull, known.scene));
  };
  EXPECT_TRUE(turned(1e-8, 0, 0).contains("tangency"));
  EXPECT_FALSE(turned(1e-8, 1e-8, 0).contains("tangency"));
  EXPECT_TRUE(turned(1e-6, 1e-8, 0).contains("tangency"));
  EXPECT_FALSE(turned(1e-6, 1e-6, 2e-6).contains("tangency"));
  EXPECT_FALSE(turned(1e-6, 1e-6, 2e-6).contains("flatness"));
  EXPECT_TRUE(turned(1e-6, 1e-6, 1e-8).contains("flatness"));
}

}  // namespace
}  // namespace taut
