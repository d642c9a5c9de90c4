#include "taut/hull/separating_graph.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>

#include "taut/core/tolerances.h"
#include "taut/hull/arc_pieces.h"
#include "taut/hull/arc_tracer.h"
#include "taut/hull/cell_crossings.h"
#include "taut/hull/contact_exits.h"
#include "taut/hull/contact_planes.h"
#include "taut/hull/facet_contacts.h"
#include "taut/hull/free_ends.h"
#include "taut/hull/point_hull.h"
#include "taut/hull/rulings_between.h"
#include "taut/hull/surface_seeds.h"

namespace taut {
namespace {

/// Contacts within this distance are of one branch.
constexpr double same_branch = 1e-6;
/// Or, far from the origin, within the distance over which heights tie.
double branch_distance(const ContactGeometry& geometry) {
  return std::max(same_branch, std::sqrt(geometry.tie()));
}
/// Directions so near to each other are not parted any further.
constexpr double narrow = 1e-9;
/// Share of its motion by which a contact may miss the first order of it.
constexpr double first_order = 0.2;
/// Cosine below which two directions are too far apart for a great arc between them.
constexpr double nearly_opposite = -0.9;
/// Share of the angle between two directions that a search between them leaves on either side.
constexpr double least_part = 0.05;
/// Weight by which a direction between two keeps clear of a plane's between them.
constexpr double beside_plane = 1.25;
/// Turn, in radians, from a free end to where its curve's contacts have parted.
constexpr double end_step = 1e-3;
/// Distances of two contacts that have parted from a free end, the first that are found count; and
/// how far from the end they are at most, in units of these.
constexpr std::array<double, 4> parted_lengths = {8e-3, 4e-3, 1e-3, 2.5e-4};
constexpr double parted_reach = 64;
/// How far aside from the end they are sought, in the same units: along a join between patches
/// contacts part slowly.
constexpr std::array<double, 7> parted_aside = {0, 4, -4, 12, -12, 32, -32};
/// Free ends that are nearer are one.
constexpr double same_end = 1e-4;
/// Spots that are left unresolved before the search is given up.
constexpr std::size_t failure_limit = 64;
/// Cells of support queries after which it is given up, too: hundreds of times what generic models
/// take, some seconds.
constexpr long least_cells = 5'000'000;
constexpr long cells_a_sample = 2'000;
constexpr int newton_limit = 60;
/// Values of two contacts that differ by so little are equal.
constexpr double parting_tie = 1e-15;
constexpr int depth_limit = 40;
/// A seed lies on a curve that was traced if the curve passes it within this distance.
constexpr double same_curve = 1e-6;
/// Cosine of the angle at which two curves that run into one free end are one.
constexpr double same_approach = 0.999;
/// Chords count as this much longer at both ends, as a share, because the curve turns between them.
constexpr double overlap = 0.2;
/// Normals of facets are the same below this difference.
constexpr double same_plane = 1e-7;
/// Those of facets with curved sides are the same below this one.
constexpr double nearly_same_plane = 1e-5;
/// How far contacts move at most where the direction turns by so much, in the scene's frame.
constexpr double moved_contact = 8;
/// Contacts of curves and their facets that are nearer are the same.
constexpr double rounded_contact = 1e-9;
/// Seeds this near to a facet's normal are where its curves begin.
constexpr double at_facet = 1e-8;
/// Or, far from the origin, below so many times the root of what coordinates are rounded to.
constexpr double root_turn = 10;
/// The circle about a pole's normal on which curves are sought.
constexpr double circle_radius = 2e-4;
constexpr int circle_samples = 64;
constexpr int circle_halvings = 10;
/// Levels by which mixed cells are refined that no curve crosses, at least, and at most while that
/// leaves fewer of them.
constexpr int least_refinements = 3;
constexpr int most_refinements = 8;
/// Part of its size within which a curve beside a refined cell accounts for it.
constexpr double refined_margin = 1;
/// Directions of consecutive rulings are no farther apart.
constexpr double longest_chord = 0.2;

/// Normal of the polygon's mean plane (Newell's).
dvec3 outline_normal(const std::vector<dvec3>& points) {
  dvec3 sum(0.0);
  for (std::size_t k = 1; k + 1 < points.size(); ++k) {
    sum += glm::cross(points[k] - points[0], points[k + 1] - points[0]);
  }
  return unit(sum);
}

class GraphTracer {
 public:
  GraphTracer(const ContactGeometry& geometry, SupportQuery& query, const Progress& progress)
      : geometry_(geometry),
        system_(geometry),
        query_(query),
        progress_(progress),
        crossings_(geometry) {}

  SeparatingGraph run(const std::vector<Sample>& samples, const std::vector<CulledCell>& cells);

