#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "taut/hull/decide/branches.h"
#include "taut/hull/decide/chart_glue.h"

namespace taut {

/// Points at which the charts of a branch meet all around: corners of patches, poles, vertices.
class CornerRings {
 public:
  /// A corner of a chart, seen on the way around: the side over which the next step leads, and the
  /// other one, which is one point at a pole.
  struct Corner {
    int chart;
    Side next, other;
    bool operator==(const Corner& c) const {
      return chart == c.chart && next == c.next && other == c.other;
    }
  };
  /// Of charts that meet at a point, but not all around, the first and the last one: beyond the
  /// sides `next` there are no others.
  using Fan = std::array<Corner, 2>;

  /// The pieces must outlive it.
  explicit CornerRings(const MapPieces& pieces) : pieces_(pieces) {}

  /// Those of a branch. The branches must stay until they are asked for no more.
  void find(const Branches& branches, const Branch& branch, const ChartGlue::Table& glued);

  int count() const { return count_; }
  /// At some corner three charts of patches or more meet, but not all around: there the branch is
  /// not convex.
  bool any_is_reentrant() const { return reentrant_; }
  /// The corner of a chart is such a point, be it a pole or not.
  bool is_inside(int chart, Side side, Side other) const {
    return inside_[place(chart, side, other)];
  }
  /// That of which the corner of a chart is part, if there is one; none where edges bound it.
  std::optional<Fan> fan(int chart, Side side, Side other) const {
    const int found = fan_at_[place(chart, side, other)];
    return found < 0 ? std::nullopt : std::optional(fans_[std::size_t(found)]);
  }
  /// Charts and their sides at poles that are such points.
  const std::vector<std::pair<int, Side>>& poles() const { return poles_; }

 private:
  /// Corners passed from one on, and how the way ends: where it began, at the chart of an edge, or
  /// nowhere.
  struct Way {
    std::vector<Corner> corners;
    bool closed = false;
    int edge = -1;
  };

  /// Where what is known of a chart with two of its sides stands.
  static std::size_t place(int chart, Side side, Side other) {
    return std::size_t(16 * chart + 4 * int(side) + int(other));
  }
  void visit(int chart, Side u, Side v);
  void add_fan();
  void walk(const Corner& from, Way& way) const;
  std::optional<Corner> step(const Corner& from, int& edge) const;
  bool is_pole(const Corner& c) const;
  bool meet(int edge, int other) const;

  const MapPieces& pieces_;
  const Branches* branches_ = nullptr;
  const Branch* branch_ = nullptr;
  const ChartGlue::Table* glued_ = nullptr;
  int count_ = 0;
  bool reentrant_ = false;
  std::vector<std::pair<int, Side>> poles_;
  std::vector<Fan> fans_;
  /// By place().
  std::vector<bool> passed_, inside_;
  std::vector<int> fan_at_;
  Way way_, back_;  // scratch
};

}  // namespace taut
