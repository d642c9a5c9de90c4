#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/decide/branch_differences.h"
#include "taut/hull/decide/branch_domination.h"
#include "taut/hull/decide/branch_order.h"
#include "taut/hull/decide/branches.h"
#include "taut/hull/decide/cell_border.h"
#include "taut/hull/decide/cell_planes.h"
#include "taut/hull/decide/contact_index.h"
#include "taut/hull/decide/direction_map.h"
#include "taut/hull/decide/near_concavity.h"
#include "taut/hull/decide/ridge_contacts.h"

namespace taut {

/// A cell that is to be decided, with what is known of it.
struct OpenCell {
  MapCell cell;
  std::shared_ptr<const std::vector<const MapPiece*>> pieces;  ///< no others touch
  std::vector<dvec3> beacons;
  Contact hint;  ///< that supports nearby
};

/// A cell that is decided, or is to be split.
struct LookedAtCell {
  MapCell cell;
  bool splits = false;
  /// Of what is split or may have to be, a node or facet: what its quarters are decided with.
  std::vector<const MapPiece*> pieces;
  std::vector<dvec3> beacons;
  long candidates = 0;  ///< pieces that were looked at
  long queries = 0;     ///< support queries
};

/// Decides cells of a direction map, one after the other.
class CellDecider {
 public:
  /// The pieces must outlive it.
  CellDecider(const MapPieces& pieces, const DirectionMapOptions& options);

  /// @throws Cancelled
  LookedAtCell decide(const OpenCell& open);

 private:
  void turn_to(const MapCell& cell, const dvec3& q, const std::vector<dvec3>& beacons);
  void drop_low(std::vector<dvec3>& beacons) const;
  void add_branch_points(std::vector<dvec3>& beacons);
  std::vector<const MapPiece*> pieces_left() const;
  void finish(MapCell& cell, MapCellKind kind) const;
  void put_in_line(MapCell& cell) const;

  std::optional<MapCellKind> kind_of_cell(const MapCell& cell, std::vector<const MapPiece*>& left);
  std::optional<MapCellKind> decided(bool before_splits);
  std::optional<MapCellKind> decided_last();
  std::optional<MapCellKind> decided_sharply(int level);
  std::vector<double> shares_of_branches() const;
  bool are_one();
  bool are_of_one_surface() const;
  std::optional<MapCellKind> kind_without_dominated();
  std::optional<MapCellKind> kind_of_branches(bool extends);
  std::optional<MapCellKind> kind_of_contacts(const std::vector<Branch>& all);
  std::optional<MapCellKind> kind_of_row();
  std::optional<MapCellKind> kind_by_border();
  bool is_facet();
  bool is_flat() const;

  const MapPieces& pieces_;
  DirectionMapOptions options_;
  SupportQuery query_;
  FaceAxes axes_ = {};
  CellView view_;
  Branches branches_;
  BranchPoints branch_points_;
  BranchDomination domination_;
  std::vector<Box> dominated_;
  BranchOrder order_;
  ContactIndex index_;
  NearConcavity concavity_;
  RidgeContacts ridge_;
  BranchDifferences differences_;
  CellPlanes planes_;
  CellBorder border_;
  std::vector<int> line_;  ///< numbers of branches that are in line
  Contact contact_ = {};   ///< supports in the middle of the cell
  std::optional<CellPlanes::Plane> facet_;
};

}  // namespace taut