 private:
  /// A direction and its support contact.
  struct Sighting {
    dvec3 n;
    Contact contact;
    dvec3 x;
  };
  Sighting seen(const dvec3& n, const Contact& hint);
  void part(const Sighting& a, const Sighting& b, int depth);
  bool is_near(const Sighting& from, const Sighting& to) const;
  bool joined(const Sighting& a, const Sighting& b) const;
  std::optional<CommonSupport> parting(const Sighting& a, const Sighting& b) const;
  bool given_up();
  bool is_crossed(const SupportChange& change) const;
  bool is_traced(const CommonSupport& seed) const;
  void trace(const CommonSupport& seed);
  void trace_waiting();
  static constexpr int free_end = -1;
  static constexpr int no_node = -2;
  int store(SeparatingArc arc);
  int side_of(int node, const dvec3& first, const dvec3& second) const;
  bool is_taken(int node, const std::vector<ArcPiece>& pieces) const;
  bool is_end_known(const std::vector<ArcPiece>& pieces) const;
  void settle_in(const FacetNode& node, std::size_t side, int end, Ruling& r) const;
  void connect(int arc, int end, int node);
  bool lies_in(const FacetNode& node, const dvec3& n, const std::vector<Contact>& contacts) const;
  bool ties_with(const FacetNode& node, const dvec3& n, const std::vector<Contact>& contacts) const;
  bool has_contacts(const FacetNode& node, const std::vector<Contact>& contacts,
                    double slack = 0) const;
  bool lies_in_facet(const CommonSupport& s) const;
  static bool is_beside(const FacetNode& node, const CommonSupport& seed, double off);
  bool is_at_facet(const CommonSupport& seed) const;
  bool is_facet(const CommonSupport& seed);
  int node_of(const dvec3& n, const std::vector<Contact>& contacts);
  int node_at(const TracedArc& traced);
  int add_node(const dvec3& n, FacetContacts facet);
  static bool meets_corner(const FacetNode& node, const Ruling& r);
  static int add_corner(FacetNode& node, const Ruling& r, int end);
  void connect_crossing(int arc, int end, int node);
  struct PieceContact {
    int arc, piece, contact;
  };
  void part_cells(const std::vector<CulledCell>& cells);
  std::vector<CulledCell> uncrossed(const std::vector<CulledCell>& cells, double margin) const;
  void search_cells(const std::vector<CulledCell>& cells);
  bool is_reached(const FreeEnd& end) const;
  std::optional<CommonSupport> parted(const FreeEnd& end, double length, double aside);
  void part_beside(const FreeEnd& end);
  void find_planes();
  void find_poles();
  std::optional<Landmark> facet_at_pole(const dvec3& n, const Contact& pole, double turn);
  void add_pole(const dvec3& n, const Contact& c);
  void part_about(const dvec3& n, const Contact& pole);
  void part_closely(const Sighting& a, const Sighting& b, int depth);
  bool is_in_plane(const dvec3& n) const;
  void fail(const dvec3& n, const char* reason);
  void tell_failures();

