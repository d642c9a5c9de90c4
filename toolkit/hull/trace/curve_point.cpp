#include "taut/hull/trace/curve_point.h"

#include <array>

#include "taut/bounds/contact_forms.h"
#include "taut/bounds/supporting_plane.h"
#include "taut/hull/contact/exit_margins.h"
#include "taut/hull/contact/level_sides.h"
#include "taut/hull/contact/rulings_between.h"

namespace taut {
namespace {

/// A contact that is no farther from a border, and moves to or from it no faster, moves along it.
constexpr double border_slack = 1e-9;
/// Rounding turns the way of a contact by no more than this, as a slope; sides of patches have no
/// less than this length.
constexpr double most_slope_of_rounding = 1e-2;
constexpr double least_size = 1e-7;
/// How far contacts may leave their elements by rounding.
constexpr double place_slack = 1e-9;
/// A direction that turns by less, relative to the motion of (n, x_0, x_1), stands still.
constexpr double still_turn = 1e-6;
/// Where rulings are looked for between the last one and a free end.
constexpr std::array<double, 5> merging_shares = {0.1, 0.3, 0.5, 0.7, 0.9};

}  // namespace

CommonSupport CurvePoint::predicted(double length) const {
  CommonSupport s = at;
  s.n = glm::normalize(s.n + length * tangent.n);
  for (std::size_t i = 0; i < 2; ++i) {
    s.contact[i].u += length * tangent.parameter[i].x;
    s.contact[i].v += length * tangent.parameter[i].y;
  }
  s.evaluate(geometry_);
  return s;
}

std::optional<CommonSupport> CurvePoint::stepped(double length) const {
  CommonSupport s = predicted(length);
  const bool solved = system_.solve(s, [&](const CommonSupport& now) {
    LinearEquation e;
    e.residual = length_to(now) - length;
    e.n = tangent.n;
    for (int i = 0; i < 2; ++i) e.add_point(now, i, tangent.x[std::size_t(i)]);
    return e;
  });
  if (!solved) return std::nullopt;
  return s;
}

bool CurvePoint::supports(const CommonSupport& s) const {
  return is_supporting(geometry_, query_, s.n, glm::dot(s.jet[0].x, s.n), s.contact[0]);
}

bool CurvePoint::is_followed(Ruling from, const Ruling& to) const {
  for (std::size_t i = 0; i < 2; ++i) {
    from.contact[i] = turned_to(geometry_, from.contact[i], to.contact[i]);
  }
  const RulingsBetween between(system_, from, to);
  if (between.empty()) return true;
  // As lengths: about a pole parameters are less exact.
  const auto stays = [&](double t, const dvec3& dx) {
    return (std::abs(t - 0.5) - 0.5) * std::min(1.0, glm::length(dx)) <= border_distance();
  };
  const auto holds = [&](double s) {
    // Exact rulings beside an end without a bend may be in front of it or behind it.
    const std::optional<MovingRuling> m =
        between.is_straight() ? between.interpolated(s) : between(s);
    if (!m) return false;
    const CommonSupport& moved = m->at;
    for (std::size_t i = 0; i < 2; ++i) {
      const Contact& c = moved.contact[i];
      if (!stays(c.u, moved.jet[i].dx[0]) || !stays(c.v, moved.jet[i].dx[1])) return false;
    }
    return supports(moved);
  };
  if (!between.merges()) return holds(0.5);
  return std::all_of(merging_shares.begin(), merging_shares.end(), holds);
}

/// What rounding does to the place of a contact across a side, where it is stationary, as a
/// parameter, and to its way as a slope: the more the smaller the patch is.
double CurvePoint::rounding_across(std::size_t contact, Side side) const {
  const ContactJet& j = at.jet[contact];
  const double second = std::abs(glm::dot(along_v(side) ? j.dxx : j.dyy, at.n));
  const double rounding = geometry_.rounding();
  return rounding < most_slope_of_rounding * second ? rounding / second : most_slope_of_rounding;
}

/// The contact is on the side of its patch and moves along it, to within rounding.
bool CurvePoint::runs_along(std::size_t contact, const ContactExit& exit) const {
  const LinearEquation e = exit_margin(geometry_, at, int(contact), exit);
  const double rate = glm::dot(e.parameter[contact], tangent.parameter[contact]);
  const Side side = all_sides[std::size_t(exit.index)];
  // As lengths: about a pole parameters are less exact.
  const double size = std::min(1.0, glm::length(at.jet[contact].dx[along_v(side) ? 0 : 1]));
  const double slack = std::max(border_slack, geometry_.rounding());
  return std::abs(e.residual) * size <= slack &&
         std::abs(rate) * size <= std::max(slack, rounding_across(contact, side));
}

void CurvePoint::move_to_edges() {
  for (std::size_t i = 0; i < 2; ++i) {
    for (const Side side : all_sides) {
      const std::optional<Contact> edge = on_level_edge(geometry_, at.contact[i], side, at.n);
      if (!edge) continue;
      at.contact[i] = *edge;
      break;
    }
  }
  at.evaluate(geometry_);
}

bool CurvePoint::settle() {
  move_to_edges();
  const CurveTangent* before = tangent.n == dvec3(0.0) ? nullptr : &tangent;
  const std::optional<CurveTangent> t = system_.tangent(at, before);
  if (!t) return false;
  tangent = *t;
  bool changed = false;
  for (std::size_t i = 0; i < 2; ++i) {
    const Contact c = at.contact[i];
    if (c.kind != SourceKind::face) continue;
    for (const ContactExit& exit : exits(geometry_, c)) {
      if (!runs_along(i, exit)) continue;
      const std::optional<Contact> over = beyond(geometry_, c, exit);
      if (!over || over->kind == SourceKind::vertex) continue;
      if (over->kind == SourceKind::face && !extends_over(geometry_, at, int(i), exit)) continue;
      at.contact[i] = *over;
      changed = true;
      break;
    }
  }
  if (changed) {
    at.evaluate(geometry_);
    const std::optional<CurveTangent> again = system_.tangent(at, before);
    if (!again) return false;
    tangent = *again;
  }
  find_joins();
  return true;
}

void CurvePoint::find_joins() {
  for (std::size_t i = 0; i < 2; ++i) {
    join[i].reset();
    const Contact& c = at.contact[i];
    if (c.kind != SourceKind::face) continue;
    for (const Side side : all_sides) {
      if (geometry_.patch(c).borders[std::size_t(side)].kind != BorderKind::smooth) continue;
      if (runs_along(i, {ContactExit::Kind::side, int(side)})) join[i] = side;
    }
  }
}

double CurvePoint::join_distance(std::size_t contact, Side side) const {
  if (geometry_.patch(at.contact[contact]).borders[std::size_t(side)].kind != BorderKind::smooth)
    return 0;
  const double size = glm::length(at.jet[contact].dx[along_v(side) ? 0 : 1]);
  const double along = border_slack / std::max(size, least_size);
  return join[contact] == side ? along : std::min(along, rounding_across(contact, side));
}

void CurvePoint::head_into(std::size_t contact) {
  if (glm::length(tangent.n) > still_turn) return;
  const Contact& c = at.contact[contact];
  for (const ContactExit& exit : exits(geometry_, c)) {
    if (!leads_over_border(exit)) continue;
    const LinearEquation e = exit_margin(geometry_, at, int(contact), exit);
    if (e.residual > 0 || glm::dot(e.parameter[contact], tangent.parameter[contact]) >= 0) continue;
    for (std::size_t i = 0; i < 2; ++i) {
      tangent.parameter[i] = -tangent.parameter[i];
      tangent.x[i] = -tangent.x[i];
    }
    tangent.n = -tangent.n;
    return;
  }
}

double CurvePoint::border_distance() const {
  return std::max(place_slack, 2 * geometry_.rounding());
}

}  // namespace taut
