#include "taut/envelope/cull/convex_cap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "models.h"
#include "surface_checks.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and reference answers

constexpr int cap_cells = 64;  // along a side of a patch

/// A square cell of a patch of some that tile it.
ParameterRectangle cap_cell(int i, int j) {
  const auto at = [](int k) { return Interval{double(k) / cap_cells, (k + 1.0) / cap_cells}; };
  return {at(i), at(j)};
}

/// The cap about a cell of the first part, up to a distance from its middle as seen along an axis
/// that is the sphere's or the torus's normal there, times the root of a curvature.
std::optional<ConvexCap> cap_about(ConcaveSurfaces& surfaces, int patch,
                                   const ParameterRectangle& cell, const dvec3& axis,
                                   double radius) {
  const auto map = OsculatingParaboloid::about(surfaces.patch(0, patch), cell.middle(), unit(axis));
  return map ? convex_cap(surfaces, 0, patch, cell, unit(axis), *map, radius) : std::nullopt;
}

/// Over a disc whose radius is a share of that of the unit sphere, whatever patches are there: all
/// but what is near the disc's border is covered, and nothing else, nor the sphere within.
TEST(ConvexCap, OfASphereIsWhatLiesOverTheDisc) {
  const Scene scene = make_scene(mapped(sphere() + sphere(0.5), skew_rotation()));
  const double unit_radius = std::sqrt(scene.frame().scale);
  ConcaveSurfaces surfaces(scene);
  Random random(1);
  for (const double share : {0.3, 0.6, 0.9}) {
    for (const int patch : {0, 3, 6}) {
      const ParameterRectangle cell = cap_cell(pick(random, 2, 61), patch == 6 ? 1 : 40);
      const dvec2 p = cell.middle();
      const dvec3 axis = unit(point(surfaces.patch(0, patch).bezier(), p.x, p.y));
      const std::optional<ConvexCap> cap =
          cap_about(surfaces, patch, cell, axis, share * unit_radius);
      ASSERT_TRUE(cap) << share << ' ' << patch;
      EXPECT_TRUE(cap->covers(patch, cell));
      EXPECT_FALSE(cap_about(surfaces, patch, cell, axis, 1.01 * unit_radius));
      int within = 0;
      for (int k = 0; k < 5000; ++k) {
        const int at = pick(random, 0, 15);
        const int i = pick(random, 0, cap_cells - 1);
        const ParameterRectangle there = cap_cell(i, pick(random, 0, cap_cells - 1));
        const dvec2 q = there.middle();
        const dvec3 x = scene.frame().to_model(point(surfaces.patch(0, at).bezier(), q.x, q.y));
        const double off = glm::length(glm::cross(axis, x));
        const bool front = at < 8 && glm::dot(axis, x) > 0;
        if (front && off < 0.7 * share - 0.03) {
          EXPECT_TRUE(cap->covers(at, there));
          ++within;
        }
        if (!front || off > share) {
          EXPECT_FALSE(cap->covers(at, there));
        }
      }
      EXPECT_GT(within, 5);
    }
  }
}

/// A cap of the sphere ends at its rim, at the distance sqrt(1 - 0.4^2) = 0.917 from its axis.
TEST(ConvexCap, NoneOverAnEdge) {
  const Scene scene = make_scene(spherical_cap(0.6));
  const double unit_radius = std::sqrt(scene.frame().scale);
  ConcaveSurfaces surfaces(scene);
  const ParameterRectangle cell{{0.25, 0.5}, {1.0 / 64, 1.0 / 32}};
  const dvec2 p = cell.middle();
  const dvec3 x = point(surfaces.patch(0, 0).bezier(), p.x, p.y);
  const dvec3 normal = unit(scene.frame().to_model(x));
  for (const double share : {0.3, 0.6, 0.85}) {
    EXPECT_TRUE(cap_about(surfaces, 0, cell, normal, share * unit_radius)) << share;
  }
  for (const double share : {0.93, 0.97}) {
    EXPECT_FALSE(cap_about(surfaces, 0, cell, normal, share * unit_radius)) << share;
  }
}

/// About the outermost circle of a torus of R = 2 and r = 1/2, up to its circles on top and below,
/// at the height r, where the curvature vanishes. The map multiplies heights by 1 / sqrt(r).
TEST(ConvexCap, NoneOverTheRimsOfATorus) {
  const Scene scene = make_scene(torus(2, 0.5));
  ConcaveSurfaces surfaces(scene);
  const double rim = std::sqrt(0.5 * scene.frame().scale);
  int found = 0;
  for (int patch = 0; patch < int(surfaces.patches(0).size()); ++patch) {
    for (const int j : {0, cap_cells - 1}) {
      const ParameterRectangle cell = cap_cell(20, j);
      const dvec2 p = cell.middle();
      const dvec3 x = scene.frame().to_model(point(surfaces.patch(0, patch).bezier(), p.x, p.y));
      if (std::hypot(x.x, x.y) < 2.49) continue;
      ++found;
      const dvec3 axis = unit(dvec3(x.x, x.y, 0));
      EXPECT_TRUE(cap_about(surfaces, patch, cell, axis, 0.8 * rim));
      EXPECT_FALSE(cap_about(surfaces, patch, cell, axis, 1.1 * rim));
      EXPECT_FALSE(cap_about(surfaces, patch, cell, -axis, 0.8 * rim));
    }
  }
  EXPECT_EQ(found, 8);
}

