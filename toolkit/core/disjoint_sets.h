#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace taut {

/// Disjoint sets of the numbers below a count, united step by step; a set is known by its lowest
/// member. (Tarjan 1975, with path halving.)
class DisjointSets {
 public:
  /// Every number is a set of its own.
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  /// The lowest member of the number's set.
  int find(int a) {
    while (parent(a) != a) a = parent(a) = parent(parent(a));
    return a;
  }
  void unite(int a, int b) {
    a = find(a);
    b = find(b);
    parent(std::max(a, b)) = std::min(a, b);
  }

 private:
  int& parent(int a) { return parent_[static_cast<std::size_t>(a)]; }

  std::vector<int> parent_;
};

}  // namespace taut
