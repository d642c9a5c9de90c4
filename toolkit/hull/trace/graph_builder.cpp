#include "taut/hull/trace/graph_builder.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "taut/bounds/poles.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/hull/contact/level_sides.h"
#include "taut/hull/contact/rulings_between.h"
#include "taut/hull/trace/arc_tracer.h"
#include "taut/hull/trace/level_way.h"
#include "taut/hull/trace/partings.h"

namespace taut {
namespace {

/// Free ends that are nearer are one.
constexpr double same_end = 1e-4;
/// A seed lies on a curve that was traced if the curve passes it within this distance.
constexpr double same_curve = 1e-6;
/// Cosine of the angle at which two curves that run into one free end are one.
constexpr double same_approach = 0.999;
/// Chords count as this much longer at both ends, as a share, because the curve turns between them.
constexpr double overlap = 0.2;
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
/// Directions of seeds are found to within this.
constexpr double seed_turn = 1e-9;
/// Halvings of what is between two rulings to find the one that a direction lies in.
constexpr int share_halvings = 40;
/// Directions of consecutive rulings are no farther apart.
constexpr double longest_chord = 0.2;

}  // namespace

void GraphBuilder::fail(const dvec3& n, const char* reason) {
  const bool known =
      std::any_of(graph_.unresolved.begin(), graph_.unresolved.end(), [&](const Unresolved& u) {
        return u.reason == reason && glm::distance(u.n, n) < same_branch_distance;
      });
  if (!known) graph_.unresolved.push_back({n, reason});
}

int GraphBuilder::add(SeparatingArc arc) {
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

int GraphBuilder::add_node(const dvec3& n, FacetContacts facet) {
  const std::size_t count = facet.contacts.size();
  for (const Contact& c : facet.contacts) crossings_.add(c);
  for (const EdgeStretch& side : facet.sides) {
    if (side.piece >= 0) crossings_.add(side);
  }
  graph_.nodes.push_back({n, std::move(facet.contacts), std::move(facet.points),
                          std::move(facet.sides), std::vector<FacetNode::Slot>(count)});
  return int(graph_.nodes.size()) - 1;
}

int GraphBuilder::crossing_at(const dvec3& n, const Contact& contact) {
  const dvec3 x = geometry_.point(contact);
  for (std::size_t k = 0; k < graph_.nodes.size(); ++k) {
    const FacetNode& node = graph_.nodes[k];
    if (node.is_crossing() && glm::distance(node.n, n) < same_branch_distance &&
        glm::distance(node.points.front(), x) < same_branch_distance) {
      return int(k);
    }
  }
  graph_.nodes.push_back({n, {contact}, {x}, {}, {}});
  return int(graph_.nodes.size()) - 1;
}

/// The side of a facet from its contact at the one point to that at the other; -1 if there is none.
int GraphBuilder::side_of(int node, const dvec3& first, const dvec3& second) const {
  const std::vector<dvec3>& points = graph_.nodes[std::size_t(node)].points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (glm::distance(points[i], first) < same_branch_distance &&
        glm::distance(points[(i + 1) % points.size()], second) < same_branch_distance) {
      return int(i);
    }
  }
  return -1;
}

/// Gives the ruling, with which an arc ends or begins on a side of the node, the node's own normal
/// and contacts: they differ by rounding.
void GraphBuilder::settle_in(const FacetNode& node, std::size_t side, int end, Ruling& r) const {
  r.n = node.n;
  for (std::size_t i = 0; i < 2; ++i) {
    const bool first = (i == 0) == (end == 0);
    const std::size_t corner = first ? side : (side + 1) % node.points.size();
    const Contact at = at_level_border(geometry_, r.contact[i], node.n).value_or(r.contact[i]);
    if (glm::distance(node.points[corner], geometry_.point(at)) > rounded_contact) continue;
    const std::optional<Contact> c = expressed_in(geometry_, node.contacts[corner], r.contact[i]);
    if (!c) continue;
    r.contact[i] = *c;
    r.point[i] = node.points[corner];
  }
}

/// Gives the ruling, with which an arc ends in a free end, the place of an arc that ends there
/// already: they differ by rounding.
void GraphBuilder::settle_in_end(int arc, Ruling& r) const {
  for (std::size_t k = 0; k < graph_.arcs.size(); ++k) {
    const SeparatingArc& other = graph_.arcs[k];
    for (const std::size_t e : {0U, 1U}) {
      if (int(k) == arc || other.closed || other.facet[e] >= 0) continue;
      const Ruling& known =
          e == 0 ? other.pieces.front().rulings.front() : other.pieces.back().rulings.back();
      if (glm::distance(known.n, r.n) > rounded_contact ||
          glm::distance(known.point[0], r.point[0]) > rounded_contact) {
        continue;
      }
      for (std::size_t i = 0; i < 2; ++i) {
        for (const Contact& from : known.contact) {
          const std::optional<Contact> c = expressed_in(geometry_, from, r.contact[i]);
          if (!c) continue;
          r.contact[i] = *c;
          r.point[i] = known.point[0];
          break;
        }
      }
      r.n = known.n;
      return;
    }
  }
}

void GraphBuilder::connect(int arc, int end, int node) {
  if (node == free_end) {
    std::vector<ArcPiece>& own = graph_.arcs[std::size_t(arc)].pieces;
    settle_in_end(arc, end == 0 ? own.front().rulings.front() : own.back().rulings.back());
    return;
  }
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
bool GraphBuilder::meets_corner(const FacetNode& node, const Ruling& r) {
  return std::any_of(node.points.begin(), node.points.end(), [&](const dvec3& p) {
    return glm::distance(p, r.point[0]) < same_branch_distance &&
           glm::distance(p, r.point[1]) < same_branch_distance;
  });
}

/// Makes the corner in which both contacts are two, with a side of no length between them; its
/// number.
int GraphBuilder::add_corner(FacetNode& node, const Ruling& r, int end) {
  const auto found = std::find_if(node.points.begin(), node.points.end(), [&](const dvec3& p) {
    return glm::distance(p, r.point[0]) < same_branch_distance;
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
void GraphBuilder::connect_crossing(int arc, int end, int node) {
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

/// Whether an arc is there already that runs into the same free end, from the same side. In a pole
/// several may end, and in one point of an edge two, their contacts on it coming from either side.
bool GraphBuilder::is_end_known(const std::vector<ArcPiece>& pieces) const {
  const auto approach = [](const Ruling& end, const Ruling& before) {
    return unit(end.n - before.n);
  };
  const std::vector<Ruling>& own = pieces.back().rulings;
  const Ruling& end = own.back();
  const Ruling& own_before = own[own.size() - 2];
  const dvec3 along = approach(end, own_before);
  // Of an arc that begins in the end the first contact is the other's second one.
  const auto same = [&](const Ruling& other, const Ruling& before, bool begins) {
    const dvec3 aside = before.point[begins ? 1 : 0] - other.point[0];
    return other.point[0] == other.point[1] &&
           glm::distance(other.n, end.n) < same_branch_distance &&
           glm::distance(other.point[0], end.point[0]) < same_branch_distance &&
           glm::dot(approach(other, before), along) > same_approach &&
           glm::dot(aside, own_before.point[0] - end.point[0]) > 0;
  };
  return std::any_of(graph_.arcs.begin(), graph_.arcs.end(), [&](const SeparatingArc& arc) {
    if (arc.closed) return false;
    const std::vector<Ruling>& first = arc.pieces.front().rulings;
    const std::vector<Ruling>& last = arc.pieces.back().rulings;
    return (arc.facet[0] < 0 && same(first.front(), first[1], true)) ||
           (arc.facet[1] < 0 && same(last.back(), last[last.size() - 2], false));
  });
}

bool GraphBuilder::is_taken(int node, const std::vector<ArcPiece>& pieces) const {
  if (node == free_end) return is_end_known(pieces);
  if (graph_.nodes[std::size_t(node)].is_crossing()) return false;
  const Ruling& last = pieces.back().rulings.back();
  const int side = side_of(node, last.point[1], last.point[0]);
  return side >= 0 && graph_.nodes[std::size_t(node)].slots[std::size_t(side)].arc >= 0;
}

bool GraphBuilder::is_crossed(const SupportChange& change) const {
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

/// The ruling has the contact, at x, as far as support values in the direction n tell.
bool GraphBuilder::is_told(const Ruling& r, std::size_t i, const Contact& c, const dvec3& x,
                           const dvec3& n) const {
  return glm::distance(r.point[i], x) < same_curve ||
         level_way(geometry_, r.contact[i], c, n).has_value();
}

bool GraphBuilder::is_traced(const CommonSupport& seed) const {
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
        const dvec3 dn = to.n - from.n;
        const dvec3 d0 = to.point[0] - from.point[0];
        const dvec3 d1 = to.point[1] - from.point[1];
        const double square = glm::dot(dn, dn) + glm::dot(d0, d0) + glm::dot(d1, d1);
        const dvec3 en = seed.n - from.n;
        // As far as the conditions below let it be: those on s and on what is off, and the ends'
        // own, (|dn| + e)^2 <= 1.25 |dn|^2 + 5 e^2.
        constexpr double farthest = (1 + overlap) * (1 + overlap) + 0.25;
        if (glm::dot(en, en) > farthest * square + 5 * same_curve * same_curve) continue;
        for (const bool swapped : {false, true}) {
          const dvec3& x0 = x[swapped ? 1 : 0];
          const dvec3& x1 = x[swapped ? 0 : 1];
          const auto is_seed = [&](const Ruling& r) {
            return glm::distance(r.n, seed.n) < same_curve &&
                   is_told(r, 0, seed.contact[swapped ? 1 : 0], x0, seed.n) &&
                   is_told(r, 1, seed.contact[swapped ? 0 : 1], x1, seed.n);
          };
          // At a pole no ruling between others may be found.
          if (is_seed(from) || is_seed(to)) return true;
          if (square == 0) continue;
          const dvec3 e0 = x0 - from.point[0];
          const dvec3 e1 = x1 - from.point[1];
          const double s = (glm::dot(en, dn) + glm::dot(e0, d0) + glm::dot(e1, d1)) / square;
          if (s < -overlap || s > 1 + overlap) continue;
          const double off = glm::dot(en, en) + glm::dot(e0, e0) + glm::dot(e1, e1);
          if (off - s * s * square > 0.25 * square + same_curve * same_curve) continue;
          const std::optional<Ruling> there = ruling_at_share(system_, from, to, s);
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
bool GraphBuilder::lies_in(const FacetNode& node, const dvec3& n,
                           const std::vector<Contact>& contacts) const {
  const bool at_poles =
      std::any_of(node.contacts.begin(), node.contacts.end(),
                  [&](const Contact& c) { return pole_side(geometry_, c).has_value(); });
  return (!node.sides.empty() || at_poles) && ties_with(node, n, contacts);
}

/// The plane is the node's as far as heights tell.
bool GraphBuilder::ties_with(const FacetNode& node, const dvec3& n,
                             const std::vector<Contact>& contacts) const {
  const double turn = std::max(nearly_same_plane, root_turn * std::sqrt(geometry_.rounding()));
  return glm::distance(node.n, n) < turn && has_contacts(node, contacts);
}

/// All of the contacts are in the facet's plane, or below it by less than `slack`.
bool GraphBuilder::has_contacts(const FacetNode& node, const std::vector<Contact>& contacts,
                                double slack) const {
  const double offset = glm::dot(node.points.front(), node.n);
  return std::all_of(contacts.begin(), contacts.end(), [&](const Contact& c) {
    return glm::dot(geometry_.point(c), node.n) >= offset - geometry_.tie() - slack;
  });
}

/// The point of the facet's plane is one of its corners, or between them.
bool GraphBuilder::is_within(const FacetNode& node, const dvec3& x) {
  const std::size_t count = node.points.size();
  bool inside = true;
  for (std::size_t k = 0; k < count; ++k) {
    if (glm::distance(node.points[k], x) < same_branch_distance) return true;
    const dvec3 side = unit(node.points[(k + 1) % count] - node.points[k]);
    inside =
        inside && glm::dot(glm::cross(side, x - node.points[k]), node.n) > -same_branch_distance;
  }
  return inside && count > 2;
}

std::optional<int> GraphBuilder::node_of(const dvec3& n,
                                         const std::vector<Contact>& contacts) const {
  for (std::size_t k = 0; k < graph_.nodes.size(); ++k) {
    const FacetNode& node = graph_.nodes[k];
    if (node.is_crossing()) continue;
    if (lies_in(node, n, contacts)) return int(k);
    if (glm::distance(node.n, n) > same_plane) continue;
    // Facets of nearly equal planes have other contacts.
    const bool known = std::all_of(contacts.begin(), contacts.end(), [&](const Contact& c) {
      return is_within(node, geometry_.point(c));
    });
    if (known) return int(k);
  }
  return std::nullopt;
}

bool GraphBuilder::lies_in_facet(const CommonSupport& s) const {
  return std::any_of(graph_.nodes.begin(), graph_.nodes.end(), [&](const FacetNode& node) {
    return lies_in(node, s.n, {s.contact[0], s.contact[1]});
  });
}

bool GraphBuilder::ties_with_facet(const CommonSupport& seed) const {
  return std::any_of(graph_.nodes.begin(), graph_.nodes.end(), [&](const FacetNode& node) {
    return ties_with(node, seed.n, {seed.contact[0], seed.contact[1]});
  });
}

/// The ruling between two of a piece in which n lies, as far as it lies between theirs.
std::optional<Ruling> GraphBuilder::ruling_towards(const Ruling& from, const Ruling& to,
                                                   const dvec3& n) const {
  const dvec3 turn = to.n - from.n;
  const double square = glm::dot(turn, turn);
  // How much of the turn lies ahead of a ruling. Next to flat ends n turns with the square of the
  // chord's share.
  const auto ahead = [&](const Ruling& r) { return glm::dot(n - r.n, turn) / square; };
  const double s = ahead(from);
  if (!(s > 0 && s < 1) || glm::distance(n, from.n + s * turn) > overlap * std::sqrt(square)) {
    return std::nullopt;
  }
  std::optional<Ruling> there;
  double low = 0;
  double high = 1;
  for (int k = 0; k < share_halvings; ++k) {
    const double middle = 0.5 * (low + high);
    there = ruling_at_share(system_, from, to, middle);
    if (!there || glm::distance(there->n, n) < same_plane) break;
    (ahead(*there) > 0 ? low : high) = middle;
  }
  return there;
}

/// All of the points are in line with the ruling of an arc in nearly this direction, in its plane.
/// On flat elements contacts move with the root of the direction's turn. `turn_slack`: n is known
/// to within this.
bool GraphBuilder::lies_in_ruling(const dvec3& n, const std::vector<dvec3>& points,
                                  double turn_slack) const {
  const auto has_points = [&](const Ruling& r) {
    const double turn = glm::distance(r.n, n);
    if (turn >= same_plane) return false;
    const double reach = same_branch_distance + std::sqrt(moved_contact * turn);
    const dvec3 along = unit(r.point[1] - r.point[0]);
    return std::all_of(points.begin(), points.end(), [&](const dvec3& x) {
      const dvec3 off = x - r.point[0];
      const double slack = geometry_.tie() + turn_slack * glm::length(off);
      return glm::length(glm::cross(along, off)) < reach && glm::dot(off, r.n) >= -slack;
    });
  };
  return std::any_of(graph_.arcs.begin(), graph_.arcs.end(), [&](const SeparatingArc& arc) {
    return std::any_of(arc.pieces.begin(), arc.pieces.end(), [&](const ArcPiece& piece) {
      const std::vector<Ruling>& all = piece.rulings;
      for (std::size_t k = 0; k + 1 < all.size(); ++k) {
        const std::optional<Ruling> between = ruling_towards(all[k], all[k + 1], n);
        if (between && has_points(*between)) return true;
      }
      return std::any_of(all.begin(), all.end(), has_points);
    });
  });
}

bool GraphBuilder::lies_in_ruling(const CommonSupport& seed) const {
  return lies_in_ruling(seed.n, {seed.jet[0].x, seed.jet[1].x}, seed_turn);
}

bool GraphBuilder::is_ruling(int index) const {
  const FacetNode& node = graph_.nodes[std::size_t(index)];
  const bool has_arcs = std::any_of(node.slots.begin(), node.slots.end(),
                                    [](const FacetNode::Slot& slot) { return slot.arc >= 0; });
  return !has_arcs && node.sides.empty() && !node.is_crossing() &&
         lies_in_ruling(node.n, node.points, 0);
}

SeparatingGraph GraphBuilder::take() {
  std::vector<int> number(graph_.nodes.size(), -1);
  std::vector<FacetNode> kept;
  for (std::size_t k = 0; k < graph_.nodes.size(); ++k) {
    if (is_ruling(int(k))) continue;
    number[k] = int(kept.size());
    kept.push_back(std::move(graph_.nodes[k]));
  }
  graph_.nodes = std::move(kept);
  for (SeparatingArc& arc : graph_.arcs) {
    for (int& node : arc.facet) {
      if (node >= 0) node = number[std::size_t(node)];
    }
  }
  return std::move(graph_);
}

/// Whether the seed, in a direction that is hardly off the node's, is on a curve that leaves it:
/// its contacts are two of the node's own that have moved by as little.
bool GraphBuilder::is_beside(const FacetNode& node, const CommonSupport& seed, double off) {
  const double reach = same_branch_distance + moved_contact * off;
  return std::all_of(seed.jet.begin(), seed.jet.begin() + seed.count, [&](const ContactJet& j) {
    return std::any_of(node.points.begin(), node.points.end(),
                       [&](const dvec3& p) { return glm::distance(p, j.x) < reach; });
  });
}

bool GraphBuilder::is_at_facet(const CommonSupport& seed) const {
  return std::any_of(graph_.nodes.begin(), graph_.nodes.end(), [&](const FacetNode& node) {
    const double off = glm::distance(node.n, seed.n);
    return !node.is_crossing() && off < at_facet && is_beside(node, seed, off);
  });
}

bool GraphBuilder::is_facet(const CommonSupport& seed) const {
  const std::vector<Contact> contacts(seed.contact.begin(), seed.contact.begin() + seed.count);
  return std::any_of(graph_.nodes.begin(), graph_.nodes.end(), [&](const FacetNode& node) {
    if (node.is_crossing()) return false;
    if (lies_in(node, seed.n, contacts)) return true;
    const double off = glm::distance(node.n, seed.n);
    return (off < same_plane && has_contacts(node, contacts, off)) ||
           (off < nearly_same_plane && is_beside(node, seed, off));
  });
}

bool GraphBuilder::is_reached(const FreeEnd& end) const {
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

std::vector<CulledCell> GraphBuilder::uncrossed(const std::vector<CulledCell>& cells,
                                                double margin) const {
  std::vector<CulledCell> result;
  std::copy_if(cells.begin(), cells.end(), std::back_inserter(result), [&](const CulledCell& cell) {
    return cell.state == CellState::mixed &&
           !geometry_.is_repeated({cell.instance, SourceKind::face, cell.patch, 0, 0}) &&
           !crossings_.crosses(cell, margin);
  });
  return result;
}

}  // namespace taut
