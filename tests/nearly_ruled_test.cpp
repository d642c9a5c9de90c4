#include "taut/surface/nearly_ruled.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "freeform.h"
#include "models.h"
#include "taut/surface/model.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// A quarter of a cylinder, of degrees (3, 3), with one of its inner control points moved, and the
/// weight of another changed.
BezierPatch bent_cylinder(double moved, double reweighted) {
  BezierPatch patch = elevated(decompose(cylinder(1, 2).surfaces[0])[0].bezier, 3, 3);
  patch.at(1, 2) += dvec4(moved * patch.at(1, 2).w, 0, 0, 0);
  patch.at(2, 1) *= 1 + reweighted;
  return patch;
}

/// Largest distance of points of the patch from the segments between the ends of its lines.
double farthest_from_lines(const BezierPatch& patch, Direction direction) {
  constexpr int places = 24;
  double farthest = 0;
  for (int i = 0; i <= places; ++i) {
    for (int k = 0; k <= places; ++k) {
      const double s = double(i) / places, t = double(k) / places;
      const bool along_u = direction == Direction::u;
      const dvec3 a = along_u ? point(patch, 0, t) : point(patch, t, 0);
      const dvec3 b = along_u ? point(patch, 1, t) : point(patch, t, 1);
      const dvec3 x = along_u ? point(patch, s, t) : point(patch, t, s);
      const double share = std::clamp(glm::dot(x - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
      farthest = std::max(farthest, glm::distance(x, glm::mix(a, b, share)));
    }
  }
  return farthest;
}

/// The direction in which a patch of a cylinder is straight.
Direction straight(const BezierPatch& patch) {
  return farthest_from_lines(patch, Direction::u) < farthest_from_lines(patch, Direction::v)
             ? Direction::u
             : Direction::v;
}

TEST(NearlyRuled, DistancesFromLinesAreBounds) {
  for (const double moved : {0.0, 1e-9, 1e-6, 1e-3}) {
    for (const double reweighted : {0.0, 1e-8, 1e-4}) {
      const BezierPatch patch = bent_cylinder(moved, reweighted);
      const Direction along = straight(patch);
      const double bound = distance_from_ruled(patch, along);
      EXPECT_GE(bound + 1e-15, farthest_from_lines(patch, along));
      EXPECT_LE(bound, 2 * moved + 10 * reweighted + 1e-14);
      EXPECT_NEAR(square_of_lines(patch, along), 4, 1e-2);
    }
  }
  const BezierPatch across = bent_cylinder(0, 0);
  const Direction other = straight(across) == Direction::u ? Direction::v : Direction::u;
  EXPECT_GE(distance_from_ruled(across, other), farthest_from_lines(across, other));
}

/// Lines of the patch along u run at a speed of their own each.
TEST(NearlyRuled, LinesHaveSpeedsOfTheirOwn) {
  // Ends (0, v, v^2) and (2, v, v^2), between them at places that are not shared out alike.
  BezierPatch patch = {2, 2, {}};
  const double middles[] = {0.4, 1.1, 1.5};
  for (const int i : {0, 1, 2}) {
    for (const int j : {0, 1, 2}) {
      const double x = i == 1 ? middles[j] : i;
      patch.points.push_back({x, 0.5 * j, j == 2 ? 1 : 0, 1});
    }
  }
  EXPECT_LE(distance_from_ruled(patch, Direction::u), 1e-15);
  for (const double moved : {1e-9, 1e-6, 1e-3}) {
    BezierPatch bent = patch;
    bent.at(1, 1).z += moved;
    const double bound = distance_from_ruled(bent, Direction::u);
    EXPECT_GE(bound, farthest_from_lines(bent, Direction::u));
    EXPECT_LE(bound, 2 * moved);
  }
  // It ends beyond the middle of its last line.
  patch.at(1, 2).x = 3;
  const double bound = distance_from_ruled(patch, Direction::u);
  EXPECT_GE(bound, farthest_from_lines(patch, Direction::u));
  EXPECT_GE(bound, 0.25);
}

/// Over the parabola z = -x^2, along y: the parameters run askew to the lines.
BezierPatch askew_cylinder() {
  BezierPatch patch = {2, 4, {}};
  // x(u, v) = u + v / 2, y(u, v) = v - u / 2, and z = -x^2 of degrees (2, 2), elevated.
  BezierPatch low = {2, 2, {}};
  for (const double u : {0.0, 0.5, 1.0}) {
    for (const double v : {0.0, 0.5, 1.0}) {
      const double uu = u == 1 ? 1 : 0, vv = v == 1 ? 1 : 0;  // coefficients of u^2 and v^2
      low.points.push_back({u + v / 2, v - u / 2, -(uu + u * v + vv / 4), 1});
    }
  }
  return elevated(low, patch.degree_u, patch.degree_v);
}

/// Largest distance of points of the patch from its plane section z = -x^2.
double farthest_from_parabola(const BezierPatch& patch) {
  constexpr int places = 24;
  double farthest = 0;
  for (int i = 0; i <= places; ++i) {
    for (int k = 0; k <= places; ++k) {
      const dvec3 x = point(patch, double(i) / places, double(k) / places);
      farthest = std::max(farthest, std::abs(x.z + x.x * x.x) / std::hypot(1, 2 * x.x));
    }
  }
  return farthest;
}

TEST(NearlyRuled, CylindersAreToldWhateverTheirParameters) {
  const BezierPatch patch = askew_cylinder();
  EXPECT_LE(farthest_from_parabola(patch), 1e-15);
  EXPECT_GE(distance_from_ruled(patch, Direction::u), 0.01);
  EXPECT_GE(distance_from_ruled(patch, Direction::v), 0.01);
  const NearCylinder exact = near_cylinder(patch);
  EXPECT_NEAR(std::abs(exact.along.y), 1, 1e-12);
  EXPECT_NEAR(exact.length, 1.5, 1e-12);
  EXPECT_LE(exact.distance, 1e-14);
  for (const double moved : {1e-9, 1e-6, 1e-3}) {
    BezierPatch bent = patch;
    bent.at(1, 2).z += moved;
    const NearCylinder near = near_cylinder(bent);
    // Where it is moved most it leaves all cylinders through its border by as much.
    EXPECT_GE(near.distance, farthest_from_parabola(bent));
    EXPECT_LE(near.distance, 10 * moved);
    EXPECT_LE(near.turned, 10 * moved);
  }
}

TEST(NearlyRuled, WhatCurvesTwiceIsNoCylinder) {
  const BezierPatch sphere_patch = decompose(sphere(1).surfaces[0])[0].bezier;
  EXPECT_EQ(near_cylinder(sphere_patch).distance, infinity);  // of weights of its own
  BezierPatch bowl = {2, 2, {}};
  for (const int i : {0, 1, 2}) {
    for (const int j : {0, 1, 2}) {
      bowl.points.push_back({0.5 * i, 0.5 * j, 0.2 * ((i == 2) + (j == 2)), 1});
    }
  }
  EXPECT_GE(near_cylinder(bowl).distance, 0.05);
}

}  // namespace
}  // namespace taut
