#pragma once

#include <array>
#include <utility>
#include <vector>

#include "taut/hull/decide/branches.h"

namespace taut {

/// Two charts that are glued span the same stretch of the side that they share; or the second one
/// no more of it than the first. What they share is one point: yes.
bool span_the_same(const Branches& branches, const Glue& glue);
bool spans(const Branches& branches, const Glue& glue);

/// What is glued to the sides and ends of the charts of a branch.
class ChartGlue {
 public:
  /// By chart, and by its sides or ends: the glue there, or -1.
  using Table = std::vector<std::array<int, 4>>;

  /// Of a branch, whose branches must outlive it. False if charts do not span the same stretches
  /// of what they share, or two are glued to one side.
  bool find(const Branches& branches, const Branch& branch);

  const Table& table() const { return table_; }
  bool is_border(int chart, int side) const {
    return table_[std::size_t(chart)][std::size_t(side)] < 0;
  }
  bool is_border(int chart, Side side) const { return is_border(chart, int(side)); }
  /// The side is one point, and no border.
  void close(int chart, Side side) { table_[std::size_t(chart)][std::size_t(side)] = 0; }
  /// Of those that charts hang together by.
  int count() const { return count_; }
  /// Charts of an element, a patch or an edge, end at an edge's or vertex's.
  bool are_beside(int chart, int element) const;

 private:
  const Branches* branches_ = nullptr;
  Table table_;
  int count_ = 0;
  /// An edge or vertex, and a chart of the branch that ends there.
  std::vector<std::pair<int, int>> beside_;
};

}  // namespace taut
