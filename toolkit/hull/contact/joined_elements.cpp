#include "taut/hull/contact/joined_elements.h"

#include <algorithm>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/contact_forms.h"
#include "taut/bounds/poles.h"

namespace taut {
namespace {

/// The smooth corner of the contact's patch about which another patch is too.
std::optional<Contact> common_corner(const ContactGeometry& geometry, const Contact& c,
                                     const Contact& other) {
  if (c.kind != SourceKind::face || other.kind != SourceKind::face) return std::nullopt;
  for (const dvec2& uv : {dvec2(0, 0), dvec2(0, 1), dvec2(1, 0), dvec2(1, 1)}) {
    Contact corner = c;
    corner.u = uv.x;
    corner.v = uv.y;
    if (pole_side(geometry, corner)) continue;
    for (const Contact& at : about(geometry, corner)) {
      if (same_element(at, other)) return corner;
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<Contact> about(const ContactGeometry& geometry, const Contact& c) {
  std::vector<Contact> found = {c};
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Contact at = found[k];
    for (const ContactExit& exit : exits(geometry, at)) {
      if (!leads_over_border(exit) || !stands_at(at, exit)) continue;
      const std::optional<Contact> over = beyond(geometry, at, exit);
      if (!over || over->kind != c.kind) continue;
      const bool known = std::any_of(found.begin(), found.end(), [&](const Contact& other) {
        return same_element(*over, other);
      });
      if (!known) found.push_back(*over);
    }
  }
  return found;
}

std::optional<Contact> expressed_in(const ContactGeometry& geometry, const Contact& c,
                                    const Contact& other) {
  if (c.instance != other.instance) return std::nullopt;
  if (same_element(c, other)) return turned_to(geometry, c, other);
  const auto found = [&](const std::optional<Contact>& next) {
    const bool own = next && same_element(*next, other);
    return own ? std::optional(turned_to(geometry, *next, other)) : std::nullopt;
  };
  if (c.kind == SourceKind::vertex) {
    for (const ContactGeometry::PieceEnd& end : geometry.ends(c)) {
      const Contact at = piece_end(c, end);
      if (const auto next = found(at)) return next;
      if (const auto next = found(expressed_in(geometry, at, other))) return next;
    }
    if (other.kind != SourceKind::face) return std::nullopt;
    for (const Side side : all_sides) {
      if (geometry.patch(other).borders[std::size_t(side)].vertex != c.element) continue;
      return on_side(c.instance, other.element, side, along_v(side) ? other.v : other.u);
    }
    const std::array<int, 4>& corners = geometry.patch(other).corner_vertex;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      if (corners[k] != c.element) continue;
      return Contact{c.instance, other.kind, other.element, k < 2 ? 0.0 : 1.0,
                     k % 2 == 0 ? 0.0 : 1.0};
    }
    return std::nullopt;
  }
  for (const ContactExit& exit : exits(geometry, c)) {
    if (!stands_at(c, exit)) continue;
    if (const auto next = found(beyond(geometry, c, exit))) return next;
  }
  for (const Contact& at : about(geometry, c)) {
    if (const auto next = found(at)) return next;
  }
  return std::nullopt;
}

std::optional<Contact> in_element(const ContactGeometry& geometry, const Contact& c,
                                  const Contact& other) {
  return pole_side(geometry, c) ? pole_in(geometry, c, other) : expressed_in(geometry, c, other);
}

bool continues(const ContactGeometry& geometry, const Contact& a, const Contact& b) {
  if (a.instance != b.instance || a.kind != b.kind || a.kind == SourceKind::vertex) return false;
  if (a.element == b.element) return true;
  for (const ContactExit& exit : exits(geometry, a)) {
    if (!leads_over_border(exit)) continue;
    const std::optional<Contact> over = beyond(geometry, at_exit(a, exit), exit);
    if (over && same_element(*over, b)) return true;
  }
  return common_corner(geometry, a, b).has_value();
}

void move_together(const ContactGeometry& geometry, Contact& a, Contact& b) {
  if (a.instance != b.instance || same_element(a, b)) return;
  const auto moved = [&](Contact& from, Contact& to) {
    for (const ContactExit& exit : exits(geometry, from)) {
      if (!leads_over_border(exit)) continue;
      const Contact border = at_exit(from, exit);
      const std::optional<Contact> over = beyond(geometry, border, exit);
      if (!over || !same_element(*over, to)) continue;
      from = border;
      to = *over;
      return true;
    }
    return false;
  };
  if (moved(a, b) || moved(b, a)) return;
  const std::optional<Contact> corner = common_corner(geometry, a, b);
  if (const auto there = corner ? expressed_in(geometry, *corner, b) : std::nullopt) {
    a = *corner;
    b = *there;
    return;
  }
  // Two edges that end in one vertex.
  for (const ContactExit& own : exits(geometry, a)) {
    if (own.kind != ContactExit::Kind::end) continue;
    const std::optional<Contact> vertex = beyond(geometry, at_exit(a, own), own);
    if (!vertex || vertex->kind != SourceKind::vertex) continue;
    Contact other = *vertex;
    Contact edge = b;
    if (edge.kind != SourceKind::edge || !moved(edge, other)) continue;
    a = at_exit(a, own);
    b = edge;
    return;
  }
}

}  // namespace taut
