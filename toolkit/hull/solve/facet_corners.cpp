#include "taut/hull/solve/facet_corners.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/contact_forms.h"
#include "taut/core/geometry.h"

namespace taut {
namespace {

/// Places on an edge between two, at which it is seen how far it is from their segment.
constexpr int places_between = 8;

void erase(std::size_t k, FacetContacts& facet) {
  const auto at = std::ptrdiff_t(k);
  facet.contacts.erase(facet.contacts.begin() + at);
  facet.points.erase(facet.points.begin() + at);
  facet.sides.erase(facet.sides.begin() + at);
}

/// The parameter of a contact on an edge's piece, if it is there.
std::optional<double> parameter_on(const ContactGeometry& geometry, const EdgeStretch& edge,
                                   const Contact& c) {
  if (c.instance != edge.instance) return std::nullopt;
  if (c.kind == SourceKind::edge && c.element == edge.piece) return c.u;
  const std::array<int, 2>& ends = geometry.piece(edge.at(0)).end_vertex;
  for (const int end : {0, 1}) {
    if (c.kind == SourceKind::vertex && c.element == ends[std::size_t(end)]) return end;
  }
  return std::nullopt;
}

bool is_near_segment(const ContactGeometry& geometry, const EdgeStretch& s, double depth) {
  const dvec3 a = geometry.point(s.at(s.from));
  const dvec3 b = geometry.point(s.at(s.to));
  for (int k = 1; k < places_between; ++k) {
    const double t = glm::mix(s.from, s.to, double(k) / places_between);
    if (distance_to_segment(geometry.point(s.at(t)), a, b) > depth) return false;
  }
  return true;
}

/// The stretch of an edge that goes on from a curved side, forwards or backwards, to the other
/// corner of a straight side beside it.
std::optional<EdgeStretch> across_dent(const ContactGeometry& geometry, const EdgeStretch& beside,
                                       bool forwards, const Contact& corner) {
  if (beside.piece < 0) return std::nullopt;
  const std::optional<double> t = parameter_on(geometry, beside, corner);
  if (!t) return std::nullopt;
  EdgeStretch s = beside;
  if (forwards) {
    s.from = beside.to;
    s.to = *t;
  } else {
    s.from = *t;
    s.to = beside.from;
  }
  const bool goes_on = (s.to - s.from) * (beside.to - beside.from) > 0;
  return goes_on ? std::optional(s) : std::nullopt;
}

/// The other contact, of the same edge, is no farther from the tangent in the one than so much.
bool goes_straight_to(const ContactGeometry& geometry, const Contact& c, const Contact& other,
                      double depth) {
  if (c.kind != SourceKind::edge) return true;
  const ContactJet j = geometry.jet(c);
  const dvec3 way = geometry.point(other) - j.x;
  return glm::length(glm::cross(way, unit(j.dx[0]))) <= depth;
}

/// How far a facet's outline is from its corner k if that is left out.
double off_outline(const ContactGeometry& geometry, std::size_t k, const FacetContacts& facet) {
  const std::size_t count = facet.points.size();
  const std::size_t before = (k + count - 1) % count;
  const dvec3& x = facet.points[k];
  const dvec3& next = facet.points[(k + 1) % count];
  if (!facet.is_curved(before)) return distance_to_segment(x, facet.points[before], next);
  const ContactJet j = geometry.jet(facet.sides[before].at(facet.sides[before].to));
  return glm::length(glm::cross(next - x, unit(j.dx[0])));
}

/// No farther from the segment between its ends.
bool is_near_own_segment(const std::vector<dvec4>& points, double distance) {
  const dvec3 a = euclidean(points.front());
  const dvec3 b = euclidean(points.back());
  return std::all_of(points.begin(), points.end(), [&](const dvec4& p) {
    return distance_to_segment(euclidean(p), a, b) <= distance;
  });
}

}  // namespace

void move_to_ends(const ContactGeometry& geometry, double depth, double distance,
                  FacetContacts& facet) {
  if (facet.sides.empty()) return;
  const auto moved = [&](const Contact& c) {
    const Contact end = moved_to_border(geometry, c, distance);
    return goes_straight_to(geometry, c, end, depth) ? end : c;
  };
  for (EdgeStretch& s : facet.sides) {
    if (s.piece < 0) continue;
    s.from = moved(s.at(s.from)).u;
    s.to = moved(s.at(s.to)).u;
  }
  for (std::size_t k = 0; k < facet.contacts.size(); ++k) {
    Contact& c = facet.contacts[k];
    c = facet.is_curved(k) ? facet.sides[k].at(facet.sides[k].from) : moved(c);
    facet.points[k] = geometry.point(c);
  }
}

void unite_corners(const ContactGeometry& geometry, double depth, double distance,
                   FacetContacts& facet) {
  if (facet.sides.empty()) return;
  // A corner with a curved side behind it stays, as that begins there.
  for (std::size_t k = 0; k < facet.contacts.size() && facet.contacts.size() > 2;) {
    const std::size_t next = (k + 1) % facet.contacts.size();
    const bool is_one = !facet.is_curved(k) &&
                        glm::distance(facet.points[k], facet.points[next]) <= distance &&
                        off_outline(geometry, k, facet) <= depth;
    if (is_one) {
      erase(k, facet);
    } else {
      ++k;
    }
  }
}

void fill_dents(const ContactGeometry& geometry, double depth, FacetContacts& facet) {
  for (std::size_t k = 0; k < facet.sides.size() && facet.sides.size() > 1;) {
    const std::size_t count = facet.sides.size();
    const std::size_t next = (k + 1) % count;
    const std::size_t before = (k + count - 1) % count;
    const bool is_straight = !facet.is_curved(k);
    const auto after = is_straight
                           ? across_dent(geometry, facet.sides[before], true, facet.contacts[next])
                           : std::nullopt;
    if (after && is_near_segment(geometry, *after, depth)) {
      facet.sides[before].to = after->to;
      erase(k, facet);
      continue;
    }
    const auto ahead = is_straight
                           ? across_dent(geometry, facet.sides[next], false, facet.contacts[k])
                           : std::nullopt;
    if (ahead && is_near_segment(geometry, *ahead, depth)) {
      facet.sides[k] = facet.sides[next];
      facet.sides[k].from = ahead->from;
      erase(next, facet);
      continue;
    }
    ++k;
  }
}

std::optional<ClimbedContact> level_border(const ContactGeometry& geometry, const Contact& c,
                                           const dvec3& n, double least) {
  const dvec3 x = geometry.point(c);
  std::optional<ClimbedContact> nearest;
  for (const ContactExit& exit : exits(geometry, c)) {
    if (!leads_over_border(exit)) continue;
    const Contact there = at_exit(c, exit);
    const dvec3 y = geometry.point(there);
    if (!(glm::dot(y, n) >= least)) continue;
    if (nearest && glm::distance(nearest->x, x) <= glm::distance(y, x)) continue;
    nearest = ClimbedContact{geometry.canonical(there), y, glm::dot(y, n)};
  }
  return nearest;
}

std::vector<EdgeStretch> pieces_between(const ContactGeometry& geometry, const Contact& from,
                                        const Contact& to, double distance) {
  const dvec3 a = geometry.point(from);
  const dvec3 b = geometry.point(to);
  const dvec3 way = unit(b - a);
  const double length = glm::distance(a, b);
  // By where they begin: where they end.
  std::multimap<double, std::pair<double, EdgeStretch>> found;
  for (const int i : geometry.scene().distinct_instances()) {
    const int count = int(geometry.part({i, SourceKind::edge, 0, 0, 0}).pieces().size());
    for (int k = 0; k < count; ++k) {
      const Contact piece{i, SourceKind::edge, k, 0, 0};
      const std::vector<dvec4>& points = geometry.curve(piece).points;
      double begin = glm::dot(euclidean(points.front()) - a, way);
      double end = glm::dot(euclidean(points.back()) - a, way);
      const bool forwards = begin < end;
      if (!forwards) std::swap(begin, end);
      if (end <= distance || begin >= length - distance) continue;
      const auto off = [&](const dvec4& p) {
        return glm::length(glm::cross(euclidean(p) - a, way));
      };
      if (std::max(off(points.front()), off(points.back())) > distance) continue;
      if (!is_near_own_segment(points, distance) || geometry.is_repeated(piece)) continue;
      EdgeStretch s{i, k, forwards ? 0.0 : 1.0, forwards ? 1.0 : 0.0};
      // Of a piece that goes on beyond a place, what is between.
      if (begin < -distance) s.from = parameter_on(geometry, s, from).value_or(s.to);
      if (end > length + distance) s.to = parameter_on(geometry, s, to).value_or(s.from);
      if (s.from == s.to) continue;
      found.emplace(std::max(begin, 0.0), std::pair(std::min(end, length), s));
    }
  }
  std::vector<EdgeStretch> pieces;
  double end = 0;
  for (const auto& [begin, piece] : found) {
    if (std::abs(begin - end) > distance) continue;  // of another edge along the same segment
    end = piece.first;
    pieces.push_back(piece.second);
  }
  return std::abs(end - length) <= distance ? pieces : std::vector<EdgeStretch>();
}

void run_along_edges(const ContactGeometry& geometry, double distance, FacetNode& facet) {
  FacetNode result{facet.n, {}, {}, {}, {}, facet.is_crossing};
  bool any = false;
  for (std::size_t k = 0; k < facet.contacts.size(); ++k) {
    result.contacts.push_back(facet.contacts[k]);
    result.points.push_back(facet.points[k]);
    result.sides.push_back(facet.sides.empty() ? EdgeStretch{} : facet.sides[k]);
    result.slots.push_back(facet.slots[k]);
    if (facet.is_curved(k) || facet.slots[k].arc >= 0) continue;
    const Contact& next = facet.contacts[(k + 1) % facet.points.size()];
    bool is_first = true;
    for (const EdgeStretch& s : pieces_between(geometry, facet.contacts[k], next, distance)) {
      if (is_first) {
        result.sides.back() = s;
      } else {
        result.contacts.push_back(s.at(s.from));
        result.points.push_back(geometry.point(s.at(s.from)));
        result.sides.push_back(s);
        result.slots.emplace_back();
      }
      is_first = false;
      any = true;
    }
  }
  if (any) facet = std::move(result);
}

}  // namespace taut
