#pragma once

#include <array>
#include <optional>
#include <vector>

#include "taut/hull/decide/branches.h"
#include "taut/hull/decide/map_cell.h"

namespace taut {

/// How the support functions of a cell's branches differ, each of one contact: by slopes of their
/// differences along the axes of the cell.
///
/// The points of translates that touch parallel planes are as far from each other as these; those
/// of round shapes of which one is the other in another size, as far as their centres but for the
/// difference in size.
class BranchDifferences {
 public:
  /// All must outlive it. `tolerance`: how nearly alike translates are.
  BranchDifferences(const MapPieces& pieces, const CellView& view, const Branches& branches,
                    double tolerance)
      : pieces_(pieces), view_(view), branches_(branches), tolerance_(tolerance) {}

  void turn_to(const dvec3& first, const dvec3& second) { axes_ = {first, second}; }

  /// The branch is of one round shape, which has one contact for each direction.
  bool is_round(const Branch& branch) const;
  /// The difference of two support functions is monotone along one of the axes.
  bool is_arc(const Branch& a, const Branch& b) const;
  /// Two differences of three support functions have independent gradients: they vanish together
  /// at most once.
  bool is_node(const Branch& a, const Branch& b, const Branch& c) const;
  /// Three, if of any two the difference is monotone along the same axis, and one is no lower than
  /// the others where these are equal: they follow each other along the axis, two curves apart.
  /// Their numbers in this order.
  std::optional<std::array<int, 3>> line_of(const std::vector<Branch>& three) const;

  /// MapCell::translates and MapCell::rounds.
  std::vector<MapCell::Translate> translates() const;
  std::vector<MapCell::Round> rounds() const;

 private:
  using Slopes = std::array<Interval, 2>;
  Slopes slopes(const Branch& a, const Branch& b) const;
  std::optional<Box> translation_to(const Branch& from, const Branch& to) const;
  const RoundShape* round(const Branch& branch) const;
  bool stands_out(const Branch& a, const Branch& middle, const Branch& c) const;

  const MapPieces& pieces_;
  const CellView& view_;
  const Branches& branches_;
  double tolerance_;
  std::array<dvec3, 2> axes_ = {};
};

}  // namespace taut
