#include "taut/bounds/poles.h"

#include "taut/core/tolerances.h"

namespace taut {

bool is_pole(const ContactGeometry& geometry, const Contact& c, Side side) {
  const Border& border = geometry.patch(c).borders[std::size_t(side)];
  return border.kind == BorderKind::collapsed && border.vertex < 0;
}

std::optional<Side> collapsed_side(const ContactGeometry& geometry, const Contact& c) {
  if (c.kind != SourceKind::face) return std::nullopt;
  for (const Side side : all_sides) {
    const double t = along_v(side) ? c.u : c.v;
    const Border& border = geometry.patch(c).borders[std::size_t(side)];
    const bool there = (at_upper_end(side) ? 1 - t : t) < pole_parameter;
    if (there && border.kind == BorderKind::collapsed) return side;
  }
  return std::nullopt;
}

std::optional<Side> pole_side(const ContactGeometry& geometry, const Contact& c) {
  if (c.kind != SourceKind::face) return std::nullopt;
  for (const Side side : all_sides) {
    const double t = along_v(side) ? c.u : c.v;
    if ((at_upper_end(side) ? 1 - t : t) < pole_parameter && is_pole(geometry, c, side))
      return side;
  }
  return std::nullopt;
}

dvec3 unit_normal(const ContactGeometry& geometry, const Contact& c) {
  return geometry.to_frame(c.instance, unit_normal(geometry.patch(c).bezier, c.u, c.v));
}

double pole_turn(const ContactGeometry& geometry, const Contact& pole) {
  const std::optional<Side> side = pole_side(geometry, pole);
  if (!side) return 0;
  const double size = glm::length(geometry.jet(pole).dx[along_v(*side) ? 0 : 1]);
  return size > 0 ? geometry.rounding() / size : 0;
}

std::optional<Contact> pole_in(const ContactGeometry& geometry, const Contact& pole,
                               const Contact& other) {
  if (other.kind != SourceKind::face || other.instance != pole.instance) return std::nullopt;
  const dvec3 x = geometry.point(pole);
  for (const Side side : all_sides) {
    if (!is_pole(geometry, other, side)) continue;
    const dvec2 uv = on_side(side, along_v(side) ? other.v : other.u);
    const Contact at = {other.instance, other.kind, other.element, uv.x, uv.y};
    if (glm::distance(geometry.point(at), x) <= join_distance) return at;
  }
  return std::nullopt;
}

}  // namespace taut