  const ContactGeometry& geometry_;
  ContactSystem system_;
  SupportQuery& query_;
  const Progress& progress_;
  SeparatingGraph graph_;
  long first_cells_ = 0;
  long cell_limit_ = 0;
  bool stopped_ = false;
  CellCrossings crossings_;                                          // of all arcs and nodes
  std::map<std::pair<int, int>, std::vector<PieceContact>> traces_;  // by instance and patch
  std::vector<Box> boxes_;                                           // of the arcs' directions
  std::vector<Landmark> landmarks_;
  std::vector<std::pair<dvec3, Contact>> poles_;  // that support, with their normals
  std::vector<int> waiting_;                      // nodes whose slots may be open
  std::map<int, const char*> not_left_;  // nodes with sides across which no curve was found
  std::vector<std::pair<CommonSupport, const char*>> failed_;  // starts that led nowhere
};

/// One spot is told once.
void GraphTracer::fail(const dvec3& n, const char* reason) {
  const bool known =
      std::any_of(graph_.unresolved.begin(), graph_.unresolved.end(), [&](const Unresolved& u) {
        return u.reason == reason && glm::distance(u.n, n) < same_branch;
      });
  if (!known) graph_.unresolved.push_back({n, reason});
}

GraphTracer::Sighting GraphTracer::seen(const dvec3& n, const Contact& hint) {
  const Support s = query_(n, hint);
  const Contact c = at_rest(geometry_, s.contact, n);
  return {n, c, geometry_.point(c)};
}

/// Whether the contact's motion is, to first order, that to the other: then they are joined without
/// a climb.
bool GraphTracer::is_near(const Sighting& from, const Sighting& to) const {
  const ContactJet j = geometry_.jet(from.contact);
  const std::optional<dvec2> rate = parameter_rate(j, from.n, to.n - from.n);
  if (!rate) return false;
  const dvec3 motion = rate->x * j.dx[0] + rate->y * j.dx[1];
  return glm::distance(to.x - from.x, motion) < first_order * glm::distance(to.x, from.x);
}

/// Whether a climb leads from the one contact to the other.
bool GraphTracer::joined(const Sighting& a, const Sighting& b) const {
  const double same = branch_distance(geometry_);
  if (glm::distance(a.x, b.x) < same) return true;
  const auto leads = [&](const Sighting& from, const Sighting& to) {
    if (is_near(from, to)) return true;
    const std::optional<Contact> c = climbed(geometry_, from.contact, to.n);
    return c && glm::distance(geometry_.point(*c), to.x) < same;
  };
  return leads(a, b) && leads(b, a);
}

/// The direction on the great arc between the two at which their contacts' branches tie: Newton's
/// method on the difference of the two values, the slope of which is the contacts' difference,
/// within the bracket that their signs make.
std::optional<CommonSupport> GraphTracer::parting(const Sighting& a, const Sighting& b) const {
  CommonSupport s;
  s.add(geometry_, a.contact);
  s.add(geometry_, b.contact);
  double lower = 0;
  double upper = 1;
  double t = 0.5;
  for (int k = 0; k < newton_limit; ++k) {
    const dvec3 mixed = (1 - t) * a.n + t * b.n;
    s.n = glm::normalize(mixed);
    // From where they were seen, lest they stay with a branch that an earlier step led to.
    const std::optional<Contact> of_a = climbed(geometry_, a.contact, s.n);
    const std::optional<Contact> of_b = climbed(geometry_, b.contact, s.n);
    if (!of_a || !of_b) return std::nullopt;
    s.contact[0] = *of_a;
    s.contact[1] = *of_b;
    s.evaluate(geometry_);
    if (glm::length(s.d()) < branch_distance(geometry_)) return std::nullopt;
    const double value = glm::dot(s.d(), s.n);
    if (std::abs(value) < parting_tie) return s;
    (value > 0 ? lower : upper) = t;
    const double slope = glm::dot(s.d(), b.n - a.n) / glm::length(mixed);
    const double next = t - value / slope;
    t = next > lower && next < upper ? next : 0.5 * (lower + upper);
    if (upper - lower < parting_tie) {
      if (std::abs(value) < geometry_.tie()) return s;
      return std::nullopt;
    }
  }
  return std::nullopt;
}

/// Finds and traces the curves that the great arc between two sightings crosses.
void GraphTracer::part(const Sighting& a, const Sighting& b, int depth) {
  if (given_up() || joined(a, b)) return;
  if (depth > depth_limit || glm::distance(a.n, b.n) < narrow) {
    // Two samples on the curve itself.
    CommonSupport tie;
    tie.n = a.n;
    tie.add(geometry_, a.contact);
    tie.add(geometry_, b.contact);
    if (glm::distance(a.n, b.n) < narrow && std::abs(glm::dot(tie.d(), a.n)) < geometry_.tie()) {
      if (!is_traced(tie)) trace(tie);
    } else {
      failed_.emplace_back(tie, "two contacts that are not joined are not parted either");
    }
    return;
  }
  if (glm::dot(a.n, b.n) < nearly_opposite) {  // no great arc to speak of
    const Sighting aside = seen(tangent_frame(a.n)[0], a.contact);
    part(a, aside, depth + 1);
    part(aside, b, depth + 1);
    return;
  }
  const std::optional<CommonSupport> seed = parting(a, b);
  if (seed && is_traced(*seed)) return;
  // A direction that is nearly one of the two would not make the search narrower.
  const double least = least_part * glm::distance(a.n, b.n);
  const bool divides =
      seed && glm::distance(seed->n, a.n) > least && glm::distance(seed->n, b.n) > least;
  if (seed && !divides) {
    const Sighting there = seen(seed->n, seed->contact[0]);
    if (glm::dot(there.x, seed->n) <= glm::dot(seed->jet[0].x, seed->n) + geometry_.tie()) {
      trace(*seed);
      return;
    }
  }
  dvec3 n = divides ? seed->n : glm::normalize(a.n + b.n);
  if (is_in_plane(n)) n = glm::normalize(a.n + beside_plane * b.n);
  const Sighting middle = seen(n, a.contact);
  if (divides && glm::dot(middle.x, n) <= glm::dot(seed->jet[0].x, n) + geometry_.tie()) {
    trace(*seed);
    return;
  }
  part(a, middle, depth + 1);
  part(middle, b, depth + 1);
}

/// Whether the contacts of curves that were traced cross the side an odd number of times.
bool GraphTracer::is_crossed(const SupportChange& change) const {
  const auto found = traces_.find({change.on.instance, change.on.element});
  if (found == traces_.end()) return false;
  const bool of_v = change.on.u == change.off.u;
  const double fixed = of_v ? change.on.u : change.on.v;
  const auto [low, high] =
      of_v ? std::minmax(change.on.v, change.off.v) : std::minmax(change.on.u, change.off.u);
  bool odd = false;
  for (const auto& [arc, piece, contact] : found->second) {
    const std::vector<Ruling>& rulings =
        graph_.arcs[std::size_t(arc)].pieces[std::size_t(piece)].rulings;
    for (std::size_t k = 0; k + 1 < rulings.size(); ++k) {
      const Contact& a = rulings[k].contact[std::size_t(contact)];
      const Contact& b = rulings[k + 1].contact[std::size_t(contact)];
      const double from = (of_v ? a.u : a.v) - fixed;
      const double to = (of_v ? b.u : b.v) - fixed;
      if ((from > 0) == (to > 0)) continue;
      const double share = from / (from - to);
      const double at = of_v ? a.v + share * (b.v - a.v) : a.u + share * (b.u - a.u);
      if (at > low && at < high) odd = !odd;
    }
  }
  return odd;
}

/// Whether there is too much that cannot be resolved, or it costs too much. Counted in the cells of
/// support queries, so that the same is given up each time.
bool GraphTracer::given_up() {
  if (stopped_ || graph_.unresolved.size() + failed_.size() >= failure_limit) return true;
  if (query_.cells() - first_cells_ <= cell_limit_) return false;
  fail(dvec3(0.0), "the search for separating curves was given up: contact along curves or areas");
  stopped_ = true;
  return true;
}

bool GraphTracer::is_traced(const CommonSupport& seed) const {
  const std::array<dvec3, 2> x = {seed.jet[0].x, seed.jet[1].x};
  for (std::size_t k = 0; k < graph_.arcs.size(); ++k) {
    const dvec3 margin(longest_chord);
    if (glm::any(glm::lessThan(seed.n, boxes_[k].lower - margin)) ||
        glm::any(glm::greaterThan(seed.n, boxes_[k].upper + margin))) {
      continue;
    }
    for (const ArcPiece& piece : graph_.arcs[k].pieces) {
      for (std::size_t i = 0; i + 1 < piece.rulings.size(); ++i) {
        const Ruling& from = piece.rulings[i];
        const Ruling& to = piece.rulings[i + 1];
        for (const bool swapped : {false, true}) {
          const dvec3& x0 = x[swapped ? 1 : 0];
          const dvec3& x1 = x[swapped ? 0 : 1];
          const auto is_seed = [&](const Ruling& r) {
            return glm::distance(r.n, seed.n) < same_curve &&
                   glm::distance(r.point[0], x0) < same_curve &&
                   glm::distance(r.point[1], x1) < same_curve;
          };
          // At a pole no ruling between others may be found.
          if (is_seed(from) || is_seed(to)) return true;
          const dvec3 dn = to.n - from.n;
          const dvec3 d0 = to.point[0] - from.point[0];
          const dvec3 d1 = to.point[1] - from.point[1];
          const double square = glm::dot(dn, dn) + glm::dot(d0, d0) + glm::dot(d1, d1);
          if (square == 0) continue;
          const dvec3 en = seed.n - from.n;
          const dvec3 e0 = x0 - from.point[0];
          const dvec3 e1 = x1 - from.point[1];
          const double s = (glm::dot(en, dn) + glm::dot(e0, d0) + glm::dot(e1, d1)) / square;
          if (s < -overlap || s > 1 + overlap) continue;
          const double off = glm::dot(en, en) + glm::dot(e0, e0) + glm::dot(e1, e1);
          if (off - s * s * square > 0.25 * square + same_curve * same_curve) continue;
          const std::optional<Ruling> there = ruling_between(system_, from, to, s);
          if (there && is_seed(*there)) return true;
        }
      }
    }
  }
  return false;
}

/// Whether the contacts are in the plane of a facet with curved sides or corners at poles. Its
/// direction is the limit of those of planes with two contacts on one of the curves, or about two
/// of the poles, which Newton's method cannot tell apart. Planes turn with the root of the heights
/// over which contacts tie.
bool GraphTracer::lies_in(const FacetNode& node, const dvec3& n,
                          const std::vector<Contact>& contacts) const {
  const bool at_poles =
      std::any_of(node.contacts.begin(), node.contacts.end(),
                  [&](const Contact& c) { return pole_side(geometry_, c).has_value(); });
  return (!node.sides.empty() || at_poles) && ties_with(node, n, contacts);
}

/// The plane is the node's as far as heights tell.
bool GraphTracer::ties_with(const FacetNode& node, const dvec3& n,
                            const std::vector<Contact>& contacts) const {
  const double turn = std::max(nearly_same_plane, root_turn * std::sqrt(geometry_.rounding()));
  return glm::distance(node.n, n) < turn && has_contacts(node, contacts);
}

/// All of the contacts are in the facet's plane, or below it by less than `slack`.
bool GraphTracer::has_contacts(const FacetNode& node, const std::vector<Contact>& contacts,
                               double slack) const {
  const double offset = glm::dot(node.points.front(), node.n);
  return std::all_of(contacts.begin(), contacts.end(), [&](const Contact& c) {
    return glm::dot(geometry_.point(c), node.n) >= offset - geometry_.tie() - slack;
  });
}

/// The facet node of a plane, a new one if there is none yet; no_node if its contacts cannot be
/// told.
int GraphTracer::node_of(const dvec3& n, const std::vector<Contact>& contacts) {
  for (std::size_t k = 0; k < graph_.nodes.size(); ++k) {
    const FacetNode& node = graph_.nodes[k];
    if (node.is_crossing()) continue;
    if (lies_in(node, n, contacts)) return int(k);
    if (glm::distance(node.n, n) > same_plane) continue;
    // Facets of nearly equal planes have other contacts.
    const bool known = std::all_of(contacts.begin(), contacts.end(), [&](const Contact& c) {
      const dvec3 x = geometry_.point(c);
      return std::any_of(node.points.begin(), node.points.end(),
                         [&](const dvec3& p) { return glm::distance(p, x) < same_branch; });
    });
    if (known) return int(k);
  }
  std::optional<FacetContacts> f = facet_contacts(geometry_, query_, n, contacts);
  if (f) return add_node(n, std::move(*f));
  fail(n, "a plane has contact along a curve");
  return no_node;
}

/// The node in which a curve ends that was traced.
int GraphTracer::node_at(const TracedArc& traced) {
  if (traced.end == TracedArc::End::merged) return free_end;
  if (traced.end == TracedArc::End::plane) return node_of(traced.n, traced.contacts);
  const dvec3 x = geometry_.point(traced.contacts.front());
  for (std::size_t k = 0; k < graph_.nodes.size(); ++k) {
    const FacetNode& node = graph_.nodes[k];
    if (node.is_crossing() && glm::distance(node.n, traced.n) < same_branch &&
        glm::distance(node.points.front(), x) < same_branch) {
      return int(k);
    }
  }
  graph_.nodes.push_back({traced.n, {traced.contacts.front()}, {x}, {}, {}});
  return int(graph_.nodes.size()) - 1;
}

int GraphTracer::add_node(const dvec3& n, FacetContacts facet) {
  const std::size_t count = facet.contacts.size();
  for (const Contact& c : facet.contacts) crossings_.add(c);
  for (const EdgeStretch& side : facet.sides) {
    if (side.piece >= 0) crossings_.add(side);
  }
  graph_.nodes.push_back({n, std::move(facet.contacts), std::move(facet.points),
                          std::move(facet.sides), std::vector<FacetNode::Slot>(count)});
  waiting_.push_back(int(graph_.nodes.size()) - 1);
  return waiting_.back();
}

/// Planes with contact along whole curves.
void GraphTracer::find_planes() {
  for (const ContactPlane& plane : contact_planes(geometry_, query_)) {
    std::optional<FacetContacts> f = facet_contacts(geometry_, query_, plane.n, {}, plane.pieces);
    if (!f || !f->is_facet()) {
      fail(plane.n, "the outline of a facet with curved sides is not found");
      continue;
    }
    // All of the curves touches the plane, its outline or not.
    for (const Contact& c : plane.pieces) {
      crossings_.add(EdgeStretch{c.instance, c.element, 0, 1});
    }
    landmarks_.push_back({plane.n, *f});
    add_node(plane.n, std::move(*f));
  }
}

/// Whether it is the normal of a plane with contact along a curve: all of the curve supports in it.
bool GraphTracer::is_in_plane(const dvec3& n) const {
  return std::any_of(landmarks_.begin(), landmarks_.end(), [&](const Landmark& l) {
    return l.facet.is_curved() && glm::distance(l.n, n) < same_plane;
  });
}

/// Poles that support together with two other contacts or more: facets that Newton's method does
/// not find.
void GraphTracer::find_poles() {
  const Model& model = geometry_.scene().model();
  for (int i = 0; i < int(model.instances().size()); ++i) {
    const Part& part = model.parts()[std::size_t(model.instances()[std::size_t(i)].part)];
    for (int p = 0; p < int(part.patches().size()); ++p) {
      for (const Side side : all_sides) {
        Contact c{i, SourceKind::face, p, 0.5, 0.5};
        if (!is_pole(geometry_, c, side) || geometry_.is_repeated(c)) continue;
        (along_v(side) ? c.u : c.v) = at_upper_end(side) ? 1 : 0;
        const dvec3 normal = unit_normal(geometry_, c);
        const dvec3 x = geometry_.point(c);
        if (normal == dvec3(0.0)) continue;
        for (const dvec3& n : {normal, -normal}) {
          const double turn = pole_turn(geometry_, c);
          if (query_(n, c).h > glm::dot(x, n) + geometry_.tie() + turn) continue;
          add_pole(n, c);
          const bool known =
              std::any_of(landmarks_.begin(), landmarks_.end(),
                          [&](const Landmark& l) { return glm::distance(l.n, n) < same_plane; });
          if (known) continue;
          const std::optional<Landmark> facet = facet_at_pole(n, c, turn);
          if (!facet) continue;
          landmarks_.push_back(*facet);
          add_node(facet->n, facet->facet);
        }
      }
    }
  }
}

/// The facet of three contacts or more at whose corner the pole lies, where the pole's normal is
/// known to within `turn` only: its plane is that of the contacts.
std::optional<Landmark> GraphTracer::facet_at_pole(const dvec3& n, const Contact& pole,
                                                   double turn) {
  const auto facet = [&](const dvec3& normal, double slack) {
    std::optional<FacetContacts> f = facet_contacts(geometry_, query_, normal, {pole}, {}, slack);
    return f && f->contacts.size() >= 3 ? f : std::nullopt;
  };
  std::optional<FacetContacts> f = facet(n, turn);
  if (!f || turn < geometry_.tie()) return f ? std::optional(Landmark{n, *f}) : std::nullopt;
  dvec3 normal = outline_normal(f->points);
  if (glm::dot(normal, n) < 0) normal = -normal;
  f = facet(normal, 0);
  return f ? std::optional(Landmark{normal, *f}) : std::nullopt;
}

/// Once for all patches that meet in it.
void GraphTracer::add_pole(const dvec3& n, const Contact& c) {
  const dvec3 x = geometry_.point(c);
  const bool known = std::any_of(poles_.begin(), poles_.end(), [&](const auto& pole) {
    return glm::distance(pole.first, n) < same_plane &&
           glm::distance(geometry_.point(pole.second), x) < same_branch;
  });
  if (!known) poles_.emplace_back(n, c);
}

/// Finds and traces the curves that begin in a pole: they cross a small circle about its normal.
void GraphTracer::part_about(const dvec3& n, const Contact& pole) {
  const std::array<dvec3, 2> frame = tangent_frame(n);
  std::vector<Sighting> circle;
  circle.reserve(circle_samples);
  for (int k = 0; k < circle_samples; ++k) {
    const double angle = 2 * std::numbers::pi * k / circle_samples;
    const dvec3 aside = std::cos(angle) * frame[0] + std::sin(angle) * frame[1];
    circle.push_back(seen(glm::normalize(n + circle_radius * aside), pole));
  }
  for (std::size_t k = 0; k < circle.size(); ++k) {
    part_closely(circle[k], circle[(k + 1) % circle.size()], circle_halvings);
  }
}

/// Halfway between two whose contacts are farther apart than to first order, the two branches may
/// be there only near the curve: a climb from farther off would lead from the one to the other.
void GraphTracer::part_closely(const Sighting& a, const Sighting& b, int depth) {
  if (depth == 0 || (is_near(a, b) && is_near(b, a))) {
    part(a, b, 0);
    return;
  }
  const Sighting middle = seen(glm::normalize(a.n + b.n), a.contact);
  part_closely(a, middle, depth - 1);
  part_closely(middle, b, depth - 1);
}

/// The side of a facet from its contact at the one point to that at the other; -1 if there is none.
int GraphTracer::side_of(int node, const dvec3& first, const dvec3& second) const {
  const std::vector<dvec3>& points = graph_.nodes[std::size_t(node)].points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (glm::distance(points[i], first) < same_branch &&
        glm::distance(points[(i + 1) % points.size()], second) < same_branch) {
      return int(i);
    }
  }
  return -1;
}

/// Whether an arc is there already that runs into the same free end, from the same side. In a pole
/// several may end.
bool GraphTracer::is_end_known(const std::vector<ArcPiece>& pieces) const {
  const auto approach = [](const Ruling& end, const Ruling& before) {
    return unit(end.n - before.n);
  };
  const std::vector<Ruling>& own = pieces.back().rulings;
  const Ruling& end = own.back();
  const dvec3 along = approach(end, own[own.size() - 2]);
  const auto same = [&](const Ruling& other, const Ruling& before) {
    return other.point[0] == other.point[1] && glm::distance(other.n, end.n) < same_branch &&
           glm::distance(other.point[0], end.point[0]) < same_branch &&
           glm::dot(approach(other, before), along) > same_approach;
  };
  return std::any_of(graph_.arcs.begin(), graph_.arcs.end(), [&](const SeparatingArc& arc) {
    if (arc.closed) return false;
    const std::vector<Ruling>& first = arc.pieces.front().rulings;
    const std::vector<Ruling>& last = arc.pieces.back().rulings;
    return (arc.facet[0] < 0 && same(first.front(), first[1])) ||
           (arc.facet[1] < 0 && same(last.back(), last[last.size() - 2]));
  });
}

/// Whether an arc is there already across the side of the node at which these pieces arrive.
bool GraphTracer::is_taken(int node, const std::vector<ArcPiece>& pieces) const {
  if (node == free_end) return is_end_known(pieces);
  if (graph_.nodes[std::size_t(node)].is_crossing()) return false;
  const Ruling& last = pieces.back().rulings.back();
  const int side = side_of(node, last.point[1], last.point[0]);
  return side >= 0 && graph_.nodes[std::size_t(node)].slots[std::size_t(side)].arc >= 0;
}

/// Gives the ruling, with which an arc ends or begins on a side of the node, the node's own normal
/// and contacts: they differ by rounding.
void GraphTracer::settle_in(const FacetNode& node, std::size_t side, int end, Ruling& r) const {
  r.n = node.n;
  for (std::size_t i = 0; i < 2; ++i) {
    const bool first = (i == 0) == (end == 0);
    const std::size_t corner = first ? side : (side + 1) % node.points.size();
    if (glm::distance(node.points[corner], r.point[i]) > rounded_contact) continue;
    const std::optional<Contact> c = expressed_in(geometry_, node.contacts[corner], r.contact[i]);
    if (!c) continue;
    r.contact[i] = *c;
    r.point[i] = node.points[corner];
  }
}

/// Plugs an arc's end into the side of the node that it crosses.
void GraphTracer::connect(int arc, int end, int node) {
  if (node == free_end) return;
  FacetNode& own = graph_.nodes[std::size_t(node)];
  if (own.is_crossing()) {
    connect_crossing(arc, end, node);
    return;
  }
  std::vector<ArcPiece>& pieces = graph_.arcs[std::size_t(arc)].pieces;
  Ruling& r = end == 0 ? pieces.front().rulings.front() : pieces.back().rulings.back();
  const int side = side_of(node, r.point[end == 0 ? 0 : 1], r.point[end == 0 ? 1 : 0]);
  if (side < 0 && meets_corner(own, r)) {
    const int corner = add_corner(own, r, end);
    own.slots[std::size_t(corner)] = {arc, end};
    graph_.arcs[std::size_t(arc)].facet[std::size_t(end)] = node;
  } else if (side < 0) {
    fail(own.n, "a separating curve meets a facet in none of its sides");
  } else if (own.slots[std::size_t(side)].arc >= 0) {
    fail(own.n, "two separating curves leave a facet across one side");
  } else {
    own.slots[std::size_t(side)] = {arc, end};
    graph_.arcs[std::size_t(arc)].facet[std::size_t(end)] = node;
    settle_in(own, std::size_t(side), end, r);
  }
}

/// Whether two contacts that touch each other are in one corner of the facet.
bool GraphTracer::meets_corner(const FacetNode& node, const Ruling& r) {
  return std::any_of(node.points.begin(), node.points.end(), [&](const dvec3& p) {
    return glm::distance(p, r.point[0]) < same_branch && glm::distance(p, r.point[1]) < same_branch;
  });
}

/// Makes the corner in which both contacts are two, with a side of no length between them; its
/// number.
int GraphTracer::add_corner(FacetNode& node, const Ruling& r, int end) {
  const auto found = std::find_if(node.points.begin(), node.points.end(), [&](const dvec3& p) {
    return glm::distance(p, r.point[0]) < same_branch;
  });
  const auto k = found - node.points.begin();
  node.contacts[std::size_t(k)] = r.contact[end == 0 ? 0 : 1];
  node.contacts.insert(node.contacts.begin() + k + 1, r.contact[end == 0 ? 1 : 0]);
  node.points.insert(node.points.begin() + k + 1, node.points[std::size_t(k)]);
  // What left across the corner's next side does so from the second of the two.
  node.slots.insert(node.slots.begin() + k, FacetNode::Slot());
  if (!node.sides.empty()) node.sides.insert(node.sides.begin() + k, EdgeStretch());
  return int(k);
}

/// Adds an arc that ends in a crossing to those that leave it, in their order about its direction.
void GraphTracer::connect_crossing(int arc, int end, int node) {
  FacetNode& own = graph_.nodes[std::size_t(node)];
  const std::array<dvec3, 2> frame = tangent_frame(own.n);
  const auto angle = [&](const FacetNode::Slot& slot) {
    const std::vector<ArcPiece>& pieces = graph_.arcs[std::size_t(slot.arc)].pieces;
    const dvec3 next =
        slot.end == 0 ? pieces.front().rulings[1].n : std::prev(pieces.back().rulings.end(), 2)->n;
    return std::atan2(glm::dot(next, frame[1]), glm::dot(next, frame[0]));
  };
  const FacetNode::Slot slot = {arc, end};
  const auto place =
      std::find_if(own.slots.begin(), own.slots.end(),
                   [&](const FacetNode::Slot& other) { return angle(other) > angle(slot); });
  own.slots.insert(place, slot);
  graph_.arcs[std::size_t(arc)].facet[std::size_t(end)] = node;
}

/// Reverses the direction, and with it the order of contacts.
void reverse(std::vector<ArcPiece>& pieces) {
  std::reverse(pieces.begin(), pieces.end());
  for (ArcPiece& piece : pieces) {
    std::reverse(piece.rulings.begin(), piece.rulings.end());
    for (Ruling& r : piece.rulings) {
      std::swap(r.contact[0], r.contact[1]);
      std::swap(r.point[0], r.point[1]);
    }
  }
}

bool same_elements(const Ruling& a, const Ruling& b) {
  return same_element(a.contact[0], b.contact[0]) && same_element(a.contact[1], b.contact[1]);
}

/// Appends pieces that go on where these end.
void append(std::vector<ArcPiece>& pieces, std::vector<ArcPiece>&& more) {
  auto first = more.begin();
  if (!pieces.empty() && first != more.end() &&
      same_elements(pieces.back().rulings.back(), first->rulings.front())) {
    auto& to = pieces.back().rulings;
    to.insert(to.end(), first->rulings.begin() + 1, first->rulings.end());
    ++first;
  }
  std::move(first, more.end(), std::back_inserter(pieces));
}

/// Whether two contacts, in a direction near that of a facet with curved sides, are in its plane.
bool GraphTracer::lies_in_facet(const CommonSupport& s) const {
  return std::any_of(graph_.nodes.begin(), graph_.nodes.end(), [&](const FacetNode& node) {
    return lies_in(node, s.n, {s.contact[0], s.contact[1]});
  });
}

/// Whether the seed, in a direction that is hardly off the node's, is on a curve that leaves it:
/// its contacts are two of the node's own that have moved by as little.
bool GraphTracer::is_beside(const FacetNode& node, const CommonSupport& seed, double off) {
  const double reach = same_branch + moved_contact * off;
  return std::all_of(seed.jet.begin(), seed.jet.begin() + seed.count, [&](const ContactJet& j) {
    return std::any_of(node.points.begin(), node.points.end(),
                       [&](const dvec3& p) { return glm::distance(p, j.x) < reach; });
  });
}

/// Whether the seed is, to within what poles leave open, two contacts of a facet: the curve through
/// it leaves the facet.
bool GraphTracer::is_at_facet(const CommonSupport& seed) const {
  return std::any_of(graph_.nodes.begin(), graph_.nodes.end(), [&](const FacetNode& node) {
    const double off = glm::distance(node.n, seed.n);
    return !node.is_crossing() && off < at_facet && is_beside(node, seed, off);
  });
}

/// Whether the seed is a facet, with other contacts beside the two: a node for it, if it is new.
bool GraphTracer::is_facet(const CommonSupport& seed) {
  const std::vector<Contact> contacts(seed.contact.begin(), seed.contact.begin() + seed.count);
  for (const FacetNode& node : graph_.nodes) {
    if (node.is_crossing()) continue;
    if (lies_in(node, seed.n, contacts)) return true;
    const double off = glm::distance(node.n, seed.n);
    if (off < same_plane && has_contacts(node, contacts, off)) return true;
    if (off < nearly_same_plane && is_beside(node, seed, off)) return true;
  }
  std::optional<FacetContacts> f = facet_contacts(geometry_, query_, seed.n, contacts);
  if (!f || !f->is_facet()) return false;
  add_node(seed.n, std::move(*f));
  return true;
}

/// Traces the curve through a seed, both ways unless it closes.
void GraphTracer::trace(const CommonSupport& seed) {
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
    store(std::move(arc));
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
  if (begin == end && begin != free_end && glm::distance(ahead.n, seed.n) < same_plane &&
      glm::distance(behind.n, seed.n) < same_plane) {
    trace_waiting();  // two contacts of a facet that share no side
    return;
  }
  // A facet has one curve across each side: this one is there already.
  if (is_taken(begin, behind.pieces) || is_taken(end, ahead.pieces)) return;
  reverse(behind.pieces);
  arc.pieces = std::move(behind.pieces);
  append(arc.pieces, std::move(ahead.pieces));
  drop_empty_pieces(geometry_, arc.pieces);
  const int index = store(std::move(arc));
  connect(index, 0, begin);
  connect(index, 1, end);
  trace_waiting();
}

/// Adds an arc; its number.
int GraphTracer::store(SeparatingArc arc) {
  Box box;
  for (const ArcPiece& piece : arc.pieces) {
    for (const Ruling& r : piece.rulings) box.include(r.n);
  }
  boxes_.push_back(box);
  const int index = int(graph_.arcs.size());
  for (int k = 0; k < int(arc.pieces.size()); ++k) {
    for (int i = 0; i < 2; ++i) {
      const Contact& c = arc.pieces[std::size_t(k)].rulings.front().contact[std::size_t(i)];
      if (c.kind == SourceKind::face) traces_[{c.instance, c.element}].push_back({index, k, i});
    }
  }
  crossings_.add(arc);
  graph_.arcs.push_back(std::move(arc));
  return index;
}

/// Traces the arcs that leave facets across sides where none was met yet.
void GraphTracer::trace_waiting() {
  while (!waiting_.empty() && !given_up()) {
    const int node = waiting_.back();
    waiting_.pop_back();
    for (std::size_t i = 0; i < graph_.nodes[std::size_t(node)].contacts.size(); ++i) {
      const FacetNode& own = graph_.nodes[std::size_t(node)];
      if (own.slots[i].arc >= 0 || own.is_curved(i)) continue;
      CommonSupport start;
      start.n = own.n;
      start.add(geometry_, own.contacts[i]);
      start.add(geometry_, own.contacts[(i + 1) % own.contacts.size()]);
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
        continue;
      }
      const int end = node_at(traced);
      if (end == no_node) continue;
      SeparatingArc arc;
      arc.pieces = std::move(traced.pieces);
      const int index = store(std::move(arc));
      connect(index, 0, node);
      connect(index, 1, end);
    }
  }
}

