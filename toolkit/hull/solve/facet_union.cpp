#include "taut/hull/solve/facet_union.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "taut/core/tolerances.h"
#include "taut/hull/solve/arc_pieces.h"

namespace taut {
namespace {

class FacetUnion {
 public:
  FacetUnion(SeparatingGraph& graph, double tie) : graph_(graph), tie_(tie) {}

  void run() {
    for (int k = 0; k < int(graph_.arcs.size()); ++k) {
      if (stands_between_two(graph_.arcs[std::size_t(k)])) unite(k);
    }
    for (int k = 0; k < int(graph_.nodes.size()); ++k) {
      while (!graph_.nodes[std::size_t(k)].is_crossing && fold_one(k)) {
      }
    }
    drop_empty();
  }

 private:
  using Slot = FacetNode::Slot;

  /// From one facet to another, all in the plane of the first.
  bool stands_between_two(const SeparatingArc& arc) const {
    if (arc.pieces.empty() || arc.closed || arc.facet[0] < 0 || arc.facet[1] < 0) return false;
    if (arc.facet[0] == arc.facet[1]) return false;
    const FacetNode& own = graph_.nodes[std::size_t(arc.facet[0])];
    const FacetNode& other = graph_.nodes[std::size_t(arc.facet[1])];
    if (own.is_crossing || other.is_crossing) return false;
    const double offset = glm::dot(own.points.front(), own.n);
    const bool is_one_plane =
        std::all_of(other.points.begin(), other.points.end(),
                    [&](const dvec3& x) { return std::abs(glm::dot(x, own.n) - offset) <= tie_; });
    if (!is_one_plane) return false;
    return std::all_of(arc.pieces.begin(), arc.pieces.end(), [&](const ArcPiece& piece) {
      return std::all_of(piece.rulings.begin(), piece.rulings.end(), [&](const Ruling& r) {
        return glm::distance(r.n, own.n) <= same_contact;
      });
    });
  }

  /// With this corner, and the side from it, the first.
  static void begin_with(FacetNode& facet, std::size_t first) {
    const auto turn = [&](auto& all) {
      if (!all.empty()) std::rotate(all.begin(), all.begin() + std::ptrdiff_t(first), all.end());
    };
    turn(facet.contacts);
    turn(facet.points);
    turn(facet.sides);
    turn(facet.slots);
  }

  /// With the side that this end of the arc leaves across the last. @pre it leaves the facet
  static void end_with(FacetNode& facet, int arc, int end) {
    const auto at = std::find_if(facet.slots.begin(), facet.slots.end(),
                                 [&](const Slot& s) { return s.arc == arc && s.end == end; });
    begin_with(facet, std::size_t(at - facet.slots.begin() + 1) % facet.slots.size());
  }

  /// The sides of the second facet follow those of the first in the place of what is between them.
  void unite(int k) {
    const auto [first, second] = graph_.arcs[std::size_t(k)].facet;
    FacetNode& own = graph_.nodes[std::size_t(first)];
    FacetNode& other = graph_.nodes[std::size_t(second)];
    end_with(own, k, 0);
    end_with(other, k, 1);
    if (!own.sides.empty() || !other.sides.empty()) {
      own.sides.resize(own.slots.size());
      other.sides.resize(other.slots.size());
      own.sides.pop_back();
      own.sides.insert(own.sides.end(), other.sides.begin(), other.sides.end() - 1);
    }
    own.slots.pop_back();
    own.slots.insert(own.slots.end(), other.slots.begin(), other.slots.end() - 1);
    own.contacts.insert(own.contacts.end(), other.contacts.begin() + 1, other.contacts.end() - 1);
    own.points.insert(own.points.end(), other.points.begin() + 1, other.points.end() - 1);
    other = {};
    graph_.arcs[std::size_t(k)] = {};
    for (const Slot& s : own.slots) {
      if (s.arc >= 0) graph_.arcs[std::size_t(s.arc)].facet[std::size_t(s.end)] = first;
    }
  }

