#include "taut/core/disjoint_sets.h"

#include <gtest/gtest.h>

#include <random>

namespace taut {
namespace {

TEST(DisjointSets, AreSinglesAtFirst) {
  DisjointSets sets(3);
  for (const int k : {0, 1, 2}) EXPECT_EQ(sets.find(k), k);
}

/// Against lists of members that are relabelled at each step.
TEST(DisjointSets, AreKnownByTheirLowestMembers) {
  std::mt19937 random(1);
  for (const int count : {1, 2, 10, 300}) {
    DisjointSets sets(static_cast<std::size_t>(count));
    std::vector<int> lowest(static_cast<std::size_t>(count));
    std::iota(lowest.begin(), lowest.end(), 0);
    std::uniform_int_distribution<int> number(0, count - 1);
    for (int step = 0; step < count; ++step) {
      const int a = number(random);
      const int b = number(random);
      sets.unite(a, b);
      const int from = lowest[static_cast<std::size_t>(a)];
      const int to = lowest[static_cast<std::size_t>(b)];
      for (int& l : lowest) {
        if (l == from || l == to) l = std::min(from, to);
      }
      for (int k = 0; k < count; ++k) {
        ASSERT_EQ(sets.find(k), lowest[static_cast<std::size_t>(k)]);
      }
    }
  }
}

}  // namespace
}  // namespace taut
