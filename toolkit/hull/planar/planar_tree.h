#pragma once

#include <span>
#include <vector>

#include "taut/core/geometry.h"

namespace taut {

/// A box of the plane.
struct PlanarBox {
  dvec2 lower = dvec2(0);
  dvec2 upper = dvec2(0);

  /// The box of points. @pre there is one
  explicit PlanarBox(const std::vector<dvec2>& points);
  /// Of both boxes.
  PlanarBox(const PlanarBox& a, const PlanarBox& b)
      : lower(glm::min(a.lower, b.lower)), upper(glm::max(a.upper, b.upper)) {}

  /// The height of its farthest corner in a direction. It rounds as the height of a point does:
  /// none of the box is found to be higher.
  double height(const dvec2& n) const {
    return glm::dot(dvec2(n.x > 0 ? upper.x : lower.x, n.y > 0 ? upper.y : lower.y), n);
  }
};

/// Numbered boxes of the plane in a binary tree.
class PlanarTree {
 public:
  /// A number with its box.
  struct Entry {
    int number;
    PlanarBox box;
  };

  PlanarTree() = default;
  explicit PlanarTree(std::vector<Entry> entries);

  /// Calls `see(number)`, which returns the height that counts from there on, for each box that
  /// reaches above that height in a direction: of two halves first the one that reaches farther.
  template <class See>
  void visit(const dvec2& n, double height, const See& see) const {
    if (!nodes_.empty()) visit(root_, n, height, see);
  }

 private:
  struct Node {
    PlanarBox box;
    int number;  ///< -1: of no leaf
    int children[2];
  };

  int build(std::span<Entry> entries);
  template <class See>
  void visit(int place, const dvec2& n, double& height, const See& see) const {
    const Node& node = nodes_[std::size_t(place)];
    if (node.box.height(n) <= height) return;
    if (node.number >= 0) {
      height = see(node.number);
      return;
    }
    const auto reach = [&](int k) { return nodes_[std::size_t(node.children[k])].box.height(n); };
    const int first = reach(1) > reach(0) ? 1 : 0;
    visit(node.children[first], n, height, see);
    visit(node.children[1 - first], n, height, see);
  }

  std::vector<Node> nodes_;
  int root_ = -1;
};

}  // namespace taut
