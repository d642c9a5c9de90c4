#include "taut/hull/decide/direction_map.h"

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "taut/hull/decide/cell_decider.h"
#include "taut/hull/decide/cell_tree.h"
#include "taut/hull/decide/needle.h"

namespace taut {
namespace {

/// Decides cells level by level, so that what costs too much to be decided takes nothing from the
/// rest.
class MapMaker {
 public:
  MapMaker(const ContactGeometry& geometry, const DirectionMapOptions& options)
      : pieces_(geometry, options.resolution), options_(options), decider_(pieces_, options) {}

  DirectionMap run() {
    const auto needle = needle_halves(pieces_.control_points(), options_.resolution);
    if (needle) {
      add_needle(*needle);
    } else {
      split_cube();
    }
    do {
      decide_waiting();
    } while (!is_spent() && split_nodes_beside_others());
    std::sort(map_.cells.begin(), map_.cells.end(), comes_before);
    map_.resolution = options_.resolution;
    return std::move(map_);
  }

 private:
  /// What a node's cell is split with.
  struct Node {
    std::vector<int> pieces;
    std::vector<CellBeacon> beacons;
  };

  void split_cube() {
    std::vector<int> all;
    for (const MapElement& e : pieces_.elements()) {
      if (!e.likeness.covered) all.push_back(e.root);
    }
    const auto whole = std::make_shared<const std::vector<int>>(std::move(all));
    for (int face = 0; face < 6; ++face) {
      MapCell root;
      root.face = face;
      waiting_.push_back({std::move(root), whole, {}, {}});
    }
  }

  /// To within the resolution the ends of a needle are all that touches, and they exchange where
  /// the segment is in the plane. What is left of slopes and curvatures across it tells nothing.
  void add_needle(const std::array<Box, 2>& halves) {
    SupportQuery query(pieces_.geometry().scene(), options_.stop);
    for (int face = 0; face < 6; ++face) {
      MapCell cell;
      cell.face = face;
      cell.kind = MapCellKind::arc;
      cell.contacts.assign(halves.begin(), halves.end());
      cell.apart = 2;
      const std::array<dvec3, 4> d = DirectionMap::corners(cell);
      cell.contact = query(unit(d[0] + d[3])).contact;
      ++map_.statistics.cells;
      add(std::move(cell));
    }
    map_.statistics.queries += query.queries();
  }

  /// By face, and along a Z-shaped curve: where two cells part first, at the coarsest.
  static bool comes_before(const MapCell& a, const MapCell& b) {
    if (a.face != b.face) return a.face < b.face;
    const int level = std::min(a.level, b.level);
    const std::uint32_t ai = a.i >> (a.level - level);
    const std::uint32_t bi = b.i >> (b.level - level);
    const std::uint32_t aj = a.j >> (a.level - level);
    const std::uint32_t bj = b.j >> (b.level - level);
    const std::uint32_t off_i = ai ^ bi;
    const std::uint32_t off_j = aj ^ bj;
    // The highest bit in which they differ decides; of equal ones that of i.
    return off_i >= off_j || (off_i ^ off_j) < off_i ? ai < bi : aj < bj;
  }

  bool is_spent() const {
    return map_.statistics.cells >= options_.cell_limit ||
           map_.statistics.candidates >= options_.candidate_limit;
  }

  void decide_waiting() {
    while (!waiting_.empty()) {
      OpenCell next = std::move(waiting_.front());
      waiting_.pop_front();
      if (is_spent()) {
        add(std::move(next.cell));  // undecided, as there is no time for it
      } else {
        take(decider_.decide(next));
      }
    }
  }

  void take(LookedAtCell&& looked_at) {
    ++map_.statistics.cells;
    map_.statistics.candidates += looked_at.candidates;
    map_.statistics.queries += looked_at.queries;
    MapCell& cell = looked_at.cell;
    if (looked_at.splits) {
      return split(cell, std::move(looked_at.pieces), looked_at.beacons, cell.contact);
    }
    map_.statistics.deepest = std::max(map_.statistics.deepest, cell.level);
    if (cell.has_plane()) {
      nodes_.emplace(int(map_.cells.size()),
                     Node{std::move(looked_at.pieces), std::move(looked_at.beacons)});
    }
    add(std::move(cell));
  }

  void add(MapCell&& cell) {
    ++map_.statistics.of_kind[std::size_t(cell.kind)];
    map_.cells.push_back(std::move(cell));
  }

  /// Two cells side by side with a node each, or what may be one: what is between is not told yet.
  /// Splits both, but for cells of one facet.
  bool split_nodes_beside_others() {
    std::vector<bool> splits(map_.cells.size(), false);
    bool any = false;
    const CellTree tree(map_.cells);
    for (const auto& [k, node] : nodes_) {
      for (int number = 0; number < 4; ++number) {
        CellTree::CellSide side;
        if (!tree.side(k, number, side)) continue;
        const auto other = nodes_.find(side.other);
        if (other == nodes_.end()) continue;
        const MapCell& own = map_.cells[std::size_t(k)];
        const MapCell& beyond = map_.cells[std::size_t(side.other)];
        if (own.shares_plane(beyond, options_.resolution)) continue;
        for (const int cell : {k, side.other}) {
          if (map_.cells[std::size_t(cell)].level == options_.level_limit) continue;
          splits[std::size_t(cell)] = any = true;
        }
      }
    }
    if (!any) return false;
    std::vector<MapCell> before;
    before.swap(map_.cells);
    std::map<int, Node> nodes;
    nodes.swap(nodes_);
    for (std::size_t k = 0; k < before.size(); ++k) {
      const auto node = nodes.find(int(k));
      if (splits[k]) {
        --map_.statistics.of_kind[std::size_t(before[k].kind)];
        split(before[k], std::move(node->second.pieces), node->second.beacons, {});
        continue;
      }
      if (node != nodes.end()) nodes_.emplace(int(map_.cells.size()), std::move(node->second));
      map_.cells.push_back(std::move(before[k]));
    }
    return true;
  }

  void split(const MapCell& cell, std::vector<int> pieces, const std::vector<CellBeacon>& beacons,
             const Contact& hint) {
    const auto shared = std::make_shared<const std::vector<int>>(std::move(pieces));
    for (std::uint32_t k = 0; k < 4; ++k) {
      MapCell quarter;
      quarter.face = cell.face;
      quarter.level = cell.level + 1;
      quarter.i = 2 * cell.i + k / 2;
      quarter.j = 2 * cell.j + k % 2;
      waiting_.push_back({std::move(quarter), shared, beacons, hint});
    }
  }

  MapPieces pieces_;
  DirectionMapOptions options_;
  CellDecider decider_;
  DirectionMap map_;
  std::map<int, Node> nodes_;  // by cell
  std::deque<OpenCell> waiting_;
};

}  // namespace

DirectionMap direction_map(const ContactGeometry& geometry, const DirectionMapOptions& options) {
  return MapMaker(geometry, options).run();
}

}  // namespace taut
