#include "taut/hull/sample/sampled_start.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models.h"
#include "taut/core/integers.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

SampledStart start_of(const Scene& scene) {
  SupportQuery query(scene);
  SampledStart start = sampled_start(scene, query);
  EXPECT_EQ(start.samples.size(), start.points.size());
  EXPECT_EQ(start.frame_points.size(), start.points.size());
  for (std::size_t k = 0; k < start.points.size(); ++k) {
    EXPECT_EQ(start.frame_points[k], scene.frame().to_frame(start.points[k]));
    EXPECT_LT(glm::distance(scene.point(start.samples[k].contact), start.points[k]),
              1e-14 * scene.diagonal() + 1e-300);
  }
  return start;
}

int dimension_of(const Shape& shape) { return start_of(make_scene(shape)).span.dimension; }

/// Of a sphere about `center` each direction has its own point.
TEST(SampledStart, OfASphereHasItsTwentySixPoints) {
  const dvec3 center(3, -4, 5);
  const SampledStart start = start_of(make_scene(shifted(sphere(2), center)));
  ASSERT_EQ(start.samples.size(), 26U);
  EXPECT_EQ(start.span.dimension, 3);
  for (std::size_t k = 0; k < 26; ++k) {
    EXPECT_LT(glm::distance(start.points[k], center + 2.0 * start.samples[k].n), 1e-6);
    // Along an axis, or a diagonal of a face or of space: all that is not zero is as large.
    const dvec3 n = glm::abs(start.samples[k].n);
    const double largest = std::max({n.x, n.y, n.z});
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(n[i] * (n[i] - largest), 0, 1e-15);
  }
}

/// Corners that support in many directions are there once.
TEST(SampledStart, HasNoPointTwice) {
  const SampledStart start = start_of(make_scene(box(1, 2, 3)));
  ASSERT_EQ(start.points.size(), 8U);
  for (std::size_t k = 0; k < 8; ++k) {
    for (std::size_t i = 0; i < k; ++i)
      EXPECT_GE(glm::distance(start.points[i], start.points[k]), 1);
  }
}

/// What all 26 directions miss is found across the plane, or line, of their points.
TEST(SampledStart, SpansWhatTheModelSpans) {
  const dmat3 turned_plate = skew_rotation();
  const std::vector<dvec3> square = {{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}};
  for (const double height : {1e-3, -1e-6, 1e-9}) {
    Shape plate{{}, {}, square};
    EXPECT_EQ(dimension_of(mapped(plate, turned_plate)), 2);
    plate.points.emplace_back(0.1, 0.2, height);
    EXPECT_EQ(dimension_of(mapped(plate, turned_plate)), 3);
    Shape needle{{}, {segment({-1, 0, 0}, {1, 0, 0})}, {}};
    EXPECT_EQ(dimension_of(mapped(needle, turned_plate)), 1);
    needle.points.emplace_back(0.1, height, 0);
    EXPECT_EQ(dimension_of(mapped(needle, turned_plate)), 2);
    needle.points.emplace_back(0.2, 0, height);
    EXPECT_EQ(dimension_of(mapped(needle, turned_plate)), 3);
  }
  // The line's points span a plane, and what leaves that is yet nearer to the line.
  const Shape thin{
      {}, {segment({-1, 0, 0}, {1, 0, 0})}, {{0.1, 1e-3, 0}, {-0.2, -1e-3, 0}, {0.3, 0, 1e-9}}};
  EXPECT_EQ(dimension_of(mapped(thin, turned_plate)), 3);
  EXPECT_EQ(dimension_of({{}, {}, {{1, 2, 3}}}), 0);
  EXPECT_EQ(dimension_of(disc(1, 2)), 2);
}

/// Flat is what is thinner than 1e-11 of the size, or than its place's rounding up to 1e-6.
TEST(SampledStart, MeaningfulWidthGrowsWithTheDistance) {
  const auto width_at = [](double distance) {
    return meaningful_width(make_scene({{}, {}, {{distance, 0, 0}, {distance + 1, 1, 1}}}));
  };
  EXPECT_EQ(width_at(0), flat_width);
  EXPECT_EQ(width_at(1000), flat_width);
  // A coordinate of 2^20 is rounded by 2^-33, and the frame is that of a size of one.
  EXPECT_NEAR(width_at(0x1p20), 4 * 0x1p-33, 0.01 * 0x1p-31);
  EXPECT_EQ(width_at(0x1p40), flat_width_limit);
  EXPECT_EQ(meaningful_width(make_scene({{}, {}, {{1, 2, 3}}})), infinity);
}

/// Support points of points are these, but for the rounding of the scene's frame.
TEST(SampledStart, VertexRoundingHoldsWhereverTheModelIs) {
  Random random(4);
  for (const double distance : {0.0, 1.0, 1e5, 1e10}) {
    const dvec3 center = distance * dvec3(1, -0.7, 0.3);
    Shape shape;
    for (int k = 0; k < 200; ++k) {
      const dvec3 x = center + random_point(random);
      shape.points.push_back(x);
    }
    const Scene scene = make_scene(shape);
    const double bound = vertex_rounding(scene);
    const double reach = std::max(1.0, 2 * distance);
    EXPECT_LE(bound, 1e-14 * reach);
    EXPECT_GE(bound, 1e-16 * reach);
    for (const dvec3& p : start_of(scene).points) {
      double nearest = infinity;
      for (const dvec3& x : shape.points) nearest = std::min(nearest, glm::distance(p, x));
      EXPECT_LE(nearest, bound);
    }
  }
}

}  // namespace
}  // namespace taut
