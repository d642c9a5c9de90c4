#include "taut/hull/solve/solved_graph.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "taut/bounds/contact_climb.h"
#include "taut/hull/contact/contact_planes.h"
#include "taut/hull/contact/facet_contacts.h"
#include "taut/hull/decide/cell_tree.h"
#include "taut/hull/decide/map_graph.h"
#include "taut/hull/solve/arc_solver.h"
#include "taut/hull/trace/arc_pieces.h"
#include "taut/hull/trace/merging.h"

namespace taut {
namespace {

class GraphSolver {
 public:
  GraphSolver(const ContactGeometry& geometry, SupportQuery& query, const DirectionMap& map,
              const Progress& progress)
      : geometry_(geometry),
        query_(query),
        map_(map),
        system_(geometry),
        search_(system_, query, map),
        progress_(progress) {}

  SeparatingGraph run() {
    told_ = map_graph(map_, query_);
    for (const MapGraph::Arc& arc : told_.arcs) {
      progress_.check();
      std::vector<Ruling>& own = rulings_.emplace_back();
      for (const MapCrossing& crossing : arc.crossings) {
        const Ruling r = search_.at(crossing).ruling;
        if (own.empty() || glm::distance(own.back().n, r.n) > same_contact) own.push_back(r);
      }
    }
    planes_ = contact_planes(geometry_, query_);
    for (const MapGraph::Node& node : told_.nodes) add(node);
    for (std::size_t k = 0; k < told_.arcs.size(); ++k) solve(k);
    graph_.newton_iterations = system_.iterations();
    return std::move(graph_);
  }

 private:
  void fail(const dvec3& n, const char* reason) { graph_.unresolved.push_back({n, reason}); }

  /// The ruling next to an end of an arc.
  const Ruling& ruling_at(const MapGraph::End& end) const {
    const std::vector<Ruling>& own = rulings_[std::size_t(end.arc)];
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
    number_.push_back(int(graph_.nodes.size()));
    graph_.nodes.push_back(std::move(*facet));
  }

  /// A plane with contact along curves.
  std::optional<FacetNode> with_curved_sides(const MapGraph::Node& node) {
    for (const ContactPlane& plane : planes_) {
      const bool is_here = std::any_of(node.cells.begin(), node.cells.end(), [&](int k) {
        const MapCell& cell = map_.cells[std::size_t(k)];
        return cell.has_plane() && glm::distance(cell.normal, plane.n) < same_plane;
      });
      if (!is_here) continue;
      const auto f = facet_contacts(geometry_, query_, plane.n, {}, plane.pieces);
      if (!f || !f->is_facet()) continue;
      FacetNode facet{plane.n, f->contacts, f->points, f->sides, {}};
      facet.slots.assign(facet.contacts.size(), {});
      return facet;
    }
    return std::nullopt;
  }

  /// Contacts between arcs that follow each other are its corners.
  std::optional<FacetNode> of_corners(const MapGraph::Node& node) {
    const std::size_t count = node.ends.size();
    std::vector<std::array<Contact, 2>> candidates;
    std::vector<dvec3> points;
    for (std::size_t k = 0; k < count; ++k) {
      const MapGraph::End& own = node.ends[k];
      const MapGraph::End& before = node.ends[(k + count - 1) % count];
      candidates.push_back({ruling_at(own).contact[contact_beside(own, 0)],
                            ruling_at(before).contact[contact_beside(before, 1)]});
      points.push_back(ruling_at(own).point[contact_beside(own, 0)]);
    }
    const std::array<std::size_t, 3> wide = widest(points);
    CommonSupport pair;
    pair.n = ruling_at(node.ends[wide[0]]).n;
    for (const std::size_t k : {wide[0], wide[1]}) pair.add(geometry_, candidates[k][0]);
    const auto plane = common_plane(system_, query_, pair, candidates[wide[2]][0]);
    if (!plane) {
      fail(pair.n, "the plane of a facet is not found");
      return std::nullopt;
    }
    FacetNode facet;
    facet.n = plane->n;
    for (const auto& [first, second] : candidates) {
      const ClimbedContact a = climb(geometry_, first, facet.n);
      const ClimbedContact b = climb(geometry_, second, facet.n);
      const ClimbedContact& c = b.h > a.h + geometry_.tie() ? b : a;
      if (c.h < glm::dot(plane->jet[0].x, facet.n) - geometry_.tie()) {
        fail(facet.n, "the contacts of a facet lie in no plane");
      }
      facet.contacts.push_back(c.contact);
      facet.points.push_back(c.x);
    }
    facet.slots.assign(facet.contacts.size(), {});
    return facet;
  }

