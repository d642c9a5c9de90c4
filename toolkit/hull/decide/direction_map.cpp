#include "taut/hull/decide/direction_map.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "taut/bounds/scene_content.h"
#include "taut/bounds/support_query.h"
#include "taut/core/disjoint_sets.h"
#include "taut/hull/decide/branches.h"
#include "taut/hull/decide/cell_tree.h"
#include "taut/hull/decide/contact_index.h"
#include "taut/hull/decide/near_concavity.h"

namespace taut {
namespace {

/// Support points of cells above that are compared with.
constexpr std::size_t beacon_limit = 20;
/// Branches of which each adds a point.
constexpr std::size_t branch_beacons = 4;
/// Rounds of splitting pieces in a cell before it is split.
constexpr int refinement_limit = 12;
/// Pieces of a cell beyond which it is split rather than looked at.
constexpr std::size_t looked_at_limit = 200;
/// Distances in units of the resolution below which three points span no plane.
constexpr double least_span = 16;

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
        index_(pieces_, options.resolution),
        concavity_(pieces_, options.resolution) {}

  DirectionMap run() {
    std::vector<int> all;
    for (const MapElement& e : pieces_.elements()) {
      if (!e.covered) all.push_back(e.root);
    }
    const auto whole = std::make_shared<const std::vector<int>>(std::move(all));
    for (int face = 0; face < 6; ++face) {
      waiting_.push_back({{face, 0, 0, 0, MapCellKind::undecided, {}, {}, {}}, whole, {}, {}});
    }
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
        const dvec3& own = map_.cells[std::size_t(k)].normal;
        const dvec3& beyond = map_.cells[std::size_t(side.other)].normal;
        if (glm::length(glm::cross(own, beyond)) <= std::ldexp(1.0, -options_.level_limit)) {
          continue;
        }
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
      waiting_.push_back({{cell.face,
                           cell.level + 1,
                           2 * cell.i + k / 2,
                           2 * cell.j + k % 2,
                           MapCellKind::undecided,
                           {},
                           {},
                           {}},
                          shared,
                          beacons,
                          hint});
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
    drop_low(beacons);
    for (const int piece : *pieces) view_.look(piece);
    view_.finish();
    std::optional<MapCellKind> kind = decided();
    // Of three contacts one may not reach the others: finer pieces tell.
    const auto is_settled = [&] { return kind && *kind != MapCellKind::node; };
    for (int round = 0; round < refinement_limit && !is_settled() && view_.refine(); ++round) {
      kind = decided();
    }
    if (!kind && cell.level >= options_.level_limit) kind = MapCellKind::undecided;
    if (kind) return finish(cell, *kind, beacons);
    add_branch_points(beacons);
    split(cell, pieces_left(), beacons, support.contact);
  }

  /// Points that are nowhere the highest in a cell are so nowhere in its quarters.
  void drop_low(std::vector<dvec3>& beacons) const {
    std::vector<dvec3> left;
    for (std::size_t k = 0; k < beacons.size(); ++k) {
      if (view_.is_highest(k)) left.push_back(beacons[k]);
    }
    beacons.swap(left);
  }

  /// For each corner of the cell the highest corner of a piece of each branch: what surpasses the
  /// rest of the branch, or of others, though it may not support itself.
  void add_branch_points(std::vector<dvec3>& beacons) {
    if (branches_.all().size() > branch_beacons) return;
    for (const Branch& branch : branches_.all()) {
      Corners highest;
      highest.fill(-infinity);
      std::array<dvec3, 4> best = {};
      for (const int chart : branch.charts) {
        for (const int k : branches_.chart(chart).pieces) {
          const SeenPiece& seen = view_.seen()[std::size_t(k)];
          const StoredNet& net = pieces_.piece(seen.piece).net;
          const int p = net.shape.p;
          const int q = net.shape.q;
          for (const int corner : {0, q, p * (q + 1), p * (q + 1) + q}) {
            const dvec4& x = pieces_.points(net)[corner];
            for (std::size_t c = 0; c < 4; ++c) {
              const double h = view_.values(seen)[corner][c] / x.w;
              if (h <= highest[c]) continue;
              highest[c] = h;
              best[c] = euclidean(x);
            }
          }
        }
      }
      beacons.insert(beacons.end(), best.begin(), best.end());
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
    if (kind == MapCellKind::node) cell.normal = plane_of_three();
    for (const Branch& b : branches_.all()) cell.contacts.push_back({b.lower, b.upper});
    if (kind == MapCellKind::facet || kind == MapCellKind::node) {
      nodes_.emplace(int(map_.cells.size()), Node{pieces_left(), beacons});
    }
    ++map_.statistics.of_kind[std::size_t(kind)];
    map_.statistics.deepest = std::max(map_.statistics.deepest, cell.level);
    map_.cells.push_back(std::move(cell));
  }

  std::optional<MapCellKind> decided() {
    if (view_.seen().size() > looked_at_limit) {
      branches_.clear();
      return is_facet() ? std::optional(MapCellKind::facet) : std::nullopt;
    }
    branches_.find(view_);
    const std::vector<Branch>& all = branches_.all();
    if (all.size() <= 3 && std::all_of(all.begin(), all.end(), [&](const Branch& branch) {
          return index_.is_one(view_, branches_, branch) ||
                 concavity_.is_one(view_, branches_, branch);
        })) {
      if (all.size() == 1) return MapCellKind::region;
      if (all.size() == 2 && is_arc(all[0], all[1])) return MapCellKind::arc;
      if (all.size() == 3 && is_node(all[0], all[1], all[2])) return MapCellKind::node;
    }
    // All that is near all the planes hangs together.
    if (is_flat()) return hang_together(all) ? MapCellKind::region : MapCellKind::flat;
    if (is_spot()) return std::nullopt;
    return is_facet() ? std::optional(MapCellKind::facet) : std::nullopt;
  }

  /// All that is left is within the resolution of the supporting planes of all directions.
  bool is_flat() const {
    return std::all_of(view_.seen().begin(), view_.seen().end(), [&](const SeenPiece& s) {
      for (std::size_t c = 0; c < 4; ++c) {
        if (!(view_.highest()[c] - s.low[c] <= options_.resolution)) return false;
      }
      return true;
    });
  }

  /// Branches that come within the resolution of each other are one.
  bool hang_together(const std::vector<Branch>& all) const {
    DisjointSets sets(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        const dvec3 gap = glm::max(
            glm::max(all[i].lower - all[j].upper, all[j].lower - all[i].upper), dvec3(0.0));
        if (glm::length(gap) <= options_.resolution) sets.unite(int(i), int(j));
      }
    }
    for (std::size_t i = 1; i < all.size(); ++i) {
      if (sets.find(int(i)) != sets.find(0)) return false;
    }
    return true;
  }