/// Finds and traces the curves that cross the sides of mixed cells.
void GraphTracer::part_cells(const std::vector<CulledCell>& cells) {
  for (const SupportChange& change : support_changes(geometry_, query_, cells)) {
    if (given_up()) break;
    if (is_crossed(change)) continue;
    const std::optional<CommonSupport> seed = separating_seed(system_, query_, change);
    if (seed && !is_traced(*seed) && !lies_in_facet(*seed) && !is_at_facet(*seed)) trace(*seed);
  }
}

/// The mixed cells for which no known contact accounts.
std::vector<CulledCell> GraphTracer::uncrossed(const std::vector<CulledCell>& cells,
                                               double margin) const {
  std::vector<CulledCell> result;
  std::copy_if(cells.begin(), cells.end(), std::back_inserter(result), [&](const CulledCell& cell) {
    return cell.state == CellState::mixed &&
           !geometry_.is_repeated({cell.instance, SourceKind::face, cell.patch, 0, 0}) &&
           !crossings_.crosses(cell, margin);
  });
  return result;
}

/// Seeks what the mixed cells hide through which no curve runs: decides them further, and where
/// that fails looks for curves across their sides, and in the end for free ends in them.
void GraphTracer::search_cells(const std::vector<CulledCell>& cells) {
  std::vector<CulledCell> left = uncrossed(cells, 0);
  CellRefinement refinement(geometry_.scene());
  bool fewer = true;
  for (int level = 1; !left.empty() && !given_up(); ++level) {
    if (level > least_refinements && (!fewer || level > most_refinements)) break;
    progress_.check();
    const std::size_t count = left.size();
    left = uncrossed(refinement.refined(left), refined_margin);
    part_cells(left);
    left = uncrossed(left, refined_margin);
    fewer = left.size() < count;
  }
  for (const FreeEnd& end : free_ends(geometry_, query_, left)) {
    if (!given_up() && !is_reached(end)) part_beside(end);
  }
  graph_.cells_searched = long(uncrossed(left, refined_margin).size());
}

