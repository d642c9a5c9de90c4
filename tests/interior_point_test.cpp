#include "taut/hull/measure/interior_point.h"

#include <gtest/gtest.h>

#include "boundaries.h"
#include "models.h"
#include "taut/bounds/support_query.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// In every direction the hull reaches farther, by a share of its size.
void expect_inside(const KnownBoundary& known) {
  const ContactGeometry geometry(known.scene);
  const dvec3 p = interior_point(geometry, known.boundary);
  SupportQuery query(known.scene);
  Random random(1);
  for (int k = 0; k < 500; ++k) {
    const dvec3 n = random_direction(random);
    EXPECT_GT(query(n).h - glm::dot(p, n), 1e-3);
  }
}

TEST(InteriorPoint, LiesInside) {
  expect_inside(tetrahedron_boundary());
  expect_inside(two_spheres_boundary(skew_rotation(), dvec3(30, -20, 10)));
  expect_inside(cylinder_boundary());
  expect_inside(half_torus_boundary(2, 0.5));
  expect_inside(torus_boundary(2, 0.5));
  expect_inside(paraboloid_boundary());
}

/// All of its curves are in one plane.
TEST(InteriorPoint, LiesInsideACap) {
  for (const double height : {0.9, 0.5, 0.1}) expect_inside(cap_boundary(height));
}

TEST(InteriorPoint, OfNothingIsTheOrigin) {
  const KnownBoundary known = tetrahedron_boundary();
  const ContactGeometry geometry(known.scene);
  EXPECT_EQ(interior_point(geometry, {}), dvec3(0.0));
}

}  // namespace
}  // namespace taut