  /// The first two sides that lead out and back. False if there are none.
  bool fold_one(int number) {
    FacetNode& facet = graph_.nodes[std::size_t(number)];
    const std::size_t count = facet.points.size();
    // Of three the third would lead nowhere.
    if (count < 2 || count == 3) return false;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t next = (k + 1) % count;
      if (facet.slots[k].arc < 0 || facet.slots[next].arc < 0) continue;
      if (glm::distance(facet.points[k], facet.points[(k + 2) % count]) > tie_) continue;
      begin_with(facet, k);
      const Slot into = facet.slots[0], out = facet.slots[1];
      // The third corner is where the first one is; of two all go.
      const std::ptrdiff_t corner = count == 2 ? 0 : 1;
      const auto leave_out = [](auto& all, std::ptrdiff_t first) {
        if (!all.empty()) all.erase(all.begin() + first, all.begin() + first + 2);
      };
      leave_out(facet.slots, 0);
      leave_out(facet.sides, 0);
      leave_out(facet.contacts, corner);
      leave_out(facet.points, corner);
      join(into, out);
      return !facet.points.empty();
    }
    return false;
  }

  /// The one arc goes on into the other.
  void join(const Slot& into, const Slot& out) {
    SeparatingArc& arc = graph_.arcs[std::size_t(into.arc)];
    if (into.arc == out.arc) {
      arc.closed = true;
      arc.facet = {-1, -1};
      return;
    }
    if (into.end == 0) turn(into.arc);
    if (out.end == 1) turn(out.arc);
    SeparatingArc& other = graph_.arcs[std::size_t(out.arc)];
    arc.facet[1] = other.facet[1];
    if (arc.facet[1] >= 0) {
      for (Slot& s : graph_.nodes[std::size_t(arc.facet[1])].slots) {
        if (s.arc == out.arc && s.end == 1) s.arc = into.arc;
      }
    }
    append(arc.pieces, std::move(other.pieces));
    other = {};
  }

  /// The arc's direction.
  void turn(int k) {
    SeparatingArc& arc = graph_.arcs[std::size_t(k)];
    reverse(arc.pieces);
    std::swap(arc.facet[0], arc.facet[1]);
    std::vector<int> nodes;
    for (const int facet : arc.facet) {
      if (facet >= 0 && std::find(nodes.begin(), nodes.end(), facet) == nodes.end()) {
        nodes.push_back(facet);
      }
    }
    for (const int facet : nodes) {
      for (Slot& s : graph_.nodes[std::size_t(facet)].slots) {
        if (s.arc == k) s.end = 1 - s.end;
      }
    }
  }

  void drop_empty() {
    std::vector<int> arc_number, node_number;
    int arcs = 0, nodes = 0;
    for (const SeparatingArc& arc : graph_.arcs) {
      arc_number.push_back(arc.pieces.empty() ? -1 : arcs++);
    }
    for (const FacetNode& node : graph_.nodes) {
      node_number.push_back(node.points.empty() ? -1 : nodes++);
    }
    std::erase_if(graph_.arcs, [](const SeparatingArc& arc) { return arc.pieces.empty(); });
    std::erase_if(graph_.nodes, [](const FacetNode& node) { return node.points.empty(); });
    for (SeparatingArc& arc : graph_.arcs) {
      for (int& facet : arc.facet) {
        if (facet >= 0) facet = node_number[std::size_t(facet)];
      }
    }
    for (FacetNode& node : graph_.nodes) {
      for (Slot& s : node.slots) {
        if (s.arc >= 0) s.arc = arc_number[std::size_t(s.arc)];
      }
    }
  }

  SeparatingGraph& graph_;
  double tie_;
};

}  // namespace

void unite_facets(SeparatingGraph& graph, double tie) { FacetUnion(graph, tie).run(); }

}  // namespace taut
