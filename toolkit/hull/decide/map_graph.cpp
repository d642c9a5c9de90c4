#include "taut/hull/decide/map_graph.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "taut/core/disjoint_sets.h"
#include "taut/core/tolerances.h"
#include "taut/hull/decide/cell_contacts.h"
#include "taut/hull/decide/cell_tree.h"
#include "taut/hull/decide/direction_cube.h"
#include "taut/hull/decide/graph_edits.h"

namespace taut {
namespace {

/// A side between two cells, with what crosses it from its beginning to its end.
struct CrossedSide {
  std::array<int, 2> cell;  // the finer, and the other
  std::array<dvec3, 2> ends;
  bool first_is_left = false;  // the finer cell, seen from outside
  std::vector<int> crossings;
};

/// Where an arc crosses a side.
struct SideCrossing {
  int side;
  int teller;                  // the cell that tells its contacts
  std::array<int, 2> contact;  // towards the side's beginning and its end
  static constexpr int none = -1;
  std::array<int, 2> arc = {none, none};   // of those of either cell; none that it tells
  std::array<int, 2> next = {none, none};  // crossing beyond either cell, or none: a node
};

class Weaving {
 public:
  Weaving(const DirectionMap& map, SupportQuery& query)
      : map_(map),
        query_(query),
        tree_(map.cells),
        contacts_(map, query),
        clusters_(map.cells.size()),
        sides_of_(map.cells.size()) {}

  MapGraph run() {
    find_sides();
    for (int k = 0; k < int(map_.cells.size()); ++k) {
      if (contacts_.is_closed(k)) pass(k);
    }
    open_cells_that_differ();
    join_neighbors();
    join_facets();
    widen_bare_facets();
    make_nodes();
    make_arcs();
    remove_arcs(graph_, map_, arcs_within_nodes(), [](const auto&) { return true; });
    return std::move(graph_);
  }

 private:
  const MapCell& cell(int k) const { return map_.cells[std::size_t(k)]; }
  CrossedSide& side(int k) { return sides_[std::size_t(k)]; }
  SideCrossing& crossing(int k) { return crossings_[std::size_t(k)]; }

  void find_sides() {
    std::vector<CellTree::CellSide> sides;
    for (int k = 0; k < int(map_.cells.size()); ++k) {
      query_.check_stop();
      for (int number = 0; number < 4; ++number) {
        CellTree::CellSide found;
        if (tree_.side(k, number, found)) sides.push_back(found);
      }
    }
    tell_in_line(sides);
    for (const CellTree::CellSide& side : sides) add(side);
  }

  /// Contacts in line with others may be told apart in one cell and not beside it: where cells that
  /// hang together agree with all of their neighbours, and with each other, so, those count alone
  /// that are above the others.
  void tell_in_line(const std::vector<CellTree::CellSide>& sides) {
    DisjointSets lines(map_.cells.size());
    for (const CellTree::CellSide& s : sides) {
      if (contacts_.has_line(s.finer) && contacts_.has_line(s.other)) lines.unite(s.finer, s.other);
    }
    std::set<int> differ;
    for (const CellTree::CellSide& s : sides) {
      query_.check_stop();
      if (!contacts_.is_closed(s.finer) || !contacts_.is_closed(s.other)) continue;
      if (!contacts_.has_line(s.finer) && !contacts_.has_line(s.other)) continue;
      const auto count = [&](int k) {
        return contacts_.has_line(k) ? passed_high(k, s).size()
                                     : contacts_.passed(k, s.from, s.to).size();
      };
      if (count(s.finer) == count(s.other)) continue;
      for (const int k : {s.finer, s.other}) differ.insert(lines.find(k));
    }
    for (int k = 0; k < int(map_.cells.size()); ++k) {
      if (contacts_.has_line(k) && differ.count(lines.find(k)) == 0) high_alone_.insert(k);
    }
  }

  std::vector<int> passed_high(int k, const CellTree::CellSide& side) {
    return contacts_.passed_by_height(k, side.from, side.to, tie_share * map_.resolution);
  }

