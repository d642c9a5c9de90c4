#include "taut/hull/decide/map_topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "taut/bounds/support_query.h"
#include "taut/core/disjoint_sets.h"
#include "taut/hull/decide/cell_tree.h"
#include "taut/hull/decide/top_parts.h"

namespace taut {
namespace {

/// Curves that a cell may hold, at most.
constexpr int arcs_a_cell = 8;

class Assembly {
 public:
  Assembly(const ContactGeometry& geometry, const DirectionMap& map, const std::stop_token& stop)
      : map_(map),
        tree_(map.cells),
        query_(geometry.scene(), stop),
        top_parts_(geometry),
        first_(first_contacts(map.cells)),
        regions_(std::size_t(first_.back())),
        clusters_(map.cells.size()),
        arcs_(arcs_a_cell * map.cells.size()),
        supports_(std::size_t(first_.back()), false),
        has_arc_(arcs_a_cell * map.cells.size(), false) {}

  MapTopology run() {
    std::vector<CellTree::CellSide> sides;
    for (int k = 0; k < int(map_.cells.size()); ++k) {
      for (int number = 0; number < 4; ++number) {
        CellTree::CellSide side;
        if (tree_.side(k, number, side)) sides.push_back(side);
      }
    }
    merges_.assign(map_.cells.size(), false);
    for (const CellTree::CellSide& side : sides) find_merges(side);
    for (const CellTree::CellSide& side : sides) join(side);
    join_facets();
    collect();
    return std::move(result_);
  }

 private:
  /// A cell's arc passes the part of its border between two directions.
  struct Crossing {
    int arc, cell;
    dvec3 from, to;
  };

  /// Contacts of all cells are numbered through.
  static std::vector<int> first_contacts(const std::vector<MapCell>& cells) {
    std::vector<int> first = {0};
    for (const MapCell& c : cells) {
      first.push_back(first.back() + std::max(1, int(c.contacts.size())));
    }
    return first;
  }

  const MapCell& cell(int k) const { return map_.cells[std::size_t(k)]; }
  /// Beside the contacts that are told apart others all but support.
  bool has_more(int k) const {
    const MapCell& c = cell(k);
    return (c.kind == MapCellKind::arc || c.kind == MapCellKind::in_line) &&
           c.contacts.size() > std::size_t(c.apart);
  }

  /// Of those one cannot tell from their border what is inside.
  bool is_open(int k) const {
    if (merges_[std::size_t(k)] || has_more(k)) return true;
    const MapCellKind kind = cell(k).kind;
    return kind != MapCellKind::region && kind != MapCellKind::arc && kind != MapCellKind::in_line;
  }

  /// The cell tells its contacts apart. (What hangs together around a facet are several.)
  bool is_known(int k) const {
    const MapCellKind kind = cell(k).kind;
    if (kind == MapCellKind::facet) return cell(k).contacts.size() > 1;
    return kind != MapCellKind::undecided && !has_more(k);
  }

  /// Two contacts that one cell tells apart are one to that beside it, within the resolution.
  void find_merges(const CellTree::CellSide& side) {
    for (const auto& [k, other] : {std::pair(side.finer, side.other), {side.other, side.finer}}) {
      if (cell(k).kind != MapCellKind::arc || cell(other).kind == MapCellKind::undecided) continue;
      if (winner(k, side.from) == winner(k, side.to)) continue;
      if (winner(other, side.from) != winner(other, side.to)) continue;
      if (cell(other).kind == MapCellKind::region || cell(other).kind == MapCellKind::arc) {
        merges_[std::size_t(other)] = true;
      }
    }
  }

  /// Number of the contact of a cell that supports in a direction on its border.
  int winner(int k, const dvec3& d) {
    const bool is_one = cell(k).contacts.size() < 2 || cell(k).kind == MapCellKind::region;
    return is_one ? first_[std::size_t(k)] : winner(k, d, point(d));
  }

  /// x supports in d. @pre the cell has contacts
  int winner(int k, const dvec3& d, const dvec3& x) const {
    return first_[std::size_t(k)] + int(cell(k).contact_of(d, x));
  }

