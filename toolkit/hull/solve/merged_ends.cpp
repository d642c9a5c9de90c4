#include "taut/hull/solve/merged_ends.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/contact_forms.h"
#include "taut/bounds/poles.h"
#include "taut/core/tolerances.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/hull/solve/free_ends.h"

namespace taut {
namespace {

/// Rate of the distance of two contacts of one surface or curve that merge, at most. It tends to
/// the square root of two, to less (0.6 and more were seen) where third derivatives are not
/// continuous.
constexpr double slowest_merging = -0.05;
/// Two contacts that run into a pole are no farther from it, and miss it by no more than the share
/// of their distance.
constexpr double pole_reach = 8e-3;
constexpr double pole_share = 0.02;
/// Sine of the angle below which two edges that merge are one.
constexpr double least_angle = 1e-3;
/// Cosine by which the limit of the direction may miss its extrapolation.
constexpr double least_cosine = 0.99;
/// Contacts nearer than this are moved by rounding.
constexpr double least_distance = 2e-4;
/// How far contacts that meet may be off each other, as a share of their distance before.
constexpr double meeting_share = 0.25;

double square(const dvec3& x) { return glm::dot(x, x); }

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

/// The place of a free end as one of the element of a contact that runs there, or of one of its
/// kind beyond others.
Contact told_beside(const ContactGeometry& geometry, const Contact& end, const Contact& own) {
  if (const auto there = expressed_in(geometry, end, own)) return *there;
  if (own.kind != SourceKind::face || end.kind != SourceKind::edge) return end;
  const Contact edge = geometry.first(end);
  const std::vector<ContactGeometry::PieceSide>& sides = geometry.sides(edge);
  return sides.empty() ? end : on_side(edge, sides.front());
}

/// The direction in which two contacts merge at a common point: a face's normal; across the
/// tangents of two edges; of an edge and its end, across the edge's osculating plane. `near` tells
/// the sense, and the direction where these are none.
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

class Merging {
 public:
  Merging(const RulingSearch& search, const Ruling& last)
      : search_(search),
        geometry_(search.geometry()),
        last_(last),
        at_(geometry_, last),
        length_(glm::length(at_.d())) {}

  std::optional<Ruling> run() {
    if (!approaches()) return std::nullopt;
    if (const auto end = in_pole()) return end;
    is_smooth_ = continues(geometry_, last_.contact[0], last_.contact[1]);
    in_one_ = same_element(last_.contact[0], last_.contact[1]);
    const Ruling near = extrapolated();
    if (!is_smooth_ && !meet(near)) return in_crossing();
    if (const auto end = in_free_end(near)) return end;
    // On one surface or curve they run into each other, rather than pass by.
    if (is_smooth_ && rate_ > slowest_merging) return std::nullopt;
    return at(near);
  }

 private:
  bool approaches();
  std::optional<Ruling> in_pole() const;
  std::optional<Ruling> into(const Contact& pole) const;
  std::optional<Ruling> in_crossing() const;
  std::optional<Ruling> in_free_end(const Ruling& near) const;
  std::optional<Ruling> at(Ruling near) const;
  Ruling extrapolated() const;
  bool meet(const Ruling& end) const;
  Ruling moved(double way) const;
  std::optional<FreeEnd> supporting(const Ruling& near) const;

  /// f(0) = f - linear() f' for a function f of the contacts' distance.
  double linear() const { return length_ / rate_; }
  double length_along(const dvec3& n, const dvec3& x) const {
    return glm::dot(n - at_.n, tangent_.n) + glm::dot(x - at_.jet[0].x, tangent_.x[0]) +
           glm::dot(x - at_.jet[1].x, tangent_.x[1]);
  }
  /// The nearer the contacts, the better the extrapolation; until rounding spoils it.
  bool is_low(const Ruling& r) const {
    const bool is_spoilt = length_ <= least_distance;
    return search_.depth(r) > (is_spoilt ? search_.map().resolution : geometry_.tie());
  }