  static std::array<std::size_t, 3> widest(const std::vector<dvec3>& points) {
    std::array<std::size_t, 3> best = {0, 1, 2};
    for (std::size_t k = 1; k < points.size(); ++k) {
      if (glm::distance(points[k], points[0]) > glm::distance(points[best[1]], points[0])) best[1] = k;
    }
    double largest = -1;
    for (std::size_t k = 1; k < points.size(); ++k) {
      const double area =
          glm::length(glm::cross(points[k] - points[0], points[best[1]] - points[0]));
      if (k == best[1] || area <= largest) continue;
      largest = area;
      best[2] = k;
    }
    return best;
  }

  /// The side of a facet across which the arc's end leaves: the one between whose corners its
  /// ruling is.
  std::size_t side_of(const FacetNode& facet, const MapGraph::End& end) const {
    const Ruling& r = ruling_at(end);
    std::size_t best = 0;
    double least = infinity;
    for (std::size_t k = 0; k < facet.points.size(); ++k) {
      if (facet.is_curved(k)) continue;
      const dvec3& next = facet.points[(k + 1) % facet.points.size()];
      const double gap = glm::distance(r.point[contact_beside(end, 0)], facet.points[k]) +
                         glm::distance(r.point[contact_beside(end, 1)], next);
      if (gap >= least) continue;
      least = gap;
      best = k;
    }
    return best;
  }

  /// The ruling in which an arc begins or ends at a node, with its side; none at free ends.
  std::optional<Ruling> plug(int arc, int end) {
    const int node = told_.arcs[std::size_t(arc)].node[std::size_t(end)];
    const int number = number_[std::size_t(node)];
    if (number < 0) return std::nullopt;
    FacetNode& facet = graph_.nodes[std::size_t(number)];
    const std::size_t side = side_of(facet, {arc, end});
    const std::size_t next = (side + 1) % facet.contacts.size();
    if (facet.slots[side].arc >= 0) fail(facet.n, "two arcs leave a facet across one side");
    facet.slots[side] = {arc, end};
    Ruling r{facet.n, {facet.contacts[side], facet.contacts[next]},
             {facet.points[side], facet.points[next]}};
    if (end == 1) {
      std::swap(r.contact[0], r.contact[1]);
      std::swap(r.point[0], r.point[1]);
    }
    return r;
  }

  void solve(std::size_t k) {
    progress_.check();
    const MapGraph::Arc& told = told_.arcs[k];
    std::vector<Ruling> known = rulings_[k];
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
    drop_empty_pieces(geometry_, arc.pieces);
    graph_.arcs.push_back(std::move(arc));
  }

  /// The contacts of the pieces' last ruling, or first, run into each other.
  void merge(std::vector<ArcPiece>& pieces, int end) {
    if (end == 0) reverse(pieces);
    CommonSupport last(geometry_, pieces.back().rulings.back());
    for (double length = glm::length(last.d()); length > merging_distance(geometry_); length /= 2) {
      CommonSupport next = last;
      const bool solved = system_.solve(next, [&](const CommonSupport& s) {
        return distance_equation(s, 0.5 * length);
      });
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
  MapGraph told_;
  std::vector<std::vector<Ruling>> rulings_;  // by arc
  std::vector<ContactPlane> planes_;
  std::vector<int> number_;  // of a told node in the graph, -1: a free end
  SeparatingGraph graph_;
};

}  // namespace

SeparatingGraph solved_graph(const ContactGeometry& geometry, SupportQuery& query,
                             const DirectionMap& map, const Progress& progress) {
  return GraphSolver(geometry, query, map, progress).run();
}

}  // namespace taut