  /// The point that supports in a direction, which is asked for from several cells.
  dvec3 point(const dvec3& d) {
    const dvec3 n = unit(d);
    const auto rounded = [](double x) { return std::llround(x * 1e12); };
    const auto [known, is_new] =
        points_.try_emplace({rounded(n.x), rounded(n.y), rounded(n.z)}, dvec3(0.0));
    if (is_new) {
      const Support s = query_(n, hint_);
      hint_ = s.contact;
      known->second = s.point;
    }
    return known->second;
  }

  void join(const CellTree::CellSide& side) {
    const int a = side.finer;
    const int b = side.other;
    const std::array<int, 2> own = {winner(a, side.from), winner(a, side.to)};
    const std::array<int, 2> others = {winner(b, side.from), winner(b, side.to)};
    for (const std::size_t end : {0u, 1u}) {
      if (is_known(a)) supports_[std::size_t(own[end])] = true;
      if (is_known(b)) supports_[std::size_t(others[end])] = true;
      if (is_known(a) && is_known(b)) regions_.unite(own[end], others[end]);
    }
    const std::vector<int> crossed = arcs_between(a, own);
    const std::vector<int> crossed_there = arcs_between(b, others);
    if (crossed.size() == 1) crossings_.push_back({crossed[0], a, side.from, side.to});
    if (crossed_there.size() == 1) crossings_.push_back({crossed_there[0], b, side.from, side.to});
    if (is_open(a) && is_open(b)) {
      clusters_.unite(a, b);
    } else if (is_open(a) || is_open(b)) {
      const bool a_is_open = is_open(a);
      const auto& [from, to] = a_is_open ? own : others;
      for (const int arc : a_is_open ? crossed_there : crossed) {
        has_arc_[std::size_t(arc)] = true;
        ends_.push_back({arc, a_is_open ? a : b, {std::min(from, to), std::max(from, to)}});
      }
    } else {
      for (std::size_t k = 0; k < std::min(crossed.size(), crossed_there.size()); ++k) {
        for (const int arc : {crossed[k], crossed_there[k]}) has_arc_[std::size_t(arc)] = true;
        arcs_.unite(crossed[k], crossed_there[k]);
      }
    }
    join_between(a, own, b);
    join_between(b, others, a);
  }

  /// The contacts between arcs that cross a side go on beyond it.
  void join_between(int k, const std::array<int, 2>& contacts, int beyond) {
    for (const int contact : contacts_between(k, contacts)) {
      supports_[std::size_t(contact)] = true;
      const int there = is_known(beyond) ? contact_like(k, contact, beyond) : -1;
      if (there >= 0) regions_.unite(contact, there);
    }
  }

  /// Number of the only contact of a cell that may be one of another cell, -1 if there is none.
  int contact_like(int k, int contact, int other) const {
    const Box& own = cell(k).contacts[std::size_t(contact - first_[std::size_t(k)])];
    int found = -1;
    const std::vector<Box>& contacts = cell(other).contacts;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      const dvec3 gap = box_gaps(contacts[c], own);
      if (std::max({gap.x, gap.y, gap.z}) > map_.resolution) continue;
      if (found >= 0) return -1;
      found = first_[std::size_t(other)] + int(c);
    }
    return found;
  }

  /// A cell has one arc, or several in line. Those on the way from one of its contacts to another.
  std::vector<int> arcs_between(int k, const std::array<int, 2>& contacts) const {
    if (contacts[0] == contacts[1]) return {};
    if (cell(k).kind != MapCellKind::in_line) return {arcs_a_cell * k};
    const int from = contacts[0] - first_[std::size_t(k)];
    const int to = contacts[1] - first_[std::size_t(k)];
    std::vector<int> arcs;
    for (int arc = std::min(from, to); arc < std::max(from, to); ++arc) {
      arcs.push_back(arcs_a_cell * k + arc);
    }
    if (from > to) std::reverse(arcs.begin(), arcs.end());
    return arcs;
  }

  /// Contacts of a cell that are in line between two of its contacts.
  std::vector<int> contacts_between(int k, const std::array<int, 2>& contacts) const {
    std::vector<int> between;
    if (cell(k).kind != MapCellKind::in_line) return between;
    const auto [from, to] = std::minmax(contacts[0], contacts[1]);
    for (int contact = from + 1; contact < to; ++contact) between.push_back(contact);
    if (contacts[0] > contacts[1]) std::reverse(between.begin(), between.end());
    return between;
  }

