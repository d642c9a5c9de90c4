#pragma once

#include <optional>
#include <vector>

#include "taut/surface/bezier.h"

namespace taut {

/// A part of the parameters of a patch that is made of rectangles, as cells of a grid on all their
/// sides, and of as much again around them.
class ParameterRegion {
 public:
  struct Cell {
    Interval u, v;
  };
  explicit ParameterRegion(const std::vector<Cell>& rectangles);

  /// It hangs together, without holes and without corners that only touch.
  bool is_disc() const;

  /// A side of a cell of the region, beyond which there is none.
  struct BorderSide {
    int i = 0, j = 0;  ///< of the cell
    Side side = Side::u0;
  };
  std::vector<BorderSide> border() const;
  /// One of them ends at a corner at which three cells of the region meet.
  bool any_end_inwards(const std::vector<BorderSide>& sides) const;
  Cell cell(int i, int j) const;
  /// Adds the cell beyond; none if the grid ends there.
  std::optional<Cell> extend(const BorderSide& side);

 private:
  int rows() const { return int(u_.size()) - 1; }
  int columns() const { return int(v_.size()) - 1; }
  bool has(int i, int j) const;
  bool hangs_together() const;
  int cells_at(int i, int j) const;

  std::vector<double> u_, v_;
  std::vector<bool> cells_;  // v within u
};

}  // namespace taut
