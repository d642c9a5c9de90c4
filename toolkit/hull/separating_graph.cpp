#include "taut/hull/separating_graph.h"

#include <algorithm>
#include <cmath>

#include "taut/hull/arc_tracer.h"
#include "taut/hull/contact_exits.h"
#include "taut/hull/facet_contacts.h"
#include "taut/hull/point_hull.h"

namespace taut {
namespace {

/// Contacts within this distance are of one branch.
constexpr double same_branch = 1e-6;
/// Directions so near to each other are not parted any further.
constexpr double narrow = 1e-9;
constexpr int secant_limit = 60;
constexpr int depth_limit = 40;
/// A seed lies on a curve that was traced if the curve passes it within this distance.
constexpr double same_curve = 1e-6;
/// Normals of facets are the same below this difference.
constexpr double same_plane = 1e-7;
/// Directions of consecutive rulings are no farther apart.
constexpr double longest_chord = 0.2;

class GraphTracer {
 public:
  GraphTracer(const ContactGeometry& geometry, SupportQuery& query, const Progress& progress)
      : geometry_(geometry), system_(geometry), query_(query), progress_(progress) {}

  SeparatingGraph run(const std::vector<Sample>& samples);

 private:
  /// A direction and its support contact.
  struct Sighting {
    dvec3 n;
    Contact contact;
    dvec3 x;
  };
  Sighting seen(const dvec3& n, const Contact& hint);
  void part(const Sighting& a, const Sighting& b, int depth);
  bool joined(const Sighting& a, const Sighting& b) const;
  std::optional<CommonSupport> parting(const Sighting& a, const Sighting& b) const;
  bool is_traced(const CommonSupport& seed) const;
  void trace(const CommonSupport& seed);
  void trace_waiting();
  void add(TracedArc&& traced, int begin_node, int begin_slot);
  void connect(int arc, int end, int node, const dvec3& first, const dvec3& second);
  int node_of(const dvec3& n, const std::vector<Contact>& contacts);
  int add_node(const dvec3& n, FacetContacts facet);
  void find_poles();
  void fail(const dvec3& n, const char* reason) { graph_.unresolved.push_back({n, reason}); }

  const ContactGeometry& geometry_;
  ContactSystem system_;
  SupportQuery& query_;
  const Progress& progress_;
  SeparatingGraph graph_;
  std::vector<Box> boxes_;  // of the arcs' directions
  std::vector<Landmark> landmarks_;
  std::vector<int> waiting_;  // nodes whose slots may be open
};

GraphTracer::Sighting GraphTracer::seen(const dvec3& n, const Contact& hint) {
  const Support s = query_(n, hint);
  return {n, geometry_.canonical(s.contact), s.point};
}

/// Whether a climb leads from the one contact to the other.
bool GraphTracer::joined(const Sighting& a, const Sighting& b) const {
  if (glm::distance(a.x, b.x) < same_branch) return true;
  const auto leads = [&](const Sighting& from, const Sighting& to) {
    const std::optional<Contact> c = climbed(geometry_, from.contact, to.n);
    return c && glm::distance(geometry_.point(*c), to.x) < same_branch;
  };
  return leads(a, b) || leads(b, a);
}

/// The direction on the great arc between the two at which their contacts' branches tie.
std::optional<CommonSupport> GraphTracer::parting(const Sighting& a, const Sighting& b) const {
  struct Difference {
    double value;
    Contact ca, cb;
    dvec3 n;
  };
  const auto difference = [&](double t) -> std::optional<Difference> {
    const dvec3 n = glm::normalize((1 - t) * a.n + t * b.n);
    const std::optional<Contact> ca = climbed(geometry_, a.contact, n);
    const std::optional<Contact> cb = climbed(geometry_, b.contact, n);
    if (!ca || !cb) return std::nullopt;
    return Difference{glm::dot(geometry_.point(*ca) - geometry_.point(*cb), n), *ca, *cb, n};
  };
  // Positive at a, negative at b; the Illinois variant of regula falsi.
  double lower = 0;
  double upper = 1;
  const auto at_lower = difference(0);
  const auto at_upper = difference(1);
  if (!at_lower || !at_upper || at_lower->value < 0 || at_upper->value > 0) return std::nullopt;
  double f_lower = at_lower->value;
  double f_upper = at_upper->value;
  for (int k = 0; k < secant_limit; ++k) {
    double t = f_lower == f_upper ? 0.5 * (lower + upper)
                                  : (f_lower * upper - f_upper * lower) / (f_lower - f_upper);
    if (k > 8) t = 0.5 * (lower + upper);
    const auto at = difference(t);
    if (!at) return std::nullopt;
    if (std::abs(at->value) < 1e-14 || upper - lower < 1e-15) {
      CommonSupport s;
      s.n = at->n;
      s.add(geometry_, at->ca);
      s.add(geometry_, at->cb);
      if (glm::length(s.d()) < same_branch) return std::nullopt;
      return s;
    }
    if (at->value > 0) {
      lower = t;
      f_lower = at->value;
      f_upper *= 0.5;
    } else {
      upper = t;
      f_upper = at->value;
      f_lower *= 0.5;
    }
  }
  return std::nullopt;
}

/// Finds and traces the curves that the great arc between two sightings crosses.
void GraphTracer::part(const Sighting& a, const Sighting& b, int depth) {
  if (joined(a, b)) return;
  if (depth > depth_limit || glm::distance(a.n, b.n) < narrow) {
    fail(a.n, "two contacts that are not joined are not parted either");
    return;
  }
  const std::optional<CommonSupport> seed = parting(a, b);
  const dvec3 n = seed ? seed->n : glm::normalize(a.n + b.n);
  const Sighting middle = seen(n, a.contact);
  if (seed && glm::dot(middle.x, n) <= glm::dot(seed->jet[0].x, n) + support_tie) {
    if (!is_traced(*seed)) trace(*seed);
    return;
  }
  part(a, middle, depth + 1);
  part(middle, b, depth + 1);
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
          const dvec3 dn = to.n - from.n;
          const dvec3 d0 = to.point[0] - from.point[0];
          const dvec3 d1 = to.point[1] - from.point[1];
          const double square = glm::dot(dn, dn) + glm::dot(d0, d0) + glm::dot(d1, d1);
          if (square == 0) continue;
          const dvec3 en = seed.n - from.n;
          const dvec3 e0 = x0 - from.point[0];
          const dvec3 e1 = x1 - from.point[1];
          const double s = (glm::dot(en, dn) + glm::dot(e0, d0) + glm::dot(e1, d1)) / square;
          if (s < -1e-6 || s > 1 + 1e-6) continue;
          const double off = glm::dot(en, en) + glm::dot(e0, e0) + glm::dot(e1, e1);
          if (off - s * s * square > 0.25 * square + same_curve * same_curve) continue;
          const Ruling there = ruling_between(system_, from, to, s);
          if (glm::distance(there.n, seed.n) < same_curve &&
              glm::distance(there.point[0], x0) < same_curve &&
              glm::distance(there.point[1], x1) < same_curve) {
            return true;
          }
        }
      }
    }
  }
  return false;
}