  /// More than three contacts touch the plane.
  bool is_of_facet(int k) const {
    return cell(k).kind == MapCellKind::facet ||
           (cell(k).kind == MapCellKind::node &&
            cell(k).contacts.size() > std::size_t(cell(k).apart));
  }

  /// Cells of one facet may touch in a corner only, or have others between them. Three of its
  /// contacts may make a node beside it, or be told apart from the others, which all but support.
  void join_facets() {
    std::vector<int> facets, others;
    for (int k = 0; k < int(map_.cells.size()); ++k) {
      if (is_of_facet(k)) facets.push_back(k);
      if (cell(k).kind == MapCellKind::facet || cell(k).kind == MapCellKind::node) {
        others.push_back(k);
      }
    }
    for (const int facet : facets) {
      for (const int other : others) {
        if (cell(facet).shares_plane(cell(other), map_.resolution)) clusters_.unite(facet, other);
      }
    }
  }

  void collect() {
    pass_through_clusters();
    std::map<int, int> nodes, arcs;
    const auto number = [](std::map<int, int> & numbers, int key, auto& list) -> auto& {
      const auto [found, is_new] = numbers.try_emplace(key, int(list.size()));
      if (is_new) list.emplace_back();
      return list[std::size_t(found->second)];
    };
    for (int k = 0; k < int(map_.cells.size()); ++k) {
      if (is_open(k)) {
        MapNode& node = number(nodes, clusters_.find(k), result_.nodes);
        node.cells.push_back(k);
        node.is_facet = node.is_facet || is_of_facet(k);
      }
      for (int arc = arcs_a_cell * k; arc < arcs_a_cell * (k + 1); ++arc) {
        if (!has_arc_[std::size_t(arc)]) continue;
        number(arcs, arcs_.find(arc), result_.arcs).cells.push_back(k);
      }
    }
    for (const End& end : ends_) {
      if (end.passes) continue;
      const int node = nodes.at(clusters_.find(end.at));
      result_.arcs[std::size_t(arcs.at(arcs_.find(end.arc)))].nodes.push_back(node);
      ++result_.nodes[std::size_t(node)].arcs;
    }
    drop_shallow_arcs(arcs);
    drop_arcs_within_facets();
    std::set<int> regions;
    for (int k = 0; k < first_.back(); ++k) {
      if (supports_[std::size_t(k)]) regions.insert(regions_.find(k));
    }
    result_.regions = int(regions.size());
  }

  /// Arcs between cells of one facet that are no longer than these.
  void drop_arcs_within_facets() {
    std::erase_if(result_.arcs, [&](const MapArc& arc) {
      if (arc.nodes.size() != 2 || arc.nodes[0] != arc.nodes[1]) return false;
      MapNode& node = result_.nodes[std::size_t(arc.nodes[0])];
      if (!node.is_facet) return false;
      double reach = 0;
      for (const int k : node.cells) reach = std::max(reach, std::ldexp(2.0, 1 - cell(k).level));
      const bool within = std::all_of(arc.cells.begin(), arc.cells.end(), [&](int k) {
        const auto d = DirectionMap::corners(cell(k));
        return std::any_of(node.cells.begin(), node.cells.end(), [&](int own) {
          return glm::distance(cell(own).normal, unit(d[0] + d[3])) <= reach;
        });
      });
      if (within) node.arcs -= 2;
      return within;
    });
  }

  /// Beside where an arc ends for want of resolution cells may tell contacts apart that are one
  /// within it: pieces of arcs between such ends are none if nowhere more than the resolution is
  /// between their contacts. `numbers`: of arcs in the result.
  void drop_shallow_arcs(const std::map<int, int>& numbers) {
    std::vector<std::vector<const Crossing*>> crossings(result_.arcs.size());
    for (const Crossing& c : crossings_) {
      const auto number = numbers.find(arcs_.find(c.arc));
      if (number != numbers.end()) crossings[std::size_t(number->second)].push_back(&c);
    }
    std::vector<MapArc> left;
    for (std::size_t k = 0; k < crossings.size(); ++k) {
      const MapArc& arc = result_.arcs[k];
      if (!ends_freely(arc) || !is_shallow(crossings[k])) {
        left.push_back(arc);
        continue;
      }
      for (const int node : arc.nodes) --result_.nodes[std::size_t(node)].arcs;
    }
    result_.arcs.swap(left);
  }

