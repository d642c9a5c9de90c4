#include <gtest/gtest.h>

#include <string>

#include "exact_checks.h"
#include "judge/families.h"
#include "models.h"
#include "taut/hull/precise_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

Hull solved_hull_of(const Scene& scene) {
  HullOptions options;
  options.relative = 1e-2;
  options.threads = 1;
  options.curves = CurveMethod::solving;
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

/// What no exact boundary is found of as yet.
Shape unsolved() {
  for (const FamilyGroup& group : family_groups()) {
    for (const Family& family : group.families) {
      if (std::string(family.name) != "cut_by_edges") continue;
      Random random(1);
      const Natural natural = family.make(random);
      return placed(natural, Variant::float32, random).shape;
    }
  }
  return {};
}

/// It is told, and there is a closed boundary with its depth all the same.
TEST(SolvedHull, IsClosedWhereItIsNotExact) {
  const Scene scene = make_scene(unsolved());
  try {
    solved_hull_of(scene);
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