/// The facet node of a plane, a new one if there is none yet; -1 if its contacts cannot be told.
int GraphTracer::node_of(const dvec3& n, const std::vector<Contact>& contacts) {
  for (std::size_t k = 0; k < graph_.nodes.size(); ++k) {
    const FacetNode& node = graph_.nodes[k];
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
  return -1;
}

int GraphTracer::add_node(const dvec3& n, FacetContacts facet) {
  const std::size_t count = facet.contacts.size();
  graph_.nodes.push_back(
      {n, std::move(facet.contacts), std::move(facet.points), std::vector<FacetNode::Slot>(count)});
  waiting_.push_back(int(graph_.nodes.size()) - 1);
  return waiting_.back();
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
        if (!is_pole(geometry_, c, side)) continue;
        (side == Side::u0 || side == Side::u1 ? c.u : c.v) =
            side == Side::u1 || side == Side::v1 ? 1 : 0;
        const dvec3 normal = unit_normal(geometry_, c);
        const dvec3 x = geometry_.point(c);
        if (normal == dvec3(0.0)) continue;
        for (const dvec3& n : {normal, -normal}) {
          if (query_(n, c).h > glm::dot(x, n) + support_tie) continue;
          const bool known =
              std::any_of(landmarks_.begin(), landmarks_.end(),
                          [&](const Landmark& l) { return glm::distance(l.n, n) < same_plane; });
          if (known) continue;
          std::optional<FacetContacts> f = facet_contacts(geometry_, query_, n, {c});
          if (!f || f->contacts.size() < 3) continue;
          landmarks_.push_back({n, *f});
          add_node(n, std::move(*f));
        }
      }
    }
  }
}

/// Plugs an arc's end into the node's side from the first to the second contact.
void GraphTracer::connect(int arc, int end, int node, const dvec3& first, const dvec3& second) {
  FacetNode& own = graph_.nodes[std::size_t(node)];
  const std::size_t count = own.points.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (glm::distance(own.points[i], first) > same_branch ||
        glm::distance(own.points[(i + 1) % count], second) > same_branch) {
      continue;
    }
    if (own.slots[i].arc >= 0) {
      fail(own.n, "two separating curves leave a facet across one side");
      return;
    }
    own.slots[i] = {arc, end};
    graph_.arcs[std::size_t(arc)].facet[std::size_t(end)] = node;
    return;
  }
  fail(own.n, "a separating curve meets a facet in none of its sides");
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

