#include "taut/hull/trace/merging.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/contact_forms.h"
#include "taut/bounds/poles.h"
#include "taut/core/tolerances.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/contact/exit_margins.h"
#include "taut/hull/contact/facet_contacts.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/hull/contact/local_curvature.h"
#include "taut/hull/trace/arc_pieces.h"
#include "taut/hull/trace/element_changes.h"
#include "taut/hull/trace/free_ends.h"
#include "taut/hull/trace/pole_passage.h"

namespace taut {
namespace {

/// Sine of the angle below which two edges that merge are one.
constexpr double least_angle = 1e-3;
/// Cosine by which the limit of the direction may miss its extrapolation.
constexpr double least_cosine = 0.99;
/// Rate of the distance of two contacts of one surface or curve that merge, at most. It tends to
/// the square root of two, to less (0.6 and more were seen) where third derivatives are not
/// continuous.
constexpr double slowest_merging = -0.05;
/// Two contacts that run into a pole are no farther from it, and miss it by no more than the share
/// of their distance.
constexpr double pole_reach = 8e-3;
constexpr double pole_share = 0.02;
/// Contacts nearer than this that do not merge are lost.
constexpr double least_distance = 2e-4;
/// The same of two that are about a pole: no farther from it than so many times their distance.
constexpr double least_distance_at_pole = 1e-6;
constexpr double about_pole = 8;

/// Rulings no longer than this may be such that rounding leaves nothing of the distance of heights.
constexpr double tied_length = 1e-6;

/// What kind of free end two contacts that merge make, and in which element it is told; none where
/// it is of no generic kind.
std::optional<FreeEnd> kind_of_end(const ContactGeometry& geometry, const Ruling& ruling) {
  const std::array<Contact, 2>& c = ruling.contact;
  const auto is = [&](std::size_t i, SourceKind kind) { return c[i].kind == kind; };
  FreeEnd end{ruling.n, c[0], FreeEnd::Kind::face, dvec3(0.0)};
  if (continues(geometry, c[0], c[1])) {
    if (is(0, SourceKind::edge)) end.kind = FreeEnd::Kind::edge;
    return end;
  }
  if (is(0, SourceKind::edge) && is(1, SourceKind::edge)) {
    end.contact = geometry.canonical(c[0]);
    end.kind = FreeEnd::Kind::corner;
    return end;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    end.contact = c[i];
    if (is(i, SourceKind::edge) && is(1 - i, SourceKind::face)) {
      end.kind = FreeEnd::Kind::border;
      return end;
    }
    if (is(i, SourceKind::vertex) && is(1 - i, SourceKind::edge)) {
      end.kind = FreeEnd::Kind::end;
      return end;
    }
  }
  return std::nullopt;
}

/// The ruling of length zero in a free end, in the elements of another ruling; none where it does
/// not lie in both of them.
std::optional<Ruling> ruling_at(const ContactGeometry& geometry, const FreeEnd& end,
                                const Ruling& other) {
  Ruling result;
  result.n = end.n;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::optional<Contact> own = expressed_in(geometry, end.contact, other.contact[i]);
    if (!own) return std::nullopt;
    result.contact[i] = *own;
  }
  const dvec3 x = geometry.point(end.contact);
  result.point = {x, x};
  return result;
}

/// Rates of an element's parameters along a unit tangent in which it bends least. None where they
/// fail.
std::optional<dvec2> rate_along(const ContactGeometry& geometry, const Contact& c,
                                const dvec3& along) {
  if (c.kind == SourceKind::edge) {
    const dvec3 d = geometry.jet(c).dx[0];
    return dvec2(glm::dot(d, along) / glm::dot(d, d), 0);
  }
  const std::optional<SurfaceCurvature> b = surface_curvature(geometry, c);
  if (!b) return std::nullopt;
  return glm::dot(b->along, along) < 0 ? -b->rate : b->rate;
}

/// A point on the border of an element.
struct BorderPoint {
  Contact contact;
  ContactExit exit;
  double distance = 0;  ///< from where a line to it begins
};

/// Where the line on which contacts part from a free end, in the sense of `along`, leaves the end's
/// element.
std::optional<BorderPoint> border_ahead(const ContactGeometry& geometry, const FreeEnd& end,
                                        const dvec3& along) {
  CommonSupport s;
  s.add(geometry, end.contact);
  const std::optional<dvec2> rate = rate_along(geometry, end.contact, along);
  if (!rate) return std::nullopt;
  std::optional<BorderPoint> first;
  for (const ContactExit& exit : exits(geometry, end.contact)) {
    if (!leads_over_border(exit)) continue;
    const LinearEquation margin = exit_margin(geometry, s, 0, exit);
    const double falls = -glm::dot(margin.parameter[0], *rate);
    if (falls <= 0 || (first && margin.residual >= first->distance * falls)) continue;
    const double distance = margin.residual / falls;
    Contact c = end.contact;
    c.u = std::clamp(c.u + distance * rate->x, 0.0, 1.0);
    c.v = std::clamp(c.v + distance * rate->y, 0.0, 1.0);
    first = {at_exit(c, exit), exit, distance};
  }
  return first;
}

/// The exit of the contact's element over which the other one lies.
std::optional<ContactExit> exit_to(const ContactGeometry& geometry, const Contact& c,
                                   const Contact& other) {
  for (const ContactExit& exit : exits(geometry, c)) {
    if (!leads_over_border(exit) || !stands_at(c, exit)) continue;
    const std::optional<Contact> over = beyond(geometry, c, exit);
    if (over && same_element(*over, other)) return exit;
  }
  return std::nullopt;
}

/// Where two contacts merge that approach each other, to first order.
struct Approach {
  Ruling end;
  double length = 0;    ///< of the ruling
  double rate = 0;      ///< of the length, along the tangent
  bool smooth = false;  ///< they run on one smooth curve or surface
  bool one_element = false;