/// Whether a curve that was traced ends in the free end.
bool GraphTracer::is_reached(const FreeEnd& end) const {
  const dvec3 x = geometry_.point(end.contact);
  for (const SeparatingArc& arc : graph_.arcs) {
    for (const std::size_t e : {0U, 1U}) {
      if (arc.closed || arc.facet[e] >= 0) continue;
      const Ruling& last =
          e == 0 ? arc.pieces.front().rulings.front() : arc.pieces.back().rulings.back();
      if (glm::distance(last.n, end.n) < same_end && glm::distance(last.point[0], x) < same_end) {
        return true;
      }
    }
  }
  return false;
}

/// The contact moved along its smooth surface by a tangent, over the join at which it stands if the
/// tangent leads there. None if it does not stay in a patch.
std::optional<Contact> moved(const ContactGeometry& geometry, const Contact& c, const dvec3& by) {
  std::vector<Contact> elements = {c};
  for (const ContactExit& exit : exits(geometry, c)) {
    const std::optional<Contact> over = beyond(geometry, c, exit);
    if (over && over->kind == SourceKind::face &&
        glm::distance(geometry.point(*over), geometry.point(c)) < same_branch) {
      elements.push_back(*over);
    }
  }
  for (Contact own : elements) {
    const ContactJet j = geometry.jet(own);
    const dvec2 r(glm::dot(j.dx[0], by), glm::dot(j.dx[1], by));
    const double uu = glm::dot(j.dx[0], j.dx[0]);
    const double uv = glm::dot(j.dx[0], j.dx[1]);
    const double vv = glm::dot(j.dx[1], j.dx[1]);
    const double det = uu * vv - uv * uv;
    if (!(det > 0)) continue;
    own.u += (vv * r.x - uv * r.y) / det;
    own.v += (uu * r.y - uv * r.x) / det;
    if (own.u >= 0 && own.u <= 1 && own.v >= 0 && own.v <= 1) return own;
  }
  return std::nullopt;
}

