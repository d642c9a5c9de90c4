#include "taut/verify/document_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "boundaries.h"
#include "cages.h"
#include "models.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/measure/boundary_measures.h"
#include "taut/io/document/boundary_document.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

DocumentMeasures measured(const HullDocument& hull, const Scene& scene) {
  const DocumentGeometry geometry(hull, scene.frame().center, 0);
  return measure(geometry, DocumentOutlines(geometry));
}

DocumentMeasures measured(const KnownBoundary& known) {
  return measured(hull_document(known.scene, known.boundary), known.scene);
}

DocumentMeasures measured(const Shape& shape) {
  const Scene scene = make_scene(shape);
  HullOptions options;
  options.relative = 1e-2;
  return measured(hull_document(scene, *convex_hull(scene, options).boundary), scene);
}

TEST(DocumentMeasures, OfATetrahedron) {
  const DocumentMeasures found = measured(tetrahedron_boundary());
  EXPECT_NEAR(found.volume, 1.0 / 6, 1e-14);
  EXPECT_NEAR(found.area, (3 + std::sqrt(3)) / 2, 1e-14);
  // Half the sum of lengths times outer angles, over 2 pi.
  const double short_sides = 3 * (pi / 2);
  const double long_sides = 3 * std::sqrt(2) * (pi - std::acos(1 / std::sqrt(3)));
  EXPECT_NEAR(found.mean_width, (short_sides + long_sides) / (4 * pi), 1e-13);
  EXPECT_LE(glm::length(found.vector_area), 1e-14);
  EXPECT_LE(found.error(), 1e-13);
}

TEST(DocumentMeasures, OfTwoSpheres) {
  constexpr double r = 0.5, D = 3, c = (1 - r) / D;
  const double area = 2 * pi * (1 + c) + 2 * pi * r * r * (1 - c) + pi * (1 + r) * D * (1 - c * c);
  const double width = (1 + c) + r * (1 - c) + D * (1 - c * c) / 2;
  for (const dvec3& shift : {dvec3(0.0), dvec3(100, -50, 20)}) {
    const DocumentMeasures found = measured(two_spheres_boundary(skew_rotation(), shift));
    EXPECT_NEAR(found.area, area, 1e-10);
    EXPECT_NEAR(found.mean_width, width, 1e-11);
    EXPECT_LE(glm::length(found.vector_area), 1e-10);
  }
}

/// Two facets within circles: along the edges that these are, and of the points alone.
TEST(DocumentMeasures, OfACylinder) {
  const KnownBoundary known = cylinder_boundary();
  HullDocument hull = hull_document(known.scene, known.boundary);
  const DocumentMeasures found = measured(hull, known.scene);
  EXPECT_NEAR(found.volume, 2 * pi, 1e-12);
  EXPECT_NEAR(found.area, 6 * pi, 1e-12);
  EXPECT_NEAR(found.mean_width, 1 + pi / 2, 1e-11);
  EXPECT_LE(found.error(), 1e-13);

  for (HullDocument::Curve& curve : hull.curves) curve.kind = HullCurveKind::bitangent;
  const DocumentMeasures near = measured(hull, known.scene);
  EXPECT_NEAR(near.volume, 2 * pi, 1e-7);
  EXPECT_NEAR(near.mean_width, 1 + pi / 2, 1e-7);
  EXPECT_GE(near.error(), std::abs(near.volume / (2 * pi) - 1));
  EXPECT_LE(near.error(), 1e-5);
}

/// Facets within curves of which only the points are known, and along which the surface's third
/// derivatives jump.
TEST(DocumentMeasures, OfTorusCages) {
  for (const int m : {4, 5, 6, 8}) {
    for (const int n : {3, 4, 5}) {
      const Model model = cage_model(torus_cage(m, n));
      const Scene scene(model);
      HullOptions options;
      options.relative = 1e-2;
      const HullBoundary boundary = *convex_hull(scene, options).boundary;
      const BoundaryMeasures known = measure(scene, ContactGeometry(scene), boundary);
      const DocumentMeasures found = measured(hull_document(scene, boundary), scene);
      const std::string name = std::to_string(m) + " x " + std::to_string(n);
      EXPECT_LE(std::abs(found.area / known.area - 1), found.error() + 1e-12) << name;
      EXPECT_LE(std::abs(found.volume / known.volume - 1), found.error() + 1e-12) << name;
      EXPECT_LE(found.error(), 1e-5) << name;
    }
  }
}

TEST(DocumentMeasures, OfTheOloid) {
  const DocumentMeasures found = measured(oloid());
  EXPECT_NEAR(found.area, 4 * pi, 1e-9);
  EXPECT_NEAR(found.volume, 3.052418, 1e-6);
}

TEST(DocumentMeasures, OfAnEllipsoid) {
  const DocumentMeasures found = measured(ellipsoid(3, 2, 1));
  EXPECT_NEAR(found.volume, 8 * pi, 1e-9);
}

}  // namespace
}  // namespace taut
