#include "judge/judge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "cages.h"
#include "judge/cases.h"
#include "judge/claims.h"
#include "judge/families.h"
#include "judge/support_reference.h"
#include "limit_support.h"
#include "taut/bounds/model_support.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/convex_hull.h"
#include "temporary_folder.h"

namespace taut_test {
namespace {

using taut::ArcPiece;
using taut::Hull;
using taut::HullBoundary;
using taut::Ruling;
using taut::Scene;
using taut::SeparatingArc;
using taut::SupportQuery;

TEST(SupportReference, IsThatOfClosedForms) {
  Random random(1);
  const SupportReference block(box(1, 2, 3));
  const SupportReference ball(shifted(sphere(2), {1, 0, 0}));
  const SupportReference egg(ellipsoid(3, 2, 1));
  const SupportReference ring(torus(3, 1));
  const SupportReference corners(Shape{{}, {}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
  for (int k = 0; k < 100; ++k) {
    const dvec3 n = random_direction(random);
    const double upper = std::max(n.x, 0.0) + 2 * std::max(n.y, 0.0) + 3 * std::max(n.z, 0.0);
    EXPECT_NEAR(block(n).h, upper, 1e-14);
    EXPECT_NEAR(ball(n).h, 2 + n.x, 1e-14);
    EXPECT_NEAR(egg(n).h, glm::length(n * dvec3(3, 2, 1)), 1e-13);
    EXPECT_NEAR(ring(n).h, 1 + 3 * std::hypot(n.x, n.y), 1e-13);
    EXPECT_EQ(corners(n).h, std::max({n.x, n.y, n.z}));
    EXPECT_EQ(glm::dot(egg(n).x, n), egg(n).h);
  }
}

TEST(SupportReference, IsThatOfQueries) {
  Random random(2);
  for (const Shape& shape : {teapot(), blob(3)}) {
    const SupportReference reference(shape);
    const Scene scene = make_scene(shape);
    SupportQuery query(scene);
    for (int k = 0; k < 50; ++k) {
      const dvec3 n = random_direction(random);
      EXPECT_NEAR(reference(n).h, support(query, scene, n).h, 1e-12 * reference.diagonal());
    }
  }
}

/// A way leads along the rim of a torus, however far, and over a lens's edge, not over the gap
/// between two balls.
TEST(SupportReference, ClimbsFromWhereItIs) {
  const SupportReference ring(torus(3, 1));
  EXPECT_NEAR(ring.climbed_from({0, -3, 1}, glm::normalize(dvec3(0, 1e-6, 1)), 1e-9), 1 + 3e-6,
              1e-11);
  const SupportReference balls(sphere(1) + shifted(sphere(1), {3, 0, 0}));
  EXPECT_NEAR(balls.climbed_from({0, 0, 1}, {1, 0, 0}, 1e-9), 1, 1e-12);
  EXPECT_EQ(balls.climbed_from({0, 0, 2}, {1, 0, 0}, 1e-9), -taut::infinity);
}

std::vector<Family> all_families() {
  std::vector<Family> all;
  for (const FamilyGroup& group : family_groups()) {
    all.insert(all.end(), group.families.begin(), group.families.end());
  }
  return all;
}

TEST(Families, AreManyAndOfTheirOwn) {
  EXPECT_GE(all_families().size(), 40U);
  for (const Family& family : all_families()) {
    Random first(1), again(1), other(2);
    const Natural one = placed(family.make(first), Variant::decimals, first);
    const Natural same = placed(family.make(again), Variant::decimals, again);
    const Natural another = placed(family.make(other), Variant::decimals, other);
    const auto numbers = [](const Natural& natural) {
      std::vector<dvec3> points = natural.shape.points;
      for (const NurbsSurface& s : natural.shape.surfaces) {
        for (const dvec4& p : s.points) points.push_back(dvec3(p));
      }
      for (const NurbsCurve& c : natural.shape.curves) {
        for (const dvec4& p : c.points) points.push_back(dvec3(p));
      }
      if (natural.cage) {
        points.insert(points.end(), natural.cage->points.begin(), natural.cage->points.end());
      }
      return points;
    };
    EXPECT_FALSE(numbers(one).empty()) << family.name;
    EXPECT_EQ(numbers(one), numbers(same)) << family.name;
    EXPECT_NE(numbers(one), numbers(another)) << family.name;
  }
}

Family family_of(const std::string& name) {
  for (const Family& family : all_families()) {
    if (family.name == name) return family;
  }
  throw std::invalid_argument(name);
}

/// Families that are right as they are drawn, and turned.
TEST(Judge, FindsExactModelsRight) {
  for (const char* name :
       {"box", "capsule", "cam", "two_circles", "overlapping_balls", "grid_of_points"}) {
    for (const Variant variant : {Variant::clean, Variant::turned}) {
      Random random(1);
      const Verdict verdict = judged(family_of(name).make(random), variant, random);
      EXPECT_TRUE(verdict.closed) << name << " " << name_of(variant);
      EXPECT_TRUE(verdict.verified) << name << " " << name_of(variant);
      EXPECT_EQ(verdict.wrong, "") << name << " " << name_of(variant);
      EXPECT_EQ(verdict.miscounted, "") << name << " " << name_of(variant);
    }
  }
}

class Planted : public testing::Test {
 protected:
  /// Of a body of two caps whose hull has a scroll.
  const Shape shape_ = sphere(2) + shifted(sphere(1), {4, 0, 0});
  const Hull hull_ = taut::convex_hull(make_scene(shape_));
  Random random_ = Random(1);
};

TEST_F(Planted, NothingIsWrongAsItIs) {
  EXPECT_EQ(wrong_places(*hull_.boundary, SupportReference(shape_), random_), "");
}

TEST_F(Planted, PlaceThatIsLower) {
  HullBoundary boundary = *hull_.boundary;
  for (SeparatingArc& arc : boundary.arcs) {
    for (ArcPiece& piece : arc.pieces) {
      for (Ruling& ruling : piece.rulings) ruling.point[0] -= 1e-8 * ruling.n;
    }
  }
  EXPECT_NE(wrong_places(boundary, SupportReference(shape_), random_), "");
}

/// A third ball that reaches through the scroll by a millionth.
TEST_F(Planted, PartThatWasMissed) {
  const dvec3 n = glm::normalize(dvec3(0.25, std::sqrt(1 - 0.0625), 0));
  const Shape bump = shifted(
      sphere(0.5), (1.5 + 1e-6) * n + dvec3(2, -0.5, 0) - glm::dot(dvec3(2, -0.5, 0), n) * n);
  const std::string wrong = wrong_places(*hull_.boundary, SupportReference(shape_ + bump), random_);
  EXPECT_NE(wrong.find("place"), std::string::npos) << wrong;
}

TEST_F(Planted, VolumeThatIsOff) {
  Random random(1);
  Natural natural = family_of("capsule").make(random);
  natural.expected.volume *= 1 + 1e-8;
  const Verdict verdict = judged(natural, Variant::clean, random);
  EXPECT_EQ(verdict.wrong, "volume off by 1e-08");
  EXPECT_EQ(verdict.measured, "VW");
}

TEST_F(Planted, MeanWidthThatIsOff) {
  Random random(1);
  Natural natural = family_of("capsule").make(random);
  natural.expected.mean_width *= 1 + 1e-8;
  EXPECT_EQ(judged(natural, Variant::clean, random).wrong, "mean width off by 1e-08");
}

TEST_F(Planted, CountsThatDiffer) {
  Random random(1);
  Natural natural = family_of("capsule").make(random);
  natural.expected.counts = {2, 3, -1, 2};
  const Verdict verdict = judged(natural, Variant::clean, random);
  EXPECT_EQ(verdict.miscounted, "2/1/0/2, not 2/3/-/2");
  EXPECT_EQ(verdict.wrong, "");
}

ControlCage grown(ControlCage cage, double factor) {
  for (dvec3& p : cage.points) p *= factor;
  return cage;
}

/// What the judge says of a cage's hull if the cage were larger by a factor.
std::string wrong_if_grown(double factor) {
  Random random(1);
  const ControlCage cage = torus_cage(5, 5);
  return judged({cage_model(cage), {}, {}, grown(cage, factor)}, random).wrong;
}

TEST(PlantedInCages, MeshThatIsOff) {
  EXPECT_EQ(wrong_if_grown(1), "");
  EXPECT_TRUE(wrong_if_grown(1.01).starts_with("the mesh leaves its bound"));
  EXPECT_TRUE(wrong_if_grown(0.99).starts_with("the mesh lies outside"));
}

TEST(PlantedInCages, ContactsThatAreOff) {
  ControlCage cage = l_profile_cage();
  // About a point inside, so that all support values grow.
  for (dvec3& p : cage.points) p -= dvec3(0.75, 0.75, 0.5);
  const Scene scene(cage_model(cage));
  const Hull hull = taut::convex_hull(scene);
  const double size = scene.diagonal(), slack = scene.model().deviation_bound();
  const auto wrong = [&](double factor) {
    const LimitSupport limit(grown(cage, factor), 3);
    Random random(1);
    return wrong_contacts(
        *hull.boundary, [&](const dvec3& n) { return limit(n, 1e-9 * size); }, size, slack, random);
  };
  EXPECT_EQ(wrong(1), "");
  EXPECT_TRUE(wrong(1 + 1e-7).starts_with("a place is surpassed"));
  EXPECT_TRUE(wrong(1 - 1e-7).starts_with("a place lies outside"));
}

/// The vertices have two faces, and Loop's triangles have edges between the same vertices.
TEST(LimitSupport, OfFacesBackToBack) {
  ControlCage quads;
  quads.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  quads.faces = {{0, 1, 2, 3}, {3, 2, 1, 0}};
  ControlCage triangles;
  triangles.scheme = CageScheme::loop;
  triangles.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangles.faces = {{0, 1, 2}, {2, 1, 0}};
  Random random(3);
  for (const ControlCage& cage : {quads, triangles}) {
    const LimitSupport coarse(cage, 2), fine(cage, 6);
    for (int k = 0; k < 20; ++k) {
      const dvec3 n = random_direction(random);
      EXPECT_LE(coarse(n, 1e-9).lower, fine(n, 1e-9).upper + 1e-12);
      EXPECT_LE(fine(n, 1e-9).lower, coarse(n, 1e-9).upper + 1e-12);
    }
  }
}

TEST(Counts, DifferWhereTheyAreKnown) {
  EXPECT_EQ(text(Counts{1, -1, 0, 12}), "1/-/0/12");
  EXPECT_FALSE(differ({1, 2, 3, 4}, {1, -1, 3, -1}));
  EXPECT_FALSE(differ({1, 2, 3, 4}, {}));
  for (const Counts& other : {Counts{2}, Counts{-1, 3}, Counts{-1, -1, 4}, Counts{1, 2, 3, 5}}) {
    EXPECT_TRUE(differ({1, 2, 3, 4}, other)) << text(other);
  }
}

class Cases : public TemporaryFolder {};

/// A document's geometry is what the reader makes of it.
TEST_F(Cases, AreReadTwice) {
  file("case.taut.json", R"({"format": "taut-model", "version": 1, "parts": [{"name": "part",
    "surfaces": [{"id": 0, "name": "s", "degree": [1, 2],
                  "knots": [[0, 0, 1, 1], [0, 0, 0, 1, 1, 1]],
                  "points": [[[0, 0, 0, 1], [3, 0, 0, 2], [3, 3, 0, 1]],
                             [[0, 0, 5, 1], [2, 0, 6, 0.5], [3, 2, 5, 1]]]}],
    "edges": [{"degree": 2, "knots": [0, 0, 0, 1, 1, 1],
               "points": [[0, 0, 0, 1], [-3, -5, 0, 0.7], [1, 0, -4, 1]]}],
    "vertices": [[0, 7, 1]]}]})");
  const Subject subject = read_case(folder_, {"case.taut.json"});
  ASSERT_EQ(subject.shape.surfaces.size(), 1U);
  ASSERT_EQ(subject.shape.curves.size(), 1U);
  ASSERT_EQ(subject.shape.points.size(), 1U);
  const SupportReference reference(subject.shape);
  const Scene scene(subject.model);
  SupportQuery query(scene);
  Random random(4);
  for (int k = 0; k < 50; ++k) {
    const dvec3 n = random_direction(random);
    EXPECT_NEAR(reference(n).h, support(query, scene, n).h, 1e-12 * reference.diagonal());
  }
}

TEST(CaseGroups, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const CaseGroup& group : case_groups()) {
    for (const Case& one : group.cases) {
      EXPECT_TRUE(one.name().starts_with(group.name + "/")) << one.name();
      EXPECT_TRUE(names.insert(one.name()).second) << one.name();
    }
  }
}

TEST(CaseGroups, AreInTheFolder) {
  const auto folder = folder_of_cases();
  if (!folder) GTEST_SKIP() << "TAUT_MODELS names no folder beside one of cases";
  for (const CaseGroup& group : case_groups()) {
    for (const Case& one : group.cases) {
      EXPECT_TRUE(std::filesystem::exists(*folder / one.file)) << one.file;
    }
  }
}

TEST(Judge, WantsSomethingToCompareWith) {
  Random random(1);
  EXPECT_THROW(judged({make_model(box(1, 2, 3)), {}, {}, {}}, random), std::invalid_argument);
}

}  // namespace
}  // namespace taut_test
