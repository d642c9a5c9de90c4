#include "taut/hull/trace/separating_graph.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <set>
#include <span>

#include "taut/bounds/contact_forms.h"
#include "taut/bounds/scene_content.h"
#include "taut/hull/contact/contact_planes.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/contact/facet_contacts.h"
#include "taut/hull/contact/in_line_contacts.h"
#include "taut/hull/contact/level_sides.h"
#include "taut/hull/contact/supporting_poles.h"
#include "taut/hull/polytope/point_hull.h"
#include "taut/hull/trace/arc_pieces.h"
#include "taut/hull/trace/arc_tracer.h"
#include "taut/hull/trace/edge_stretches.h"
#include "taut/hull/trace/edge_touches.h"
#include "taut/hull/trace/free_end_seeds.h"
#include "taut/hull/trace/free_ends.h"
#include "taut/hull/trace/graph_builder.h"
#include "taut/hull/trace/level_way.h"
#include "taut/hull/trace/map_crossings.h"
#include "taut/hull/trace/map_support.h"
#include "taut/hull/trace/partings.h"
#include "taut/hull/trace/plane_corners.h"
#include "taut/hull/trace/surface_seeds.h"

namespace taut {
namespace {

/// Directions so near to each other are not parted any further.
constexpr double narrow = 1e-9;
/// Cosine below which two directions are too far apart for a great arc between them.
constexpr double nearly_opposite = -0.9;
/// Share of the angle between two directions that a search between them leaves on either side.
constexpr double least_part = 0.05;
/// Weight by which a direction between two keeps clear of a plane's between them.
constexpr double beside_plane = 1.25;
/// Slopes of edges at vertices, which support in directions that are not level too, that are zero.
constexpr double vertex_slope = 1e-10;
/// Turn, in radians, from a free end to where its curve's contacts have parted.
constexpr double end_step = 1e-3;
/// Spots that are left unresolved before the search is given up.
constexpr std::size_t failure_limit = 64;
/// Cells of support queries after which it is given up, too, and how many more a sample and a
/// refined cell may take, hundreds of times what generic models do, some seconds.
constexpr long cells_of_search = 5'000'000;
constexpr long cells_a_place = 2'000;
/// The same of jets of contacts: of those that came out whole none took 900 a sample.
constexpr long jets_of_search = 1'000'000;
constexpr long jets_a_place = 2'000;
/// Once so many are spent, not more than so many a query, half as many again as it takes on the
/// worst models that came out whole: where they cost more there is next to nothing that parts
/// contacts from each other.
constexpr long cells_before_rate = 1'000'000;
constexpr long search_cells_a_query = 400;
/// Culled cells, at least, the sides of which are looked at together.
constexpr std::ptrdiff_t cells_at_a_time = 128;
constexpr int depth_limit = 40;
/// The circle about a pole's normal on which curves are sought.
constexpr double circle_radius = 2e-4;
constexpr int circle_samples = 64;
constexpr int circle_halvings = 10;
/// Levels by which mixed cells are refined that no curve crosses, at least, and at most while that
/// leaves fewer of them.
constexpr int least_refinements = 3;
constexpr int most_refinements = 8;
/// Not more than so many cells at a time.
constexpr std::size_t refined_cells = 32768;
/// More than so many are not refined again that a level has made this many times more: nothing
/// decides cells along lines, of which there are twice as many a level.
constexpr std::size_t few_cells = 2048;
constexpr double line_growth = 1.5;
/// Part of its size within which a curve beside a refined cell accounts for it.
constexpr double refined_margin = 1;

/// The cells that a parabolic curve may reach. Contacts merge on none of the others, nor on their
/// borders: there the surface is curved one way, and where it is not on the far side of a join,
/// that is another cell's.
std::vector<CulledCell> not_definite(const std::vector<CulledCell>& cells) {
  std::vector<CulledCell> result;
  std::copy_if(cells.begin(), cells.end(), std::back_inserter(result),
               [](const CulledCell& cell) { return !cell.definite; });
  return result;
}

/// The support with contacts in their canonical form, on edges and seams where they are exactly,
/// and at vertices that its direction does not tell from where they are.
CommonSupport settled_at_vertices(const ContactGeometry& geometry, CommonSupport s) {
  for (int i = 0; i < s.count; ++i) {
    Contact& c = s.contact[std::size_t(i)];
    c = geometry.canonical(c);
    const std::optional<Contact> end = at_level_border(geometry, c, s.n, vertex_slope);
    if (!end) continue;
    const Contact vertex = geometry.canonical(*end);
    if (vertex.kind == SourceKind::vertex) c = vertex;
  }
  s.evaluate(geometry);
  return s;
}

/// The support with contacts of faces on the edges and seams beside them that are as high: where
/// faces are level across these, support values do not tell the two places apart.
CommonSupport on_tied_edges(const ContactGeometry& geometry, CommonSupport s) {
  for (int i = 0; i < s.count; ++i) {
    Contact& c = s.contact[std::size_t(i)];
    if (const std::optional<EdgeBeside> beside = tied_edge(geometry, c, s.n)) c = beside->edge;
  }
  s.evaluate(geometry);
  return s;
}

class GraphTracer {
 public:
  GraphTracer(const ContactGeometry& geometry, SupportQuery& query, const Progress& progress)
      : geometry_(geometry),
        system_(geometry),
        query_(query),
        progress_(progress),
        built_(system_) {}