/// On bodies in general position: whatever cap is found, all of it lies below the tangent planes of
/// all of it, whose normals are within a right angle of the axis.
TEST(ConvexCap, TangentPlanesAreAboveAllOfIt) {
  Random random(2);
  int found = 0;
  int none = 0;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Scene scene = make_scene(blob(seed));
    ConcaveSurfaces surfaces(scene);
    for (int k = 0; k < 30; ++k) {
      const int patch = pick(random, 0, int(surfaces.patches(0).size()) - 1);
      const int i = pick(random, 0, cap_cells - 1);
      const ParameterRectangle cell = cap_cell(i, pick(random, 0, cap_cells - 1));
      const BezierPatch& bezier = surfaces.patch(0, patch).bezier();
      const dvec2 p = cell.middle();
      const dvec3 axis = aligned(unit_normal(bezier, p.x, p.y), point(bezier, p.x, p.y));
      const double radius = log_uniform(random, 0.02, 1);
      const std::optional<ConvexCap> cap = cap_about(surfaces, patch, cell, axis, radius);
      ++(cap ? found : none);
      if (!cap) continue;
      std::vector<std::pair<rvec3, rvec3>> planes;  // points and normals
      for (int i_point = 0; i_point < 30; ++i_point) {
        const auto& piece = cap->pieces[std::size_t(pick(random, 0, int(cap->pieces.size()) - 1))];
        const double s = piece.cell.u.at(uniform(random, 0, 1));
        const double t = piece.cell.v.at(uniform(random, 0, 1));
        const ReferenceJet j = reference_jet(surfaces.patch(0, piece.patch).bezier(), s, t);
        const real side = glm::dot(j.normal(), rvec3(axis));
        planes.emplace_back(j.S, j.normal() * (side > 0 ? real(1) : real(-1)));
        EXPECT_LT(glm::length(cap->map(dvec3(j.S))), radius);
      }
      for (const auto& [x, n] : planes) {
        for (const auto& [y, m] : planes) {
          EXPECT_LT(double(glm::dot(n, y - x)), 1e-13 * double(glm::length(n)));
        }
      }
    }
  }
  EXPECT_GT(found, 20);
  EXPECT_GT(none, 20);
}

/// Of three quarters of a square, in cells at multiples of 1/8.
TEST(ConvexCap, CoversWhatItsPiecesDoTogether) {
  const Interval low{0, 0.5};
  const Interval high{0.5, 1};
  ConvexCap cap;
  for (const int patch : {1, 2, 4}) cap.pieces.push_back({patch, {low, low}, {}});
  cap.pieces.insert(cap.pieces.begin() + 2, {{2, {high, low}, {}}, {2, {low, high}, {}}});
  EXPECT_FALSE(cap.covers(1, {{0, 0.501}, {0, 0.4}}));
  for (const int size : {1, 2, 4, 8}) {
    for (int i = 0; i + size <= 8; ++i) {
      for (int j = 0; j + size <= 8; ++j) {
        const ParameterRectangle cell{{i / 8.0, (i + size) / 8.0}, {j / 8.0, (j + size) / 8.0}};
        const bool in_all = i + size <= 4 && j + size <= 4;
        EXPECT_EQ(cap.covers(1, cell), in_all);
        EXPECT_EQ(cap.covers(2, cell), i + size <= 4 || j + size <= 4) << i << ' ' << j;
        EXPECT_EQ(cap.covers(4, cell), in_all);
        EXPECT_FALSE(cap.covers(3, cell));
      }
    }
  }
}

/// Pyramids about directions at an angle with the axis, half as wide as 0.3.
TEST(ConvexCap, FacesNormalsWithinARightAngleOfItsAxis) {
  ConvexCap cap;
  cap.axis = skew_rotation() * dvec3(0, 0, 1);
  const auto [x, y] = tangent_frame(cap.axis);
  for (int k = 0; k <= 30; ++k) {
    const double angle = 0.1 * k;
    std::vector<dvec3> directions;
    for (const double off : {angle - 0.3, angle + 0.3}) {
      for (const double lean : {-0.01, 0.01}) {
        directions.push_back(unit(std::cos(off) * cap.axis + std::sin(off) * x + lean * y));
      }
    }
    const std::optional<NormalPyramid> pyramid = normal_pyramid(directions, 0);
    ASSERT_TRUE(pyramid);
    EXPECT_EQ(cap.faces(*pyramid, 1), angle + 0.3 < 0.5 * pi) << angle;
    EXPECT_EQ(cap.faces(*pyramid, -1), angle - 0.3 > 0.5 * pi) << angle;
  }
}

}  // namespace
}  // namespace taut
