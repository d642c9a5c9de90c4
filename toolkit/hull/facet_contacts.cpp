#include "taut/hull/facet_contacts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "taut/hull/contact_exits.h"
#include "taut/hull/outline.h"

namespace taut {
namespace {

/// How often the third contact may be exchanged for one that surpasses it.
constexpr int exchange_limit = 16;

/// Turn of the direction, in radians, by which contacts beyond a side show. A tie is won by turn
/// times distance, much more than support_tie; a contact that loses in the plane itself by more
/// than that stays hidden.
constexpr double side_turn = 1e-6;

/// Directions turned all around: any other contact is within 60 degrees of one of three.
constexpr int all_around = 3;

/// How far parameters may leave [0, 1] by rounding.
constexpr double parameter_slack = 1e-9;

bool in_range(const Contact& c) {
  const auto within = [](double t) { return t >= -parameter_slack && t <= 1 + parameter_slack; };
  return within(c.u) && within(c.v);
}

Contact clamped(Contact c) {
  c.u = std::clamp(c.u, 0.0, 1.0);
  c.v = std::clamp(c.v, 0.0, 1.0);
  return c;
}

/// The corners of the contacts' convex hull, counter-clockwise about n.
FacetContacts corners_only(const FacetContacts& f, const dvec3& n) {
  const auto turn = [&](std::size_t k) {
    return glm::dot(glm::cross(f.points[1] - f.points[0], f.points[k] - f.points[0]), n);
  };
  std::size_t third = 2;
  for (std::size_t k = 3; k < f.points.size(); ++k) {
    if (std::abs(turn(k)) > std::abs(turn(third))) third = k;
  }
  if (turn(third) == 0) return f;
  const dvec3& a = f.points[turn(third) > 0 ? 0 : 1];
  const dvec3& b = f.points[turn(third) > 0 ? 1 : 0];
  const PlaneView view(a, b, f.points[third]);
  FacetContacts result;
  for (const int k : simplified_outline(convex_outline(f.points, view), f.points, same_contact)) {
    result.contacts.push_back(f.contacts[std::size_t(k)]);
    result.points.push_back(f.points[std::size_t(k)]);
  }
  return result;
}

}  // namespace

std::optional<CommonSupport> common_plane(const ContactSystem& system, SupportQuery& query,
                                          const CommonSupport& s, Contact winner) {
  const ContactGeometry& geometry = system.geometry();
  dvec3 near = s.n;
  for (int k = 0; k < exchange_limit; ++k) {
    const std::optional<Contact> third = climbed(geometry, clamped(winner), near);
    if (!third) return std::nullopt;
    CommonSupport plane = s;
    plane.count = 2;
    plane.add(geometry, *third);
    if (!system.solve(plane)) return std::nullopt;
    if (!in_range(plane.contact[2])) {
      // The contact belongs to a neighbouring element there.
      winner = plane.contact[2];
      near = plane.n;
      const std::optional<Contact> moved = climbed(geometry, clamped(winner), near);
      if (!moved || (moved->kind == third->kind && moved->element == third->element &&
                     moved->instance == third->instance)) {
        return std::nullopt;
      }
      winner = *moved;
      continue;
    }
    const Support top = query(plane.n, plane.contact[2]);
    if (top.h <= glm::dot(plane.jet[0].x, plane.n) + support_tie) return plane;
    winner = geometry.canonical(top.contact);
    near = plane.n;
  }
  return std::nullopt;
}

std::optional<FacetContacts> facet_contacts(const ContactGeometry& geometry, SupportQuery& query,
                                            const dvec3& n, const std::vector<Contact>& known) {
  FacetContacts f;
  const auto add = [&](std::size_t place, const Contact& c, const dvec3& x) {
    f.contacts.insert(f.contacts.begin() + std::ptrdiff_t(place), c);
    f.points.insert(f.points.begin() + std::ptrdiff_t(place), x);
  };
  for (const Contact& c : known) add(f.points.size(), clamped(c), geometry.point(clamped(c)));
  if (known.empty()) {
    const Support top = query(n);
    add(0, geometry.canonical(top.contact), top.point);
  }
  const double h = glm::dot(f.points[0], n);
  /// A contact that ties with the others in n, seen from a direction turned by `towards`.
  const auto found = [&](const dvec3& towards) -> std::optional<std::pair<Contact, dvec3>> {
    const Support s = query(glm::normalize(n + side_turn * towards), f.contacts[0]);
    const std::optional<Contact> c = climbed(geometry, s.contact, n);
    if (!c) return std::nullopt;
    const dvec3 x = geometry.point(*c);
    const bool is_new = std::all_of(f.points.begin(), f.points.end(), [&](const dvec3& p) {
      return glm::distance(p, x) > same_contact;
    });
    if (!is_new || glm::dot(x, n) < h - support_tie) return std::nullopt;
    return std::pair(*c, x);
  };
  if (f.points.size() == 1) {
    const auto [e1, e2] = tangent_frame(n);
    for (int k = 0; k < all_around && f.points.size() == 1; ++k) {
      const double angle = 2 * std::numbers::pi * k / all_around;
      const auto more = found(std::cos(angle) * e1 + std::sin(angle) * e2);
      if (more) add(1, more->first, more->second);
    }
  }
  if (f.points.size() == 1) return f;
  if (f.points.size() == 3 &&
      glm::dot(glm::cross(f.points[1] - f.points[0], f.points[2] - f.points[0]), n) < 0) {
    std::swap(f.contacts[1], f.contacts[2]);
    std::swap(f.points[1], f.points[2]);
  }
  for (std::size_t i = 0; i < f.points.size();) {
    if (f.points.size() > facet_corner_limit) return std::nullopt;
    const dvec3 a = f.points[i];
    const dvec3 outward = unit(glm::cross(f.points[(i + 1) % f.points.size()] - a, n));
    const auto more = found(outward);
    if (more && glm::dot(more->second - a, outward) > same_contact) {
      add(i + 1, more->first, more->second);
    } else {
      ++i;
    }
  }
  return f.points.size() < 3 ? f : corners_only(f, n);
}

}  // namespace taut
