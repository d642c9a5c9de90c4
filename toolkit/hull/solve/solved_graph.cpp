#include "taut/hull/solve/solved_graph.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "taut/bounds/contact_climb.h"
#include "taut/bounds/contact_forms.h"
#include "taut/core/tolerances.h"
#include "taut/hull/contact/facet_contacts.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/hull/solve/arc_ends.h"
#include "taut/hull/solve/arc_pieces.h"
#include "taut/hull/solve/arc_solver.h"
#include "taut/hull/solve/crossings.h"
#include "taut/hull/solve/edge_places.h"
#include "taut/hull/solve/facet_corners.h"
#include "taut/hull/solve/facet_union.h"
#include "taut/hull/solve/known_arcs.h"
#include "taut/hull/solve/level_pieces.h"
#include "taut/hull/solve/node_ears.h"
#include "taut/hull/solve/tolerant_places.h"
#include "taut/hull/solve/touching_plane.h"

namespace taut {
namespace {

/// Depths, in units of the resolution, of corners below a plane that they do not lie in as yet.
constexpr double first_corner_depths = 8;
/// Units of the resolution up to which pieces of arcs may be none.
constexpr double empty_depths = 8;
/// Pieces of rounded models that may be none, in units of the way from one ruling to the next.
constexpr double piece_ways = 4;

/// Share of the resolution that a contact may be lower where it is told as in one place.
constexpr double corner_share = 0.5;

/// Divisions of ways between rulings, and for each that is known, after which it is seen that what
/// the map tells is no graph of arcs: as of maps that are left undecided.
constexpr int divisions_limit = 1000;
constexpr int divisions_limit_each = 4;

/// Shares of the step at which the arcs that are known are found, and the facets, about.
constexpr double known_share = 0.5;
constexpr double facets_share = 0.6;

/// Places between two on an edge at which it is seen whether it touches a plane.
constexpr int places_along = 4;
/// Slope that rounding may leave where an exact plane touches.
constexpr double exact_slope = 1e-8;

class GraphSolver {
 public:
  GraphSolver(const ContactGeometry& geometry, SupportQuery& query, const DirectionMap& map,
              double place_depths, const Progress& progress)
      : geometry_(geometry),
        query_(query),
        map_(map),
        system_(geometry),
        search_(system_, query, map),
        place_depths_(place_depths),
        progress_(progress),
        known_(with_ears_cut(search_, progress)),
        most_divisions_(divisions_limit + divisions_limit_each * int(known_count())) {}

  SeparatingGraph run() {
    find_facets();
    for (std::size_t k = 0; k < known_.graph.arcs.size() && !is_spent(); ++k) solve(k);
    if (is_spent()) {
      SeparatingGraph none;
      none.unresolved.push_back({dvec3(0.0), "curves between contacts are not found"});
      none.newton_iterations = system_.iterations();
      return none;
    }
    drop_arcs();
    const double resolution = search_.place_resolution();
    const double extent = search_.place_extent();
    const double places = place_depths_ * resolution;
    unite_edge_places(geometry_, graph_, resolution, places, map_.contact_extent(),
                      [&](const Contact& c) { return search_.touches(c); });
    const double empty = empty_depths * resolution;
    const double reach = std::max(empty, extent > 0 ? piece_ways * search_.least_way() : 0);
    const double beside = std::max(extent, piece_ways * search_.least_way());
    // So far contacts have moved to edges beside which ruled patches are bent.
    const double moved = geometry_.bent() > 0 ? map_.contact_extent() : extent;
    for (SeparatingArc& arc : graph_.arcs) {
      tell_vertices(geometry_, arc.pieces, map_.contact_extent());
      for (ArcPiece& piece : arc.pieces) drop_turns(piece.rulings, map_.contact_extent());
    }
    unite_facets(graph_, geometry_.tie());
    for (SeparatingArc& arc : graph_.arcs) {
      drop_empty_pieces(geometry_, arc.pieces, empty, reach, extent);
      for (ArcPiece& piece : arc.pieces) drop_beside_ends(piece.rulings, beside);
      tell_corners(arc.pieces, places, moved, corner_share * resolution);
      turn_ends(system_, arc.pieces);
      tell_along_edges(geometry_, arc.pieces);
      tell_along_joins(geometry_, arc.pieces, extent);
      join_in_crossings(arc);
    }
    graph_.newton_iterations = system_.iterations();
    graph_.depth = map_.resolution;
    return std::move(graph_);
  }

