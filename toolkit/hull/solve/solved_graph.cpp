#include "taut/hull/solve/solved_graph.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "taut/bounds/contact_climb.h"
#include "taut/hull/contact/facet_contacts.h"
#include "taut/hull/solve/arc_solver.h"
#include "taut/hull/solve/edge_places.h"
#include "taut/hull/solve/known_arcs.h"
#include "taut/hull/solve/level_pieces.h"
#include "taut/hull/solve/touching_plane.h"
#include "taut/hull/trace/arc_pieces.h"
#include "taut/hull/trace/merging.h"

namespace taut {
namespace {

/// Places on edges that are one, in units of the resolution.
constexpr double place_depths = 8;

class GraphSolver {
 public:
  GraphSolver(const ContactGeometry& geometry, SupportQuery& query, const DirectionMap& map,
              const Progress& progress)
      : geometry_(geometry),
        query_(query),
        map_(map),
        system_(geometry),
        search_(system_, query, map),
        progress_(progress),
        known_(known_arcs(search_, progress)) {}

  SeparatingGraph run() {
    for (const MapGraph::Node& node : known_.graph.nodes) add(node);
    for (std::size_t k = 0; k < known_.graph.arcs.size(); ++k) solve(k);
    unite_edge_places(geometry_, graph_, place_depths * map_.resolution);
    for (SeparatingArc& arc : graph_.arcs) drop_empty_pieces(geometry_, arc.pieces);
    graph_.newton_iterations = system_.iterations();
    return std::move(graph_);
  }

 private:
  void fail(const dvec3& n, const char* reason) { graph_.unresolved.push_back({n, reason}); }

  /// The ruling next to an end of an arc.
  const Ruling& ruling_at(const MapGraph::End& end) const {
    const std::vector<Ruling>& own = known_.rulings[std::size_t(end.arc)];
    return end.end == 0 ? own.front() : own.back();
  }
  /// Its contact to the right (0) or left of the way out of the node.
  std::size_t contact_beside(const MapGraph::End& end, std::size_t side) const {
    return end.end == 0 ? side : 1 - side;
  }

  /// A node of the map is a facet, or a free end.
  void add(const MapGraph::Node& node) {
    std::optional<FacetNode> facet = with_curved_sides(node);
    if (!facet && node.ends.size() > 2) facet = of_corners(node);
    if (!facet) {
      number_.push_back(-1);
      if (node.ends.size() != 1) fail(dvec3(0.0), "a node is neither a facet nor a free end");
      return;
    }
    const std::vector<std::size_t> sides = sides_of(*facet, node);
    if (sides.size() != node.ends.size()) {
      fail(facet->n, "not as many arcs leave a facet as it has straight sides");
      number_.push_back(-1);
      return;
    }
    for (std::size_t k = 0; k < sides.size(); ++k) {
      facet->slots[sides[k]] = {node.ends[k].arc, node.ends[k].end};
    }
    number_.push_back(int(graph_.nodes.size()));
    graph_.nodes.push_back(std::move(*facet));
  }

  /// A plane with contact along curves.
  std::optional<FacetNode> with_curved_sides(const MapGraph::Node& node) {
    for (const int k : node.cells) {
      const MapCell& cell = map_.cells[std::size_t(k)];
      if (!cell.has_plane()) continue;
      const LevelPieces level = level_pieces(geometry_, query_, cell.normal, map_.resolution);
      if (level.pieces.empty()) return std::nullopt;
      const double slack = level.off > geometry_.tie() ? level.off : 0;
      const double least = query_(level.n).h - std::max(geometry_.tie(), slack);
      std::vector<Contact> corners;
      for (const MapGraph::End& end : node.ends) {
        for (const Contact& c : ruling_at(end).contact) {
          const ClimbedContact there = climb(geometry_, c, level.n);
          if (there.h >= least) corners.push_back(there.contact);
        }
      }
      const auto f = facet_contacts(geometry_, query_, level.n, corners, level.pieces, slack);
      if (!f || !f->is_facet()) return std::nullopt;
      FacetNode facet{level.n, f->contacts, f->points, f->sides, {}};
      facet.slots.assign(facet.contacts.size(), {});
      return facet;
    }
    return std::nullopt;
  }

  /// Contacts between arcs that follow each other are its corners.
  std::optional<FacetNode> of_corners(const MapGraph::Node& node) {
    const std::size_t count = node.ends.size();
    std::vector<Contact> corners;
    std::vector<dvec3> beside;
    dvec3 n(0.0);
    for (std::size_t k = 0; k < count; ++k) {
      const MapGraph::End& own = node.ends[k];
      corners.push_back(ruling_at(own).contact[contact_beside(own, 0)]);
      beside.push_back(ruling_at(own).n);
      n += beside.back();
    }
    for (const int k : node.cells) {
      const MapCell& cell = map_.cells[std::size_t(k)];
      if (cell.has_plane()) n = cell.normal;
    }
    TouchingPlane plane = touching_plane(geometry_, query_, unit(n), corners);
    if (plane.in_line) plane = turned_to_part(geometry_, query_, plane, beside);
    if (plane.off() > map_.resolution) {
      fail(plane.n, "the contacts of a facet lie in no plane");
    }
    FacetNode facet;
    facet.n = plane.n;
    for (const ClimbedContact& c : plane.contacts) {
      facet.contacts.push_back(c.contact);
      facet.points.push_back(c.x);
    }
    facet.slots.assign(facet.contacts.size(), {});
    return facet;
  }

