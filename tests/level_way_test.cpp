#include "taut/hull/trace/level_way.h"

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <vector>

#include "freeform.h"
#include "models.h"
#include "taut/bounds/support_query.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// z = height(x) - y^2 over [-1, 1]^2 by the quartic's Bernstein coefficients; y along v.
Shape sheet(const std::array<double, 5>& height) {
  BezierPatch patch{4, 2, {}};
  for (std::size_t i = 0; i <= 4; ++i) {
    for (std::size_t j = 0; j <= 2; ++j) {
      const double square = j == 1 ? -1 : 1;  // of y
      patch.points.push_back(homogeneous({double(i) / 2 - 1, double(j) - 1, height[i] - square}));
    }
  }
  return of_patch(patch);
}

/// Bernstein coefficients over [-1, 1] of -x^4, of x^2 and of -x^2.
constexpr std::array<double, 5> flat_top = {-1, 1, -1, 1, -1};
constexpr std::array<double, 5> valley = {1, 0, -1.0 / 3, 0, 1};
constexpr std::array<double, 5> round_top = {-1, 0, 1.0 / 3, 0, -1};

/// Levels of contacts at -x and x on the sheet's middle line.
std::optional<std::vector<WayCrossing>> way_across(const Shape& shape, double x) {
  const Scene scene = make_scene(shape);
  const ContactGeometry geometry(scene);
  const auto at = [&](double place) -> Contact {
    return {0, SourceKind::face, 0, 0.5 * (place + 1), 0.5};
  };
  return level_way(geometry, at(-x), at(x), dvec3(0, 0, 1));
}

/// 1e-4 from the top of -x^4 nothing is told; 0.1 from it, or in a valley of 1e-8, it is.
TEST(LevelWay, IsWhereHeightsDoNotTell) {
  const auto way = way_across(sheet(flat_top), 1e-4);
  ASSERT_TRUE(way.has_value());
  EXPECT_TRUE(way->empty());
  EXPECT_FALSE(way_across(sheet(flat_top), 0.1));
  EXPECT_FALSE(way_across(sheet(valley), 1e-4));
  // Between the two it may rise.
  EXPECT_TRUE(way_across(sheet(round_top), 1e-4));
}

/// A sheet in four patches: one join lies between the contacts.
TEST(LevelWay, CrossesJoins) {
  const Scene scene = make_scene(split(sheet(round_top), 0.5, 0.25));
  const ContactGeometry geometry(scene);
  SupportQuery query(scene);
  const auto at = [&](double slope) {
    return geometry.canonical(query(glm::normalize(dvec3(slope, 0, 1))).contact);
  };
  const Contact left = at(-4e-4);
  const Contact right = at(4e-4);
  ASSERT_NE(left.element, right.element);
  const auto way = level_way(geometry, left, right, dvec3(0, 0, 1));
  ASSERT_TRUE(way.has_value());
  ASSERT_EQ(way->size(), 1U);
  const WayCrossing& crossing = way->front();
  EXPECT_EQ(crossing.from.element, left.element);
  EXPECT_EQ(crossing.to.element, right.element);
  EXPECT_LT(glm::distance(geometry.point(crossing.from), geometry.point(crossing.to)), 1e-15);
  // Farther apart it is not asked.
  EXPECT_FALSE(level_way(geometry, at(-0.1), at(0.1), dvec3(0, 0, 1)));
}

/// From a place on the flat top, a climb beyond it ends in the top of the other half.
TEST(TiedAhead, IsTheNextTop) {
  // -(x^2 - 1e-8)^2 has its tops at -1e-4 and 1e-4, and rises 1e-16 above what is between.
  constexpr double square = 1e-8;
  std::array<double, 5> twin_top = {};
  for (std::size_t k = 0; k < 5; ++k) twin_top[k] = flat_top[k] + 2 * square * valley[k];
  const Scene scene = make_scene(sheet(twin_top));
  const ContactGeometry geometry(scene);
  const Contact left{0, SourceKind::face, 0, 0.5 * (1 - 1e-4), 0.5};
  const std::optional<LevelStep> ahead = tied_ahead(geometry, left, dvec2(1, 0), dvec3(0, 0, 1));
  ASSERT_TRUE(ahead.has_value());
  EXPECT_NEAR(ahead->to.u, 0.5 * (1 + 1e-4), 1e-7);
  EXPECT_TRUE(ahead->way.empty());
  // A round top ties with nothing.
  const Scene round = make_scene(sheet(round_top));
  const Contact top{0, SourceKind::face, 0, 0.5, 0.5};
  EXPECT_FALSE(tied_ahead(ContactGeometry(round), top, dvec2(1, 0), dvec3(0, 0, 1)));
}

}  // namespace
}  // namespace taut
