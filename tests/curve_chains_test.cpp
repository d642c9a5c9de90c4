#include "taut/hull/stitch/curve_chains.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace taut {
namespace {

CurveElement element(int left, int right, std::vector<dvec3> points) {
  CurveElement result;
  result.left = left;
  result.right = right;
  result.points = std::move(points);
  return result;
}

const dvec3 a(0, 0, 0), b(1, 0, 0), c(1, 1, 0), d(0, 1, 0);

TEST(CurveChains, OfNothing) { EXPECT_TRUE(chains({}).empty()); }

/// In whatever order the elements come.
TEST(CurveChains, FollowEachOtherHeadToTail) {
  std::vector<int> order = {0, 1, 2};
  do {
    const CurveElement parts[] = {element(0, 1, {a, 0.5 * (a + b), b}), element(0, 1, {b, c}),
                                  element(0, 1, {c, d})};
    std::vector<CurveElement> elements;
    for (const int k : order) elements.push_back(parts[k]);
    const std::vector<CurveChain> found = chains(elements);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_FALSE(found[0].closed);
    EXPECT_EQ(found[0].elements.size(), 3U);
    EXPECT_EQ(points_along(found[0], elements), (std::vector<dvec3>{a, 0.5 * (a + b), b, c, d}));
  } while (std::next_permutation(order.begin(), order.end()));
}

/// To within same_curve_end; the points are those of the first end.
TEST(CurveChains, Close) {
  const dvec3 near = a + dvec3(0.5 * same_curve_end, 0, 0);
  const std::vector<CurveElement> elements = {element(0, 1, {a, b}), element(0, 1, {b, c}),
                                              element(0, 1, {c, near})};
  const std::vector<CurveChain> found = chains(elements);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].closed);
  EXPECT_EQ(points_along(found[0], elements), (std::vector<dvec3>{a, b, c, a}));

  const std::vector<CurveElement> circle = {element(0, 1, {a, b, c, a})};
  ASSERT_EQ(chains(circle).size(), 1U);
  EXPECT_TRUE(chains(circle)[0].closed);

  const dvec3 far = a + dvec3(2 * same_curve_end, 0, 0);
  EXPECT_FALSE(chains({element(0, 1, {a, b, far})})[0].closed);
}

/// A corner is where other curves end.
TEST(CurveChains, EndInCorners) {
  const std::vector<CurveElement> elements = {element(0, 1, {a, b}), element(0, 1, {b, c}),
                                              element(0, 1, {c, a})};
  const std::vector<CurveChain> one = chains(elements, {b});
  ASSERT_EQ(one.size(), 1U);
  EXPECT_FALSE(one[0].closed);
  EXPECT_EQ(points_along(one[0], elements), (std::vector<dvec3>{b, c, a, b}));
  EXPECT_EQ(chains(elements, {a, c}).size(), 2U);
}

TEST(CurveChains, KeepFacesAndSourcesApart) {
  std::vector<CurveElement> elements = {element(1, 2, {a, b}), element(0, 2, {b, c}),
                                        element(1, 2, {b, d}), element(1, 2, {d, c})};
  elements[3].source = 7;
  const std::vector<CurveChain> found = chains(elements);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].elements, (std::vector<std::size_t>{1}));
  EXPECT_EQ(found[1].elements, (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(found[2].elements, (std::vector<std::size_t>{3}));
}

/// The head of one is not the head of another.
TEST(CurveChains, DoNotTurnElements) {
  EXPECT_EQ(chains({element(0, 1, {a, b}), element(0, 1, {c, b})}).size(), 2U);
}

}  // namespace
}  // namespace taut
