// Measures of boundaries within hulls that are known, of which they state how far these are.

#include "taut/hull/measure/measure_bounds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "boundaries.h"
#include "models.h"
#include "taut/hull/sample/facetted_boundary.h"
#include "taut/hull/sample/sampled_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// What a hull measures.
struct Known {
  double volume, area, mean_width;
  dvec3 centroid = dvec3(0.0);
  dmat3 inertia = dmat3(0.0);
};

Known ball(double r) {
  const double volume = 4 * pi / 3 * r * r * r;
  return {volume, 4 * pi * r * r, 2 * r, dvec3(0.0), dmat3(0.4 * volume * r * r)};
}

/// From a corner to the other.
Known box_between(const dvec3& lower, const dvec3& upper) {
  const dvec3 a = upper - lower;
  const double volume = a.x * a.y * a.z;
  const dvec3 s = volume / 12 * a * a;
  return {volume,
          2 * (a.x * a.y + a.y * a.z + a.z * a.x),
          (a.x + a.y + a.z) / 2,
          0.5 * (lower + upper),
          {s.y + s.z, 0, 0, 0, s.z + s.x, 0, 0, 0, s.x + s.y}};
}

/// The bounds hold, and are no more than so many times what they are of.
void expect_bounds(const BoundaryMeasures& m, const Known& truth, double diagonal, double times) {
  const auto expect = [&](const char* what, double bound, double off) {
    EXPECT_LE(off, bound * (1 + 1e-9) + 1e-13) << what;
    EXPECT_GE(times * off + 1e-13, bound) << what;
  };
  const double largest = std::max({m.inertia[0][0], m.inertia[1][1], m.inertia[2][2]});
  double inertia_off = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      inertia_off = std::max(inertia_off, std::abs(truth.inertia[i][j] - m.inertia[i][j]));
    }
  }
  expect("volume", m.bounds.volume, truth.volume / m.volume - 1);
  expect("area", m.bounds.area, truth.area / m.area - 1);
  expect("mean width", m.bounds.mean_width, truth.mean_width / m.mean_width - 1);
  expect("inertia", m.bounds.inertia, inertia_off / largest);
  EXPECT_LE(glm::distance(m.centroid, truth.centroid), m.bounds.centroid * diagonal + 1e-13);
  EXPECT_GE(m.bounds.largest(), m.bounds.inertia);
}

/// A ball within a larger one.
TEST(MeasureBounds, OfPatchesWithinTheGap) {
  for (const double gap : {1e-2, 1e-5, 1e-8}) {
    const Scene scene = make_scene(sphere(1));
    const ContactGeometry geometry(scene);
    HullBoundary boundary;
    HullFace face;
    face.kind = FaceKind::patch;
    for (int k = 0; k < int(scene.model().parts()[0].patches().size()); ++k) {
      const int sign = outward_sign(geometry, k, dvec3(0.0));
      face.regions.push_back({0, k, sign, {whole_outline()}});
    }
    boundary.frame = scene.frame();
    boundary.faces.push_back(face);
    boundary.gap = scene.frame().length_to_frame(gap);
    const BoundaryMeasures m = measure(scene, geometry, boundary);
    EXPECT_LT(m.accuracy, 1e-12);
    expect_bounds(m, ball(1 + gap), scene.diagonal(), 5);
  }
}

/// A box as facets and the segments between them.
HullBoundary box_boundary(const Scene& scene) {
  const ContactGeometry geometry(scene);
  HullBoundary boundary;
  boundary.frame = scene.frame();
  const auto point = [&](int k) { return geometry.point({0, SourceKind::vertex, k, 0, 0}); };
  const std::vector<std::vector<int>> facets = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const std::vector<int>& corners : facets) {
    HullFace face;
    for (const int k : corners) {
      face.contacts.push_back({0, SourceKind::vertex, k, 0, 0});
      face.points.push_back(point(k));
    }
    face.n = polygon_normal(face.points);
    face.offset = glm::dot(face.n, face.points[0]);
    boundary.faces.push_back(face);
  }
  const auto left_of = [&](int a, int b) {
    for (int f = 0; f < 6; ++f) {
      const std::vector<int>& corners = facets[std::size_t(f)];
      for (std::size_t k = 0; k < 4; ++k) {
        if (corners[k] == a && corners[(k + 1) % 4] == b) return f;
      }
    }
    return -1;
  };
  for (int a = 0; a < 8; ++a) {
    for (int b = a + 1; b < 8; ++b) {
      if (left_of(a, b) < 0) continue;
      HullCurve curve;
      curve.faces = {left_of(a, b), left_of(b, a)};
      curve.points = {point(a), point(b)};
      boundary.curves.push_back(curve);
    }
  }
  return boundary;
}

