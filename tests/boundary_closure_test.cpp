#include "taut/hull/stitch/boundary_closure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "boundaries.h"
#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: boundaries

/// How many things are told of the boundary.
std::size_t told(HullBoundary boundary) {
  check_closure(boundary, 1e-7);
  return boundary.unresolved.size();
}

TEST(BoundaryClosure, NothingIsToldOfClosedOnes) {
  const dmat3 turn = skew_rotation();
  EXPECT_EQ(told(tetrahedron_boundary().boundary), 0U);
  EXPECT_EQ(told(two_spheres_boundary(turn).boundary), 0U);
  EXPECT_EQ(told(cylinder_boundary(turn).boundary), 0U);
  EXPECT_EQ(told(cap_boundary(0.5).boundary), 0U);
  EXPECT_EQ(told(half_torus_boundary(3, 1).boundary), 0U);
  EXPECT_EQ(told(torus_boundary(3, 1).boundary), 0U);
  EXPECT_EQ(told(paraboloid_boundary().boundary), 0U);
}

TEST(BoundaryClosure, CurvesWithoutTwoFacesAreTold) {
  HullBoundary boundary = tetrahedron_boundary().boundary;
  boundary.curves[1].faces[0] = -1;
  boundary.curves[4].faces[1] = -1;
  EXPECT_EQ(told(boundary), 2U);
}

TEST(BoundaryClosure, WhatIsMissingIsTold) {
  const std::vector<std::function<void(HullBoundary&)>> faults = {
      [](HullBoundary& b) { b.faces.push_back(b.faces.back()); },
      [](HullBoundary& b) {
        b.faces.push_back(b.faces.back());
        b.faces.back().kind = FaceKind::patch;
        b.faces.back().loops.resize(2);
      },
      [](HullBoundary& b) { std::swap(b.curves[0].faces[0], b.curves[0].faces[1]); },
      [](HullBoundary& b) { b.curves.pop_back(); },
      [](HullBoundary& b) { b.curves.push_back(b.curves.front()); },
      [](HullBoundary& b) { b.curves[0].points.back() += dvec3(1e-6, 0, 0); },
  };
  for (const auto& fault : faults) {
    HullBoundary boundary = tetrahedron_boundary().boundary;
    fault(boundary);
    EXPECT_EQ(told(boundary), 1U);
  }
  HullBoundary spheres = two_spheres_boundary().boundary;
  for (HullFace& face : spheres.faces) face.loops.clear();
  EXPECT_EQ(told(spheres), 1U);
}

/// But not of those so narrow that corners moved by as much as ends of curves may be apart turn
/// them.
TEST(BoundaryClosure, FacetsThatAreTurnedInsideOutAreTold) {
  HullBoundary boundary = tetrahedron_boundary().boundary;
  std::vector<dvec3>& corners = boundary.faces.front().points;
  std::reverse(corners.begin(), corners.end());
  EXPECT_EQ(told(boundary), 1U);
  corners.back() = 0.5 * (corners[0] + corners[1]) + 1e-8 * (corners.back() - corners[0]);
  EXPECT_EQ(told(boundary), 0U);
}

TEST(BoundaryClosure, FacetsThatAreSegmentsAreTold) {
  HullBoundary boundary = tetrahedron_boundary().boundary;
  HullFace& facet = boundary.faces.front();
  facet.points.pop_back();
  facet.contacts.pop_back();
  EXPECT_EQ(told(boundary), 1U);
}

/// It would tell the same once more.
TEST(BoundaryClosure, OfUnresolvedOnesTheCharacteristicIsNotTold) {
  HullBoundary boundary = tetrahedron_boundary().boundary;
  boundary.faces.pop_back();
  boundary.unresolved.push_back({dvec3(0, 0, 1), "a facet is missing"});
  EXPECT_EQ(told(boundary), 1U);
}

}  // namespace
}  // namespace taut