  /// f(0) = f - linear() f' for a function f of the length.
  double linear() const { return length / rate; }
};

/// Looks for the end, in a copy of the point that goes there.
class Merging {
 public:
  explicit Merging(const CurvePoint& point)
      : geometry_(point.geometry()), system_(point.system()), point_(point) {
    end_.pieces.emplace_back();
    push(point_.at.ruling());
  }

  std::optional<MergedEnd> run();

 private:
  void push(const Ruling& ruling) { end_.pieces.back().rulings.push_back(ruling); }
  bool merge();
  Approach approach() const;
  bool meet(const Ruling& end) const;
  std::optional<FreeEnd> exact_end(const Ruling& near) const;
  std::optional<FreeEnd> end_ahead(const Approach& a) const;
  bool is_ahead(const FreeEnd& end, double length) const;
  bool end_beyond(const FreeEnd& end);
  std::optional<ElementChange> change_before(const FreeEnd& end) const;
  std::optional<ElementChange> change_ahead(const FreeEnd& end) const;
  bool solve_change(ElementChange& event, double length) const;
  bool tie_at_exit(ElementChange& event) const;
  bool is_followed(const Ruling& from, const Ruling& to) const;
  CommonSupport near_end(const FreeEnd& end, double length) const;
  bool merge_at_pole();
  bool runs_into(const dvec3& pole);
  bool crosses();

