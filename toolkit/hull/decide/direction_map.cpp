#include "taut/hull/decide/direction_map.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "taut/bounds/contact_climb.h"
#include "taut/bounds/scene_content.h"
#include "taut/bounds/support_query.h"
#include "taut/core/disjoint_sets.h"
#include "taut/core/tolerances.h"
#include "taut/hull/decide/branch_differences.h"
#include "taut/hull/decide/branch_domination.h"
#include "taut/hull/decide/branch_order.h"
#include "taut/hull/decide/branches.h"
#include "taut/hull/decide/cell_border.h"
#include "taut/hull/decide/cell_tree.h"
#include "taut/hull/decide/contact_index.h"
#include "taut/hull/decide/near_concavity.h"
#include "taut/hull/decide/ridge_contacts.h"

namespace taut {
namespace {

/// Support points of cells above that are compared with.
constexpr std::size_t beacon_limit = 20;
/// Branches of which each adds a point.
constexpr std::size_t branch_beacons = 4;
/// Rounds of splitting pieces in a cell before it is split.
constexpr int refinement_limit = 12;
/// Pieces of a cell up to which those that bend both ways are split.
constexpr std::size_t sharpened_limit = 48;
/// What is below the convex hull of the rest by this share of the resolution is left out then.
constexpr double sharp_share = 0.5;
/// Pieces of a cell beyond which it is split rather than looked at.
constexpr std::size_t looked_at_limit = 200;
/// Contacts in line, at most.
constexpr std::size_t line_limit = 8;
/// Rounds of Newton's kind for the plane of a node: contacts of a plane, and the plane of these.
constexpr int plane_rounds = 4;
/// In units of the resolution over the width of facets: how far their normals may part.
constexpr double facet_slack = 4;
/// In units of the resolution: three points span a plane if the planes across directions of a cell
/// part by more over the least of their distances from a line. What is thinner is near them all
/// across it.
constexpr double least_span = 4;

/// In units of the resolution: how far planes across directions of a cell part over a flat spot
/// that is waited for to become none.
constexpr double spot = 64;

/// How near a facet's normal is to the middle of its cells, in their half widths: cells beside one
/// that holds it would have to be split for ever.
constexpr double facet_reach = 1.5;

/// Turns the cube's faces out of all that models are aligned with.
const dmat3& cube_frame() {
  static const dmat3 frame = [] {
    const dvec3 a = unit(dvec3(0.8147236863931789, 0.4057919370756193, 0.3269868162937285));
    const auto [b, c] = tangent_frame(a);
    const double turn = 0.7345102;
    return dmat3(std::cos(turn) * b + std::sin(turn) * c, std::cos(turn) * c - std::sin(turn) * b,
                 a);
  }();
  return frame;
}

/// Of a face of the cube: its middle, and the axes of its cells.
struct FaceAxes {
  dvec3 own, first, second;
};

FaceAxes face_axes(int face) {
  const int own = face / 2;
  const dmat3& e = cube_frame();
  return {face % 2 == 0 ? e[own] : -e[own], e[(own + 1) % 3], e[(own + 2) % 3]};
}

/// Decides cells level by level, so that what costs too much to be decided takes nothing from the
/// rest.
class Decider {
 public:
  Decider(const ContactGeometry& geometry, const DirectionMapOptions& options)
      : pieces_(geometry, options.resolution),
        query_(geometry.scene(), options.stop),
        options_(options),
        view_(pieces_, noise_units * geometry.scene().content().rounding),
        domination_(pieces_.budget_left() * options.resolution),
        index_(pieces_, options.resolution),
        concavity_(pieces_, options.resolution),
        ridge_(pieces_),
        differences_(pieces_, view_, branches_, cover_share * options.resolution),
        border_(view_, branches_, query_) {}