  void add(const CellTree::CellSide& found) {
    const auto d = DirectionMap::corners(cell(found.finer));
    CrossedSide own{{found.finer, found.other}, {found.from, found.to}, false, {}};
    own.first_is_left = glm::dot(glm::cross(found.from, found.to), d[0] + d[1] + d[2] + d[3]) > 0;
    const int index = int(sides_.size());
    std::array<std::vector<int>, 2> passed;
    for (const std::size_t i : {0u, 1u}) {
      sides_of_[std::size_t(own.cell[i])].push_back(index);
      if (!contacts_.is_closed(own.cell[i])) continue;
      passed[i] = high_alone_.count(own.cell[i]) > 0
                      ? passed_high(own.cell[i], found)
                      : contacts_.passed(own.cell[i], found.from, found.to);
    }
    const std::size_t teller = passed[0].size() >= passed[1].size() ? 0 : 1;
    const bool agree = passed[0].size() == passed[1].size();
    for (std::size_t k = 0; k + 1 < passed[teller].size(); ++k) {
      SideCrossing c{index, own.cell[teller], {passed[teller][k], passed[teller][k + 1]}};
      for (const std::size_t i : {0u, 1u}) {
        if (i != teller && !agree) continue;
        const auto [low, high] = std::minmax(passed[i][k], passed[i][k + 1]);
        c.arc[i] = cell(own.cell[i]).apart * low + high;
      }
      own.crossings.push_back(int(crossings_.size()));
      crossings_.push_back(c);
    }
    sides_.push_back(std::move(own));
  }

  bool is_open(int k) const { return !contacts_.is_closed(k) || opened_.count(k) > 0; }
  /// Arcs may end in it.
  bool is_of_node(int k) { return is_open(k) || has_left_over(k); }

  /// Cells of more contacts than they tell apart do not tell what is inside of them where something
  /// is left over in one of them, nor do those beside it that tell other contacts apart; nor where
  /// contacts in line may be taken for each other.
  void open_cells_that_differ() {
    std::vector<int> waiting;
    std::vector<dvec3> differ;
    for (int k = 0; k < int(map_.cells.size()); ++k) {
      if (!contacts_.has_more(k)) continue;
      const std::size_t before = differ.size();
      for (const int c : left_over(k)) differ.push_back(unit(middle(c)));
      if (differ.size() > before) waiting.push_back(k);
    }
    const auto opens_beyond = [&](int s) {
      if (!tell_alike(side(s))) return true;
      const dvec3 n = unit(unit(side(s).ends[0]) + unit(side(s).ends[1]));
      return std::any_of(differ.begin(), differ.end(), [&](const dvec3& other) {
        return glm::distance(n, other) <= map_.contact_extent();
      });
    };
    while (!waiting.empty()) {
      const int k = waiting.back();
      waiting.pop_back();
      if (!open(k)) continue;
      for (const int s : sides_of_[std::size_t(k)]) {
        if (!opens_beyond(s)) continue;
        for (const int beyond : side(s).cell) {
          if (contacts_.has_more(beyond)) waiting.push_back(beyond);
        }
      }
    }
  }

  /// Arcs end in it. False if they did before.
  bool open(int k) {
    if (!opened_.insert(k).second) return false;
    for (const int s : sides_of_[std::size_t(k)]) {
      for (const int c : side(s).crossings) {
        crossing(c).next[number_of(crossing(c), k)] = SideCrossing::none;
      }
    }
    return true;
  }

  /// The contacts that exchange on the side are the same ones for both of its cells.
  bool tell_alike(const CrossedSide& own) const {
    return std::all_of(own.crossings.begin(), own.crossings.end(), [&](int c) {
      const auto& arc = crossings_[std::size_t(c)].arc;
      if (arc[0] == SideCrossing::none || arc[1] == SideCrossing::none) return false;
      const auto contact = [&](std::size_t i, int k) {
        const MapCell& of = cell(own.cell[i]);
        return of.contacts[std::size_t(k == 0 ? arc[i] / of.apart : arc[i] % of.apart)];
      };
      const auto meet = [&](int k, int other) {
        return box_gaps(contact(0, k), contact(1, other)) == dvec3(0.0);
      };
      return (meet(0, 0) && meet(1, 1)) || (meet(0, 1) && meet(1, 0));
    });
  }

