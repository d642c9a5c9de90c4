#include "taut/surface/equal_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

Part model_part(const Shape& shape) { return make_model(shape).parts()[0]; }

TEST(EqualParts, TellsTheFirst) {
  EXPECT_TRUE(equal_parts({}).empty());
  const Part pot = model_part(teapot());
  const Part ball = model_part(shapes::sphere());
  EXPECT_EQ(equal_parts({ball, pot, ball, pot, pot}), (std::vector<int>{0, 1, 0, 1, 1}));
  const Part empty = make_model({}).parts()[0];
  EXPECT_EQ(equal_parts({empty, ball, empty}), (std::vector<int>{0, 1, 0}));
}

TEST(EqualParts, NamesDoNotCount) {
  const Part ball = model_part(shapes::sphere());
  Part renamed = ball;
  renamed.name = "another";
  EXPECT_EQ(equal_parts({ball, renamed}), (std::vector<int>{0, 0}));
}

TEST(EqualParts, EveryNumberCounts) {
  const Shape pot = teapot();
  const std::vector<int> differ = {0, 1};
  Shape reversed = pot;
  std::reverse(reversed.surfaces.begin(), reversed.surfaces.end());
  EXPECT_EQ(equal_parts({model_part(pot), model_part(reversed)}), differ);
  for (const std::size_t k : {std::size_t(0), std::size_t(13), pot.surfaces.size() - 1}) {
    Shape moved = pot;
    double& x = moved.surfaces[k].points[5].x;
    x = std::nextafter(x, 10.0);
    EXPECT_EQ(equal_parts({model_part(pot), model_part(moved)}), differ) << k;
  }
  Shape with_point = pot;
  with_point.points.emplace_back(0, 0, 1);
  EXPECT_EQ(equal_parts({model_part(pot), model_part(with_point)}), differ);
}

/// The same faces, of which one is joined smoothly and the other in creases.
TEST(EqualParts, JoinsCount) {
  Part creased;
  for (const NurbsSurface& surface : teapot().surfaces) creased.add_surface(surface, "face");
  Part smooth = creased;
  creased.connect(0);
  smooth.connect(smooth_join_angle);
  ASSERT_NE(creased.edges().size(), smooth.edges().size());
  EXPECT_EQ(equal_parts({creased, smooth}), (std::vector<int>{0, 1}));
}

}  // namespace
}  // namespace taut