 private:
  static KnownArcs with_ears_cut(const RulingSearch& search, const Progress& progress) {
    KnownArcs known = known_arcs(search, progress.part(0, known_share));
    cut_ears(search, known);
    return known;
  }

  std::size_t known_count() const {
    std::size_t count = 0;
    for (const std::vector<Ruling>& own : known_.rulings) count += own.size();
    return count;
  }
  bool is_spent() const { return divisions_ > most_divisions_; }

  void fail(const dvec3& n, const char* reason) { graph_.unresolved.push_back({n, reason}); }

  /// Its contact to the right (0) or left of the way out of the node.
  std::size_t contact_beside(const MapGraph::End& end, std::size_t side) const {
    return end.end == 0 ? side : 1 - side;
  }

  /// A node of the map is a facet, or a free end; or two arcs that go on into each other.
  void find_facets() {
    std::vector<std::optional<FacetNode>> facets;
    const Progress part = progress_.part(known_share, facets_share);
    WorkProgress share(part, "trace", double(known_.graph.nodes.size()));
    for (const MapGraph::Node& node : known_.graph.nodes) {
      facets.push_back(facet_of(node));
      share.add(1);
    }
    for (std::size_t k = 0; k < facets.size(); ++k) {
      const std::size_t count = known_.graph.nodes[k].ends.size();
      if (facets[k] || count == 1) continue;
      if (count == 2) {
        join_arcs(known_, int(k));
      } else {
        fail(dvec3(0.0), "a node is neither a facet nor a free end");
      }
    }
    for (std::size_t k = 0; k < facets.size(); ++k) {
      add(known_.graph.nodes[k], std::move(facets[k]));
    }
  }

  /// Across each of its straight sides one of the node's arcs leaves.
  std::optional<FacetNode> facet_of(const MapGraph::Node& node) {
    if (std::optional<FacetNode> crossing = crossing_of(search_, known_, node)) return crossing;
    const auto fits_node = [&](const std::optional<FacetNode>& own) {
      return own && sides_of(*own, node).size() == node.ends.size();
    };
    std::optional<FacetNode> facet = with_curved_sides(node, false);
    // Sides so short that no arc leaves across them are none.
    if (facet && !fits_node(facet)) facet = with_curved_sides(node, true);
    if (node.ends.size() <= 2) return fits_node(facet) ? facet : std::nullopt;
    // Without curved sides its corners are where arcs leave.
    const bool fits = fits_node(facet);
    if (fits && facet->has_curved_side()) return facet;
    return of_corners(node, fits ? std::move(facet) : std::nullopt);
  }

  void add(const MapGraph::Node& node, std::optional<FacetNode> facet) {
    number_.push_back(facet ? int(graph_.nodes.size()) : -1);
    if (!facet) return;
    const std::vector<std::size_t> sides = sides_of(*facet, node);
    for (std::size_t k = 0; k < sides.size(); ++k) {
      facet->slots[sides[k]] = {node.ends[k].arc, node.ends[k].end};
    }
    if (!facet->is_crossing) run_along_edges(geometry_, map_.resolution, *facet);
    graph_.nodes.push_back(std::move(*facet));
  }

  /// A plane with contact along curves; `rounded` where it is known to the resolution only.
  std::optional<FacetNode> with_curved_sides(const MapGraph::Node& node, bool rounded) {
    for (const int k : node.cells) {
      const MapCell& cell = map_.cells[std::size_t(k)];
      if (cell.has_plane()) return with_curved_sides(node, cell.normal, rounded);
    }
    return std::nullopt;
  }