  /// What is left over beside cells that do not tell what is inside of them ends there.
  void join_neighbors() {
    std::vector<bool> of_node(map_.cells.size());
    for (std::size_t k = 0; k < of_node.size(); ++k) of_node[k] = is_of_node(int(k));
    for (const CrossedSide& s : sides_) {
      const auto& [a, b] = s.cell;
      const bool one_is_open = is_open(a) || is_open(b);
      if (one_is_open && of_node[std::size_t(a)] && of_node[std::size_t(b)]) clusters_.unite(a, b);
    }
  }

  /// Cells of one facet may touch in a corner only, or have others between them. Three of its
  /// contacts may make a node beside it, or be told apart from the others, which all but support.
  void join_facets() {
    std::vector<int> facets, others;
    for (int k = 0; k < int(map_.cells.size()); ++k) {
      if (contacts_.is_of_facet(k)) facets.push_back(k);
      if (cell(k).has_plane() && is_of_node(k)) others.push_back(k);
    }
    for (const int facet : facets) {
      query_.check_stop();
      for (const int other : others) {
        if (cell(facet).shares_plane(cell(other), map_.resolution)) clusters_.unite(facet, other);
      }
    }
  }

  /// Arcs leave from a facet of several contacts. Of one that comes through a single side of its
  /// cell and goes back over it the ends of that side do not tell: it is in the cell beyond.
  void widen_bare_facets() {
    for (const auto& [first, cells] : cells_of_nodes()) {
      MapGraph::Node node;
      node.cells = cells;
      const auto has_arcs = [&](int k) {
        return contacts_.is_of_facet(k) && cell(k).contacts.size() > 1;
      };
      const auto facet = std::find_if(cells.begin(), cells.end(), has_arcs);
      if (facet == cells.end() || !border_of(node).empty()) continue;
      const int beyond = nearest_beyond(*facet);
      if (beyond < 0) continue;
      open(beyond);
      clusters_.unite(*facet, beyond);
    }
  }

  /// The cell with arcs in it beyond the side of a facet's cell that is nearest to its normal; -1
  /// if there is none.
  int nearest_beyond(int facet) {
    const DirectionMap::Place place = DirectionMap::place(cell(facet).normal);
    const dvec3 normal = DirectionMap::direction(place.face, place.s, place.t);
    int best = -1;
    double least = infinity;
    for (const int s : sides_of_[std::size_t(facet)]) {
      const CrossedSide& own = side(s);
      const int beyond = own.cell[own.cell[0] == facet ? 1 : 0];
      if (is_open(beyond) || cell(beyond).kind == MapCellKind::region) continue;
      const double gap = distance_to_segment(normal, own.ends[0], own.ends[1]);
      if (gap >= least) continue;
      least = gap;
      best = beyond;
    }
    return best;
  }

  std::size_t number_of(const SideCrossing& c, int k) const {
    return sides_[std::size_t(c.side)].cell[0] == k ? 0 : 1;
  }

  /// Each of the cell's arcs goes on from crossing to crossing.
  void pass(int k) {
    std::map<int, std::vector<int>> of_arc;
    for (const int s : sides_of_[std::size_t(k)]) {
      for (const int c : side(s).crossings) {
        const int arc = crossing(c).arc[number_of(crossing(c), k)];
        if (arc != SideCrossing::none) of_arc[arc].push_back(c);
      }
    }
    for (auto& [arc, left] : of_arc) {
      const bool is_of_node = cell(k).kind == MapCellKind::node && cell(k).apart == 3;
      if (left.size() > 2 && (left.size() % 2 == 0 || is_of_node)) {
        pass_in_order(k, arc, left);
      } else {
        while (left.size() > 1) pass_nearest(k, left);
      }
    }
  }

