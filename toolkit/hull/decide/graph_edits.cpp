#include "taut/hull/decide/graph_edits.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace taut {
namespace {

/// Where cells are left undecided arcs may pass many of them: as a share of what is between the two
/// contacts of an arc, how far each may move on the way.
constexpr double way_share = 0.05;

class GraphEdit {
 public:
  GraphEdit(MapGraph& graph, const DirectionMap& map) : graph_(graph), map_(map) {}

  /// Removes arcs, and nodes that are nothing without them.
  void drop(const std::set<int>& dropped) {
    std::vector<int> number(graph_.arcs.size(), -1);
    std::vector<MapGraph::Arc> arcs;
    for (std::size_t k = 0; k < number.size(); ++k) {
      if (dropped.count(int(k)) > 0) continue;
      number[k] = int(arcs.size());
      arcs.push_back(std::move(graph_.arcs[k]));
    }
    graph_.arcs.swap(arcs);
    std::set<int> bare;
    for (std::size_t k = 0; k < graph_.nodes.size(); ++k) {
      MapGraph::Node& node = graph_.nodes[k];
      std::erase_if(node.ends,
                    [&](const MapGraph::End& end) { return number[std::size_t(end.arc)] < 0; });
      for (MapGraph::End& end : node.ends) end.arc = number[std::size_t(end.arc)];
      if (node.ends.empty() && !node.is_facet) bare.insert(int(k));
    }
    leave_out_nodes(bare);
  }

  /// The ends of both nodes, in order about what the arc was.
  void contract(int k) {
    const auto [first, second] = graph_.arcs[std::size_t(k)].node;
    if (first == second) return;
    MapGraph::Node& own = graph_.nodes[std::size_t(first)];
    MapGraph::Node& other = graph_.nodes[std::size_t(second)];
    const auto turned_to = [&](std::vector<MapGraph::End>& ends, int end) {
      const auto at = std::find_if(ends.begin(), ends.end(), [&](const MapGraph::End& e) {
        return e.arc == k && e.end == end;
      });
      std::rotate(ends.begin(), at, ends.end());
    };
    turned_to(own.ends, 0);
    turned_to(other.ends, 1);
    for (const MapGraph::End& e : other.ends)
      graph_.arcs[std::size_t(e.arc)].node[std::size_t(e.end)] = first;
    own.ends.insert(own.ends.end(), other.ends.begin(), other.ends.end());
    own.cells.insert(own.cells.end(), other.cells.begin(), other.cells.end());
    std::sort(own.cells.begin(), own.cells.end());
    own.is_facet = own.is_facet || other.is_facet;
    other = {};
  }

  /// Ends of arcs that go on into each other through the node: two alone, or each two that follow
  /// each other there between the same contacts.
  std::vector<std::array<MapGraph::End, 2>> pairs_that_pass(const MapGraph::Node& node) const {
    std::vector<MapGraph::End> left = node.ends;
    const double slack = is_undecided(node) ? way_share : 0;
    std::vector<std::array<MapGraph::End, 2>> pairs;
    for (std::size_t i = 0; i < left.size() && left.size() > 1;) {
      const std::size_t j = (i + 1) % left.size();
      if (left.size() > 2 && !go_on(left[i], left[j], slack)) {
        ++i;
        continue;
      }
      pairs.push_back({left[i], left[j]});
      left.erase(left.begin() + std::ptrdiff_t(std::max(i, j)));
      left.erase(left.begin() + std::ptrdiff_t(std::min(i, j)));
      i = 0;
    }
    return pairs;
  }

  void join_arcs_that_pass(const IsCrossing& is_crossing) {
    std::map<std::pair<int, int>, MapGraph::End> on;
    std::set<int> passed;
    for (std::size_t k = 0; k < graph_.nodes.size(); ++k) {
      const MapGraph::Node& node = graph_.nodes[k];
      if (node.is_facet || (may_be_crossing(node) && is_crossing(node))) continue;
      const auto pairs = pairs_that_pass(node);
      if (pairs.size() * 2 < node.ends.size()) continue;
      passed.insert(int(k));
      for (const auto& [a, b] : pairs) {
        on[{a.arc, a.end}] = b;
        on[{b.arc, b.end}] = a;
      }
    }
    if (!passed.empty()) join(on, passed);
  }