  /// The side of a facet across which each of the node's arcs leaves: they follow each other as the
  /// sides do that are not curved.
  std::vector<std::size_t> sides_of(const FacetNode& facet, const MapGraph::Node& node) const {
    std::vector<std::size_t> straight;
    for (std::size_t k = 0; k < facet.points.size(); ++k) {
      if (!facet.is_curved(k)) straight.push_back(k);
    }
    const std::size_t count = node.ends.size();
    if (straight.size() != count || count == 0) return {};
    const auto gap = [&](std::size_t end, std::size_t side) {
      const Ruling& r = ruling_at(node.ends[end]);
      const dvec3& next = facet.points[(side + 1) % facet.points.size()];
      return glm::distance(r.point[contact_beside(node.ends[end], 0)], facet.points[side]) +
             glm::distance(r.point[contact_beside(node.ends[end], 1)], next);
    };
    std::size_t best = 0;
    double least = infinity;
    for (std::size_t turn = 0; turn < count; ++turn) {
      double sum = 0;
      for (std::size_t k = 0; k < count; ++k) sum += gap(k, straight[(k + turn) % count]);
      if (sum >= least) continue;
      least = sum;
      best = turn;
    }
    std::vector<std::size_t> sides;
    for (std::size_t k = 0; k < count; ++k) sides.push_back(straight[(k + best) % count]);
    return sides;
  }

  /// The ruling in which an arc begins or ends at a node, with its side; none at free ends.
  std::optional<Ruling> plug(int arc, int end) {
    const int node = known_.graph.arcs[std::size_t(arc)].node[std::size_t(end)];
    const int number = number_[std::size_t(node)];
    if (number < 0) return std::nullopt;
    FacetNode& facet = graph_.nodes[std::size_t(number)];
    std::size_t side = 0;
    while (facet.slots[side].arc != arc || facet.slots[side].end != end) ++side;
    const std::size_t next = (side + 1) % facet.contacts.size();
    Ruling r{facet.n,
             {facet.contacts[side], facet.contacts[next]},
             {facet.points[side], facet.points[next]}};
    if (end == 1) {
      std::swap(r.contact[0], r.contact[1]);
      std::swap(r.point[0], r.point[1]);
    }
    return r;
  }

  void solve(std::size_t k) {
    progress_.check();
    const MapGraph::Arc& told = known_.graph.arcs[k];
    std::vector<Ruling> known = known_.rulings[k];
    SeparatingArc arc;
    arc.closed = told.is_closed();
    std::array<bool, 2> merges = {false, false};
    for (const int end : {0, 1}) {
      if (arc.closed) break;
      arc.facet[std::size_t(end)] = number_[std::size_t(told.node[std::size_t(end)])];
      const std::optional<Ruling> r = plug(int(k), end);
      merges[std::size_t(end)] = !r;
      if (r) known.insert(end == 0 ? known.begin() : known.end(), *r);
    }
    if (arc.closed) known.push_back(known.front());
    ArcSolver solver(search_, known.front());
    for (std::size_t i = 1; i < known.size(); ++i) solver.go_on(known[i]);
    for (const Unresolved& u : solver.unresolved()) graph_.unresolved.push_back(u);
    arc.pieces = solver.take();
    for (const int end : {1, 0}) {
      if (merges[std::size_t(end)]) merge(arc.pieces, end);
    }
    if (arc.closed && arc.pieces.size() > 1 &&
        same_elements(arc.pieces.back().rulings.back(), arc.pieces.front().rulings.front())) {
      std::vector<ArcPiece> first;
      first.push_back(std::move(arc.pieces.front()));
      arc.pieces.erase(arc.pieces.begin());
      append(arc.pieces, std::move(first));
    }
    graph_.arcs.push_back(std::move(arc));
  }

  /// The contacts of the pieces' last ruling, or first, run into each other.
  void merge(std::vector<ArcPiece>& pieces, int end) {
    if (end == 0) reverse(pieces);
    CommonSupport last(geometry_, pieces.back().rulings.back());
    for (double length = glm::length(last.d()); length > merging_distance(geometry_); length /= 2) {
      CommonSupport next = last;
      const bool solved = system_.solve(
          next, [&](const CommonSupport& s) { return distance_equation(s, 0.5 * length); });
      if (!solved) break;
      ArcSolver solver(search_, pieces.back().rulings.back());
      solver.go_on(next.ruling());
      append(pieces, solver.take());
      last = CommonSupport(geometry_, pieces.back().rulings.back());
    }
    CurvePoint point(system_, query_, last);
    if (point.settle()) {
      if (auto merged = merged_end(point)) {
        append(pieces, std::move(merged->pieces));
        if (end == 0) reverse(pieces);
        return;
      }
    }
    fail(last.n, "the free end of an arc is not found");
    if (end == 0) reverse(pieces);
  }

  const ContactGeometry& geometry_;
  SupportQuery& query_;
  const DirectionMap& map_;
  ContactSystem system_;
  RulingSearch search_;
  const Progress& progress_;
  const KnownArcs known_;
  std::vector<int> number_;  // of a told node in the graph, -1: a free end
  SeparatingGraph graph_;
};

}  // namespace

SeparatingGraph solved_graph(const ContactGeometry& geometry, SupportQuery& query,
                             const DirectionMap& map, const Progress& progress) {
  return GraphSolver(geometry, query, map, progress).run();
}

}  // namespace taut