/// Two contacts of one surface that have parted from the free end by so much, sought about a point
/// that lies so many times as far aside.
std::optional<CommonSupport> GraphTracer::parted(const FreeEnd& end, double length, double aside) {
  if (end.kind != FreeEnd::Kind::face) return std::nullopt;
  const dvec3 middle = aside * length * glm::cross(end.n, end.along);
  CommonSupport s;
  for (const double sense : {-0.5, 0.5}) {
    const auto c = moved(geometry_, end.contact, middle + sense * length * end.along);
    if (!c) return std::nullopt;
    s.add(geometry_, *c);
    const dvec3 normal = unit_normal(geometry_, *c);
    s.n += glm::dot(normal, end.n) < 0 ? -normal : normal;
  }
  s.n = glm::normalize(s.n);
  const dvec3 x = geometry_.point(end.contact);
  const bool found = system_.settle(s, [&](const CommonSupport& now) {
    LinearEquation e;
    const dvec3 d = now.d() / length;
    e.residual = 0.5 * (glm::dot(now.d(), d) - length);
    e.add_point(now, 0, d);
    e.add_point(now, 1, -d);
    return e;
  });
  const auto in_element = [](double t) { return t >= 0 && t <= 1; };
  for (std::size_t i = 0; found && i < 2; ++i) {
    if (!in_element(s.contact[i].u) || !in_element(s.contact[i].v)) return std::nullopt;
    if (glm::distance(s.jet[i].x, x) > parted_reach * length) return std::nullopt;
  }
  if (!found || query_(s.n, s.contact[0]).h > glm::dot(s.jet[0].x, s.n) + geometry_.tie()) {
    return std::nullopt;
  }
  return s;
}

