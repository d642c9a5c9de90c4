#pragma once

#include <optional>
#include <vector>

#include "taut/hull/decide/branches.h"

namespace taut {

/// How the branches of a cell lie beside each other, seen along its directions: the slopes of their
/// support functions over the cell are the places of their contacts.
class BranchOrder {
 public:
  /// Along two axes of the plane in which the directions lie.
  void find(const CellView& view, const Branches& branches, const dvec3& first,
            const dvec3& second);

  /// Certain: a line parts the two, so that the difference of their support functions is monotone
  /// along some direction.
  bool apart(std::size_t a, std::size_t b) const;
  /// Certain: any three points of theirs go around the same way. Two differences of the three
  /// support functions have independent gradients then, and vanish together at most once.
  bool go_around(std::size_t a, std::size_t b, std::size_t c) const;
  /// Certain: the branches follow each other along one of the axes. Their numbers in this order.
  std::optional<std::vector<int>> row(std::size_t axis) const;
  /// Certain: any three of those in a row go around the same way, in its order.
  bool go_around_alike(const std::vector<int>& row) const;

 private:
  /// Which way three go around: 1, -1, or 0 if it is not certain.
  int turn(std::size_t a, std::size_t b, std::size_t c) const;
  /// Of the points of a branch.
  Interval along(std::size_t branch, const dvec2& axis) const;
  dvec2 middle(std::size_t branch) const;

  std::vector<std::vector<dvec2>> points_;  // by branch
};

}  // namespace taut