  DirectionMap run() {
    std::vector<int> all;
    for (const MapElement& e : pieces_.elements()) {
      if (!e.likeness.covered) all.push_back(e.root);
    }
    if (!is_needle()) split_cube(std::move(all));
    do {
      decide_waiting();
    } while (!is_spent() && split_nodes_beside_others());
    std::sort(map_.cells.begin(), map_.cells.end(), comes_before);
    map_.resolution = options_.resolution;
    map_.statistics.queries = query_.queries();
    map_.statistics.candidates = view_.looked();
    return std::move(map_);
  }

 private:
  void split_cube(std::vector<int> pieces) {
    const auto whole = std::make_shared<const std::vector<int>>(std::move(pieces));
    for (int face = 0; face < 6; ++face) {
      MapCell root;
      root.face = face;
      waiting_.push_back({std::move(root), whole, {}, {}});
    }
  }

  /// The model is within half of the resolution of a straight segment: to within it, the ends are
  /// all that touches, and they exchange where the segment is in the plane. What is left of slopes
  /// and curvatures across it tells nothing.
  bool is_needle() {
    points_ = pieces_.control_points();
    if (points_.empty()) return false;
    const dvec3 first = points_.front();
    const dvec3 a = farthest([&](const dvec3& x) { return glm::distance(x, first); });
    const dvec3 b = farthest([&](const dvec3& x) { return glm::distance(x, a); });
    if (!(glm::distance(a, b) > options_.resolution)) return false;  // it is a point
    const dvec3 along = unit(b - a);
    std::array<Box, 2> halves;
    for (const dvec3& x : points_) {
      if (!(glm::length(glm::cross(x - a, along)) <= 0.5 * options_.resolution)) return false;
      halves[glm::distance(x, a) < glm::distance(x, b) ? 0 : 1].include(x);
    }
    for (int face = 0; face < 6; ++face) {
      MapCell cell;
      cell.face = face;
      cell.kind = MapCellKind::arc;
      cell.contacts.assign(halves.begin(), halves.end());
      cell.apart = 2;
      const std::array<dvec3, 4> d = DirectionMap::corners(cell);
      cell.contact = query_(unit(d[0] + d[3])).contact;
      ++map_.statistics.cells;
      ++map_.statistics.of_kind[std::size_t(cell.kind)];
      map_.cells.push_back(std::move(cell));
    }
    return true;
  }

  /// Heights are differences of two support values, and of sums of some coefficients.
  static constexpr double noise_units = 4;

  /// A cell that is to be decided, with what is known of it.
  struct Waiting {
    MapCell cell;
    std::shared_ptr<const std::vector<int>> pieces;
    std::vector<dvec3> beacons;
    Contact hint;
  };

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
           view_.looked() >= options_.candidate_limit;
  }