  /// An arc that leaves its cell and comes back: the difference of its contacts keeps to one side
  /// all over the cell, so that across it the arc goes on and on. From a node in the cell it goes
  /// where the third contact falls behind: the first crossing on that way is left over.
  void pass_in_order(int k, int arc, std::vector<int>& passes) {
    const auto [low, high] = std::div(arc, cell(k).apart);
    const auto contact = [&](int i) { return cell(k).contacts[std::size_t(i)].center(); };
    const auto d = DirectionMap::corners(cell(k));
    dvec3 along = glm::cross(d[0] + d[1] + d[2] + d[3], contact(low) - contact(high));
    const bool from_node = passes.size() % 2 == 1;
    if (from_node && glm::dot(contact(3 - low - high) - contact(low), along) > 0) along = -along;
    std::sort(passes.begin(), passes.end(), [&](int a, int b) {
      const double before = glm::dot(middle(a), along), after = glm::dot(middle(b), along);
      return before != after ? before < after : a < b;
    });
    for (std::size_t i = from_node ? 1 : 0; i < passes.size(); i += 2) {
      join(k, passes[i], passes[i + 1]);
    }
  }

  /// The two of them that are nearest to each other.
  void pass_nearest(int k, std::vector<int>& left) {
    std::pair<std::size_t, std::size_t> best = {0, 1};
    double least = infinity;
    for (std::size_t a = 0; a < left.size(); ++a) {
      for (std::size_t b = a + 1; b < left.size(); ++b) {
        const double gap = left.size() == 2 ? 0 : glm::distance(middle(left[a]), middle(left[b]));
        if (gap >= least) continue;
        least = gap;
        best = {a, b};
      }
    }
    join(k, left[best.first], left[best.second]);
    left.erase(left.begin() + std::ptrdiff_t(best.second));
    left.erase(left.begin() + std::ptrdiff_t(best.first));
  }

  /// An arc passes the cell from the one to the other.
  void join(int k, int a, int b) {
    crossing(a).next[number_of(crossing(a), k)] = b;
    crossing(b).next[number_of(crossing(b), k)] = a;
  }

  dvec3 middle(int k) {
    const CrossedSide& own = side(crossing(k).side);
    return unit(own.ends[0]) + unit(own.ends[1]);
  }

  /// The cells of each node, by one of them.
  std::map<int, std::vector<int>> cells_of_nodes() {
    std::map<int, std::vector<int>> found;
    for (int k = 0; k < int(map_.cells.size()); ++k) {
      if (is_of_node(k)) found[clusters_.find(k)].push_back(k);
    }
    return found;
  }

  void make_nodes() {
    for (auto& [first, cells] : cells_of_nodes()) {
      MapGraph::Node node;
      node.cells = std::move(cells);
      for (const int k : node.cells) node.is_facet = node.is_facet || contacts_.is_of_facet(k);
      const std::vector<int> around = border_of(node);
      if (around.empty() && !node.is_facet) continue;
      for (const int c : around) {
        const std::size_t i = end_at(crossing(c), node.cells);
        node_of_[{c, int(i)}] = int(graph_.nodes.size());
      }
      around_.push_back(around);
      graph_.nodes.push_back(std::move(node));
    }
  }

  bool has_left_over(int k) const { return !left_over(k).empty(); }
  /// Crossings from which nothing goes on in the cell.
  std::vector<int> left_over(int k) const {
    std::vector<int> found;
    for (const int s : sides_of_[std::size_t(k)]) {
      for (const int c : sides_[std::size_t(s)].crossings) {
        const SideCrossing& own = crossings_[std::size_t(c)];
        if (own.next[number_of(own, k)] == SideCrossing::none) found.push_back(c);
      }
    }
    return found;
  }

  /// In which of the two cells at a crossing an arc ends that ends in one of these.
  std::size_t end_at(const SideCrossing& c, const std::vector<int>& cells) {
    const bool is_first = std::binary_search(cells.begin(), cells.end(), side(c.side).cell[0]);
    return is_first && c.next[0] == SideCrossing::none ? 0 : 1;
  }

