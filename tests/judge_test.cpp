#include "judge/judge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "cages.h"
#include "judge/families.h"
#include "judge/support_reference.h"
#include "limit_support.h"
#include "taut/bounds/model_support.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/convex_hull.h"

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

TEST(Families, AreManyAndOfTheirOwn) {
  EXPECT_GE(families().size(), 40U);
  for (const Family& family : families()) {
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

const Family& family_of(const std::string& name) {
  for (const Family& family : families()) {
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
    }
  }
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
  natural.volume *= 1 + 1e-8;
  EXPECT_EQ(judged(natural, Variant::clean, random).wrong, "volume off by 1e-08");
}

}  // namespace
}  // namespace taut_test