  void decide_waiting() {
    while (!waiting_.empty()) {
      Waiting next = std::move(waiting_.front());
      waiting_.pop_front();
      axes_ = face_axes(next.cell.face);
      decide(std::move(next));
    }
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

  void split(const MapCell& cell, std::vector<int> pieces, const std::vector<dvec3>& beacons,
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

  std::vector<int> pieces_left() const {
    std::vector<int> left;
    for (const SeenPiece& s : view_.seen()) left.push_back(s.piece);
    return left;
  }

  void decide(Waiting&& waiting) {
    check_stop(options_.stop);
    auto& [cell, pieces, beacons, hint] = waiting;
    if (is_spent()) return leave(std::move(cell));
    ++map_.statistics.cells;
    const std::array<dvec3, 4> d = DirectionMap::corners(cell);
    const Support support = query_(unit(d[0] + d[3]), hint);
    cell.contact = support.contact;
    beacons.push_back(support.point);
    while (beacons.size() > beacon_limit) beacons.erase(beacons.begin());
    view_.turn_to(d, support.point, beacons);
    differences_.turn_to(axes_.first, axes_.second);
    drop_low(beacons);
    for (const int piece : *pieces) view_.look(piece);
    view_.finish();
    std::optional<MapCellKind> kind = decided(true);
    // Of three contacts one may not reach the others, and of more the border is to tell: finer
    // pieces tell more.
    const auto is_open_row = [&] { return kind == MapCellKind::in_line && line_.empty(); };
    const auto is_settled = [&] { return kind && *kind != MapCellKind::node && !is_open_row(); };
    for (int round = 0; round < refinement_limit && !is_settled() && view_.refine(); ++round) {
      kind = decided(false);
    }
    if (!kind) kind = decided_last();
    std::vector<int> left = pieces_left();
    if (!kind) kind = decided_sharply(cell.level);
    if (is_open_row() && !is_spot() && is_facet()) kind = MapCellKind::facet;
    if (kind == MapCellKind::node || is_open_row()) kind = kind_by_border(support.contact);
    if (!kind && cell.level >= options_.level_limit) kind = MapCellKind::undecided;
    if (kind) return finish(cell, *kind, beacons);
    add_branch_points(beacons);
    // Of pieces that were split in vain there would be ever more.
    std::vector<int> sharp = pieces_left();
    split(cell, std::move(sharp.size() <= left.size() ? sharp : left), beacons, support.contact);
  }

  /// Points that are nowhere the highest in a cell are so nowhere in its quarters.
  void drop_low(std::vector<dvec3>& beacons) const {
    std::vector<dvec3> left;
    for (std::size_t k = 0; k < beacons.size(); ++k) {
      if (view_.is_highest(k)) left.push_back(beacons[k]);
    }
    beacons.swap(left);
  }

  /// What surpasses the rest of a branch, or of others, though it may not support itself.
  void add_branch_points(std::vector<dvec3>& beacons) {
    if (branches_.all().size() > branch_beacons) return;
    branch_points_.find(view_, branches_);
    for (std::size_t b = 0; b < branches_.all().size(); ++b) {
      const auto& points = branch_points_.points(b);
      beacons.insert(beacons.end(), points.begin(), points.end());
    }
  }

  /// As there is no time for it.
  void leave(MapCell&& cell) {
    ++map_.statistics.of_kind[std::size_t(MapCellKind::undecided)];
    map_.cells.push_back(std::move(cell));
  }

  void finish(MapCell& cell, MapCellKind kind, const std::vector<dvec3>& beacons) {
    cell.kind = kind;
    if (kind == MapCellKind::facet) {
      cell.normal = facet_normal_;
      cell.width = facet_width_;
    }
    if (kind == MapCellKind::node) find_plane(cell);
    for (const Branch& b : branches_.all()) cell.contacts.push_back({b.lower, b.upper});
    cell.apart = int(cell.contacts.size());
    cell.contacts.insert(cell.contacts.end(), dominated_.begin(), dominated_.end());
    if (kind != MapCellKind::region && kind != MapCellKind::undecided) {
      cell.translates = differences_.translates();
      cell.rounds = differences_.rounds();
    }
    if (kind == MapCellKind::in_line) put_in_line(cell);
    if (kind == MapCellKind::facet || kind == MapCellKind::node) {
      nodes_.emplace(int(map_.cells.size()), Node{pieces_left(), beacons});
    }
    ++map_.statistics.of_kind[std::size_t(kind)];
    map_.statistics.deepest = std::max(map_.statistics.deepest, cell.level);
    map_.cells.push_back(std::move(cell));
  }

  void put_in_line(MapCell& cell) const {
    const std::vector<Box> contacts = cell.contacts;
    const std::vector<MapCell::Round> rounds = cell.rounds;
    for (std::size_t k = 0; k < line_.size(); ++k) {
      const auto from = std::size_t(line_[k]);
      cell.contacts[k] = contacts[from];
      if (!rounds.empty()) cell.rounds[k] = rounds[from];
    }
    cell.translates.clear();  // rounds, and boxes that part, tell more
  }

  std::optional<MapCellKind> decided(bool before_splits) {
    dominated_.clear();
    if (view_.seen().size() > looked_at_limit) {
      branches_.clear();
      return is_facet() ? std::optional(MapCellKind::facet) : std::nullopt;
    }
    branches_.find(view_);
    // Something supports: what is taken for granted of the model does not hold.
    if (branches_.all().empty()) return MapCellKind::undecided;
    if (const auto kind = kind_of_branches(false)) return kind;
    // All that is near all the planes hangs together.
    const std::vector<Branch>& all = branches_.all();
    if (is_flat()) return hang_together(all) ? MapCellKind::region : MapCellKind::flat;
    return before_splits && !is_spot() && is_facet() ? std::optional(MapCellKind::facet)
                                                     : std::nullopt;
  }

  /// What takes longer, for pieces that are as fine as they become.
  std::optional<MapCellKind> decided_last() {
    if (view_.seen().size() > looked_at_limit) return std::nullopt;
    if (!is_spot() && is_facet()) return MapCellKind::facet;
    if (const auto kind = kind_of_branches(true)) return kind;
    return kind_without_dominated();
  }

  /// From what supports in the cell, or all but: pieces are split where they bend both ways, the
  /// more often the smaller the cell has had to become.
  std::optional<MapCellKind> decided_sharply(int level) {
    for (int round = 1; round < level / 2; ++round) {
      if (view_.seen().size() > sharpened_limit) return std::nullopt;
      if (!view_.sharpen(sharp_share * options_.resolution)) return std::nullopt;
      branches_.find(view_);
      if (const auto kind = kind_of_branches(true)) return kind;
    }
    return std::nullopt;
  }

  /// Without the branches that others stand for to within what is left of the resolution. (The only
  /// one that is left would have to be told from these.)
  std::optional<MapCellKind> kind_without_dominated() {
    const std::vector<Branch> all = branches_.all();
    if (all.size() < 3) return std::nullopt;
    branch_points_.find(view_, branches_);
    const std::vector<bool> left = domination_.left(view_, branch_points_, branches_);
    const auto count = std::count(left.begin(), left.end(), true);
    if (count < 2 || count == std::ptrdiff_t(all.size())) return std::nullopt;
    branches_.keep(left);
    const std::optional<MapCellKind> kind = kind_of_branches(true);
    for (std::size_t b = 0; b < all.size() && kind; ++b) {
      if (!left[b]) dominated_.push_back({all[b].lower, all[b].upper});
    }
    return kind;
  }

  std::optional<MapCellKind> kind_of_branches(bool extends) {
    const std::vector<Branch>& all = branches_.all();
    const std::optional<MapCellKind> kind = kind_of_contacts(all);
    if (!kind) return std::nullopt;
    for (const Branch& branch : all) {
      if (!differences_.is_round(branch) && !index_.is_one(view_, branches_, branch) &&
          !concavity_.is_one(view_, branches_, branch) &&
          !(extends && index_.is_one_of_more(view_, branches_, branch)) &&
          !(extends && index_.is_one_of_pieces(view_, branches_, branch)) &&
          !(extends && ridge_.are_one(view_, branches_, branch))) {
        return std::nullopt;
      }
    }
    return kind;
  }

  /// If each branch has one contact.
  std::optional<MapCellKind> kind_of_contacts(const std::vector<Branch>& all) {
    if (all.size() == 1) return MapCellKind::region;
    if (all.empty() || all.size() > line_limit) return std::nullopt;
    line_.clear();
    const bool part = boxes_part(all);
    if (part) order_.find(view_, branches_, axes_.first, axes_.second);
    if (all.size() == 2) {
      const bool is_arc = (part && order_.apart(0, 1)) || differences_.is_arc(all[0], all[1]);
      return is_arc ? std::optional(MapCellKind::arc) : std::nullopt;
    }
    if (all.size() > 3) return part ? kind_of_row() : std::nullopt;
    if ((part && order_.go_around(0, 1, 2)) || differences_.is_node(all[0], all[1], all[2])) {
      return MapCellKind::node;
    }
    const std::optional<std::array<int, 3>> line = differences_.line_of(all);
    if (!line) return part ? kind_of_row() : std::nullopt;
    line_.assign(line->begin(), line->end());
    return MapCellKind::in_line;
  }

  /// Along one of the axes: each stands out from those beside it, so that no others exchange; or
  /// all between are on one side of lines from one to another, and the border tells.
  std::optional<MapCellKind> kind_of_row() {
    for (const std::size_t axis : {0u, 1u}) {
      const std::optional<std::vector<int>> row = order_.row(axis);
      if (!row) continue;
      branch_points_.find(view_, branches_);
      bool all_stand_out = true;
      for (std::size_t k = 1; k + 1 < row->size() && all_stand_out; ++k) {
        all_stand_out = stands_out(view_, branch_points_, branches_, std::size_t((*row)[k]),
                                   std::size_t((*row)[k - 1]), std::size_t((*row)[k + 1]));
      }
      if (all_stand_out) line_ = *row;
      if (all_stand_out || order_.go_around_alike(*row)) return MapCellKind::in_line;
    }
    return std::nullopt;
  }

  /// Of what may be a node, or not, and of what may be in line.
  std::optional<MapCellKind> kind_by_border(const Contact& hint) {
    const std::vector<Branch>& all = branches_.all();
    const auto open = all.size() == 3 ? std::optional(MapCellKind::node) : std::nullopt;
    // Of what is dominated it is not told where it supports.
    if (!dominated_.empty() || !boxes_part(all)) return open;
    order_.find(view_, branches_, axes_.first, axes_.second);
    const std::optional<CellBorder::Found> found = border_.find(order_, hint);
    if (!found || found->is_node) return open;
    std::vector<bool> left(all.size(), false);
    for (const int k : found->supporting) left[std::size_t(k)] = true;
    line_ = found->supporting;
    for (int& k : line_) k = int(std::count(left.begin(), left.begin() + k, true));
    branches_.keep(left);
    constexpr std::array kinds = {MapCellKind::region, MapCellKind::arc};
    return line_.size() <= kinds.size() ? kinds[line_.size() - 1] : MapCellKind::in_line;
  }

  /// A point of a contact tells by its place which of them it is of.
  static bool boxes_part(const std::vector<Branch>& all) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        const dvec3 gap = glm::max(all[i].lower - all[j].upper, all[j].lower - all[i].upper);
        if (!(std::max({gap.x, gap.y, gap.z}) > 0)) return false;
      }
    }
    return true;
  }

