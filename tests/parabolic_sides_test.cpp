#include "taut/hull/contact/parabolic_sides.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "models.h"
#include "surface_checks.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and reference answers

/// The bicubic patch through the function's points at multiples of 1/3.
template <class Function>
BezierPatch bicubic(const Function& f) {
  // Bezier points of a cubic by its values there.
  constexpr std::array<std::array<double, 4>, 4> shares = {
      {{1, 0, 0, 0}, {-5.0 / 6, 3, -1.5, 1.0 / 3}, {1.0 / 3, -1.5, 3, -5.0 / 6}, {0, 0, 0, 1}}};
  BezierPatch patch{3, 3, {}};
  for (const auto& in_u : shares) {
    for (const auto& in_v : shares) {
      dvec3 sum(0.0);
      for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t l = 0; l < 4; ++l) {
          sum += in_u[k] * in_v[l] * f(double(k) / 3, double(l) / 3);
        }
      }
      patch.points.push_back(homogeneous(sum));
    }
  }
  return patch;
}

/// The graph of z = x p(y) + x^3 + c y^2, p = p0 + p1 y + p2 y^2, which is level along x across
/// x = 0, where the mixed derivative is p'(y). By x = u and y = v + (a + b v) u.
struct LevelGraph {
  double p0, p1, p2, c, a, b;

  BezierPatch patch() const {
    return bicubic([this](double x, double v) {
      const double y = v + (a + b * v) * x;
      return dvec3(x, y, x * (p0 + p1 * y + p2 * y * y) + x * x * x + c * y * y);
    });
  }
  /// The second form of x and y where x = 0, along the unit normal.
  double twist(double t) const {
    const double p = p0 + p1 * t + p2 * t * t;
    return (p1 + 2 * p2 * t) / std::sqrt(1 + p * p + 4 * c * c * t * t);
  }
};

/// The patch with its side u = 0 as another one.
std::vector<std::pair<Side, BezierPatch>> turned_patches(const BezierPatch& patch) {
  BezierPatch back = patch;
  for (int i = 0; i <= patch.degree_u; ++i) {
    for (int j = 0; j <= patch.degree_v; ++j) back.at(i, j) = patch.at(patch.degree_u - i, j);
  }
  return {{Side::u0, patch},
          {Side::u1, back},
          {Side::v0, transposed(patch)},
          {Side::v1, transposed(back)}};
}

/// The determinant of the second form along Su x Sv, of random patches in long double.
TEST(ParabolicSides, FunctionsAreTheDeterminant) {
  Random random(1);
  for (int k = 0; k < 10; ++k) {
    const BezierPatch patch = random_patch(random, {2, 4}, k % 2 == 0 ? 1 : 3);
    const Scene scene = make_scene(of_patch(patch));
    const ContactGeometry geometry(scene);
    const real scale = scene.frame().scale;
    for (const Side side : all_sides) {
      const SideFunction f = parabolic_along(geometry, {0, SourceKind::face, 0, 0, 0}, side);
      for (int i = 0; i <= 10; ++i) {
        const dvec2 uv = on_side(side, 0.1 * i);
        const ReferenceJet j = reference_jet(patch, uv.x, uv.y);
        const rvec3 n = j.normal();
        const real uu = glm::dot(j.Suu, n);
        const real uv_form = glm::dot(j.Suv, n);
        const real vv = glm::dot(j.Svv, n);
        const real size = std::abs(uu * vv) + uv_form * uv_form;
        const real factor = std::pow(scale, 6);
        EXPECT_NEAR(f(0.1 * i), double(factor * (uu * vv - uv_form * uv_form)),
                    1e-11 * double(factor * size));
      }
    }
  }
}

