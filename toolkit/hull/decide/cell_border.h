#pragma once

#include <array>
#include <optional>
#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/decide/branch_domination.h"
#include "taut/hull/decide/branch_order.h"

namespace taut {

/// Which of a cell's branches support on its border, one after the other, and what that tells of
/// its inside.
///
/// Along a side the branches support in the order of their places, each over one stretch or
/// nowhere: slopes of support functions are the places of contacts. The ends of a side tell all of
/// it then, but for those between, for which it is asked where the others exchange.
///
/// Where a plane touches three, seen along the row the one between them appears or vanishes. If any
/// three go around alike, none but appear, or none but vanish: that two exchange which then never
/// do so again shows on the border.
class CellBorder {
 public:
  /// All must outlive it.
  CellBorder(const CellView& view, const Branches& branches, SupportQuery& query)
      : view_(view), branches_(branches), query_(query) {}

  struct Found {
    /// Numbers of the branches that support in the cell; if it is no node, each exchanges with the
    /// next only, along one curve or the same curve again.
    std::vector<int> supporting;
    bool is_node = false;  ///< of three, which touch one plane
  };
  /// None if it is not certain, but for what the resolution leaves open.
  /// @pre there are three branches or more, each of one contact, whose boxes part; any three touch
  /// one plane at most once, and of more than three go around alike in a row along one of the
  /// cell's axes; the order is that of the branches, along these axes
  std::optional<Found> find(const BranchOrder& order, const Contact& hint);

 private:
  /// Corners.
  using CellSide = std::array<std::size_t, 2>;

  std::optional<std::vector<int>> along(const CellSide& side, const BranchOrder& order,
                                        std::size_t axis);
  std::optional<Found> inside(const std::vector<int>& loop) const;
  std::optional<int> winner_along(const CellSide& side) const;
  bool is_above(int branch, const dvec3& point, const CellSide& side) const;
  bool add_between(const std::vector<int>& row, const dvec3& from, const Support& first,
                   const dvec3& to, const Support& last, std::vector<int>& found);
  std::size_t count() const { return branches_.all().size(); }
  int branch_of(const dvec3& x) const;

  const CellView& view_;
  const Branches& branches_;
  SupportQuery& query_;
  BranchPoints points_;
  std::array<Support, 4> corner_;
  std::array<int, 4> winner_ = {};  // at corners
};

}  // namespace taut