  /// All that is left is within the resolution of the supporting planes of all directions; and what
  /// is left for being below what others stand for no farther than that from the rest.
  bool is_flat() const {
    const double depth = options_.resolution + pieces_.covered_above();
    return std::all_of(view_.seen().begin(), view_.seen().end(), [&](const SeenPiece& s) {
      for (std::size_t c = 0; c < 4; ++c) {
        if (!(view_.highest()[c] - s.low[c] <= depth)) return false;
      }
      return true;
    });
  }

  /// Branches are one of which two points are within the resolution of each other: corners of their
  /// pieces.
  bool hang_together(const std::vector<Branch>& all) const {
    DisjointSets sets(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        if (come_near(all[i], all[j])) sets.unite(int(i), int(j));
      }
    }
    for (std::size_t i = 1; i < all.size(); ++i) {
      if (sets.find(int(i)) != sets.find(0)) return false;
    }
    return true;
  }

  bool come_near(const Branch& a, const Branch& b) const {
    const dvec3 gap = glm::max(glm::max(a.lower - b.upper, b.lower - a.upper), dvec3(0.0));
    if (glm::length(gap) > options_.resolution) return false;
    const std::vector<dvec3> own = corners_of_pieces(a);
    const std::vector<dvec3> other = corners_of_pieces(b);
    return std::any_of(own.begin(), own.end(), [&](const dvec3& x) {
      return std::any_of(other.begin(), other.end(), [&](const dvec3& y) {
        return glm::distance(x, y) <= options_.resolution;
      });
    });
  }

  std::vector<dvec3> corners_of_pieces(const Branch& branch) const {
    std::vector<dvec3> corners;
    for (const int chart : branch.charts) {
      for (const int k : branches_.chart(chart).pieces) {
        const StoredNet& net = pieces_.piece(view_.seen()[std::size_t(k)].piece).net;
        const int row = net.shape.q + 1;
        for (const int corner : {0, row - 1, net.shape.p * row, net.shape.p * row + row - 1}) {
          corners.push_back(euclidean(pieces_.points(net)[corner]));
        }
      }
    }
    return corners;
  }

  /// What is left is near one plane because it is small: a few levels below it is near all planes.
  bool is_spot() const {
    Box box;
    for (const Branch& branch : branches_.all()) box.include({branch.lower, branch.upper});
    return diagonal(box) * width() <= spot * options_.resolution;
  }

  double width() const { return glm::distance(view_.corners()[0], view_.corners()[3]); }

  void collect_points() {
    points_.clear();
    for (const SeenPiece& s : view_.seen()) {
      const StoredNet& net = pieces_.piece(s.piece).net;
      const dvec4* p = pieces_.points(net);
      for (int k = 0; k < net.shape.size(); ++k) points_.push_back(euclidean(p[k]));
    }
  }

  template <class Measure>
  dvec3 farthest(const Measure& measure) const {
    return *std::max_element(points_.begin(), points_.end(), [&](const dvec3& a, const dvec3& b) {
      return measure(a) < measure(b);
    });
  }

  /// All that is left is within the resolution of one plane, with a normal in the cell.
  bool is_facet() {
    collect_points();
    const dvec3 o = view_.q();
    const dvec3 along = unit(farthest([&](const dvec3& x) { return glm::distance(x, o); }) - o);
    const dvec3 beside =
        farthest([&](const dvec3& x) { return glm::length(glm::cross(x - o, along)); }) - o;
    if (glm::length(glm::cross(beside, along)) * width() < least_span * options_.resolution) {
      return false;
    }
    const dvec3 n = aligned(unit(glm::cross(beside, along)), axes_.own);
    double lower = 0;
    double upper = 0;
    for (const dvec3& x : points_) {
      lower = std::min(lower, glm::dot(x - o, n));
      upper = std::max(upper, glm::dot(x - o, n));
      if (upper - lower > 2 * options_.resolution) return false;  // on either side
    }
    // In the cell's coordinates from -1 to 1.
    const auto& d = view_.corners();
    const dvec3 to_plane = n / glm::dot(n, axes_.own);
    const double half = 0.5 * glm::dot(d[3] - d[0], axes_.first);
    const dvec3 off = (to_plane - 0.5 * (d[0] + d[3])) / half;
    if (std::abs(glm::dot(off, axes_.first)) > facet_reach) return false;
    if (std::abs(glm::dot(off, axes_.second)) > facet_reach) return false;
    facet_normal_ = n;
    facet_width_ = glm::length(glm::cross(beside, along));
    return true;
  }

  /// The plane that touches three branches, from that through their middles on.
  void find_plane(MapCell& cell) const {
    const ContactGeometry& geometry = pieces_.geometry();
    const std::vector<Branch>& all = branches_.all();
    std::array<dvec3, 3> x;
    std::array<Contact, 3> contact;
    for (const std::size_t k : {0u, 1u, 2u}) {
      const MapPiece& piece = pieces_.piece(
          view_.seen()[std::size_t(branches_.chart(all[k].charts[0]).pieces[0])].piece);
      contact[k] = pieces_.element_of(piece).contact;
      contact[k].u = 0.5 * (piece.u.lower + piece.u.upper);
      contact[k].v = 0.5 * (piece.v.lower + piece.v.upper);
      x[k] = 0.5 * (all[k].lower + all[k].upper);
    }
    const auto normal = [&] {
      return aligned(unit(glm::cross(x[1] - x[0], x[2] - x[0])), axes_.own);
    };
    cell.normal = normal();
    for (int round = 0; round < plane_rounds; ++round) {
      for (const std::size_t k : {0u, 1u, 2u}) {
        const ClimbedContact top = climb(geometry, contact[k], cell.normal);
        // Beyond the branch is another contact.
        const dvec3 off = glm::max(all[k].lower - top.x, top.x - all[k].upper);
        if (std::max({off.x, off.y, off.z}) <= options_.resolution) x[k] = top.x;
      }
      cell.normal = normal();
    }
    const double longest =
        std::max({glm::distance(x[0], x[1]), glm::distance(x[1], x[2]), glm::distance(x[2], x[0])});
    cell.width = glm::length(glm::cross(x[1] - x[0], x[2] - x[0])) / longest;
  }

  /// What a node's cell is split with.
  struct Node {
    std::vector<int> pieces;
    std::vector<dvec3> beacons;
  };

  MapPieces pieces_;
  SupportQuery query_;
  DirectionMapOptions options_;
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
  CellBorder border_;
  std::vector<int> line_;  ///< numbers of branches that are in line
  FaceAxes axes_;
  DirectionMap map_;
  std::map<int, Node> nodes_;  // by cell
  std::deque<Waiting> waiting_;
  dvec3 facet_normal_ = dvec3(0.0);
  double facet_width_ = 0;
  std::vector<dvec3> points_;  // scratch
};

}  // namespace

