#include "taut/hull/decide/direction_map.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "taut/core/parallel.h"
#include "taut/core/pool.h"
#include "taut/hull/decide/cell_decider.h"
#include "taut/hull/decide/cell_tree.h"
#include "taut/hull/decide/needle.h"

namespace taut {
namespace {

/// Cells that are decided at once, on several threads.
constexpr std::size_t batch_limit = 256;
/// Of the limits the part that may be added to part nodes from each other.
constexpr long share_of_nodes = 8;
/// Coordinates of directions of a face of the cube whose support points the first cells have for
/// beacons.
constexpr double first_beacons[] = {-0.9, -0.3, 0.3, 0.9};

/// Rounds in which half of what is left of a map's share is done: how many there will be is not
/// known, and most maps are decided in twice to thrice as many.
constexpr double half_rounds = 5;
/// Share of what comes before the first of them.
constexpr double pieces_share = 0.05;

/// The share that is done of a map's rounds, in each of which all cells that wait are looked at.
class RoundShare {
 public:
  /// A round begins, in which so many pieces of the model are looked at.
  void begin(double pieces) {
    if (pieces_ > 0) ++rounds_;
    pieces_ = pieces;
    done_ = 0;
  }
  void add(double pieces) { done_ += pieces; }
  /// With so many pieces more than those added.
  double now(double more) const {
    const double rounds = rounds_ + (pieces_ > 0 ? std::min((done_ + more) / pieces_, 1.0) : 0);
    return 1 - std::exp2(-rounds / half_rounds);
  }

 private:
  double rounds_ = 0;
  double pieces_ = 0;  // of the round at hand
  double done_ = 0;
};

/// Decides cells level by level, so that what costs too much to be decided takes nothing from the
/// rest.
class MapMaker {
 public:
  MapMaker(const ContactGeometry& geometry, const DirectionMapOptions& options)
      : options_(options),
        pieces_(geometry, options.resolution,
                [this](double share) { report(pieces_share * share); }),
        deciders_([this] { return std::make_unique<CellDecider>(pieces_, options_); }) {}

  DirectionMap run() {
    const auto needle = needle_halves(pieces_.control_points(), options_.resolution);
    if (needle) {
      add_needle(*needle);
    } else {
      split_cube();
    }
    decide_waiting();
    // Nodes are parted even where others have taken all there was.
    options_.cell_limit += options_.cell_limit / share_of_nodes;
    options_.candidate_limit += options_.candidate_limit / share_of_nodes;
    while (!is_spent() && split_nodes_beside_others()) decide_waiting();
    std::sort(map_.cells.begin(), map_.cells.end(), comes_before);
    map_.resolution = options_.resolution;
    map_.bent = pieces_.bent_above();
    map_.covered = pieces_.covered_patches();
    map_.covered_edges = pieces_.covered_edges();
    return std::move(map_);
  }

 private:
  /// What a node's cell is split with.
  struct Node {
    std::vector<const MapPiece*> pieces;
    std::vector<dvec3> beacons;
  };

  void split_cube() {
    std::vector<const MapPiece*> all;
    for (const MapElement& e : pieces_.elements()) {
      if (!e.likeness.covered) all.push_back(e.root);
    }
    const auto whole = std::make_shared<const std::vector<const MapPiece*>>(std::move(all));
    SupportQuery query(pieces_.geometry().scene(), options_.stop);
    for (int face = 0; face < 6; ++face) {
      MapCell root;
      root.face = face;
      std::vector<dvec3> beacons;
      for (const double s : first_beacons) {
        for (const double t : first_beacons) {
          beacons.push_back(query(unit(DirectionMap::direction(face, s, t))).point);
        }
      }
      waiting_.push_back({std::move(root), whole, std::move(beacons), {}});
    }
    map_.statistics.queries += query.queries();
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
      if (left_in_round_ == 0) begin_round();
      std::vector<OpenCell> batch = next_batch();
      left_in_round_ -= batch.size();
      std::vector<LookedAtCell> looked_at(batch.size());
      if (!is_spent()) look_at(batch, looked_at);
      for (std::size_t k = 0; k < batch.size(); ++k) {
        if (is_spent()) {
          add(std::move(batch[k].cell));  // undecided, as there is no time for it
        } else {
          take(std::move(looked_at[k]));
        }
      }
    }
  }

  void begin_round() {
    left_in_round_ = waiting_.size();
    double pieces = 0;
    for (const OpenCell& open : waiting_) pieces += work_of(open);
    share_.begin(pieces);
  }

  /// What it takes to look at a cell, about.
  static double work_of(const OpenCell& open) { return 1 + double(open.pieces->size()); }

  void look_at(const std::vector<OpenCell>& batch, std::vector<LookedAtCell>& looked_at) {
    double work = 0;
    for (const OpenCell& open : batch) work += work_of(open);
    parallel_for(
        batch.size(), 1, options_.threads,
        [&](std::size_t begin, std::size_t end) {
          const auto decider = deciders_.lease();
          for (std::size_t k = begin; k < end; ++k) looked_at[k] = (*decider).decide(batch[k]);
        },
        [&](std::size_t done) {
          const double now = share_.now(work * double(done) / double(batch.size()));
          report(pieces_share + (1 - pieces_share) * now);
        });
    share_.add(work);
  }

  void report(double share) const {
    if (options_.report) options_.report(share);
  }

  /// Of the round at hand. What is looked at beyond a limit is forgotten, so that it does not
  /// matter how many these are.
  std::vector<OpenCell> next_batch() {
    const auto count = std::min(left_in_round_, options_.threads == 1 ? 1 : batch_limit);
    const auto end = waiting_.begin() + std::ptrdiff_t(count);
    std::vector<OpenCell> batch(std::make_move_iterator(waiting_.begin()),
                                std::make_move_iterator(end));
    waiting_.erase(waiting_.begin(), end);
    return batch;
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
      options_.stop.check();
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

  void split(const MapCell& cell, std::vector<const MapPiece*> pieces,
             const std::vector<dvec3>& beacons, const Contact& hint) {
    const auto shared = std::make_shared<const std::vector<const MapPiece*>>(std::move(pieces));
    for (std::uint32_t k = 0; k < 4; ++k) {
      MapCell quarter;
      quarter.face = cell.face;
      quarter.level = cell.level + 1;
      quarter.i = 2 * cell.i + k / 2;
      quarter.j = 2 * cell.j + k % 2;
      waiting_.push_back({std::move(quarter), shared, beacons, hint});
    }
  }

  DirectionMapOptions options_;
  const MapPieces pieces_;
  Pool<CellDecider> deciders_;
  DirectionMap map_;
  std::map<int, Node> nodes_;  // by cell
  std::deque<OpenCell> waiting_;
  std::size_t left_in_round_ = 0;  // of those that wait
  RoundShare share_;
};

}  // namespace

DirectionMap direction_map(const ContactGeometry& geometry, const DirectionMapOptions& options) {
  return MapMaker(geometry, options).run();
}

}  // namespace taut