  /// In cells in which two contacts are one.
  bool ends_freely(const MapArc& arc) const {
    return !arc.nodes.empty() && std::all_of(arc.nodes.begin(), arc.nodes.end(), [&](int node) {
      const std::vector<int>& cells = result_.nodes[std::size_t(node)].cells;
      return std::all_of(cells.begin(), cells.end(), [&](int k) {
        return cell(k).kind == MapCellKind::region || cell(k).kind == MapCellKind::arc;
      });
    });
  }

  bool is_shallow(const std::vector<const Crossing*>& crossings) {
    if (crossings.empty()) return false;
    // In the middle an arc is deepest, mostly.
    const auto middle = crossings.begin() + std::ptrdiff_t(crossings.size() / 2);
    return is_shallow(**middle) && std::all_of(crossings.begin(), crossings.end(),
                                               [&](const Crossing* c) { return is_shallow(*c); });
  }

  /// Both contacts are in one piece of what is within the resolution of the plane.
  bool is_shallow(const Crossing& crossing) {
    std::array<dvec3, 2> d = {unit(crossing.from), unit(crossing.to)};
    std::array<Contact, 2> contacts = {query_(d[0], hint_).contact, query_(d[1], hint_).contact};
    const int first = winner(crossing.cell, crossing.from);
    for (int k = 0; k < std::numeric_limits<double>::digits; ++k) {
      const dvec3 middle = unit(d[0] + d[1]);
      const Support there = query_(middle, hint_);
      const std::size_t side = winner(crossing.cell, middle, there.point) == first ? 0 : 1;
      d[side] = middle;
      contacts[side] = there.contact;
    }
    return top_parts_.hang_together(d[0], contacts[0], contacts[1], map_.resolution);
  }

  /// Open cells without a facet in which arcs do not end: two between the same contacts are one
  /// that passes. (Of three contacts whose support functions have independent gradients, each two
  /// exchange along one curve, and these meet in three or pass each other.)
  void pass_through_clusters() {
    std::map<int, std::vector<End*>> ends_at;
    for (End& end : ends_) ends_at[clusters_.find(end.at)].push_back(&end);
    for (int k = 0; k < int(map_.cells.size()); ++k) {
      if (is_open(k) && cell(k).kind == MapCellKind::facet) ends_at[clusters_.find(k)].clear();
    }
    for (auto& [cluster, ends] : ends_at) {
      std::sort(ends.begin(), ends.end(),
                [](const End* a, const End* b) { return a->contacts < b->contacts; });
      bool in_pairs = ends.size() % 2 == 0;
      for (std::size_t k = 0; k + 1 < ends.size() && ends.size() > 2; k += 2) {
        in_pairs = in_pairs && ends[k]->contacts == ends[k + 1]->contacts;
      }
      if (!in_pairs) continue;
      for (std::size_t k = 0; k + 1 < ends.size(); k += 2) {
        ends[k]->passes = ends[k + 1]->passes = true;
        arcs_.unite(ends[k]->arc, ends[k + 1]->arc);
      }
    }
  }

  /// A cell's arc, and the open one beside it, with the numbers of the latter's contacts.
  struct End {
    int arc, at;
    std::pair<int, int> contacts;
    bool passes = false;
  };

  const DirectionMap& map_;
  CellTree tree_;
  SupportQuery query_;
  TopParts top_parts_;
  std::vector<int> first_;  // contact of each cell
  DisjointSets regions_, clusters_, arcs_;
  std::vector<bool> supports_;  // by contact
  std::vector<bool> has_arc_;   // by arc
  std::vector<bool> merges_;    // by cell: where an arc ends for want of resolution
  std::vector<Crossing> crossings_;
  std::vector<End> ends_;
  std::map<std::array<long long, 3>, dvec3> points_;
  Contact hint_;
  MapTopology result_;
};

}  // namespace

MapTopology map_topology(const ContactGeometry& geometry, const DirectionMap& map,
                         const std::stop_token& stop) {
  return Assembly(geometry, map, stop).run();
}

}  // namespace taut