Shape corners_of_box(const dvec3& a) {
  Shape shape;
  for (int k = 0; k < 8; ++k) {
    shape.points.push_back(0.5 * a * dvec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
  }
  return shape;
}

/// A box within one that reaches farther on the side of one facet.
TEST(MeasureBounds, OfAFacetBelowItsPlane) {
  const dvec3 a(1, 2, 3);
  const Scene scene = make_scene(corners_of_box(a));
  for (const double depth : {1e-2, 1e-6}) {
    for (int f = 0; f < 6; ++f) {
      HullBoundary boundary = box_boundary(scene);
      const BoundaryMeasures exact = measure(scene, ContactGeometry(scene), boundary);
      EXPECT_NEAR(exact.mean_width, 3, 1e-14);
      EXPECT_LT(exact.bounds.largest(), 1e-13);
      HullFace& face = boundary.faces[std::size_t(f)];
      face.tolerant = scene.frame().length_to_frame(depth);
      boundary.gap = face.tolerant;
      const dvec3 out = depth * face.n;
      const BoundaryMeasures m = measure(scene, ContactGeometry(scene), boundary);
      expect_bounds(
          m, box_between(-0.5 * a + glm::min(out, dvec3(0.0)), 0.5 * a + glm::max(out, dvec3(0.0))),
          scene.diagonal(), 60);
      EXPECT_GT(m.bounds.centroid, 0);
    }
  }
}

/// What is flat is known by its sides' angles all the same: what a facet without width adds to one
/// of them with its normal, it takes from the other.
TEST(MeasureBounds, NormalsOfThinFacetsDoNotMatter) {
  const Scene scene = make_scene(corners_of_box({1, 2, 3}));
  HullBoundary boundary = box_boundary(scene);
  // Between the two facets beside a curve, one without width, of any normal.
  const HullCurve side = boundary.curves[0];
  HullFace thin;
  thin.points = {side.points[0], side.points[1], 0.5 * (side.points[0] + side.points[1])};
  thin.contacts.resize(3);
  const dvec3& m = boundary.faces[std::size_t(side.faces[0])].n;
  const dvec3& n = boundary.faces[std::size_t(side.faces[1])].n;
  thin.n = unit(2.0 * n - m);  // beyond both
  boundary.faces.push_back(thin);
  HullCurve other = side;
  boundary.curves[0].faces[1] = 6;
  other.faces[0] = 6;
  boundary.curves.push_back(other);
  EXPECT_NEAR(measure(scene, ContactGeometry(scene), boundary).mean_width, 3, 1e-14);
}

/// Meshes lie in the hull; what they lack is within the bounds that their distance gives.
TEST(MeasureBounds, OfMeshes) {
  for (const double relative : {3e-2, 1e-3}) {
    const Scene scene = make_scene(sphere(1));
    HullOptions options;
    options.relative = relative;
    options.threads = 1;
    const Hull hull = facetted_hull(scene, options);
    const BoundaryMeasures m = measure(scene, ContactGeometry(scene), *hull.boundary);
    const Measures mesh = measure(polygons(hull.mesh));
    EXPECT_NEAR(m.volume / mesh.volume, 1, 1e-12);
    EXPECT_NEAR(m.area / mesh.area, 1, 1e-12);
    EXPECT_NEAR(hull.boundary->frame.length_to_model(hull.boundary->gap), hull.distance_bound,
                1e-15);
    expect_bounds(m, ball(1), scene.diagonal(), 60);
    // Of a polyhedron within the unit ball whose facets touch a ball of radius r.
    const double r = 1 - 2 * hull.distance_bound;
    EXPECT_LT(m.mean_width, 2);
    EXPECT_GT(m.mean_width, 2 * r);
  }
}

}  // namespace
}  // namespace taut