  std::optional<FacetNode> with_curved_sides(const MapGraph::Node& node, const dvec3& n,
                                             bool rounded) {
    LevelPieces level = level_pieces(geometry_, query_, n, map_.resolution);
    if (level.pieces.empty()) return std::nullopt;
    const auto near = level_corners(node, level.n, first_corner_depths);
    const bool is_rounded = rounded || level.off > geometry_.tie() ||
                            near.size() > level_corners(node, level.n, 0).size();
    if (is_rounded) {
      std::vector<dvec3> points;
      points.reserve(near.size());
      for (const ClimbedContact& c : near) points.push_back(c.x);
      level = level_pieces(geometry_, query_, n, map_.resolution, points);
      if (level.pieces.empty()) return std::nullopt;
    }
    std::vector<Contact> corners;
    for (const ClimbedContact& c : level_corners(node, level.n, is_rounded ? 1 : 0)) {
      corners.push_back(c.contact);
    }
    auto found = facet_contacts(geometry_, query_, level.n, corners, level.pieces,
                                is_rounded ? map_.resolution : 0);
    if (!found || !found->is_facet()) return std::nullopt;
    const double depth = map_.resolution;
    if (is_rounded) move_to_ends(geometry_, depth, map_.contact_extent(), *found);
    unite_corners(geometry_, depth, is_rounded ? map_.contact_extent() : depth, *found);
    fill_dents(geometry_, map_.resolution, *found);
    FacetNode facet{level.n, found->contacts, found->points, found->sides, {}};
    facet.slots.assign(facet.contacts.size(), {});
    return facet;
  }

  /// What arcs leave a node from, where it touches the plane across n: no deeper than rounding and
  /// so many units of the resolution.
  std::vector<ClimbedContact> level_corners(const MapGraph::Node& node, const dvec3& n,
                                            double depths) {
    const double least = query_(n).h - std::max(geometry_.tie(), depths * map_.resolution);
    std::vector<ClimbedContact> corners;
    for (const MapGraph::End& end : node.ends) {
      for (const Contact& c : known_.ruling_at(end).contact) {
        const ClimbedContact there = climb(geometry_, c, n);
        if (there.h >= least) corners.push_back(there);
      }
    }
    return corners;
  }

  /// From the middle of the directions beside the node or, where that leads nowhere, from each.
  TouchingPlane plane_of(const MapGraph::Node& node, const NodeCorners& corners) {
    TouchingPlane plane = touching_plane(geometry_, query_, corners.n, corners.contacts);
    const bool is_lost = plane.in_line && has_merged(plane, corners);
    if (plane.off() <= map_.resolution && !is_lost) return plane;
    for (std::size_t k = 0; k < node.ends.size(); ++k) {
      const Ruling& r = known_.ruling_at(node.ends[k]);
      std::vector<Contact> contacts = corners.contacts;
      contacts[(k + 1) % contacts.size()] = r.contact[contact_beside(node.ends[k], 1)];
      TouchingPlane other = touching_plane(geometry_, query_, r.n, contacts);
      if (other.off() <= map_.resolution && !other.in_line && !has_merged(other, corners)) {
        return other;
      }
    }
    return plane;
  }

  /// Where corners have become one in the plane they stay what they are told beside it, if they are
  /// no farther below it than the resolution.
  TouchingPlane with_corners_apart(const TouchingPlane& plane, const NodeCorners& corners) {
    TouchingPlane apart = plane;
    const double h = query_(plane.n, plane.contacts.front().contact).h;
    for (std::size_t k = 0; k < apart.contacts.size(); ++k) {
      const dvec3 x = geometry_.point(corners.contacts[k]);
      const double height = glm::dot(x, plane.n);
      if (h - height > map_.resolution) return plane;
      apart.contacts[k] = {corners.contacts[k], x, height};
    }
    return apart;
  }

  /// Two corners that were apart have become one.
  bool has_merged(const TouchingPlane& plane, const NodeCorners& corners) const {
    for (std::size_t a = 0; a < corners.contacts.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const double apart = glm::distance(geometry_.point(corners.contacts[a]),
                                           geometry_.point(corners.contacts[b]));
        const double now = glm::distance(plane.contacts[a].x, plane.contacts[b].x);
        if (now <= same_contact && apart > map_.contact_extent()) return true;
      }
    }
    return false;
  }