  const RulingSearch& search_;
  const ContactGeometry& geometry_;
  const Ruling& last_;
  CommonSupport at_;
  double length_;
  double rate_ = 0;  ///< of the distance, along the tangent
  CurveTangent tangent_;
  bool is_smooth_ = false;  ///< they run on one smooth curve or surface
  bool in_one_ = false;     ///< in one element
};

/// The tangent in the sense in which the contacts do so.
bool Merging::approaches() {
  const std::optional<CurveTangent> tangent = search_.system().tangent(at_);
  if (!tangent || !(length_ > 0)) return false;
  tangent_ = *tangent;
  rate_ = glm::dot(tangent_.x[0] - tangent_.x[1], at_.d()) / length_;
  if (rate_ > 0) {
    rate_ = -rate_;
    tangent_.n = -tangent_.n;
    for (const std::size_t i : {0u, 1u}) {
      tangent_.x[i] = -tangent_.x[i];
      tangent_.parameter[i] = -tangent_.parameter[i];
    }
  }
  return rate_ < 0;
}

/// The contacts along the tangent, in their elements.
Ruling Merging::moved(double way) const {
  Ruling r = last_;
  r.n = unit(r.n + way * tangent_.n);
  for (std::size_t i = 0; i < 2; ++i) {
    r.contact[i].u = std::clamp(r.contact[i].u + way * tangent_.parameter[i].x, 0.0, 1.0);
    r.contact[i].v = std::clamp(r.contact[i].v + way * tangent_.parameter[i].y, 0.0, 1.0);
  }
  return r;
}

/// As functions of their distance, the contacts' parameters and n are smooth at a free end. Where
/// both run on one smooth curve or surface, n and, if they are in one element, the parameters' mean
/// are smooth functions of its square.
Ruling Merging::extrapolated() const {
  Ruling end = moved(-linear());
  // f(0) = f - length f' / 2 for a function of the square.
  const double squared = 0.5 * linear();
  if (is_smooth_) end.n = unit(at_.n - squared * tangent_.n);
  if (in_one_) {
    const dvec2 mean = 0.5 * (parameters(last_.contact[0]) + parameters(last_.contact[1])) -
                       0.5 * squared * (tangent_.parameter[0] + tangent_.parameter[1]);
    for (Contact& c : end.contact) {
      c.u = std::clamp(mean.x, 0.0, 1.0);
      c.v = std::clamp(mean.y, 0.0, 1.0);
    }
  }
  move_together(geometry_, end.contact[0], end.contact[1]);
  return end;
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

/// Both contacts run straight into one pole. Curvatures differ along the ways out of it: its
/// surface, to second order homogeneous about it, may touch a plane twice however near to it.
std::optional<Ruling> Merging::in_pole() const {
  const Contact& c = last_.contact[0];
  if (c.kind != SourceKind::face) return std::nullopt;
  for (const Side side : all_sides) {
    if (!is_pole(geometry_, c, side)) continue;
    if (const auto end = into(on_side(c.instance, c.element, side, 0.5))) return end;
  }
  return std::nullopt;
}

/// On straight ways: their distance need not be linear, being small where the curvatures hardly
/// differ.
std::optional<Ruling> Merging::into(const Contact& pole) const {
  const dvec3 x = geometry_.point(pole);
  double approach = 0;
  double speed = 0;
  double reach = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    approach += glm::dot(x - at_.jet[i].x, tangent_.x[i]);
    speed += square(tangent_.x[i]);
    reach = std::max(reach, pole_share * glm::distance(at_.jet[i].x, x));
  }
  if (approach <= 0 || reach > pole_share * pole_reach) return std::nullopt;
  const double ahead = approach / speed;
  Ruling end = moved(ahead);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::optional<Contact> there = pole_in(geometry_, pole, end.contact[i]);
    if (!there || glm::distance(at_.jet[i].x + ahead * tangent_.x[i], x) > reach) {
      return std::nullopt;
    }
    end.contact[i] = *there;
  }
  if (end.contact[0].instance != end.contact[1].instance) return std::nullopt;
  end.n = aligned(unit_normal(geometry_, end.contact[0]), at_.n);
  end.point = {x, x};
  if (glm::distance(end.n, at_.n + ahead * tangent_.n) > reach || is_low(end)) return std::nullopt;
  return end;
}

/// The contacts, of two surfaces or curves, meet in a common point.
std::optional<Ruling> Merging::in_crossing() const {
  const std::optional<CommonSupport> found = search_.system().crossing(at_);
  if (!found) return std::nullopt;
  const double way = std::sqrt(square(found->n - at_.n) + square(found->jet[0].x - at_.jet[0].x) +
                               square(found->jet[1].x - at_.jet[1].x));
  if (way > 4 * length_) return std::nullopt;
  Ruling end = found->ruling();
  for (Contact& c : end.contact) {
    if (glm::distance(parameters(c), parameters(clamped(c))) > same_contact) return std::nullopt;
    c = clamped(c);
  }
  end.point[1] = end.point[0];
  return is_low(end) ? std::nullopt : std::optional(end);
}

/// The free end near a ruling, if it supports.
std::optional<FreeEnd> Merging::supporting(const Ruling& near) const {
  const std::optional<FreeEnd> kind = kind_of_end(geometry_, near);
  const std::optional<FreeEnd> end = kind ? polished(geometry_, *kind) : std::nullopt;
  if (!end) return std::nullopt;
  const dvec3 x = geometry_.point(end->contact);
  return is_low({end->n, {end->contact, end->contact}, {x, x}}) ? std::nullopt : end;
}

/// The free end into which the contacts run, told in their elements as far as it lies in these.
std::optional<Ruling> Merging::in_free_end(const Ruling& near) const {
  std::optional<FreeEnd> end = supporting(near);
  if (!end && is_smooth_ && !in_one_) {
    // Where a join makes the end, n is no smooth function of the square.
    Ruling straight = near;
    straight.n = unit(at_.n - linear() * tangent_.n);
    end = supporting(straight);
  }
  if (!end && !is_smooth_) {
    // Where a parabolic curve touches an edge, the distance falls with the square of the way.
    end = supporting(moved(-2 * linear()));
  }
  if (!end) return std::nullopt;
  // On an edge that a parabolic curve touches it lies twice as far ahead as the distance tells.
  const double reach = (is_smooth_ ? 2 : 3) * std::abs(linear());
  const dvec3 x = geometry_.point(end->contact);
  if (length_along(end->n, x) <= 0 || glm::distance(x, at_.jet[0].x) >= reach) return std::nullopt;
  Ruling r{end->n, {end->contact, end->contact}, {x, x}};
  for (std::size_t i = 0; i < 2; ++i) {
    r.contact[i] = told_beside(geometry_, end->contact, last_.contact[i]);
  }
  return r;
}

/// Where it is extrapolated to, in the direction in which contacts merge there.
std::optional<Ruling> Merging::at(Ruling near) const {
  const std::array<ContactJet, 2> jet = {geometry_.jet(near.contact[0]),
                                         geometry_.jet(near.contact[1])};
  if (glm::distance(jet[0].x, jet[1].x) > meeting_share * length_) return std::nullopt;
  near.n = limit_normal(jet, near.n);
  const dvec3 x = jet[jet[0].dimension <= jet[1].dimension ? 0 : 1].x;
  near.point = {x, x};
  return is_low(near) ? std::nullopt : std::optional(near);
}

}  // namespace

double merging_distance(const ContactGeometry& geometry) {
  return std::max(merge_distance, 2 * std::pow(geometry.rounding(), 0.25));
}

std::optional<Ruling> merged_ruling(const RulingSearch& search, const Ruling& last) {
  return Merging(search, last).run();
}

}  // namespace taut
