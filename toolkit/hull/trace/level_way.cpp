#include "taut/hull/trace/level_way.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "taut/bounds/contact_climb.h"
#include "taut/bounds/contact_exits.h"
#include "taut/hull/contact/joined_elements.h"

namespace taut {
namespace {

/// Contacts that are farther apart are told by other means than their heights.
constexpr double longest_level_way = 2e-3;
/// Contacts nearer to each other than this are one.
constexpr double shortest_way = 1e-7;
/// Elements in a row.
constexpr int element_limit = 8;
/// Parts of the way in an element, at the ends of which heights are compared.
constexpr int samples = 8;

/// Contacts with other parameters, of one element.
Contact between(const Contact& a, const Contact& b, double share) {
  Contact c = a;
  c.u += share * (b.u - a.u);
  c.v += share * (b.v - a.v);
  return c;
}

/// Where the parameters would have to be for the contact to be at x, to first order.
dvec2 parameters_at(const ContactGeometry& geometry, const Contact& c, const dvec3& x) {
  const ContactJet j = geometry.jet(c);
  return parameters(c) + parameter_change(j, x - j.x);
}

/// The exit, to where the parameters would have to be, that is met first, and the contact there.
std::optional<std::pair<Contact, ContactExit>> exit_towards(const ContactGeometry& geometry,
                                                            const Contact& c, const dvec2& to) {
  std::optional<std::pair<Contact, ContactExit>> first;
  double least = 1;
  const dvec2 way = to - dvec2(c.u, c.v);
  for (const ContactExit& exit : exits(geometry, c)) {
    if (!leads_over_border(exit)) continue;
    const Side side = all_sides[std::size_t(exit.index)];  // an edge's ends are as the first two
    const Contact border = at_exit(c, exit);
    const double speed = (at_upper_end(side) ? 1 : -1) * (along_v(side) ? way.x : way.y);
    const double distance = std::abs(border.u - c.u) + std::abs(border.v - c.v);
    if (speed <= 0 || distance > least * speed) continue;
    least = distance / speed;
    Contact there = c;
    there.u = std::clamp(c.u + least * way.x, 0.0, 1.0);
    there.v = std::clamp(c.v + least * way.y, 0.0, 1.0);
    first = {at_exit(there, exit), exit};
  }
  return first;
}

/// The edge that leaves the vertex most nearly towards x.
std::optional<Contact> edge_towards(const ContactGeometry& geometry, const Contact& vertex,
                                    const dvec3& x) {
  std::optional<Contact> best;
  double most = 0;
  const dvec3 way = unit(x - geometry.point(vertex));
  for (const Contact& c : piece_ends(geometry, vertex)) {
    const double along = (c.u == 0 ? 1 : -1) * glm::dot(unit(geometry.jet(c).dx[0]), way);
    if (along <= most) continue;
    most = along;
    best = c;
  }
  return best;
}

/// The crossings of the way from a to b, found step by step.
std::optional<std::vector<WayCrossing>> way(const ContactGeometry& geometry, const Contact& a,
                                            const Contact& b) {
  const dvec3 x = geometry.point(b);
  std::vector<WayCrossing> crossings;
  Contact at = a;
  for (int k = 0; k < element_limit; ++k) {
    if (at.kind == SourceKind::edge && geometry.is_straight(at)) return std::nullopt;
    if (same_element(at, b)) return crossings;
    if (at.kind == SourceKind::vertex) {
      const std::optional<Contact> edge = edge_towards(geometry, at, x);
      if (!edge) return std::nullopt;
      crossings.push_back({at, *edge});
      at = *edge;
      continue;
    }
    const auto exit = exit_towards(geometry, at, parameters_at(geometry, at, x));
    if (!exit) {
      // Up to rounding b lies on a border, of an element beyond.
      const std::optional<Contact> own = expressed_in(geometry, b, at);
      if (!own) return std::nullopt;
      crossings.push_back({*own, b});
      return crossings;
    }
    const std::optional<Contact> over = beyond(geometry, exit->first, exit->second);
    if (!over) return std::nullopt;
    crossings.push_back({exit->first, *over});
    at = *over;
  }
  return std::nullopt;
}

/// The point of the surface or curve to which the way towards x leads.
std::optional<Contact> walked(const ContactGeometry& geometry, const Contact& c, const dvec3& x) {
  std::optional<Contact> at = c;
  for (int k = 0; k < element_limit && at && at->kind != SourceKind::vertex; ++k) {
    const dvec2 to = parameters_at(geometry, *at, x);
    const auto exit = exit_towards(geometry, *at, to);
    if (!exit) {
      at->u = to.x;
      at->v = to.y;
      return at;
    }
    at = beyond(geometry, exit->first, exit->second);
  }
  return std::nullopt;
}

/// No point of the way is lower than this.
bool is_level(const ContactGeometry& geometry, const Contact& a, const Contact& b,
              const std::vector<WayCrossing>& crossings, const dvec3& n, double least) {
  Contact from = a;
  for (std::size_t k = 0; k <= crossings.size(); ++k) {
    const Contact& to = k < crossings.size() ? crossings[k].from : b;
    for (int i = 0; i <= samples; ++i) {
      const Contact c = between(from, to, double(i) / samples);
      if (glm::dot(geometry.point(c), n) < least) return false;
    }
    if (k < crossings.size()) from = crossings[k].to;
  }
  return true;
}

}  // namespace

std::optional<std::vector<WayCrossing>> level_way(const ContactGeometry& geometry, const Contact& a,
                                                  const Contact& b, const dvec3& n) {
  const dvec3 apart = geometry.point(a) - geometry.point(b);
  if (a.instance != b.instance || glm::length(apart) > longest_level_way) return std::nullopt;
  std::optional<std::vector<WayCrossing>> crossings = way(geometry, a, b);
  if (!crossings) {
    crossings = way(geometry, b, a);
    if (!crossings) return std::nullopt;
    std::reverse(crossings->begin(), crossings->end());
    for (WayCrossing& c : *crossings) std::swap(c.from, c.to);
  }
  const double height = std::min(glm::dot(geometry.point(a), n), glm::dot(geometry.point(b), n));
  if (!is_level(geometry, a, b, *crossings, n, height - geometry.tie())) return std::nullopt;
  return crossings;
}

std::optional<LevelStep> tied_ahead(const ContactGeometry& geometry, const Contact& c,
                                    const dvec2& rate, const dvec3& n) {
  const ContactJet j = geometry.jet(c);
  const dvec3 along = unit(rate.x * j.dx[0] + rate.y * j.dx[1]);
  std::optional<LevelStep> best;
  double highest = 0;
  for (double reach = shortest_way; reach < longest_level_way; reach *= 2) {
    const std::optional<Contact> from = walked(geometry, c, j.x + reach * along);
    if (!from) break;
    const std::optional<Contact> top = climbed(geometry, *from, n);
    if (!top || is_flat(geometry.jet(*top), n, least_curvature)) continue;
    const dvec3 x = geometry.point(*top);
    const double height = glm::dot(x, n);
    if (glm::distance(x, j.x) < shortest_way || (best && height <= highest)) continue;
    std::optional<std::vector<WayCrossing>> way = level_way(geometry, c, *top, n);
    if (!way) continue;
    best = LevelStep{*top, std::move(*way)};
    highest = height;
  }
  return best;
}

}  // namespace taut