  /// The corner of a facet, or nearer to where the arcs beside it have theirs: on the border of the
  /// same element, or on the same straight edge, if all between the two touches the plane, too.
  ClimbedContact corner_beside(const Contact& beside, const ClimbedContact& corner,
                               const dvec3& n) const {
    const double extent = map_.contact_extent();
    const dvec3 from = geometry_.point(beside);
    const auto level = level_border(geometry_, beside, n, corner.h - geometry_.tie());
    if (level && glm::distance(level->x, from) + extent < glm::distance(corner.x, from)) {
      return *level;
    }
    const Contact own = geometry_.canonical(moved_to_border(geometry_, beside, extent));
    const std::optional<double> end = place_on(own, geometry_.canonical(corner.contact));
    if (!end || glm::distance(geometry_.point(own), corner.x) <= extent) return corner;
    const double depth = search_.place_extent() > 0 ? map_.resolution : geometry_.tie();
    for (int k = 0; k < places_along; ++k) {
      Contact between = own;
      between.u = glm::mix(own.u, *end, double(k) / places_along);
      if (glm::dot(geometry_.point(between), n) < corner.h - depth) return corner;
    }
    const dvec3 x = geometry_.point(own);
    return {own, x, glm::dot(x, n)};
  }

  /// The parameter of a contact on a straight edge's piece. Of what is rounded its vertices are
  /// apart: sides of facets that are level to within the resolution end there.
  std::optional<double> place_on(const Contact& edge, const Contact& c) const {
    const bool is_straight = edge.kind == SourceKind::edge && geometry_.is_straight(edge);
    if (!is_straight || c.instance != edge.instance) return std::nullopt;
    if (same_element(edge, c)) return c.u;
    if (search_.place_extent() > 0) return std::nullopt;
    const std::array<int, 2>& ends = geometry_.piece(edge).end_vertex;
    for (const int end : {0, 1}) {
      if (c.kind == SourceKind::vertex && c.element == ends[std::size_t(end)]) return end;
    }
    return std::nullopt;
  }

  /// Its cells are left so: what is between arcs that leave it is not told.
  bool is_undecided(const MapGraph::Node& node) const {
    return std::any_of(node.cells.begin(), node.cells.end(), [&](int k) {
      return map_.cells[std::size_t(k)].kind == MapCellKind::undecided;
    });
  }

  /// Where the arc before a corner has its contact elsewhere in the plane the facet runs from there
  /// to the corner along a straight border.
  void run_to(const ClimbedContact& corner, const MapGraph::End& before, FacetNode& facet) const {
    const Contact& beside = known_.ruling_at(before).contact[contact_beside(before, 1)];
    const ClimbedContact c = corner_beside(beside, climb(geometry_, beside, facet.n), facet.n);
    if (c.h < corner.h - geometry_.tie()) return;
    if (glm::distance(c.x, corner.x) <= map_.contact_extent()) return;
    for (const EdgeStretch& s :
         pieces_between(geometry_, c.contact, corner.contact, map_.resolution)) {
      facet.contacts.push_back(s.at(s.from));
      facet.points.push_back(geometry_.point(s.at(s.from)));
      facet.sides.push_back(s);
    }
  }

  /// Contacts between arcs that follow each other are its corners. `other`: what it is where these
  /// lie in no plane.
  FacetNode of_corners(const MapGraph::Node& node, std::optional<FacetNode> other) {
    const NodeCorners corners = corners_of(known_, node, map_);
    TouchingPlane plane = plane_of(node, corners);
    if (plane.in_line) {
      plane = turned_to_part(geometry_, query_, plane, corners.contacts, corners.beside,
                             map_.resolution);
    }
    if (has_merged(plane, corners)) plane = with_corners_apart(plane, corners);
    if (plane.off() > map_.resolution) {
      if (other) return *std::move(other);
      fail(plane.n, "the contacts of a facet lie in no plane");
    }
    FacetNode facet;
    facet.n = plane.n;
    for (std::size_t k = 0; k < plane.contacts.size(); ++k) {
      const ClimbedContact c = corner_beside(corners.contacts[k], plane.contacts[k], plane.n);
      if (is_undecided(node)) {
        run_to(c, node.ends[(k + node.ends.size() - 1) % node.ends.size()], facet);
      }
      facet.contacts.push_back(c.contact);
      facet.points.push_back(c.x);
      facet.sides.emplace_back();
    }
    if (!facet.has_curved_side()) facet.sides.clear();
    facet.slots.assign(facet.contacts.size(), {});
    return facet;
  }

