#include "taut/hull/mesh/boundary_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "boundaries.h"
#include "models.h"
#include "taut/core/integers.h"
#include "taut/hull/polytope/point_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

BoundarySamples samples_of(const KnownBoundary& known, const SampleSpacing& spacing) {
  const ContactGeometry geometry(known.scene);
  const ContactFaces faces(geometry, known.boundary);
  SupportQuery query(known.scene);
  return boundary_samples(geometry, known.boundary, faces, spacing, query);
}

std::vector<int> faces_at(const BoundarySamples& all, int sample) {
  std::vector<int> faces;
  for (const TouchedFace& f : all.faces[to_size(sample)]) faces.push_back(f.face);
  return faces;
}

/// A corner is the contact of three facets, and one sample.
TEST(BoundarySamples, OfATetrahedronAreItsCorners) {
  const KnownBoundary known = tetrahedron_boundary();
  const BoundarySamples all = samples_of(known, {.gap = 0.01, .width = 1e-9});
  ASSERT_EQ(all.points.size(), 4U);
  EXPECT_TRUE(all.chords.empty());
  std::set<std::vector<int>> triples;
  for (int k = 0; k < 4; ++k) {
    triples.insert(faces_at(all, k));
    EXPECT_EQ(all.faces[to_size(k)].size(), 3U);
  }
  EXPECT_EQ(triples.size(), 4U);
  // Within a width beyond its size it is one sample, which touches all.
  EXPECT_EQ(faces_at(samples_of(known, {.gap = 0.01, .width = 2}), 0),
            (std::vector<int>{0, 1, 2, 3}));
}

/// On circles of radius one, n chords around have the sagitta 1 - cos(pi / n).
TEST(BoundarySamples, OfACylinderDivideItsCircles) {
  for (const double gap : {0.02, 1e-3, 1e-5}) {
    const BoundarySamples all = samples_of(cylinder_boundary(), {.gap = gap, .width = 1e-9});
    for (std::size_t k = 0; k < all.points.size(); ++k) {
      const dvec3& x = all.points[k];
      const dvec3& n = all.samples[k].n;
      EXPECT_NEAR(std::hypot(x.x, x.y), 1, 1e-14);
      EXPECT_NEAR(std::abs(x.z - 1), 1, 1e-14);
      EXPECT_NEAR(glm::dot(x, n), std::hypot(n.x, n.y) + std::max(0.0, 2 * n.z), 1e-12);
      EXPECT_EQ(faces_at(all, to_int(k)), (std::vector<int>{x.z > 1 ? 1 : 0, 2}));
    }
    // Chords go from sample to sample, all the way around.
    std::array<int, 2> count = {0, 0};
    std::set<std::pair<int, int>> ends;
    for (const CurveChord& chord : all.chords) {
      EXPECT_TRUE(ends.insert({chord.a, 0}).second);
      EXPECT_TRUE(ends.insert({chord.b, 1}).second);
      EXPECT_EQ(all.points[to_size(chord.a)].z > 1, chord.contact == 1);
      EXPECT_EQ(all.points[to_size(chord.b)].z > 1, chord.contact == 1);
      ++count[to_size(chord.contact)];
    }
    for (int k = 0; k < to_int(all.points.size()); ++k) {
      EXPECT_EQ(ends.count({k, 0}), ends.count({k, 1}));
      const dvec3& x = all.points[to_size(k)];
      const bool is_corner_of_facet = std::abs(x.x * x.y) < 1e-12;
      EXPECT_TRUE(is_corner_of_facet || ends.count({k, 0}) == 1);
    }
    for (const int n : count) {
      const double sagitta = 1 - std::cos(pi / n);
      EXPECT_LE(sagitta, gap);
      EXPECT_GE(sagitta, gap / 4);
    }
  }
}

bool is_edge_of(const PointHull& hull, int a, int b) {
  return std::any_of(hull.facets().begin(), hull.facets().end(), [&](const auto& facet) {
    return facet.alive && std::count(facet.vertex.begin(), facet.vertex.end(), a) > 0 &&
           std::count(facet.vertex.begin(), facet.vertex.end(), b) > 0;
  });
}

