#include "taut/hull/polytope/model_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models.h"
#include "reference.h"
#include "taut/core/integers.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

Model model_with_points(const std::vector<dvec3>& points) {
  Part part;
  part.add_points(points);
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  return model;
}

Part pyramid_part(const dvec3& corner) {
  Part part;
  part.add_polygons({{corner, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.4, 0.3, 2}},
                     {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}});
  return part;
}

TEST(ModelPoints, OfOnePartAtRestAreItsOwn) {
  const Model model = model_with_points({{1, 2, -3}, {-4, 0.5, 2}, {0, 0, 1}});
  const ModelPoints points(model);
  EXPECT_EQ(points.points().data(), model.parts()[0].vertices().data());
  EXPECT_EQ(points.scale(), 1);
  EXPECT_EQ(points.product_scale(), 1);
  EXPECT_DOUBLE_EQ(points.diagonal(), std::sqrt(5 * 5 + 2 * 2 + 5 * 5));
  EXPECT_DOUBLE_EQ(points.reach(), 4 + 2 + 3);
  EXPECT_EQ(points.placement_bound(), 0);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(points.model_point(k), points.points()[to_size(k)]);
    EXPECT_EQ(points.source(k), model.source_id({SourceKind::vertex, 0, k}));
  }
}

/// Five points of a pyramid, four times, and between them three points of another part.
TEST(ModelPoints, OfInstancesAreNumberedThrough) {
  Model model = model_with_points({{5, 0, 0}, {0, 5, 0}, {0, 0, 5}});
  model.clear_instances();
  const int pyramid = model.add_part(pyramid_part({0, 0, 0}), smooth_join_angle);
  Random random(3);
  for (const int part : {pyramid, 0, pyramid, pyramid}) {
    RigidMotion pose;
    pose.rotation = random_rotation(random);
    pose.translation = 100.0 * random_point(random);
    model.add_instance(part, pose);
  }
  const ModelPoints points(model);
  ASSERT_EQ(points.points().size(), 23U);
  int number = 0;
  real off = 0;
  for (int i = 0; i < to_int(model.instances().size()); ++i) {
    const Instance& instance = model.instances()[to_size(i)];
    const glm::mat<3, 3, real> rotation(instance.pose.rotation);
    const std::vector<dvec3>& vertices = model.parts()[to_size(instance.part)].vertices();
    for (int k = 0; k < to_int(vertices.size()); ++k, ++number) {
      const rvec3 x = rotation * rvec3(vertices[to_size(k)]) + rvec3(instance.pose.translation);
      off = std::max(off, glm::length(x - rvec3(points.points()[to_size(number)])));
      EXPECT_EQ(points.source(number), model.source_id({SourceKind::vertex, i, k}));
      EXPECT_EQ(points.model_point(number), points.points()[to_size(number)]);
    }
  }
  EXPECT_LE(off, points.placement_bound());
  EXPECT_LE(points.placement_bound(), 1e-12);
  int polygons = 0;
  points.for_each_polygon([&](int source, const std::vector<int>& corners) {
    const Source place = model.source(source);
    EXPECT_EQ(place.kind, SourceKind::face);
    const Instance& instance = model.instances()[to_size(place.instance)];
    const Part& part = model.parts()[to_size(instance.part)];
    const std::vector<int>& own = part.polygons()[to_size(place.index)];
    ASSERT_EQ(corners.size(), own.size());
    for (std::size_t k = 0; k < own.size(); ++k) {
      const dvec3 x = instance.pose(part.vertices()[to_size(own[k])]);
      EXPECT_EQ(points.points()[to_size(corners[k])], x);
    }
    ++polygons;
  });
  EXPECT_EQ(polygons, 4 * 5);
}

/// Huge and tiny ones are multiplied by a power of two, exactly.
TEST(ModelPoints, KeepProductsInTheRangeOfDoubles) {
  for (const double size : {1e300, 3e-300, 1e70, 2e-70}) {
    const std::vector<dvec3> corners = {
        {size, 0, 0}, {0, 1.1 * size, 0}, {0, 0, 1.7 * size}, {0.3 * size, -size, size}};
    const Model model = model_with_points(corners);
    const ModelPoints points(model);
    int exponent = 0;
    EXPECT_EQ(std::frexp(points.scale(), &exponent), 0.5);
    EXPECT_EQ(points.product_scale(), 1);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const dvec3& x = points.points()[k];
      EXPECT_EQ(x / points.scale(), corners[k]);
      EXPECT_EQ(points.model_point(to_int(k)), corners[k]);
      EXPECT_TRUE(std::isnormal(glm::dot(x, x) * glm::length(x)));
    }
    EXPECT_DOUBLE_EQ(points.diagonal(), points.scale() * diagonal(model.control_box()));
    EXPECT_DOUBLE_EQ(points.reach(), points.scale() * (1 + 1.1 + 1.7) * size);
  }
}

/// Where that would round the smallest ones it is left to the products.
TEST(ModelPoints, ThatScalingWouldRoundStayAsTheyAre) {
  const std::vector<dvec3> corners = {{1e300, 0, 0}, {0, 1.1e-20, 0}, {0, 0, 1}, {1, 1, 1}};
  const Model model = model_with_points(corners);
  const ModelPoints points(model);
  EXPECT_EQ(points.scale(), 1);
  EXPECT_GT(points.product_scale() * 1e300, 0.1);
  EXPECT_LT(points.product_scale() * 1e300, 10);
  for (std::size_t k = 0; k < corners.size(); ++k) EXPECT_EQ(points.points()[k], corners[k]);
  EXPECT_DOUBLE_EQ(points.reach(), 1e300);
}

}  // namespace
}  // namespace taut