 private:
  bool may_be_crossing(const MapGraph::Node& node) const {
    const std::vector<MapGraph::End>& ends = node.ends;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (!go_on(ends[i], ends[(i + 1) % ends.size()], 0)) return false;
    }
    return ends.size() > 2;
  }

  /// Between the same contacts: what is to the right of the way out along the one is to the left of
  /// that along the other.
  /// `slack`: by how much contacts move on the way, as a share of what is between them.
  bool go_on(const MapGraph::End& a, const MapGraph::End& b, double slack) const {
    const std::array<Box, 2> from = {contact_beside(a, 0), contact_beside(a, 1)};
    const std::array<Box, 2> to = {contact_beside(b, 1), contact_beside(b, 0)};
    const double between = std::min(gap(from[0], from[1]), gap(to[0], to[1]));
    const double far = std::max(map_.resolution, slack * between);
    return gap(from[0], to[0]) <= far && gap(from[1], to[1]) <= far;
  }
  static double gap(const Box& a, const Box& b) {
    const dvec3 gaps = box_gaps(a, b);
    return std::max({gaps.x, gaps.y, gaps.z});
  }
  bool is_undecided(const MapGraph::Node& node) const {
    return std::all_of(node.cells.begin(), node.cells.end(),
                       [&](int k) { return cell(k).kind == MapCellKind::undecided; });
  }
  /// To the right (0) or left of the way out of the node.
  const Box& contact_beside(const MapGraph::End& end, int side) const {
    const MapGraph::Arc& arc = graph_.arcs[std::size_t(end.arc)];
    const MapCrossing& c = end.end == 0 ? arc.crossings.front() : arc.crossings.back();
    const int contact = c.contact[std::size_t(end.end == 0 ? side : 1 - side)];
    return cell(c.cell).contacts[std::size_t(contact)];
  }

  void join(const std::map<std::pair<int, int>, MapGraph::End>& on, const std::set<int>& passed) {
    std::vector<MapGraph::Arc> before;
    before.swap(graph_.arcs);
    std::vector<bool> done(before.size(), false);
    std::map<std::pair<int, int>, MapGraph::End> ends;  // as they were: as they are
    const auto follow = [&](MapGraph::End at) {
      const int index = int(graph_.arcs.size());
      MapGraph::Arc arc;
      arc.node[0] = before[std::size_t(at.arc)].node[std::size_t(at.end)];
      ends[{at.arc, at.end}] = {index, 0};
      while (!done[std::size_t(at.arc)]) {
        done[std::size_t(at.arc)] = true;
        MapGraph::Arc& own = before[std::size_t(at.arc)];
        if (at.end == 1) reverse(own);
        arc.crossings.insert(arc.crossings.end(), own.crossings.begin(), own.crossings.end());
        arc.node[1] = own.node[1];
        const MapGraph::End out = {at.arc, 1 - at.end};
        ends[{out.arc, out.end}] = {index, 1};
        const auto next = on.find({out.arc, out.end});
        if (next == on.end()) break;
        at = next->second;
        arc.node[1] = -1;
      }
      if (arc.node[1] < 0) arc.node[0] = -1;
      graph_.arcs.push_back(std::move(arc));
    };
    for (int k = 0; k < int(before.size()); ++k) {
      for (int end = 0; end < 2; ++end) {
        if (!done[std::size_t(k)] && on.count({k, end}) == 0) follow({k, end});
      }
    }
    for (int k = 0; k < int(before.size()); ++k) {
      if (!done[std::size_t(k)]) follow({k, 0});
    }
    for (int k = 0; k < int(graph_.nodes.size()); ++k) {
      if (passed.count(k) > 0) continue;
      for (MapGraph::End& end : graph_.nodes[std::size_t(k)].ends)
        end = ends.at({end.arc, end.end});
    }
    leave_out_nodes(passed);
  }

