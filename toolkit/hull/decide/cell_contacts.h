#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/decide/direction_map.h"

namespace taut {

/// Which of the contacts of a map's cells support on the cells' borders. Contacts are told by their
/// numbers in MapCell::contacts.
class CellContacts {
 public:
  /// Both must outlive it.
  CellContacts(const DirectionMap& map, SupportQuery& query) : map_(map), query_(query) {}

  const MapCell& cell(int k) const { return map_.cells[std::size_t(k)]; }

  /// What is inside of the cell is told by its border: it has one contact, or several that are told
  /// apart and exchange along arcs which pass through or, of three contacts, meet once.
  bool is_closed(int k) const;
  /// Beside two contacts others all but support. Which of them are told apart there is as it
  /// happens: in cells beside it others may be.
  bool has_more(int k) const;
  /// The cell holds, or may hold, the normal of a plane that more than three contacts touch.
  bool is_of_facet(int k) const;

  /// It tells more than two contacts apart, all or some of which may be in line.
  bool has_line(int k) const {
    return cell(k).kind == MapCellKind::in_line ||
           (cell(k).kind == MapCellKind::node && is_closed(k));
  }

  /// The contact that supports in a direction.
  int winner(int k, const dvec3& d);

  /// The point that supports in a direction.
  const dvec3& point(const dvec3& d);

  /// The contacts that support one after the other on the way from one direction to another, both
  /// on a side of the cell. @pre the cell is closed
  std::vector<int> passed(int k, const dvec3& from, const dvec3& to);
  /// Of these the first, the last, and those that are above others by more than so much where these
  /// exchange: of contacts in line not all are.
  std::vector<int> passed_by_height(int k, const dvec3& from, const dvec3& to, double least);

 private:
  std::optional<dvec3> where_another_supports(int k, const dvec3& from, const dvec3& to,
                                              double least);

  const DirectionMap& map_;
  SupportQuery& query_;
  std::map<std::array<long long, 3>, dvec3> points_;
  Contact hint_;
};

}  // namespace taut
