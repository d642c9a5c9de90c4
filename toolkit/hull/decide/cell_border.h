#pragma once

#include <array>
#include <optional>
#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/decide/branch_domination.h"
#include "taut/hull/decide/branch_order.h"

namespace taut {

/// Which of a cell's three branches support on its border, one after the other, and what that tells
/// of its inside.
///
/// Along a side the branches support in the order of their places, each over one stretch or
/// nowhere: slopes of support functions are the places of contacts. The ends of a side tell all of
/// it then, but for the one in the middle, for which it is asked where the others exchange.
class CellBorder {
 public:
  /// All must outlive it.
  CellBorder(const CellView& view, const Branches& branches, SupportQuery& query)
      : view_(view), branches_(branches), query_(query) {}

  struct Found {
    /// Numbers of the branches that support in the cell; of three that are no node one that follows
    /// both others is in the middle.
    std::vector<int> supporting;
    /// All three touch one plane, with a normal in the cell. Else no curves in which two exchange
    /// meet.
    bool is_node = false;
  };
  /// None if it is not certain, but for what the resolution leaves open.
  /// @pre there are three branches, each of one contact, whose boxes part and that touch one plane
  /// at most once; the order is that of the branches, along the cell's axes
  std::optional<Found> find(const BranchOrder& order, const Contact& hint);

 private:
  /// Corners.
  using CellSide = std::array<std::size_t, 2>;

  std::optional<std::vector<int>> along(const CellSide& side, const BranchOrder& order,
                                        std::size_t axis);
  std::optional<int> winner_along(const CellSide& side) const;
  bool is_above(int branch, const dvec3& point, const CellSide& side) const;
  std::optional<bool> supports_between(int branch, const CellSide& side);
  int branch_of(const dvec3& x) const;

  const CellView& view_;
  const Branches& branches_;
  SupportQuery& query_;
  BranchPoints points_;
  std::array<Support, 4> corner_;
  std::array<int, 4> winner_ = {};  // at corners
};

}  // namespace taut
