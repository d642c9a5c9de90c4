#include "taut/bounds/contact_forms.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/poles.h"
#include "taut/surface/rulings.h"

namespace taut {

Contact clamped(Contact c) {
  c.u = std::clamp(c.u, 0.0, 1.0);
  c.v = std::clamp(c.v, 0.0, 1.0);
  return c;
}

Contact at_rest(const ContactGeometry& geometry, const Contact& c, const dvec3& n) {
  Contact own = geometry.canonical(c);
  const auto move_to_end = [&](const Contact& low, const Contact& high) {
    const dvec3 x = geometry.point(own);
    const dvec3 to_low = geometry.point(low) - x;
    const dvec3 to_high = geometry.point(high) - x;
    const double rise = glm::dot(to_high - to_low, n);
    const bool level = std::abs(rise) <= geometry.tie();
    const bool nearer_to_high = glm::length(to_high) <= glm::length(to_low);
    own = geometry.canonical((level ? nearer_to_high : rise > 0) ? high : low);
  };
  const Part& part = geometry.part(own);
  for (std::size_t k = 0; own.kind == SourceKind::face; ++k) {
    const PatchPoint at{own.element, {own.u, own.v}};
    const std::vector<std::array<dvec2, 2>> all =
        rulings(geometry.patch(own), at.uv, geometry.bent());
    if (k >= all.size()) break;
    const dvec3 along =
        unit(point(part, {at.patch, all[k][1]}) - point(part, {at.patch, all[k][0]}));
    const auto last = [&](const dvec3& direction) {
      const std::vector<PatchPoint> path = ruling_path(part, at, direction, geometry.bent());
      const PatchPoint end = path.empty() ? at : path.back();
      return Contact{own.instance, own.kind, end.patch, end.uv.x, end.uv.y};
    };
    move_to_end(last(-along), last(along));
  }
  if (own.kind == SourceKind::edge && geometry.is_straight(own)) {
    move_to_end(geometry.straight_end(own, 0), geometry.straight_end(own, 1));
  }
  return own;
}

Contact moved_to_border(const ContactGeometry& geometry, Contact c, double distance) {
  const ContactJet j = geometry.jet(c);
  // Along a pole all parameters are one point, and the contact's tells from where it came.
  const std::optional<Side> pole = pole_side(geometry, c);
  const auto snap = [&](double& t, const dvec3& dx) {
    const double own = t, nearest = std::round(std::clamp(t, 0.0, 1.0));
    if (own == nearest || std::abs(own - nearest) * glm::length(dx) > distance) return;
    const dvec3 before = geometry.point(c);
    t = nearest;
    // Where speeds grow from nearly nothing the border is farther than they tell.
    if (glm::distance(before, geometry.point(c)) > distance) t = own;
  };
  if (j.dimension == 2 && !(pole && along_v(*pole))) snap(c.v, j.dx[1]);
  if (j.dimension >= 1 && !(pole && !along_v(*pole))) snap(c.u, j.dx[0]);
  return c;
}

Contact moved_to_bent(const ContactGeometry& geometry, Contact c, double distance) {
  if (geometry.bent() == 0 || c.kind != SourceKind::face) return c;
  const dvec3 x = geometry.point(c);
  Contact result = c;
  for (const Side side : all_sides) {
    const Contact on = on_side(c.instance, c.element, side, along_v(side) ? c.v : c.u);
    const int piece = geometry.patch(c).borders[std::size_t(side)].piece;
    if (piece < 0 || glm::distance(geometry.point(on), x) > distance) continue;
    if (!geometry.is_beside_bent(geometry.first({c.instance, SourceKind::edge, piece, 0, 0})))
      continue;
    (along_v(side) ? result.u : result.v) = at_upper_end(side) ? 1 : 0;
  }
  return result;
}

Contact snapped(const ContactGeometry& geometry, const Contact& c, double distance) {
  return geometry.canonical(moved_to_border(geometry, c, distance));
}

Contact turned_to(const ContactGeometry& geometry, Contact c, const Contact& beside) {
  const std::optional<Side> side = collapsed_side(geometry, c);
  if (side) (along_v(*side) ? c.v : c.u) = along_v(*side) ? beside.v : beside.u;
  return c;
}

}  // namespace taut