  const ContactGeometry& geometry_;
  const ContactSystem& system_;
  CurvePoint point_;
  MergedEnd end_;
};

/// As functions of their distance, the contacts' parameters and n are smooth at a free end. Where
/// both run on one smooth curve or surface, n and, if they are in one element, the parameters' mean
/// are smooth functions of its square.
Approach Merging::approach() const {
  Approach a;
  a.end = point_.at.ruling();
  const std::array<Contact, 2> c = a.end.contact;
  a.length = point_.apart();
  a.rate = point_.rate_apart();
  a.smooth = continues(geometry_, c[0], c[1]);
  a.one_element = same_element(c[0], c[1]);
  // f(0) = f - length f' / 2 for a function of the square.
  const double squared = 0.5 * a.linear();
  a.end.n = point_.at.n - (a.smooth ? squared : a.linear()) * point_.tangent.n;
  const dvec2 mean = 0.5 * (parameters(c[0]) + parameters(c[1])) -
                     0.5 * squared * (point_.tangent.parameter[0] + point_.tangent.parameter[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    const dvec2 own = parameters(c[i]) - a.linear() * point_.tangent.parameter[i];
    const dvec2 there = a.one_element ? mean : own;
    a.end.contact[i].u = std::clamp(there.x, 0.0, 1.0);
    a.end.contact[i].v = std::clamp(there.y, 0.0, 1.0);
  }
  move_together(geometry_, a.end.contact[0], a.end.contact[1]);
  return a;
}

/// Ends the arc where its contacts, of two surfaces or curves, meet in a common point.
bool Merging::crosses() {
  const std::optional<CommonSupport> end = system_.crossing(point_.at);
  if (!end || point_.distance_to(*end) > 4 * glm::length(point_.at.d())) return false;
  for (std::size_t i = 0; i < 2; ++i) {
    const Contact& c = end->contact[i];
    if (std::min({c.u, 1 - c.u, c.v, 1 - c.v}) < -point_.border_distance()) return false;
  }
  if (point_.query()(end->n, end->contact[0]).h >
      glm::dot(end->jet[0].x, end->n) + geometry_.tie()) {
    return false;
  }
  push(end->ruling());
  Ruling& last = end_.pieces.back().rulings.back();
  for (Contact& c : last.contact) {
    c.u = std::clamp(c.u, 0.0, 1.0);
    c.v = std::clamp(c.v, 0.0, 1.0);
  }
  last.point[1] = last.point[0];
  end_.n = end->n;
  end_.contacts.assign(last.contact.begin(), last.contact.end());
  return true;
}

/// The free end near the ruling that supports the model.
std::optional<FreeEnd> Merging::exact_end(const Ruling& near) const {
  const std::optional<FreeEnd> kind = kind_of_end(geometry_, near);
  const std::optional<FreeEnd> end = kind ? polished(geometry_, *kind) : std::nullopt;
  if (!end) return std::nullopt;
  const double height = glm::dot(geometry_.point(end->contact), end->n);
  return point_.query()(end->n, near.contact[0]).h <= height + geometry_.tie() ? end : std::nullopt;
}

/// Ends the arc where both contacts run straight into one pole. Curvatures differ along the ways
/// out of it: its surface, to second order homogeneous about it, may touch a plane twice however
/// near to it.
bool Merging::merge_at_pole() {
  if (point_.at.contact[0].kind != SourceKind::face) return false;
  for (const Side side : all_sides) {
    if (is_pole(geometry_, point_.at.contact[0], side) &&
        runs_into(geometry_.point(at_pole(point_.at.contact[0], side)))) {
      return true;
    }
  }
  return false;
}

/// Ends the arc in the pole at x, if both contacts run there. On straight ways: their distance need
/// not be linear, being small where the curvatures hardly differ.
bool Merging::runs_into(const dvec3& x) {
  double approach = 0;
  double speed = 0;
  double reach = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    approach += glm::dot(x - point_.at.jet[i].x, point_.tangent.x[i]);
    speed += glm::dot(point_.tangent.x[i], point_.tangent.x[i]);
    reach = std::max(reach, pole_share * glm::distance(point_.at.jet[i].x, x));
  }
  if (approach <= 0 || reach > pole_share * pole_reach) return false;
  const double ahead = approach / speed;
  Ruling end = point_.at.ruling();
  for (std::size_t i = 0; i < 2; ++i) {
    Contact& c = end.contact[i];
    c.u = std::clamp(c.u + ahead * point_.tangent.parameter[i].x, 0.0, 1.0);
    c.v = std::clamp(c.v + ahead * point_.tangent.parameter[i].y, 0.0, 1.0);
    const std::optional<Contact> pole = at_pole_of(geometry_, c, x);
    if (!pole || glm::distance(point_.at.jet[i].x + ahead * point_.tangent.x[i], x) > reach)
      return false;
    c = *pole;
  }
  if (end.contact[0].instance != end.contact[1].instance) return false;
  end.n = aligned(unit_normal(geometry_, end.contact[0]), point_.at.n);
  if (glm::distance(end.n, point_.at.n + ahead * point_.tangent.n) > reach ||
      point_.query()(end.n, end.contact[0]).h > glm::dot(x, end.n) + geometry_.tie()) {
    return false;
  }
  end.point = {x, x};
  push(end);
  return true;
}

/// Whether the contacts run into the free end, within this length.
bool Merging::is_ahead(const FreeEnd& end, double length) const {
  const dvec3 x = geometry_.point(end.contact);
  return point_.length_along(end.n, x, x) > 0 && glm::distance(x, point_.at.jet[0].x) < length;
}

/// The free end into which the contacts run.
std::optional<FreeEnd> Merging::end_ahead(const Approach& a) const {
  std::optional<FreeEnd> exact = exact_end(a.end);
  if (!exact && a.smooth && !a.one_element) {
    // Where a join makes the end, n is no smooth function of the square.
    Ruling straight = a.end;
    straight.n = point_.at.n - a.linear() * point_.tangent.n;
    exact = exact_end(straight);
  }
  if (!exact && !a.smooth) {
    // Where a parabolic curve touches an edge, the distance falls with the square of the way.
    Ruling twice = point_.at.ruling();
    twice.n = glm::normalize(twice.n - 2 * a.linear() * point_.tangent.n);
    for (std::size_t i = 0; i < 2; ++i) {
      const dvec2 ahead = -2 * a.linear() * point_.tangent.parameter[i];
      twice.contact[i].u = std::clamp(twice.contact[i].u + ahead.x, 0.0, 1.0);
      twice.contact[i].v = std::clamp(twice.contact[i].v + ahead.y, 0.0, 1.0);
    }
    exact = exact_end(twice);
    if (exact) {
      const dvec3 x = geometry_.point(exact->contact);
      if (point_.length_along(exact->n, x, x) < 1.5 * std::abs(a.linear())) exact.reset();
    }
  }
  // On an edge that a parabolic curve touches it lies twice as far ahead as the distance tells.
  const double reach = (a.smooth ? 2 : 3) * std::abs(a.linear());
  if (exact && !is_ahead(*exact, reach)) exact.reset();
  return exact;
}

/// The contacts are on one element in the end: a face's is on an edge, or at the corner of a face
/// where the edge's next piece begins.
bool Merging::meet(const Ruling& end) const {
  const Contact a = geometry_.canonical(end.contact[0]);
  const Contact b = geometry_.canonical(end.contact[1]);
  if (same_element(a, b)) return true;
  return a.kind == SourceKind::edge && continues(geometry_, a, b) &&
         glm::distance(geometry_.point(a), geometry_.point(b)) < same_contact;
}

/// Ends the arc where the contacts merge, if they do.
bool Merging::merge() {
  if (merge_at_pole()) return true;
  Approach a = approach();
  Ruling& end = a.end;
  const double rho = a.length;
  if (!a.smooth && !meet(end)) return crosses();
  if (const std::optional<FreeEnd> exact = end_ahead(a)) {
    if (const std::optional<Ruling> ruling = ruling_at(geometry_, *exact, end)) {
      push(*ruling);
      return true;
    }
    // A contact changes its element before.
    const CommonSupport start = point_.at;
    if (end_beyond(*exact)) return true;
    point_.at = start;
    end_.pieces.resize(1);
    end_.pieces.front().rulings.resize(1);
    if (rho > 2 * least_distance) return false;
  }
  // On one surface or curve they run into each other, rather than pass by.
  if (a.smooth && a.rate > slowest_merging) return false;
  const std::array<ContactJet, 2> jet = {geometry_.jet(end.contact[0]),
                                         geometry_.jet(end.contact[1])};
  if (glm::distance(jet[0].x, jet[1].x) > 0.25 * rho) return false;
  end.n = limit_normal(jet, end.n);
  const std::size_t anchor = jet[0].dimension <= jet[1].dimension ? 0 : 1;
  dvec3 x = jet[anchor].x;
  const Support top = point_.query()(end.n, point_.at.contact[0]);
  // The nearer the contacts, the better the extrapolation; until rounding spoils it. About a free
  // end heights differ by the fourth power of distances, at a border by the third.
  const double slack = rho > least_distance ? geometry_.tie() : rho * rho * rho;
  if (top.h - glm::dot(x, end.n) > slack || glm::distance(top.point, x) > 4 * rho) {
    return false;
  }
  // The direction is as near to the end's as the extrapolation; the contact is the direction's own.
  if (const Contact own = geometry_.canonical(top.contact);
      a.one_element && same_element(own, end.contact[0])) {
    end.contact = {own, own};
    const ContactJet j = geometry_.jet(own);
    end.n = limit_normal({j, j}, end.n);
    x = j.x;
  }
  end.point = {x, x};
  push(end);
  return true;
}

/// The next change of a contact into the element of the free end, over a smooth join. The contacts
/// are about as far from the end as each other, and as the end from the join then.
std::optional<ElementChange> Merging::change_before(const FreeEnd& end) const {
  std::optional<ElementChange> event;
  double longest = 0;
  for (int i = 0; i < 2; ++i) {
    const auto k = std::size_t(i);
    const Contact& own = point_.at.contact[k];
    if (same_element(own, end.contact)) continue;
    const dvec3 apart = point_.at.jet[k].x - point_.at.jet[1 - k].x;
    const dvec3 along = aligned(end.along, apart);
    const std::optional<BorderPoint> border = border_ahead(geometry_, end, along);
    if (!border || border->distance <= longest) continue;
    const std::optional<Contact> over = beyond(geometry_, border->contact, border->exit);
    if (!over || !same_element(*over, own)) return std::nullopt;
    const std::optional<ContactExit> exit = exit_to(geometry_, *over, end.contact);
    if (!exit) return std::nullopt;
    event.emplace();
    event->contact = i;
    event->exit = *exit;
    event->support = near_end(end, 2 * border->distance);
    event->support.contact[k] = *over;
    event->support.evaluate(geometry_);
    longest = border->distance;
  }
  if (!event || !solve_change(*event, 2 * longest)) return std::nullopt;
  return event;
}

/// The same where the contacts run to the end side by side, each over a join into a patch in whose
/// border the end lies: the first of them at the share of the way at which it meets its join.
std::optional<ElementChange> Merging::change_ahead(const FreeEnd& end) const {
  const double apart = point_.apart();
  const double length = -apart / point_.rate_apart();
  std::optional<ElementChange> event;
  double first = 1;
  for (int i = 0; i < 2; ++i) {
    const auto k = std::size_t(i);
    const Contact& own = point_.at.contact[k];
    if (expressed_in(geometry_, end.contact, own)) continue;
    const dvec2 rate = point_.tangent.parameter[k];
    for (const ContactExit& exit : exits(geometry_, own)) {
      if (!leads_over_border(exit)) continue;
      const LinearEquation margin = exit_margin(geometry_, point_.at, i, exit);
      const double falls = -length * glm::dot(margin.parameter[k], rate);
      if (falls <= 0 || margin.residual >= first * falls) continue;
      const double share = margin.residual / falls;
      Contact border = own;
      border.u = std::clamp(own.u + share * length * rate.x, 0.0, 1.0);
      border.v = std::clamp(own.v + share * length * rate.y, 0.0, 1.0);
      border = at_exit(border, exit);
      const std::optional<Contact> over = beyond(geometry_, border, exit);
      if (!over || !expressed_in(geometry_, end.contact, *over)) continue;
      event.emplace();
      event->contact = i;
      event->exit = exit;
      CommonSupport& s = event->support;
      s = point_.at;
      s.n = glm::normalize((1 - share) * point_.at.n + share * end.n);
      for (std::size_t j = 0; j < 2; ++j) {
        s.contact[j].u += share * length * point_.tangent.parameter[j].x;
        s.contact[j].v += share * length * point_.tangent.parameter[j].y;
      }
      s.contact[k] = border;
      s.evaluate(geometry_);
      first = share;
    }
  }
  if (!event || !solve_change(*event, (1 - first) * apart)) return std::nullopt;
  return event;
}

/// Solves for the ruling of about this length with which a contact stands at its exit; from a start
/// near it.
bool Merging::solve_change(ElementChange& event, double length) const {
  CommonSupport& s = event.support;
  const CommonSupport start = s;
  const bool solved = system_.settle(s, [&](const CommonSupport& now) {
    return exit_margin(geometry_, now, event.contact, event.exit);
  });
  if (solved) {
    put_on_border(geometry_, event);
  } else {
    s = start;
    if (length > tied_length || !tie_at_exit(event)) return false;
  }
  event.length = point_.length_to(s);
  const double apart = glm::length(s.d());
  return event.length > margin_slack && apart > 0.5 * length && apart < 2 * length &&
         point_.supports(s);
}

/// The same of contacts so near to each other that their heights are the same up to rounding, which
/// leaves the system nothing: the direction is the normal of the one at its exit, and the other
/// moves along the parameter in which it is curved to where that has it.
bool Merging::tie_at_exit(ElementChange& event) const {
  const auto i = std::size_t(event.contact);
  CommonSupport& s = event.support;
  put_on_border(geometry_, event);
  if (s.contact[i].kind != SourceKind::face) return false;
  s.n = aligned(unit_normal(geometry_, s.contact[i]), s.n);
  Contact& other = s.contact[1 - i];
  for (int k = 0; k < 2 && other.kind == SourceKind::face; ++k) {
    // Where it stands across, the prediction tells as well as anything.
    const ContactJet j = geometry_.jet(other);
    const double uu = glm::dot(j.dxx, s.n);
    const double vv = glm::dot(j.dyy, s.n);
    if (std::abs(uu) > std::abs(vv)) {
      other.u = std::clamp(other.u - glm::dot(j.dx[0], s.n) / uu, 0.0, 1.0);
    } else {
      other.v = std::clamp(other.v - glm::dot(j.dx[1], s.n) / vv, 0.0, 1.0);
    }
  }
  s.evaluate(geometry_);
  return std::abs(glm::dot(s.d(), s.n)) <= geometry_.rounding();
}

/// About where the contacts have approached each other to this length, before the free end: at a
/// border or an edge's end all is linear in it, else n is so in its square.
CommonSupport Merging::near_end(const FreeEnd& end, double length) const {
  const bool is_linear = end.kind == FreeEnd::Kind::border || end.kind == FreeEnd::Kind::end;
  const double apart = point_.apart();
  const double rate = point_.rate_apart();
  const double share = length / apart;
  CommonSupport s = point_.at;
  s.n = glm::normalize(end.n + (is_linear ? share : share * share) * (point_.at.n - end.n));
  for (std::size_t i = 0; i < 2; ++i) {
    Contact& c = s.contact[i];
    if (is_linear && same_element(c, end.contact)) {
      c.u = (1 - share) * end.contact.u + share * c.u;
      c.v = (1 - share) * end.contact.v + share * c.v;
      continue;
    }
    const dvec2 ahead = (length - apart) / rate * point_.tangent.parameter[i];
    c.u = std::clamp(c.u + ahead.x, 0.0, 1.0);
    c.v = std::clamp(c.v + ahead.y, 0.0, 1.0);
    if (!same_element(c, end.contact)) continue;
    const dvec3 side = point_.at.jet[i].x - point_.at.jet[1 - i].x;
    const std::optional<dvec2> along = rate_along(geometry_, end.contact, aligned(end.along, side));
    if (!along) continue;
    c.u = std::clamp(end.contact.u + 0.5 * length * along->x, 0.0, 1.0);
    c.v = std::clamp(end.contact.v + 0.5 * length * along->y, 0.0, 1.0);
  }
  return s;
}

/// Goes to a free end in an element into which a contact changes over before; false if that is not
/// found.
bool Merging::end_beyond(const FreeEnd& end) {
  FreeEnd near = end;
  near.contact = snapped(geometry_, end.contact, longest_empty_piece);
  std::optional<Ruling> last = ruling_at(geometry_, near, point_.at.ruling());
  for (int k = 0; k < 2 && !last; ++k) {
    std::optional<ElementChange> event = change_before(end);
    if (!event) event = change_ahead(end);
    if (!event || !is_followed(point_.at.ruling(), event->support.ruling())) return false;
    const auto i = std::size_t(event->contact);
    point_.at = event->support;
    push(point_.at.ruling());
    const std::optional<Contact> over = beyond(geometry_, point_.at.contact[i], event->exit);
    if (!over) return false;
    point_.at.contact[i] = *over;
    point_.at.evaluate(geometry_);
    end_.pieces.emplace_back();
    push(point_.at.ruling());
    last = ruling_at(geometry_, end, point_.at.ruling());
  }
  if (last) push(*last);
  return last.has_value();
}

/// From a ruling on, the rulings before another one are found, or so short that their heights tie.
bool Merging::is_followed(const Ruling& from, const Ruling& to) const {
  return glm::distance(from.point[0], from.point[1]) <= tied_length || point_.is_followed(from, to);
}

std::optional<MergedEnd> Merging::run() {
  if (!merge()) return std::nullopt;
  const std::vector<Ruling>& rulings = end_.pieces.back().rulings;
  if (!is_followed(rulings[rulings.size() - 2], rulings.back())) return std::nullopt;
  return std::move(end_);
}

/// Whether both contacts are near to one pole. The surface about it is homogeneous to second order,
/// and the contacts as far from each other as from the pole: they can be told apart down to where
/// heights are rounding.
bool is_about_pole(const CurvePoint& point) {
  const ContactGeometry& geometry = point.geometry();
  const Contact& c = point.at.contact[0];
  if (c.kind != SourceKind::face) return false;
  return std::any_of(all_sides.begin(), all_sides.end(), [&](Side side) {
    if (!is_pole(geometry, c, side)) return false;
    const dvec3 x = geometry.point(at_pole(c, side));
    return std::max(glm::distance(point.at.jet[0].x, x), glm::distance(point.at.jet[1].x, x)) <
           about_pole * glm::length(point.at.d());
  });
}

}  // namespace