/// Seeks the curve that ends in the free end: from two contacts that have parted from it, or
/// between directions to both sides of it.
void GraphTracer::part_beside(const FreeEnd& end) {
  for (const double length : parted_lengths) {
    for (const double aside : parted_aside) {
      const std::optional<CommonSupport> seed = parted(end, length, aside);
      if (!seed || is_traced(*seed)) continue;
      trace(*seed);
      if (is_reached(end)) return;
    }
  }
  const dvec3 ahead = glm::cross(end.n, end.along);
  for (const double sense : {1.0, -1.0}) {
    const auto beside = [&](double side) {
      return seen(
          glm::normalize(end.n + sense * end_step * ahead + side * end_step * end_step * end.along),
          end.contact);
    };
    part(beside(1), beside(-1), 0);
  }
}

SeparatingGraph GraphTracer::run(const std::vector<Sample>& samples,
                                 const std::vector<CulledCell>& cells) {
  first_cells_ = query_.cells();
  cell_limit_ = least_cells + cells_a_sample * long(samples.size());
  find_planes();
  find_poles();
  std::vector<Sighting> sightings;
  std::vector<dvec3> points;
  Box box;
  for (const Sample& s : samples) {
    if (is_in_plane(s.n)) continue;
    const Contact c = at_rest(geometry_, s.contact, s.n);
    const dvec3 x = geometry_.point(c);
    box.include(x);
    points.push_back(x);
    sightings.push_back({s.n, c, x});
  }
  trace_waiting();
  part_cells(cells);
  for (const auto& [n, pole] : poles_) part_about(n, pole);
  PointHull hull(box);
  hull.add(points);
  for (const PointHull::Facet& f : hull.facets()) {
    if (!f.alive || given_up()) continue;
    progress_.check();
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = f.vertex[k];
      const int b = f.vertex[(k + 1) % 3];
      if (a < b) part(sightings[std::size_t(a)], sightings[std::size_t(b)], 0);
    }
  }
  search_cells(cells);
  tell_failures();
  graph_.newton_iterations = system_.iterations();
  return std::move(graph_);
}

/// Starts that led nowhere, unless others led to the curve or facet there; and sides of facets that
/// no curve leaves across.
void GraphTracer::tell_failures() {
  for (const auto& [start, reason] : failed_) {
    const std::vector<Contact> contacts = {start.contact[0], start.contact[1]};
    const dvec3& n = start.n;
    const bool in_facet =
        std::any_of(graph_.nodes.begin(), graph_.nodes.end(),
                    [&](const FacetNode& node) { return ties_with(node, n, contacts); });
    if (!in_facet && !is_traced(start)) fail(n, reason);
  }
  for (const auto& [node, reason] : not_left_) {
    const FacetNode& own = graph_.nodes[std::size_t(node)];
    for (std::size_t k = 0; k < own.slots.size(); ++k) {
      if (own.slots[k].arc < 0 && !own.is_curved(k)) fail(own.n, reason);
    }
  }
}

}  // namespace

SeparatingGraph trace_separating_curves(const ContactGeometry& geometry, SupportQuery& query,
                                        const std::vector<Sample>& samples,
                                        const std::vector<CulledCell>& cells,
                                        const Progress& progress) {
  return GraphTracer(geometry, query, progress).run(samples, cells);
}

}  // namespace taut
