#pragma once

#include <vector>

#include "taut/hull/decide/beacon_envelope.h"
#include "taut/hull/decide/branches.h"

namespace taut {

/// Of each branch points that are high in some direction of a cell.
class BranchPoints {
 public:
  /// For each corner of the cell the highest corner of a piece of each branch.
  void find(const CellView& view, const Branches& branches);
  /// Of a branch, with their heights at the cell's corners.
  const std::array<dvec3, 4>& points(std::size_t branch) const { return points_[branch]; }
  const std::array<Corners, 4>& heights(std::size_t branch) const { return heights_[branch]; }

 private:
  std::vector<std::array<dvec3, 4>> points_;
  std::vector<std::array<Corners, 4>> heights_;
};

/// Certain: for each direction of the cell a branch is higher than the means of two others, with
/// weights that are the same for all: where these are as high as each other they do not support.
bool stands_out(const CellView& view, const BranchPoints& points, const Branches& branches,
                std::size_t branch, std::size_t first, std::size_t second);

/// Branches that are nowhere more than a budget above the convex hull of the others: they have no
/// contacts of their own to within it.
class BranchDomination {
 public:
  explicit BranchDomination(double budget) : budget_(budget) {}

  /// Which branches are left if others are dropped one after the other, the last first. All where
  /// there are many.
  std::vector<bool> left(const CellView& view, const BranchPoints& points,
                         const Branches& branches);

 private:
  bool is_dominated(const CellView& view, const Branches& branches, std::size_t branch) const;

  double budget_;
  BeaconEnvelope envelope_;
  std::vector<Corners> others_;  // scratch
};

}  // namespace taut