namespace {

/// Of a contact and its translates, of which boxes may be nearly the same.
std::size_t farthest_translate(const std::vector<MapCell::Translate>& all, std::size_t contact,
                               const dvec3& d) {
  if (contact >= all.size()) return contact;
  std::size_t best = contact;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].of == all[contact].of && glm::dot(all[k].by - all[best].by, d) > 0) best = k;
  }
  return best;
}

}  // namespace

bool MapCell::shares_plane(const MapCell& other, double resolution) const {
  const double slack = facet_slack * resolution / std::min(width, other.width);
  return glm::dot(normal, other.normal) > 0 &&
         glm::length(glm::cross(normal, other.normal)) <= slack;
}

std::size_t MapCell::contact_of(const dvec3& d, const dvec3& x) const {
  if (!rounds.empty()) {
    const auto height = [&](const Round& round) {
      return glm::dot(round.center, d) + glm::length(round.root * d);
    };
    const auto highest =
        std::max_element(rounds.begin(), rounds.end(),
                         [&](const Round& a, const Round& b) { return height(a) < height(b); });
    return std::size_t(highest - rounds.begin());
  }
  const auto gap = [&](const Box& box) {
    return glm::length(glm::max(glm::max(box.lower - x, x - box.upper), dvec3(0.0)));
  };
  const auto best = std::min_element(contacts.begin(), contacts.end(),
                                     [&](const Box& a, const Box& b) { return gap(a) < gap(b); });
  return farthest_translate(translates, std::size_t(best - contacts.begin()), d);
}

dvec3 DirectionMap::direction(int face, double s, double t) {
  const FaceAxes axes = face_axes(face);
  return axes.own + s * axes.first + t * axes.second;
}

DirectionMap::Place DirectionMap::place(const dvec3& d) {
  Place place;
  double highest = 0;
  for (int face = 0; face < 6; ++face) {
    const FaceAxes axes = face_axes(face);
    const double height = glm::dot(d, axes.own);
    if (!(height > highest)) continue;
    highest = height;
    place = {face, glm::dot(d, axes.first) / height, glm::dot(d, axes.second) / height};
  }
  return place;
}

std::array<dvec3, 4> DirectionMap::corners(const MapCell& cell) {
  const double size = std::ldexp(2.0, -cell.level);
  std::array<dvec3, 4> result;
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t i = cell.i + k / 2;
    const std::uint32_t j = cell.j + k % 2;
    result[k] = direction(cell.face, -1 + size * i, -1 + size * j);
  }
  return result;
}

DirectionMap direction_map(const ContactGeometry& geometry, const DirectionMapOptions& options) {
  return Decider(geometry, options).run();
}

}  // namespace taut