  /// What is left is near one plane because it is small: a few levels below it is near all planes.
  bool is_spot() const {
    Box box;
    for (const Branch& branch : branches_.all()) box.include({branch.lower, branch.upper});
    const double width = glm::distance(view_.corners()[0], view_.corners()[3]);
    return diagonal(box) * width <= spot * options_.resolution;
  }

  /// All that is left is within the resolution of one plane, with a normal in the cell.
  bool is_facet() {
    points_.clear();
    for (const SeenPiece& s : view_.seen()) {
      const StoredNet& net = pieces_.piece(s.piece).net;
      const dvec4* p = pieces_.points(net);
      for (int k = 0; k < net.shape.size(); ++k) points_.push_back(euclidean(p[k]));
    }
    const dvec3 o = view_.q();
    const auto farthest = [&](const auto& measure) {
      return *std::max_element(points_.begin(), points_.end(), [&](const dvec3& a, const dvec3& b) {
        return measure(a) < measure(b);
      });
    };
    const dvec3 along = unit(farthest([&](const dvec3& x) { return glm::distance(x, o); }) - o);
    const dvec3 beside =
        farthest([&](const dvec3& x) { return glm::length(glm::cross(x - o, along)); }) - o;
    if (glm::length(glm::cross(beside, along)) < least_span * options_.resolution) return false;
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

  /// Outward normal of the plane through the middles of three branches.
  dvec3 plane_of_three() const {
    const std::vector<Branch>& all = branches_.all();
    const auto middle = [&](std::size_t k) { return 0.5 * (all[k].lower + all[k].upper); };
    return aligned(unit(glm::cross(middle(1) - middle(0), middle(2) - middle(0))), axes_.own);
  }

  /// How far the points of one branch are from those of another along the cell's axes: the slopes
  /// of the difference of their support functions.
  std::array<Interval, 2> difference(const Branch& a, const Branch& b) const {
    const dvec3 middle = 0.5 * (a.lower + a.upper - b.lower - b.upper);
    const dvec3 half = 0.5 * (a.upper - a.lower + b.upper - b.lower);
    const auto along = [&](const dvec3& axis) {
      const double m = glm::dot(middle, axis);
      const double r = glm::dot(half, glm::abs(axis));
      return Interval{m - r, m + r};
    };
    return {along(axes_.first), along(axes_.second)};
  }
  static bool excludes_zero(const Interval& x) { return x.lower > 0 || x.upper < 0; }

  /// The difference of two support functions is monotone along one of the axes.
  bool is_arc(const Branch& a, const Branch& b) const {
    const std::array<Interval, 2> slope = difference(a, b);
    return excludes_zero(slope[0]) || excludes_zero(slope[1]);
  }

  /// Two differences of three support functions have independent gradients: they vanish together
  /// at most once.
  bool is_node(const Branch& a, const Branch& b, const Branch& c) const {
    const std::array<Interval, 2> s = difference(a, b);
    const std::array<Interval, 2> t = difference(a, c);
    const auto product = [](const Interval& x, const Interval& y) {
      const auto [least, most] =
          std::minmax({x.lower * y.lower, x.lower * y.upper, x.upper * y.lower, x.upper * y.upper});
      return Interval{least, most};
    };
    const Interval p = product(s[0], t[1]);
    const Interval q = product(s[1], t[0]);
    return excludes_zero({p.lower - q.upper, p.upper - q.lower});
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
  ContactIndex index_;
  NearConcavity concavity_;
  FaceAxes axes_;
  DirectionMap map_;
  std::map<int, Node> nodes_;  // by cell
  std::deque<Waiting> waiting_;
  dvec3 facet_normal_ = dvec3(0.0);
  double facet_width_ = 0;
  std::vector<dvec3> points_;  // scratch
};

}  // namespace

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