/// Traces the curve through a seed, both ways unless it closes.
void GraphTracer::trace(const CommonSupport& seed) {
  TracedArc ahead = trace_arc(system_, query_, seed, landmarks_, progress_);
  if (ahead.end == TracedArc::End::lost) {
    fail(seed.n, ahead.reason);
    return;
  }
  SeparatingArc arc;
  const int index = int(graph_.arcs.size());
  if (ahead.end == TracedArc::End::closed) {
    arc.closed = true;
    arc.pieces = std::move(ahead.pieces);
    // It began in the middle of a piece.
    if (arc.pieces.size() > 1 &&
        same_elements(arc.pieces.back().rulings.back(), arc.pieces.front().rulings.front())) {
      std::vector<ArcPiece> first(1, std::move(arc.pieces.front()));
      arc.pieces.erase(arc.pieces.begin());
      append(arc.pieces, std::move(first));
    }
  } else {
    CommonSupport turned = seed;
    std::swap(turned.contact[0], turned.contact[1]);
    std::swap(turned.jet[0], turned.jet[1]);
    TracedArc behind = trace_arc(system_, query_, turned, landmarks_, progress_);
    if (behind.end == TracedArc::End::lost || behind.end == TracedArc::End::closed) {
      fail(seed.n, behind.end == TracedArc::End::lost ? behind.reason
                                                      : "a separating curve closes one way only");
      return;
    }
    const int begin = behind.end == TracedArc::End::plane ? node_of(behind.n, behind.contacts) : -2;
    const int end = ahead.end == TracedArc::End::plane ? node_of(ahead.n, ahead.contacts) : -2;
    if (begin == -1 || end == -1) return;
    reverse(behind.pieces);
    arc.pieces = std::move(behind.pieces);
    append(arc.pieces, std::move(ahead.pieces));
    graph_.arcs.push_back(std::move(arc));
    const SeparatingArc& own = graph_.arcs.back();
    const Ruling first = own.pieces.front().rulings.front();
    const Ruling last = own.pieces.back().rulings.back();
    if (begin >= 0) connect(index, 0, begin, first.point[0], first.point[1]);
    if (end >= 0) connect(index, 1, end, last.point[1], last.point[0]);
  }
  if (arc.closed) graph_.arcs.push_back(std::move(arc));
  Box box;
  for (const ArcPiece& piece : graph_.arcs.back().pieces) {
    for (const Ruling& r : piece.rulings) box.include(r.n);
  }
  boxes_.push_back(box);
  trace_waiting();
}

/// Traces the arcs that leave facets across sides where none was met yet.
void GraphTracer::trace_waiting() {
  while (!waiting_.empty()) {
    const int node = waiting_.back();
    waiting_.pop_back();
    const std::size_t count = graph_.nodes[std::size_t(node)].contacts.size();
    for (std::size_t i = 0; i < count; ++i) {
      if (graph_.nodes[std::size_t(node)].slots[i].arc >= 0) continue;
      const FacetNode& own = graph_.nodes[std::size_t(node)];
      CommonSupport start;
      start.n = own.n;
      start.add(geometry_, own.contacts[i]);
      start.add(geometry_, own.contacts[(i + 1) % count]);
      TracedArc traced = trace_arc(system_, query_, start, landmarks_, progress_);
      if (traced.end == TracedArc::End::lost || traced.end == TracedArc::End::closed) {
        fail(start.n, traced.end == TracedArc::End::lost
                          ? traced.reason
                          : "a separating curve returns into its facet");
        continue;
      }
      const int end = traced.end == TracedArc::End::plane ? node_of(traced.n, traced.contacts) : -2;
      if (end == -1) continue;
      const int index = int(graph_.arcs.size());
      graph_.arcs.emplace_back();
      graph_.arcs.back().pieces = std::move(traced.pieces);
      const Ruling last = graph_.arcs.back().pieces.back().rulings.back();
      graph_.nodes[std::size_t(node)].slots[i] = {index, 0};
      graph_.arcs.back().facet[0] = node;
      if (end >= 0) connect(index, 1, end, last.point[1], last.point[0]);
      Box box;
      for (const ArcPiece& piece : graph_.arcs.back().pieces) {
        for (const Ruling& r : piece.rulings) box.include(r.n);
      }
      boxes_.push_back(box);
    }
  }
}

SeparatingGraph GraphTracer::run(const std::vector<Sample>& samples) {
  std::vector<Sighting> sightings;
  std::vector<dvec3> points;
  Box box;
  for (const Sample& s : samples) {
    const Contact c = geometry_.canonical(s.contact);
    const dvec3 x = geometry_.point(c);
    box.include(x);
    points.push_back(x);
    sightings.push_back({s.n, c, x});
  }
  find_poles();
  trace_waiting();
  PointHull hull(box);
  hull.add(points);
  for (const PointHull::Facet& f : hull.facets()) {
    if (!f.alive) continue;
    progress_.check();
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = f.vertex[k];
      const int b = f.vertex[(k + 1) % 3];
      if (a < b) part(sightings[std::size_t(a)], sightings[std::size_t(b)], 0);
    }
  }
  graph_.newton_iterations = system_.iterations();
  return std::move(graph_);
}

}  // namespace

SeparatingGraph trace_separating_curves(const ContactGeometry& geometry, SupportQuery& query,
                                        const std::vector<Sample>& samples,
                                        const Progress& progress) {
  return GraphTracer(geometry, query, progress).run(samples);
}

}  // namespace taut
