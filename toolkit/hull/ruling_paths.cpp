#include "taut/hull/ruling_paths.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "taut/hull/contact_exits.h"
#include "taut/surface/rulings.h"

namespace taut {
namespace {

/// Sine of the angle between segments of one line.
constexpr double same_line = 1e-6;
/// Shorter ones have no direction.
constexpr double shortest = 1e-10;
/// Parameters so near to a side's are at it.
constexpr double at_side = 1e-9;
/// Patches that a line passes at most.
constexpr std::size_t patch_limit = 1000;

/// The end of the contact's segment in the direction.
std::optional<Contact> end_along(const ContactGeometry& geometry, const Contact& c,
                                 const dvec3& along) {
  const dvec3 x = geometry.point(c);
  for (const std::array<Contact, 2>& ends : rulings(geometry, c)) {
    for (const Contact& end : ends) {
      const dvec3 way = geometry.point(end) - x;
      if (glm::length(way) > shortest && glm::distance(unit(way), along) < same_line) return end;
    }
  }
  return std::nullopt;
}

/// The contact's point in all the ruled patches about it that smooth joins lead to, beginning with
/// its own.
std::vector<Contact> about(const ContactGeometry& geometry, const Contact& c) {
  std::vector<Contact> all = {c};
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (const Side side : all_sides) {
      Contact at = all[k];
      double& t = along_v(side) ? at.u : at.v;
      const double bound = at_upper_end(side) ? 1 : 0;
      if (std::abs(t - bound) > at_side) continue;
      t = bound;
      const auto over = beyond(geometry, at, {ContactExit::Kind::side, int(side)});
      if (!over || over->kind != SourceKind::face || !geometry.is_ruled(*over)) continue;
      const bool known = std::any_of(all.begin(), all.end(),
                                     [&](const Contact& a) { return same_element(a, *over); });
      if (!known) all.push_back(*over);
    }
  }
  return all;
}

}  // namespace

std::vector<std::array<Contact, 2>> rulings(const ContactGeometry& geometry, const Contact& c) {
  const Patch& patch = geometry.patch(c);
  const auto at = [&](double u, double v) { return Contact{c.instance, c.kind, c.element, u, v}; };
  std::vector<std::array<Contact, 2>> result;
  if (patch.ruled_v) result.push_back({at(c.u, 0), at(c.u, 1)});
  if (patch.ruled_u) result.push_back({at(0, c.v), at(1, c.v)});
  if (!patch.ruled_obliquely) return result;
  if (const auto ends = ruling_ends(patch.bezier, {c.u, c.v})) {
    result.push_back({at((*ends)[0].x, (*ends)[0].y), at((*ends)[1].x, (*ends)[1].y)});
  }
  return result;
}

std::vector<Contact> ruling_path(const ContactGeometry& geometry, const Contact& c,
                                 const dvec3& along) {
  std::vector<Contact> path;
  Contact from = c;
  while (path.size() < patch_limit) {
    std::optional<Contact> next;
    for (const Contact& a : about(geometry, from)) {
      next = end_along(geometry, a, along);
      if (next) break;
    }
    if (!next) break;
    path.push_back(*next);
    from = *next;
  }
  return path;
}

}  // namespace taut