  /// The crossings of the border of a node that end there, counter-clockwise from outside.
  std::vector<int> border_of(const MapGraph::Node& node) {
    using Key = std::array<long long, 3>;
    std::map<Key, std::vector<std::vector<int>>> from;  // crossings of a side, by its beginning
    std::map<Key, std::vector<Key>> to;
    std::vector<Key> starts;
    std::vector<int> within;
    int loops = 0;
    for (const int k : node.cells) {
      for (const int s : sides_of_[std::size_t(k)]) {
        const CrossedSide& own = side(s);
        const bool first = own.cell[0] == k;
        if (std::binary_search(node.cells.begin(), node.cells.end(), own.cell[first ? 1 : 0])) {
          // Arcs that pass one of its cells may end in another.
          for (const int c : own.crossings) {
            const auto& next = crossing(c).next;
            const bool ends = next[first ? 0 : 1] == SideCrossing::none;
            if (ends && next[first ? 1 : 0] != SideCrossing::none) within.push_back(c);
          }
          continue;
        }
        const bool ahead = first == own.first_is_left;
        std::vector<int> ending;
        for (const int c : own.crossings) {
          if (crossing(c).next[first ? 0 : 1] == SideCrossing::none) ending.push_back(c);
        }
        if (!ahead) std::reverse(ending.begin(), ending.end());
        const Key begin = place_on_cube(own.ends[ahead ? 0 : 1]);
        from[begin].push_back(std::move(ending));
        to[begin].push_back(place_on_cube(own.ends[ahead ? 1 : 0]));
        starts.push_back(begin);
      }
    }
    std::vector<int> around;
    for (const Key& start : starts) {
      if (from[start].empty()) continue;
      ++loops;
      for (Key at = start; !from[at].empty();) {
        const std::vector<int>& ending = from[at].back();
        around.insert(around.end(), ending.begin(), ending.end());
        const Key next = to[at].back();
        from[at].pop_back();
        to[at].pop_back();
        at = next;
      }
    }
    around.insert(around.end(), within.begin(), within.end());
    if (loops > 1 || !within.empty()) sort_about(node, around);
    return around;
  }

  /// As the sides of a convex polygon: by the angle of what leads from the contact to the right of
  /// the way out over a crossing to that to its left.
  void sort_about(const MapGraph::Node& node, std::vector<int>& around) {
    dvec3 n(0.0);
    for (const int k : node.cells) n += middle_of(k);
    const std::array<dvec3, 2> frame = tangent_frame(unit(n));
    std::map<int, double> angle;
    for (const int c : around) {
      const MapCrossing out = passed(c, end_at(crossing(c), node.cells));
      const dvec3 side = contacts_.point(out.ends[1]) - contacts_.point(out.ends[0]);
      angle[c] = std::atan2(glm::dot(side, frame[1]), glm::dot(side, frame[0]));
    }
    std::stable_sort(around.begin(), around.end(),
                     [&](int a, int b) { return angle[a] < angle[b]; });
  }

  void make_arcs() {
    std::vector<bool> done(crossings_.size(), false);
    for (std::size_t k = 0; k < graph_.nodes.size(); ++k) {
      for (const int c : around_[k]) {
        if (!done[std::size_t(c)]) follow(c, end_at(crossing(c), graph_.nodes[k].cells), done);
      }
    }
    for (int c = 0; c < int(crossings_.size()); ++c) {
      const auto& next = crossing(c).next;
      const bool passes = next[0] != SideCrossing::none && next[1] != SideCrossing::none;
      if (passes && !done[std::size_t(c)]) follow(c, 0, done);
    }
    for (std::size_t k = 0; k < graph_.nodes.size(); ++k) {
      MapGraph::Node& node = graph_.nodes[k];
      for (const int c : around_[k]) {
        const int i = int(end_at(crossing(c), node.cells));
        node.ends.push_back(end_of_.at({c, i}));
      }
    }
  }

