#include "taut/hull/contact/exit_margins.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

using ExitKind = ContactExit::Kind;

CommonSupport supports_at(const ContactGeometry& geometry, const dvec3& n,
                          std::initializer_list<Contact> contacts) {
  CommonSupport s;
  s.n = n;
  for (const Contact& c : contacts) s.add(geometry, c);
  return s;
}

/// Distances of a parameter from the ends of its interval, of either of two contacts: one on the
/// graph of x^2 + y^2, x = 2 u - 1, y = 2 v - 1, the other on the curve (t, t^2, t^3).
TEST(ExitMargins, OfSidesAndEndsAreDistancesOfParameters) {
  const Scene scene = make_scene(paraboloid() + Shape{{}, {twisted_cubic()}, {}});
  const ContactGeometry geometry(scene);
  const Contact face{0, SourceKind::face, 0, 0.3, 0.9};
  const Contact edge{0, SourceKind::edge, 0, 0.2, 0};
  const CommonSupport s = supports_at(geometry, {0, 0, 1}, {face, edge});
  const std::array<double, 4> margins = {0.3, 0.7, 0.9, 0.1};
  const std::array<dvec2, 4> rates = {dvec2(1, 0), {-1, 0}, {0, 1}, {0, -1}};
  for (std::size_t k = 0; k < 4; ++k) {
    const LinearEquation e = exit_margin(geometry, s, 0, {ExitKind::side, int(k)});
    EXPECT_DOUBLE_EQ(e.residual, margins[k]);
    EXPECT_EQ(e.parameter[0], rates[k]);
    EXPECT_EQ(e.parameter[1], dvec2(0.0));
    EXPECT_EQ(e.n, dvec3(0.0));
  }
  for (const int end : {0, 1}) {
    const LinearEquation e = exit_margin(geometry, s, 1, {ExitKind::end, end});
    EXPECT_DOUBLE_EQ(e.residual, end == 0 ? 0.2 : 0.8);
    EXPECT_EQ(e.parameter[1], dvec2(end == 0 ? 1 : -1, 0));
    EXPECT_EQ(e.parameter[0], dvec2(0.0));
    EXPECT_EQ(e.n, dvec3(0.0));
  }
}

/// At the rim of a cap, at the height 0.4 of the unit sphere, into the cap: the inward tangent
/// turns with the rim, and does not change in length.
TEST(ExitMargins, OfTheRimOfACap) {
  const dmat3 turn = skew_rotation();
  const Scene scene = make_scene(mapped(spherical_cap(0.6), turn));
  const ContactGeometry geometry(scene);
  const double scale = scene.frame().scale;
  const double height = 0.4;
  const double rim = std::sqrt(1 - height * height);
  Random random(1);
  for (int k = 0; k < 100; ++k) {
    const Contact c{0, SourceKind::edge, pick(random, 0, 3), uniform(random, 0, 1), 0};
    ASSERT_EQ(geometry.sides(c).size(), 1U);
    const ContactExit exit{ExitKind::face, 0};
    const dvec3 x = scene.frame().to_model(geometry.point(c));
    const dvec3 radial = unit(glm::transpose(turn) * x - dvec3(0, 0, height));
    const dvec3 inward = turn * (-height * radial + dvec3(0, 0, rim));
    const dvec3 n = random_direction(random);
    const LinearEquation e = exit_margin(geometry, supports_at(geometry, n, {c}), 0, exit);
    EXPECT_LT(glm::distance(e.n, -inward), 1e-13);
    EXPECT_NEAR(e.residual, -glm::dot(inward, n), 1e-13);
    // It turns with the rim, whose radius it is multiplied by the height.
    const dvec3 rate = -height * geometry.jet(c).dx[0] / (rim * scale);
    EXPECT_NEAR(e.parameter[0].x, -glm::dot(rate, n), 1e-12);
  }
}

/// (t, t^2, t^3) leaves its ends along (1, 0, 0) and -(1, 2, 3).
TEST(ExitMargins, OfTheEndsOfACurve) {
  const Scene scene = make_scene({{}, {twisted_cubic()}, {}});
  const ContactGeometry geometry(scene);
  Random random(2);
  for (int end = 0; end < 2; ++end) {
    const Contact vertex = geometry.canonical({0, SourceKind::edge, 0, double(end), 0});
    ASSERT_EQ(vertex.kind, SourceKind::vertex);
    const ContactExit exit{ExitKind::edge, 0};
    const dvec3 away = end == 0 ? dvec3(1, 0, 0) : dvec3(-1, -2, -3);
    const dvec3 n = random_direction(random);
    const LinearEquation e = exit_margin(geometry, supports_at(geometry, n, {vertex}), 0, exit);
    EXPECT_NEAR(e.residual, -glm::dot(unit(away), n), 1e-14);
    EXPECT_LT(glm::distance(e.n, -unit(away)), 1e-14);
  }
}

}  // namespace
}  // namespace taut
