#include "taut/hull/decide/parameter_region.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace {

using taut::ParameterRegion;

/// Of squares of a quarter of the parameters, by their places.
ParameterRegion region_of(const std::vector<std::pair<int, int>>& squares) {
  std::vector<ParameterRegion::Cell> cells;
  cells.reserve(squares.size());
  for (const auto& [i, j] : squares) {
    cells.push_back({{0.25 * i, 0.25 * (i + 1)}, {0.25 * j, 0.25 * (j + 1)}});
  }
  return ParameterRegion(cells);
}

TEST(ParameterRegion, DiscsHangTogetherWithoutHoles) {
  EXPECT_TRUE(region_of({{1, 1}}).is_disc());
  EXPECT_TRUE(region_of({{0, 0}, {0, 1}, {1, 1}}).is_disc());
  EXPECT_FALSE(region_of({{0, 0}, {2, 0}}).is_disc());
  EXPECT_FALSE(region_of({{0, 0}, {1, 1}}).is_disc()) << "corners that touch";
  EXPECT_FALSE(
      region_of({{0, 0}, {0, 1}, {0, 2}, {1, 2}, {2, 2}, {2, 1}, {2, 0}, {1, 0}}).is_disc())
      << "a ring";
  EXPECT_FALSE(
      region_of({{0, 0}, {0, 1}, {1, 1}, {1, 2}, {0, 2}, {2, 0}, {2, 1}, {3, 3}}).is_disc());
}

TEST(ParameterRegion, RectanglesOfManySizesFitTogether) {
  const ParameterRegion region({{{0.25, 0.5}, {0, 0.5}}, {{0.5, 0.75}, {0.25, 0.375}}});
  EXPECT_TRUE(region.is_disc());
}

TEST(ParameterRegion, GrowsAcrossItsBorder) {
  ParameterRegion region = region_of({{1, 1}});
  ASSERT_EQ(region.border().size(), 4u);
  const ParameterRegion::BorderSide first = region.border().front();
  const auto beyond = region.extend(first);
  ASSERT_TRUE(beyond);
  EXPECT_EQ(beyond->u.upper, 0.25);
  EXPECT_TRUE(region.is_disc());
  EXPECT_EQ(region.border().size(), 6u);
  // At the border of the patch there is no more.
  ParameterRegion whole = region_of({{0, 0}, {0, 1}, {0, 2}, {0, 3}});
  for (const ParameterRegion::BorderSide& side : whole.border()) {
    if (side.side != taut::Side::u1) {
      EXPECT_FALSE(whole.extend(side));
    }
  }
}

/// At the inner corner of an L heights may fall to both sides of what is beyond it.
TEST(ParameterRegion, InnerCorners) {
  const ParameterRegion region = region_of({{1, 1}, {2, 1}, {2, 2}});
  std::vector<ParameterRegion::BorderSide> inner, outer;
  for (const ParameterRegion::BorderSide& side : region.border()) {
    const auto cell = region.cell(side.i, side.j);
    const bool lower = cell.u.lower == 0.25 && side.side == taut::Side::v1;
    const bool upper = cell.v.lower == 0.5 && side.side == taut::Side::u0;
    (lower || upper ? inner : outer).push_back(side);
  }
  ASSERT_EQ(inner.size(), 2u);
  EXPECT_TRUE(region.any_end_inwards(inner));
  EXPECT_TRUE(region.any_end_inwards({inner.front()}));
  EXPECT_FALSE(region.any_end_inwards(outer));
}

}  // namespace