/// Where the curvature is nowhere positive the twist tells, of either sign, in whatever direction
/// the patch is level.
TEST(ParabolicSides, FunctionsAreTheTwistOfLevelPatches) {
  for (const LevelGraph& graph : {LevelGraph{0.3, -0.8, 1, 0, 0, 0},
                                  {0.3, -0.8, 1, 0.7, 0, 0},
                                  {0.3, -0.8, 1, -1, 0.4, 0},
                                  {-0.2, 0.6, -1, 0.5, 0.3, -0.5},
                                  {0.1, 1, 0.2, -0.5, -0.2, 0.7}}) {
    for (const auto& [side, patch] : turned_patches(graph.patch())) {
      const Scene scene = make_scene(mapped(of_patch(patch), skew_rotation()));
      const ContactGeometry geometry(scene);
      const SideFunction f = parabolic_along(geometry, {0, SourceKind::face, 0, 0, 0}, side);
      const double factor = std::copysign(scene.frame().scale, f(0) * graph.twist(0));
      for (int i = 0; i <= 20; ++i) {
        EXPECT_NEAR(f(0.05 * i), factor * graph.twist(0.05 * i), 1e-11) << int(side);
      }
      const double root = -0.5 * graph.p1 / graph.p2;
      EXPECT_LT(f(root - 1e-9) * f(root + 1e-9), 0) << int(side);
    }
  }
}

/// All sides of a box are edges.
TEST(ParabolicSides, StraightOnesOfABox) {
  const Scene scene = make_scene(mapped(box(1, 2, 3), skew_rotation()));
  const ContactGeometry geometry(scene);
  for (int patch = 0; patch < 6; ++patch) {
    for (const Side side : all_sides) {
      const Contact c{0, SourceKind::face, patch, 0.3, 0.6};
      const std::optional<Contact> piece = straight_piece(geometry, c, side);
      ASSERT_TRUE(piece);
      EXPECT_EQ(piece->kind, SourceKind::edge);
      const dvec3 middle = geometry.point({0, SourceKind::edge, piece->element, 0.5, 0});
      EXPECT_LT(glm::distance(middle, geometry.point(on_side_of(c, side, 0.5))), 1e-15);
    }
  }
}

/// z = x^2 (1 + y^2), x from 0 to 1, goes on smoothly in a plane over the straight seam x = 0.
TEST(ParabolicSides, StraightSeamsAreNoEdges) {
  const BezierPatch graph =
      bicubic([](double x, double y) { return dvec3(x, y, x * x * (1 + y * y)); });
  const BezierPatch plane{1, 1, {{-1, 0, 0, 1}, {-1, 1, 0, 1}, {0, 0, 0, 1}, {0, 1, 0, 1}}};
  const Scene scene = make_scene(of_patch(graph) + of_patch(plane));
  const ContactGeometry geometry(scene);
  for (int patch = 0; patch < 2; ++patch) {
    const Contact c{0, SourceKind::face, patch, 0.3, 0.6};
    const Side seam = patch == 0 ? Side::u0 : Side::u1;
    EXPECT_GE(geometry.patch(c).borders[std::size_t(seam)].piece, 0);
    // The others of the plane are straight edges, those of the graph are bent.
    for (const Side side : all_sides) {
      EXPECT_EQ(straight_piece(geometry, c, side).has_value(), patch == 1 && side != seam)
          << int(side);
    }
  }
}

/// A bent surface of three spans, straight along u: its long sides are of three pieces each.
TEST(ParabolicSides, SegmentsOfSeveralPieces) {
  NurbsSurface strip{1, 2, {0, 0, 1, 2, 3, 3}, {0, 0, 0, 1, 1, 1}, {}};
  for (const double x : {0.0, 1.0, 2.5, 3.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) strip.points.push_back(homogeneous({x, y, y * y}));
  }
  const Scene scene = make_scene(mapped({{strip}, {}, {}}, skew_rotation()));
  const ContactGeometry geometry(scene);
  for (int patch = 0; patch < 3; ++patch) {
    for (const Side side : all_sides) {
      const bool is_long = side == Side::v0 || side == Side::v1;
      EXPECT_EQ(straight_piece(geometry, {0, SourceKind::face, patch, 0.3, 0.6}, side).has_value(),
                is_long)
          << int(side);
    }
  }
}

}  // namespace
}  // namespace taut
