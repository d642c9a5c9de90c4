#include "taut/hull/decide/top_parts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models.h"
#include "taut/bounds/support_query.h"

namespace {

using namespace taut_test;  // NOLINT: shapes
using taut::BezierCurve;
using taut::BezierPatch;
using taut::ContactGeometry;
using taut::dvec3;
using taut::Scene;
using taut::TopParts;

/// Of y = -(x^2 - a^2)^2 over [-1, 1], with two highest points and a^4 between them: Bernstein
/// coefficients, the polar form at ends.
double height(double a, int k) {
  constexpr double products[] = {1, -1, 1, -1, 1};
  constexpr double sums_of_products_of_two[] = {6, 0, -2, 0, 6};
  return -products[k] + a * a * sums_of_products_of_two[k] / 3 - std::pow(a, 4);
}

Shape curve_with_dip(double a) {
  BezierCurve curve;
  for (int k = 0; k <= 4; ++k) curve.points.emplace_back(0.5 * k - 1, height(a, k), 0, 1);
  return {{}, {as_nurbs(curve)}, {}};
}

/// Falls off to both sides of the curve, as -z^2.
Shape sheet_with_dip(double a) {
  BezierPatch patch{4, 2, {}};
  for (int k = 0; k <= 4; ++k) {
    for (const dvec3 off : {dvec3(0, -1, -1), dvec3(0, 1, 0), dvec3(0, -1, 1)}) {
      patch.points.emplace_back(dvec3(0.5 * k - 1, height(a, k), 0) + off, 1);
    }
  }
  return {{as_nurbs(patch)}, {}, {}};
}

/// Whether its two highest points hang together, at shares of the dip's depth.
void expect_dip(const Shape& shape, double a) {
  const Scene scene(make_model(shape));
  const ContactGeometry geometry(scene);
  const TopParts parts(geometry);
  const auto highest = [&](int side) {
    return taut::SupportQuery(scene)(taut::unit({1e-3 * std::pow(a, 3) * side, 1, 0})).contact;
  };
  const auto hang_together = [&](double share) {
    return parts.hang_together({0, 1, 0}, highest(-1), highest(1),
                               scene.frame().length_to_frame(share * std::pow(a, 4)));
  };
  EXPECT_FALSE(hang_together(0.01));
  EXPECT_FALSE(hang_together(0.79));
  EXPECT_TRUE(hang_together(1.01));
  EXPECT_TRUE(hang_together(2));
}

TEST(TopParts, HangTogetherWhereADipIsShallow) {
  for (const double a : {0.5, 0.1, 0.02}) {
    SCOPED_TRACE(a);
    expect_dip(curve_with_dip(a), a);
    expect_dip(sheet_with_dip(a), a);
  }
}

TEST(TopParts, DoNotHangTogetherWhereThereAreTwo) {
  const Scene scene(make_model(two_spheres(1, 1, 3)));
  const ContactGeometry geometry(scene);
  const auto highest = [&](double z) {
    return taut::SupportQuery(scene)(taut::unit({0, 1, z})).contact;
  };
  EXPECT_FALSE(TopParts(geometry).hang_together({0, 1, 0}, highest(-1e-9), highest(1e-9), 1e-3));
  EXPECT_TRUE(TopParts(geometry).hang_together({0, 1, 0}, highest(1e-9), highest(2e-9), 1e-3));
}

/// Each within the depth of the other, and they cross.
TEST(TopParts, OfTwoCurvesDoNotHangTogether) {
  const Shape one = {{}, {circle(dvec3(0.0), {1, 0, 0}, {0, 1, 0})}, {}};
  const Scene scene(make_model(one + shifted(one, {1e-5, 0, 0})));
  const ContactGeometry geometry(scene);
  const TopParts parts(geometry);
  const auto highest = [&](double x) {
    return taut::SupportQuery(scene)(taut::unit({x, 1, 0})).contact;
  };
  ASSERT_FALSE(taut::same_element(highest(-1e-9), highest(1e-9)));
  EXPECT_FALSE(parts.hang_together({0, 1, 0}, highest(-1e-9), highest(1e-9), 1e-3));
  EXPECT_TRUE(parts.hang_together({0, 1, 0}, highest(1e-9), highest(2e-9), 1e-3));
}

}  // namespace