  SeparatingGraph run(const std::vector<Sample>& samples, const std::vector<CulledCell>& cells,
                      const CurveSearch& search);

 private:
  static constexpr int no_node = -2;
  void find_planes(const std::vector<Sample>& samples);
  void find_poles();
  void find_touches(const std::vector<CulledCell>& cells);
  void add_landmark(const Landmark& landmark);
  void add_pole(const SupportingPole& pole);
  bool is_in_plane(const dvec3& n) const;
  void find_settled(const std::vector<CulledCell>& cells);
  bool is_settled(const Contact& c) const;
  void part_samples(const std::vector<Sample>& samples);
  void part(const SupportSample& a, const SupportSample& b, int depth);
  void part_about(const SupportingPole& pole);
  void part_closely(const SupportSample& a, const SupportSample& b, int depth);
  void part_cells(const std::vector<CulledCell>& cells);
  void part_sides(std::span<const CulledCell> cells);
  void part_beside(const FreeEnd& end);
  void search_cells(const std::vector<CulledCell>& cells);
  void search_map(const DirectionMap& map);
  void trace(const CommonSupport& seed);
  void trace_both_ways(const CommonSupport& seed);
  void trace_waiting();
  void trace_from(int node, std::size_t side);
  int node_of(const dvec3& n, const std::vector<Contact>& contacts);
  int node_at(const TracedArc& traced);
  int add_node(const dvec3& n, FacetContacts facet);
  bool is_facet(const CommonSupport& seed);
  bool given_up();
  void tell_failures();