  /// Follows an arc over a crossing out of one of its cells, to a node or back to where it began.
  void follow(int c, std::size_t out_of, std::vector<bool>& done) {
    const int index = int(graph_.arcs.size());
    MapGraph::Arc arc;
    const auto begin = node_of_.find({c, int(out_of)});
    if (begin != node_of_.end()) {
      arc.node[0] = begin->second;
      end_of_[{c, int(out_of)}] = {index, 0};
    }
    for (int at = c;;) {
      done[std::size_t(at)] = true;
      arc.crossings.push_back(passed(at, out_of));
      const std::size_t into = 1 - out_of;
      const int next = crossing(at).next[into];
      if (next == SideCrossing::none) {
        arc.node[1] = node_of_.at({at, int(into)});
        end_of_[{at, int(into)}] = {index, 1};
        break;
      }
      if (done[std::size_t(next)]) break;
      out_of = number_of(crossing(next), side(crossing(at).side).cell[into]);
      at = next;
    }
    graph_.arcs.push_back(std::move(arc));
  }

  MapCrossing passed(int k, std::size_t out_of) {
    const SideCrossing& own = crossing(k);
    const CrossedSide& across = side(own.side);
    MapCrossing result{across.ends, own.teller, own.contact};
    // Out of a cell to the left of the side, its beginning is to the right of the way.
    if ((out_of == 0) != across.first_is_left) {
      std::swap(result.ends[0], result.ends[1]);
      std::swap(result.contact[0], result.contact[1]);
    }
    return result;
  }

  /// Arcs that leave a node and come back, and are no longer than its cells are wide: the cells
  /// have a hole, as no single one has.
  std::set<int> arcs_within_nodes() const {
    std::set<int> found;
    for (int k = 0; k < int(graph_.arcs.size()); ++k) {
      const MapGraph::Arc& arc = graph_.arcs[std::size_t(k)];
      if (arc.is_closed() || arc.node[0] != arc.node[1]) continue;
      const std::vector<int>& cells = graph_.nodes[std::size_t(arc.node[0])].cells;
      if (cells.size() == 1) continue;
      double reach = 0;
      for (const int own : cells) reach = std::max(reach, std::ldexp(2.0, 1 - cell(own).level));
      const bool within =
          std::all_of(arc.crossings.begin(), arc.crossings.end(), [&](const auto& c) {
            const dvec3 n = unit(unit(c.ends[0]) + unit(c.ends[1]));
            return std::any_of(cells.begin(), cells.end(),
                               [&](int own) { return glm::distance(middle_of(own), n) <= reach; });
          });
      if (within) found.insert(k);
    }
    return found;
  }
  /// The normal of its plane, or a direction inside.
  dvec3 middle_of(int k) const {
    const auto d = DirectionMap::corners(cell(k));
    return cell(k).has_plane() ? cell(k).normal : unit(d[0] + d[3]);
  }

  const DirectionMap& map_;
  const SupportQuery& query_;
  CellTree tree_;
  CellContacts contacts_;
  DisjointSets clusters_;
  std::set<int> high_alone_;
  std::set<int> opened_;
  std::vector<CrossedSide> sides_;
  std::vector<SideCrossing> crossings_;
  std::vector<std::vector<int>> sides_of_;               // by cell
  std::vector<std::vector<int>> around_;                 // by node: crossings in order
  std::map<std::pair<int, int>, int> node_of_;           // by crossing and its cell
  std::map<std::pair<int, int>, MapGraph::End> end_of_;  // the same
  MapGraph graph_;
};

}  // namespace

int MapGraph::regions() const {
  DisjointSets parts(nodes.size() + arcs.size());
  int vertices = int(nodes.size());
  for (std::size_t k = 0; k < arcs.size(); ++k) {
    const int own = int(nodes.size() + k);
    if (arcs[k].is_closed()) {
      ++vertices;  // one of it is a node
      continue;
    }
    for (const int node : arcs[k].node) parts.unite(own, node);
  }
  std::set<int> components;
  for (int k = 0; k < int(nodes.size() + arcs.size()); ++k) components.insert(parts.find(k));
  return 1 + int(components.size()) - vertices + int(arcs.size());
}

MapGraph map_graph(const DirectionMap& map, SupportQuery& query) {
  return Weaving(map, query).run();
}

}  // namespace taut
