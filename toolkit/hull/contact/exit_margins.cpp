#include "taut/hull/contact/exit_margins.h"

namespace taut {

LinearEquation exit_margin(const ContactGeometry& geometry, const CommonSupport& s, int i,
                           const ContactExit& exit) {
  const Contact& c = s.contact[std::size_t(i)];
  LinearEquation e;
  dvec2& parameter = e.parameter[std::size_t(i)];
  if (exit.kind == ContactExit::Kind::side) {
    const Side side = all_sides[std::size_t(exit.index)];
    const int a = along_v(side) ? 0 : 1;
    const double value = a == 0 ? c.u : c.v;
    e.residual = at_upper_end(side) ? 1 - value : value;
    parameter[a] = at_upper_end(side) ? -1 : 1;
  } else if (exit.kind == ContactExit::Kind::end) {
    e.residual = exit.index == 0 ? c.u : 1 - c.u;
    parameter.x = exit.index == 0 ? 1 : -1;
  } else if (exit.kind == ContactExit::Kind::face) {
    const ContactGeometry::PieceSide& side = geometry.sides(c)[std::size_t(exit.index)];
    const ContactJet j = geometry.jet(on_side(c, side));
    const dvec3 in = inward_derivative(j, side.side);
    const double length = glm::length(in);
    if (length == 0) return e;
    e.n = -in / length;
    e.residual = glm::dot(e.n, s.n);
    const double sense = (side.reversed ? -1.0 : 1.0) * (at_upper_end(side.side) ? -1.0 : 1.0);
    parameter.x = -sense * glm::dot(j.dxy, s.n) / length;
  } else {
    const ContactGeometry::PieceEnd& end = geometry.ends(c)[std::size_t(exit.index)];
    const dvec3 away = tangent_from(geometry, c, end);
    const double length = glm::length(away);
    if (length == 0) return e;
    e.n = -away / length;
    e.residual = glm::dot(e.n, s.n);
  }
  return e;
}

}  // namespace taut