  /// Numbers the others anew. @pre no arc ends in them
  void leave_out_nodes(const std::set<int>& left_out) {
    std::vector<int> number(graph_.nodes.size(), -1);
    std::vector<MapGraph::Node> nodes;
    for (std::size_t k = 0; k < number.size(); ++k) {
      if (left_out.count(int(k)) > 0) continue;
      number[k] = int(nodes.size());
      nodes.push_back(std::move(graph_.nodes[k]));
    }
    graph_.nodes.swap(nodes);
    for (MapGraph::Arc& arc : graph_.arcs) {
      for (int& node : arc.node) {
        if (node >= 0) node = number[std::size_t(node)];
      }
    }
  }

  static void reverse(MapGraph::Arc& arc) {
    std::reverse(arc.crossings.begin(), arc.crossings.end());
    for (MapCrossing& c : arc.crossings) {
      std::swap(c.ends[0], c.ends[1]);
      std::swap(c.contact[0], c.contact[1]);
    }
    std::swap(arc.node[0], arc.node[1]);
  }

  const MapCell& cell(int k) const { return map_.cells[std::size_t(k)]; }

  MapGraph& graph_;
  const DirectionMap& map_;
};

/// The parts of an arc between what is none of it, in order: no part where it is all its own. Of an
/// open one its first and its last crossing are.
std::vector<std::vector<MapCrossing>> parts_of(
    const MapGraph::Arc& arc, const std::function<bool(const MapCrossing&)>& is_none) {
  std::vector<MapCrossing> all = arc.crossings;
  std::vector<bool> none(all.size(), false);
  std::transform(all.begin(), all.end(), none.begin(), is_none);
  if (!arc.is_closed()) none.front() = none.back() = false;
  if (std::count(none.begin(), none.end(), true) == 0) return {};
  if (arc.is_closed()) {
    // From behind what is none of it on.
    const auto first = std::find(none.begin(), none.end(), true) - none.begin();
    std::rotate(none.begin(), none.begin() + first, none.end());
    std::rotate(all.begin(), all.begin() + first, all.end());
  }
  std::vector<std::vector<MapCrossing>> parts;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (none[k]) continue;
    if (k == 0 || none[k - 1]) parts.emplace_back();
    parts.back().push_back(all[k]);
  }
  return parts;
}

}  // namespace

void cut_arcs(MapGraph& graph, const std::function<bool(const MapCrossing&)>& is_none) {
  const auto node_at = [&](int arc, int end) {
    MapGraph::Node node;
    node.ends = {{arc, end}};
    graph.nodes.push_back(std::move(node));
    return int(graph.nodes.size()) - 1;
  };
  for (int k = 0, count = int(graph.arcs.size()); k < count; ++k) {
    const bool closed = graph.arcs[std::size_t(k)].is_closed();
    std::vector<std::vector<MapCrossing>> parts = parts_of(graph.arcs[std::size_t(k)], is_none);
    const std::array<int, 2> node = graph.arcs[std::size_t(k)].node;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const int own = p == 0 ? k : int(graph.arcs.size());
      if (p > 0) graph.arcs.emplace_back();
      MapGraph::Arc part;
      part.crossings = std::move(parts[p]);
      part.node[0] = p == 0 && !closed ? node[0] : node_at(own, 0);
      const bool ends = p + 1 == parts.size() && !closed;
      part.node[1] = ends ? node[1] : node_at(own, 1);
      if (ends) {
        for (MapGraph::End& e : graph.nodes[std::size_t(node[1])].ends) {
          if (e.arc == k && e.end == 1) e.arc = own;
        }
      }
      graph.arcs[std::size_t(own)] = std::move(part);
    }
  }
}

void remove_arcs(MapGraph& graph, const DirectionMap& map, const std::set<int>& arcs,
                 const IsCrossing& is_crossing) {
  GraphEdit edit(graph, map);
  if (!arcs.empty()) edit.drop(arcs);
  edit.join_arcs_that_pass(is_crossing);
}

bool arcs_pass(MapGraph& graph, const DirectionMap& map, const MapGraph::Node& node) {
  return GraphEdit(graph, map).pairs_that_pass(node).size() * 2 == node.ends.size();
}

void contract_arcs(MapGraph& graph, const DirectionMap& map, const std::set<int>& arcs,
                   const IsCrossing& is_crossing) {
  GraphEdit edit(graph, map);
  for (const int k : arcs) edit.contract(k);
  edit.drop(arcs);
  edit.join_arcs_that_pass(is_crossing);
}

}  // namespace taut