  const ContactGeometry& geometry_;
  ContactSystem system_;
  SupportQuery& query_;
  const Progress& progress_;
  GraphBuilder built_;
  long cells_before_ = 0;  // of the query, before
  long queries_before_ = 0;
  long jets_before_ = 0;
  long places_ = 0;  // samples and refined cells
  bool given_up_ = false;
  bool exhausted_ = false;  // and therefore given up
  long cells_searched_ = 0;
  long refinement_queries_ = 0;
  std::set<std::pair<int, int>> settled_;  // instances and patches
  std::vector<TouchedStretch> stretches_;
  std::vector<Landmark> landmarks_;
  std::vector<SupportingPole> poles_;
  std::vector<int> waiting_;             // nodes whose slots may be open
  std::map<int, const char*> not_left_;  // nodes with sides across which no curve was found
  std::vector<std::pair<CommonSupport, const char*>> failed_;  // starts that led nowhere
};

/// Whether there is too much that cannot be resolved, or it costs too much. Counted in the cells of
/// support queries and in jets, so that the same is given up each time.
bool GraphTracer::given_up() {
  if (given_up_) return true;
  const long cells = query_.cells() - cells_before_;
  const long queries = query_.queries() - queries_before_;
  const long jets = geometry_.evaluations() - jets_before_;
  exhausted_ = cells > std::min(cells_of_search + cells_a_place * places_,
                                cells_before_rate + search_cells_a_query * queries) ||
               jets > jets_of_search + jets_a_place * places_;
  if (exhausted_) {
    built_.fail(dvec3(0.0),
                "the search for separating curves was given up, as too many contacts all but tie");
  }
  given_up_ = exhausted_ || built_.graph().unresolved.size() + failed_.size() >= failure_limit;
  return given_up_;
}

/// Planes with contact along whole curves.
void GraphTracer::find_planes(const std::vector<Sample>& samples) {
  for (const ContactPlane& plane : contact_planes(geometry_, query_, samples)) {
    std::optional<FacetContacts> f = facet_contacts(geometry_, query_, plane.n, {}, plane.pieces);
    if (!f || !f->is_facet()) {
      built_.fail(plane.n, "the outline of a facet with curved sides is not found");
      continue;
    }
    *f = with_stretches(geometry_, plane.n, *f, stretches_);
    // All of the curves touches the plane, its outline or not.
    for (const Contact& c : plane.pieces) {
      built_.add_contact({c.instance, c.element, 0, 1});
    }
    add_landmark({plane.n, *f});
  }
}

/// Whether it is the normal of a plane with contact along a curve: all of the curve supports in it.
bool GraphTracer::is_in_plane(const dvec3& n) const {
  return std::any_of(landmarks_.begin(), landmarks_.end(), [&](const Landmark& l) {
    return l.facet.is_curved() && glm::distance(l.n, n) < same_plane;
  });
}

/// Poles that support, and the facets at whose corners they are.
void GraphTracer::find_poles() {
  for (const SupportingPole& pole : supporting_poles(geometry_, query_)) {
    add_pole(pole);
    if (is_landmark(landmarks_, pole.n)) continue;
    const std::optional<Landmark> facet = facet_at_pole(geometry_, query_, pole);
    if (facet) add_landmark(*facet);
  }
}

/// Where planes that turn about straight edges touch the faces beside them.
void GraphTracer::find_touches(const std::vector<CulledCell>& cells) {
  for (const auto& touches :
       {edge_touches(geometry_, query_, cells), edge_stretches(geometry_, query_, stretches_)}) {
    for (const Landmark& touch : touches) {
      if (!is_landmark(landmarks_, touch.n)) add_landmark(touch);
    }
  }
}

void GraphTracer::add_landmark(const Landmark& landmark) {
  landmarks_.push_back(landmark);
  add_node(landmark.n, landmark.facet);
}

/// Once for all patches that meet in it.
void GraphTracer::add_pole(const SupportingPole& pole) {
  const dvec3 x = geometry_.point(pole.contact);
  const bool known = std::any_of(poles_.begin(), poles_.end(), [&](const SupportingPole& other) {
    return glm::distance(other.n, pole.n) < same_plane &&
           glm::distance(geometry_.point(other.contact), x) < same_branch_distance;
  });
  if (!known) poles_.push_back(pole);
}

/// Stand-ins all cells of which are on: what they have of branches is not the surface's.
void GraphTracer::find_settled(const std::vector<CulledCell>& cells) {
  const SceneContent& content = geometry_.scene().content();
  std::set<std::pair<int, int>> left;
  for (const CulledCell& c : cells) {
    const ScenePart& part = content.part_of(c.instance);
    const int element = part.element_of_patch[std::size_t(c.patch)];
    if (!part.elements[std::size_t(element)].stand_in) continue;
    (c.state == CellState::on ? settled_ : left).emplace(c.instance, c.patch);
  }
  for (const auto& place : left) settled_.erase(place);
}

bool GraphTracer::is_settled(const Contact& c) const {
  return c.kind == SourceKind::face && settled_.count({c.instance, c.element}) > 0;
}

/// Finds and traces the curves that the great arc between two support_samples crosses.
void GraphTracer::part(const SupportSample& a, const SupportSample& b, int depth) {
  if (given_up() || is_settled(a.contact) || is_settled(b.contact)) return;
  if (same_branch(geometry_, a, b)) return;
  if (depth > depth_limit || glm::distance(a.n, b.n) < narrow) {
    if (level_way(geometry_, a.contact, b.contact, a.n)) return;
    // Two samples on the curve itself.
    CommonSupport tie;
    tie.n = a.n;
    tie.add(geometry_, a.contact);
    tie.add(geometry_, b.contact);
    if (glm::distance(a.n, b.n) < narrow && std::abs(glm::dot(tie.d(), a.n)) < geometry_.tie()) {
      if (!built_.is_traced(tie)) trace(tie);
    } else {
      failed_.emplace_back(tie, "two contacts that are not joined are not parted either");
    }
    return;
  }
  if (glm::dot(a.n, b.n) < nearly_opposite) {  // no great arc to speak of
    const SupportSample aside = seen(geometry_, query_, tangent_frame(a.n)[0], a.contact);
    part(a, aside, depth + 1);
    part(aside, b, depth + 1);
    return;
  }
  const std::optional<CommonSupport> seed = parting(geometry_, a, b);
  if (seed && built_.is_traced(*seed)) return;
  // A direction that is nearly one of the two would not make the search narrower.
  const double least = least_part * glm::distance(a.n, b.n);
  const bool divides =
      seed && glm::distance(seed->n, a.n) > least && glm::distance(seed->n, b.n) > least;
  if (seed && !divides) {
    const SupportSample there = seen(geometry_, query_, seed->n, seed->contact[0]);
    if (glm::dot(there.x, seed->n) <= glm::dot(seed->jet[0].x, seed->n) + geometry_.tie()) {
      trace(*seed);
      return;
    }
  }
  dvec3 n = divides ? seed->n : glm::normalize(a.n + b.n);
  if (is_in_plane(n)) n = glm::normalize(a.n + beside_plane * b.n);
  const SupportSample middle = seen(geometry_, query_, n, a.contact);
  if (divides && glm::dot(middle.x, n) <= glm::dot(seed->jet[0].x, n) + geometry_.tie()) {
    trace(*seed);
    return;
  }
  part(a, middle, depth + 1);
  part(middle, b, depth + 1);
}

/// Finds and traces the curves between every two neighbours on the samples' polytope.
void GraphTracer::part_samples(const std::vector<Sample>& samples) {
  if (given_up()) return;
  std::vector<SupportSample> support_samples;
  std::vector<dvec3> points;
  Box box;
  for (const Sample& s : samples) {
    if (is_in_plane(s.n) || is_settled(s.contact)) continue;
    const Contact c = at_rest(geometry_, s.contact, s.n);
    const dvec3 x = geometry_.point(c);
    box.include(x);
    points.push_back(x);
    support_samples.push_back({s.n, c, x});
  }
  PointHull hull(box);
  hull.add(points);
  for (const PointHull::Facet& f : hull.facets()) {
    if (!f.alive || given_up()) continue;
    progress_.check();
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = f.vertex[k];
      const int b = f.vertex[(k + 1) % 3];
      if (a < b) part(support_samples[std::size_t(a)], support_samples[std::size_t(b)], 0);
    }
  }
}

/// Finds and traces the curves that begin in a pole: they cross a small circle about its normal.
void GraphTracer::part_about(const SupportingPole& pole) {
  if (given_up()) return;
  const std::array<dvec3, 2> frame = tangent_frame(pole.n);
  std::vector<SupportSample> circle;
  circle.reserve(circle_samples);
  for (int k = 0; k < circle_samples; ++k) {
    const double angle = 2 * std::numbers::pi * k / circle_samples;
    const dvec3 aside = std::cos(angle) * frame[0] + std::sin(angle) * frame[1];
    circle.push_back(
        seen(geometry_, query_, glm::normalize(pole.n + circle_radius * aside), pole.contact));
  }
  for (std::size_t k = 0; k < circle.size(); ++k) {
    part_closely(circle[k], circle[(k + 1) % circle.size()], circle_halvings);
  }
}

/// Halfway between two whose contacts are farther apart than to first order, the two branches may
/// be there only near the curve: a climb from farther off would lead from the one to the other.
void GraphTracer::part_closely(const SupportSample& a, const SupportSample& b, int depth) {
  if (depth == 0 || given_up() || (is_near(geometry_, a, b) && is_near(geometry_, b, a))) {
    part(a, b, 0);
    return;
  }
  const SupportSample middle = seen(geometry_, query_, glm::normalize(a.n + b.n), a.contact);
  part_closely(a, middle, depth - 1);
  part_closely(middle, b, depth - 1);
}

/// Finds and traces the curves that cross the sides of mixed cells.
void GraphTracer::part_cells(const std::vector<CulledCell>& cells) {
  const auto same_patch = [](const CulledCell& a, const CulledCell& b) {
    return a.instance == b.instance && a.patch == b.patch;
  };
  for (auto begin = cells.begin(); begin != cells.end() && !given_up();) {
    auto end = begin + std::min(cells.end() - begin, cells_at_a_time);
    end = std::find_if_not(end, cells.end(),
                           [&](const CulledCell& cell) { return same_patch(cell, *(end - 1)); });
    part_sides({begin, end});
    begin = end;
  }
}

/// Of these cells. @pre all cells of their patches are among them
void GraphTracer::part_sides(std::span<const CulledCell> cells) {
  for (const SupportChange& change : support_changes(geometry_, query_, cells)) {
    if (given_up()) break;
    if (built_.is_crossed(change)) continue;
    const std::optional<CommonSupport> seed = separating_seed(system_, query_, change);
    if (seed && !built_.is_traced(*seed) && !built_.lies_in_facet(*seed) &&
        !built_.is_at_facet(*seed))
      trace(*seed);
  }
}

/// Seeks the curve that ends in the free end: from two contacts that have parted from it, or
/// between directions to both sides of it.
void GraphTracer::part_beside(const FreeEnd& end) {
  bool reached = false;
  visit_parted(system_, query_, end, [&](const CommonSupport& seed) {
    if (built_.is_traced(seed)) return false;
    trace(seed);
    reached = built_.is_reached(end);
    return reached;
  });
  if (reached) return;
  const dvec3 ahead = glm::cross(end.n, end.along);
  for (const double sense : {1.0, -1.0}) {
    const auto beside = [&](double side) {
      return seen(
          geometry_, query_,
          glm::normalize(end.n + sense * end_step * ahead + side * end_step * end_step * end.along),
          end.contact);
    };
    part(beside(1), beside(-1), 0);
  }
}

/// Seeks what the mixed cells hide through which no curve runs: decides them further, and where
/// that fails looks for curves across their sides, and in the end for free ends in them.
void GraphTracer::search_cells(const std::vector<CulledCell>& cells) {
  std::vector<CulledCell> left = built_.uncrossed(cells, 0);
  CellRefinement refinement(geometry_.scene(), progress_.stop);
  bool fewer = true;
  for (int level = 1; !left.empty() && !given_up(); ++level) {
    if (level > least_refinements && (!fewer || level > most_refinements)) break;
    if (left.size() > refined_cells) break;
    progress_.check();
    const std::size_t count = left.size();
    left = built_.uncrossed(refinement.refined(left), refined_margin);
    places_ += long(left.size());
    part_cells(left);
    left = built_.uncrossed(left, refined_margin);
    fewer = left.size() < count;
    if (left.size() > few_cells && double(left.size()) > line_growth * double(count)) break;
  }
  if (!given_up()) {
    for (const FreeEnd& end : free_ends(geometry_, query_, not_definite(left))) {
      if (!given_up() && !built_.is_reached(end)) part_beside(end);
    }
  }
  refinement_queries_ = refinement.support_queries();
  cells_searched_ = long(built_.uncrossed(left, refined_margin).size());
}

/// Seeks the curves that the map tells and that were not met: between corners of its cells at which
/// different contacts support.
void GraphTracer::search_map(const DirectionMap& map) {
  MapCrossings crossings(map);
  // About a free end, heights differ by the fourth power of how far two contacts have parted.
  const double untold = std::sqrt(std::sqrt(geometry_.tie()));
  MapSupport support(geometry_, query_, std::max(map.contact_extent(), untold));
  std::size_t known = 0;
  for (std::size_t k = 0; k < map.cells.size() && !given_up(); ++k) {
    for (; known < built_.graph().arcs.size(); ++known) crossings.add(built_.graph().arcs[known]);
    const MapCell& cell = map.cells[k];
    if (cell.contacts.size() < 2 || crossings.crosses(int(k))) continue;
    progress_.check();
    for (const auto& [a, b] : support.partings(cell)) part(a, b, 0);
  }
}

/// The facet node of a plane, a new one if there is none yet; no_node if its contacts cannot be
/// told.
int GraphTracer::node_of(const dvec3& n, const std::vector<Contact>& contacts) {
  if (const std::optional<int> known = built_.node_of(n, contacts)) return *known;
  std::optional<FacetContacts> f = facet_contacts(geometry_, query_, n, contacts);
  if (f) return add_node(n, std::move(*f));
  built_.fail(n, "a plane has contact along a curve");
  return no_node;
}

/// The node in which a curve ends that was traced.
int GraphTracer::node_at(const TracedArc& traced) {
  if (traced.end == TracedArc::End::merged) return GraphBuilder::free_end;
  if (traced.end == TracedArc::End::plane) return node_of(traced.n, traced.contacts);
  return built_.crossing_at(traced.n, traced.contacts.front());
}

/// Curves leave it across its sides.
int GraphTracer::add_node(const dvec3& n, FacetContacts facet) {
  waiting_.push_back(built_.add_node(n, std::move(facet)));
  return waiting_.back();
}

/// Whether the seed is a facet, with other contacts beside the two: a node for it, if it is new.
bool GraphTracer::is_facet(const CommonSupport& seed) {
  if (built_.is_facet(seed)) return true;
  const std::vector<Contact> contacts(seed.contact.begin(), seed.contact.begin() + seed.count);
  std::optional<FacetContacts> f = facet_contacts(geometry_, query_, seed.n, contacts);
  if (!f || !f->is_facet()) return false;
  add_node(seed.n, std::move(*f));
  return true;
}

/// Traces the curve through a seed, from the first to the last of contacts in line. None where
/// support values do not tell the two contacts apart: the curve, if it goes on to where they do, is
/// found there.
void GraphTracer::trace(const CommonSupport& seed) {
  const CommonSupport settled =
      settled_in_plane_corners(geometry_, query_, settled_at_vertices(geometry_, seed));
  if (built_.is_traced(settled)) return;
  if (level_way(geometry_, settled.contact[0], settled.contact[1], settled.n)) return;
  const std::optional<CommonSupport> wide = widened(geometry_, query_, settled);
  if (!wide) {
    trace_both_ways(settled);
  } else if (!built_.is_traced(*wide)) {
    trace_both_ways(*wide);
  }
}

/// Both ways unless it closes.
void GraphTracer::trace_both_ways(const CommonSupport& seed) {
  // In a facet itself the curve, if there is one, leads one way only.
  const auto lost = [&](const char* reason) {
    if (is_facet(seed)) {
      trace_waiting();
    } else {
      failed_.emplace_back(seed, reason);
    }
  };
  TracedArc ahead = trace_arc(system_, query_, seed, landmarks_, progress_);
  if (ahead.end == TracedArc::End::lost) {
    lost(ahead.reason);
    return;
  }
  SeparatingArc arc;
  if (ahead.end == TracedArc::End::closed) {
    arc.closed = true;
    arc.pieces = std::move(ahead.pieces);
    // It begins in the middle of a piece.
    if (arc.pieces.size() > 1 &&
        same_elements(arc.pieces.back().rulings.back(), arc.pieces.front().rulings.front())) {
      std::vector<ArcPiece> first;
      first.push_back(std::move(arc.pieces.front()));
      arc.pieces.erase(arc.pieces.begin());
      append(arc.pieces, std::move(first));
    }
    built_.add(std::move(arc));
    return;
  }
  CommonSupport turned = seed;
  std::swap(turned.contact[0], turned.contact[1]);
  std::swap(turned.jet[0], turned.jet[1]);
  TracedArc behind = trace_arc(system_, query_, turned, landmarks_, progress_);
  if (behind.end == TracedArc::End::lost || behind.end == TracedArc::End::closed) {
    lost(behind.end == TracedArc::End::lost ? behind.reason
                                            : "a separating curve closes one way only");
    return;
  }
  const int begin = node_at(behind);
  const int end = node_at(ahead);
  if (begin == no_node || end == no_node) return;
  if (begin == end && begin != GraphBuilder::free_end &&
      glm::distance(ahead.n, seed.n) < same_plane && glm::distance(behind.n, seed.n) < same_plane) {
    trace_waiting();  // two contacts of a facet that share no side
    return;
  }
  // A facet has one curve across each side: this one is there already.
  if (built_.is_taken(begin, behind.pieces) || built_.is_taken(end, ahead.pieces)) return;
  reverse(behind.pieces);
  arc.pieces = std::move(behind.pieces);
  append(arc.pieces, std::move(ahead.pieces));
  drop_empty_pieces(geometry_, arc.pieces);
  const int index = built_.add(std::move(arc));
  built_.connect(index, 0, begin);
  built_.connect(index, 1, end);
  trace_waiting();
}

/// Traces the arcs that leave facets across sides where none was met yet.
void GraphTracer::trace_waiting() {
  while (!waiting_.empty() && !given_up()) {
    const int node = waiting_.back();
    waiting_.pop_back();
    for (std::size_t i = 0; i < built_.node(node).contacts.size() && !given_up(); ++i) {
      const FacetNode& own = built_.node(node);
      if (own.slots[i].arc < 0 && !own.is_curved(i)) trace_from(node, i);
    }
  }
}

void GraphTracer::trace_from(int node, std::size_t side) {
  const FacetNode& own = built_.node(node);
  CommonSupport start;
  start.n = own.n;
  start.add(geometry_, own.contacts[side]);
  start.add(geometry_, own.contacts[(side + 1) % own.contacts.size()]);
  TracedArc traced = trace_arc(system_, query_, start, landmarks_, progress_);
  const bool stays =
      traced.end == TracedArc::End::plane && glm::distance(traced.n, start.n) < same_plane;
  if (stays || traced.end == TracedArc::End::lost) {
    traced = trace_arc(system_, query_, start, landmarks_, progress_, true);
  }
  if (traced.end == TracedArc::End::lost || traced.end == TracedArc::End::closed) {
    // It may yet arrive from its other end.
    not_left_[node] = traced.end == TracedArc::End::lost
                          ? traced.reason
                          : "a separating curve returns into its facet";
    return;
  }
  const int end = node_at(traced);
  if (end == no_node) return;
  SeparatingArc arc;
  arc.pieces = std::move(traced.pieces);
  const int index = built_.add(std::move(arc));
  built_.connect(index, 0, node);
  built_.connect(index, 1, end);
}

SeparatingGraph GraphTracer::run(const std::vector<Sample>& samples,
                                 const std::vector<CulledCell>& cells, const CurveSearch& search) {
  cells_before_ = query_.cells();
  queries_before_ = query_.queries();
  jets_before_ = geometry_.evaluations();
  places_ = long(samples.size());
  find_settled(cells);
  stretches_ = touched_stretches(geometry_, query_, cells);
  find_planes(samples);
  find_poles();
  find_touches(cells);
  trace_waiting();
  part_cells(cells);
  for (const SupportingPole& pole : poles_) part_about(pole);
  part_samples(samples);
  if (search.map != nullptr) search_map(*search.map);
  if (search.cells) search_cells(cells);
  tell_failures();
  SeparatingGraph graph = built_.take();
  graph.cells_searched = cells_searched_;
  graph.exhausted = exhausted_;
  graph.newton_iterations = system_.iterations();
  graph.support_queries = refinement_queries_;
  return graph;
}

/// Starts that led nowhere, unless others led to the curve or facet there; and sides of facets that
/// no curve leaves across.
void GraphTracer::tell_failures() {
  for (const auto& [start, reason] : failed_) {
    const bool known = built_.ties_with_facet(start) || built_.lies_in_ruling(start) ||
                       built_.is_traced(start) || built_.is_traced(on_tied_edges(geometry_, start));
    if (!known) built_.fail(start.n, reason);
  }
  for (const auto& [node, reason] : not_left_) {
    if (built_.is_ruling(node)) continue;
    const FacetNode& own = built_.node(node);
    for (std::size_t k = 0; k < own.slots.size(); ++k) {
      if (own.slots[k].arc < 0 && !own.is_curved(k)) built_.fail(own.n, reason);
    }
  }
  if (given_up_ && built_.graph().unresolved.empty()) {
    built_.fail(dvec3(0.0),
                "the search for separating curves was given up after too many that were not found");
  }
}

}  // namespace

SeparatingGraph trace_separating_curves(const ContactGeometry& geometry, SupportQuery& query,
                                        const std::vector<Sample>& samples,
                                        const std::vector<CulledCell>& cells,
                                        const CurveSearch& search, const Progress& progress) {
  return GraphTracer(geometry, query, progress).run(samples, cells, search);
}

}  // namespace taut