  /// The side of a facet across which each of the node's arcs leaves: they follow each other as the
  /// sides do that are not curved; a crossing has them in the arcs' order.
  std::vector<std::size_t> sides_of(const FacetNode& facet, const MapGraph::Node& node) const {
    std::vector<std::size_t> straight;
    for (std::size_t k = 0; k < facet.points.size(); ++k) {
      if (!facet.is_curved(k)) straight.push_back(k);
    }
    const std::size_t count = node.ends.size();
    if (straight.size() != count || count == 0) return {};
    if (facet.is_crossing) return straight;
    const auto gap = [&](std::size_t end, std::size_t side) {
      const Ruling& r = known_.ruling_at(node.ends[end]);
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

  /// The plane with normal n touches the contact's element there.
  bool is_level(const Contact& c, const dvec3& n) const {
    const ContactJet j = geometry_.jet(c);
    const double slope = std::max(search_.place_extent(), exact_slope);
    return std::all_of(j.dx.begin(), j.dx.begin() + j.dimension, [&](const dvec3& dx) {
      return std::abs(glm::dot(dx, n)) <= std::max(slope * glm::length(dx), geometry_.rounding());
    });
  }

  /// The ruling in which an arc begins or ends at a node, with its side, told in the elements of
  /// the next one as far as it lies on these and touches them; none at free ends.
  std::optional<Ruling> plug(int arc, int end, const Ruling& beside) {
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
    for (const std::size_t i : {0u, 1u}) {
      const auto own = expressed_in(geometry_, r.contact[i], beside.contact[i]);
      if (own && is_level(*own, r.n)) r.contact[i] = *own;
    }
    return r;
  }

  /// Where other contacts of a node are higher, what cells tell beside it is none of the arc's.
  void drop_beyond_node(std::vector<Ruling>& known, int end) {
    const auto is_beyond = [&](const Ruling& r) {
      const double height = std::min(glm::dot(r.point[0], r.n), glm::dot(r.point[1], r.n));
      return query_(r.n, r.contact[0]).h - height > map_.resolution;
    };
    while (known.size() > 1 && is_beyond(end == 0 ? known.front() : known.back())) {
      known.erase(end == 0 ? known.begin() : known.end() - 1);
    }
  }

  /// What cells tell of other sides of a facet, or across it, is none of the arc's that leaves it:
  /// in its plane to within the resolution, and nearer to other corners.
  void drop_in_facet(std::vector<Ruling>& known, int end, const FacetNode& facet,
                     const Ruling& side) const {
    const auto is_other = [&](const Ruling& r) {
      for (const std::size_t i : {0u, 1u}) {
        const double depth = glm::dot(facet.points.front() - r.point[i], facet.n);
        if (std::abs(depth) > map_.resolution) return false;
      }
      for (const std::size_t i : {0u, 1u}) {
        const double own = glm::distance(r.point[i], side.point[i]);
        for (const dvec3& corner : facet.points) {
          if (glm::distance(r.point[i], corner) < own) return true;
        }
      }
      return false;
    };
    while (known.size() > 1 && is_other(end == 0 ? known.front() : known.back())) {
      known.erase(end == 0 ? known.begin() : known.end() - 1);
    }
  }

  void solve(std::size_t k) {
    const double solved = double(k) / double(known_.graph.arcs.size());
    progress_.update("trace", glm::mix(facets_share, 1.0, solved));
    const MapGraph::Arc& told = known_.graph.arcs[k];
    std::vector<Ruling> known = known_.rulings[k];
    if (known.empty()) return graph_.arcs.push_back({});  // it is part of another one
    SeparatingArc arc;
    arc.closed = told.is_closed();
    std::array<bool, 2> merges = {false, false};
    std::array<std::optional<Ruling>, 2> plugs;
    for (const int end : {0, 1}) {
      if (arc.closed) break;
      arc.facet[std::size_t(end)] = number_[std::size_t(told.node[std::size_t(end)])];
      if (arc.facet[std::size_t(end)] >= 0) drop_beyond_node(known, end);
      const Ruling& next = end == 0 ? known.front() : known.back();
      std::optional<Ruling> r = plug(int(k), end, next);
      const bool crosses = r && graph_.nodes[std::size_t(arc.facet[std::size_t(end)])].is_crossing;
      merges[std::size_t(end)] = !r || crosses;
      if (crosses) plugs[std::size_t(end)] = std::exchange(r, std::nullopt);
      if (r) drop_close_to_pole(geometry_, *r, known, end);
      if (r) {
        drop_in_facet(known, end, graph_.nodes[std::size_t(arc.facet[std::size_t(end)])], *r);
      }
      if (r) known.insert(end == 0 ? known.begin() : known.end(), *r);
    }
    if (arc.closed) known.push_back(known.front());
    ArcSolver solver(search_, known.front());
    const int before = divisions_;
    for (std::size_t i = 1; i < known.size() && !is_spent(); ++i) {
      solver.go_on(known[i]);
      divisions_ = before + solver.divisions();
    }
    arc.pieces = solver.take();
    for (const int end : {1, 0}) {
      if (!merges[std::size_t(end)]) continue;
      std::optional<Ruling>& crossing = plugs[std::size_t(end)];
      if (crossing && end == 0) *crossing = reversed(*crossing);
      if (end == 0) reverse(arc.pieces);
      merge(search_, arc.pieces, crossing);
      if (end == 0) reverse(arc.pieces);
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

  /// In a crossing both contacts are in one place, to within the resolution.
  void join_in_crossings(SeparatingArc& arc) const {
    for (const int end : {0, 1}) {
      const int facet = arc.facet[std::size_t(end)];
      if (facet < 0 || !graph_.nodes[std::size_t(facet)].is_crossing) continue;
      Ruling& r = end == 0 ? arc.pieces.front().rulings.front() : arc.pieces.back().rulings.back();
      r.point.fill(graph_.nodes[std::size_t(facet)].points.front());
    }
  }

  /// Leaves out arcs that lead back, or are parts of others.
  void drop_arcs() {
    std::vector<int> number;
    int count = 0;
    for (const SeparatingArc& arc : graph_.arcs) number.push_back(leads_back(arc) ? -1 : count++);
    std::erase_if(graph_.arcs, [&](const SeparatingArc& arc) { return leads_back(arc); });
    for (FacetNode& node : graph_.nodes) {
      for (FacetNode::Slot& slot : node.slots) {
        if (slot.arc >= 0) slot.arc = number[std::size_t(slot.arc)];
      }
    }
  }

  /// It begins and ends in one free end: cells beside that were taken for an arc.
  bool leads_back(const SeparatingArc& arc) const {
    if (arc.pieces.empty()) return true;
    if (arc.closed || arc.facet[0] >= 0 || arc.facet[1] >= 0) return false;
    const Ruling& first = arc.pieces.front().rulings.front();
    const Ruling& last = arc.pieces.back().rulings.back();
    return glm::distance(first.n, last.n) <= same_contact &&
           glm::distance(first.point[0], last.point[0]) <= same_contact;
  }

  const ContactGeometry& geometry_;
  SupportQuery& query_;
  const DirectionMap& map_;
  ContactSystem system_;
  RulingSearch search_;
  const double place_depths_;
  const Progress& progress_;
  KnownArcs known_;
  const int most_divisions_;
  std::vector<int> number_;  // of a told node in the graph, -1: a free end
  SeparatingGraph graph_;
  int divisions_ = 0;
};

}  // namespace

SeparatingGraph solved_graph(const ContactGeometry& geometry, SupportQuery& query,
                             const DirectionMap& map, const Progress& progress,
                             double place_depths) {
  return GraphSolver(geometry, query, map, place_depths, progress).run();
}

}  // namespace taut