dvec3 limit_normal(const std::array<ContactJet, 2>& jet, const dvec3& near) {
  const ContactJet& a = jet[0].dimension >= jet[1].dimension ? jet[0] : jet[1];
  const ContactJet& b = jet[0].dimension >= jet[1].dimension ? jet[1] : jet[0];
  dvec3 normal(0.0);
  if (a.dimension == 2) {
    normal = glm::cross(a.dx[0], a.dx[1]);
  } else if (b.dimension == 1) {
    normal = glm::cross(unit(a.dx[0]), unit(b.dx[0]));
    // Of one edge: as at its end.
    if (glm::length(normal) < least_angle) normal = dvec3(0.0);
  } else {
    normal = glm::cross(a.dx[0], a.dxx);
  }
  normal = unit(normal);
  if (std::abs(glm::dot(normal, near)) < least_cosine) {
    normal = near;
    for (const ContactJet& j : jet) {
      if (j.dimension != 1) continue;
      const dvec3 along = unit(j.dx[0]);
      normal -= glm::dot(normal, along) * along;
    }
    normal = unit(normal);
  }
  return aligned(normal, near);
}

double merging_distance(const ContactGeometry& geometry) {
  return std::max(merge_distance, 2 * std::pow(geometry.rounding(), 0.25));
}

double least_distance_at(const CurvePoint& point) {
  return is_about_pole(point) ? least_distance_at_pole : least_distance;
}

std::optional<MergedEnd> merged_end(const CurvePoint& point) { return Merging(point).run(); }

}  // namespace taut