/// Spheres of radius 1 and 1/2 about z = 0 and 3 are touched by the scroll's normals, z = 1/6. The
/// rows beside their circles are at the height of equilateral triangles of this gap.
TEST(BoundarySamples, OfTwoSpheresHaveRowsBesideTheirCircles) {
  const double gap = 2e-3;
  const BoundarySamples all = samples_of(two_spheres_boundary(), {.gap = gap, .width = 1e-9});
  std::array<std::array<int, 2>, 2> count{};  // by sphere, on the circle and beside
  PointHull hull({{-1, -1, -1}, {1, 1, 4}});
  hull.add(all.points);
  for (std::size_t k = 0; k < all.points.size(); ++k) {
    const dvec3& n = all.samples[k].n;
    const std::size_t sphere = all.points[k].z > 1.5 ? 1 : 0;
    const double radius = sphere == 0 ? 1 : 0.5;
    const dvec3 on_sphere = radius * n + dvec3(0, 0, sphere == 0 ? 0 : 3);
    EXPECT_LT(glm::distance(all.points[k], on_sphere), 1e-7);
    const double step = (sphere == 0 ? -1 : 1) * (std::asin(n.z) - std::asin(1.0 / 6));
    const bool beside = std::abs(step) > 1e-7;
    EXPECT_EQ(faces_at(all, to_int(k)),
              beside ? std::vector{to_int(sphere)} : std::vector({to_int(sphere), 2}));
    ++count[sphere][beside ? 1 : 0];
    if (!beside) continue;
    const double side = std::tan(step) * radius / std::sqrt(0.75);
    EXPECT_LE(side * side / (6 * radius), gap);
    EXPECT_GE(side * side / (6 * radius), gap / 2);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_GE(count[i][0], 3);
    const double radius = i == 0 ? 1 : 0.5;
    const double around = 2 * pi * std::sqrt(radius) / std::sqrt(6 * gap);
    EXPECT_GT(count[i][1], around - 4);
    EXPECT_LT(count[i][1], 1.5 * around + 4);
  }
  for (const CurveChord& chord : all.chords) EXPECT_TRUE(is_edge_of(hull, chord.a, chord.b));
}

/// Of an arc that could not be solved there may be one ruling, which divides nothing.
TEST(BoundarySamples, OfAPieceOfOneRulingAreNone) {
  KnownBoundary one = two_spheres_boundary();
  for (ArcPiece& piece : one.boundary.arcs.front().pieces) piece.rulings.resize(1);
  const BoundarySamples all = samples_of(one, {.gap = 2e-3, .width = 1e-9});
  EXPECT_TRUE(all.chords.empty());
}

/// On the rim of a cap, of radius R, a sagitta counts by how much the normal turns there.
TEST(BoundarySamples, OfACapDivideItsRim) {
  const double gap = 1e-4;
  const BoundarySamples all = samples_of(cap_boundary(0.1), {.gap = gap, .width = 1e-9});
  const double R = std::sqrt(1 - 0.9 * 0.9);
  int rim = 0;
  for (std::size_t k = 0; k < all.points.size(); ++k) {
    EXPECT_NEAR(glm::length(all.points[k]), 1, 1e-14);
    const bool on_rim = std::abs(all.points[k].z - 0.9) < 1e-12;
    EXPECT_EQ(faces_at(all, to_int(k)), on_rim ? std::vector({0, 1}) : std::vector({0}));
    rim += on_rim ? 1 : 0;
  }
  EXPECT_GT(to_int(all.points.size()), 3 * rim / 2);
  const double turn_of_normal = glm::distance(dvec3(R, 0, 0.9), dvec3(0, 0, -1));
  const double counts = turn_of_normal * R * (1 - std::cos(pi / rim));
  EXPECT_LE(counts, gap);
  EXPECT_GE(counts, gap / 2);
}

}  // namespace
}  // namespace taut
