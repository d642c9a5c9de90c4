#include "taut/hull/solve/ruling_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/contact_forms.h"
#include "taut/bounds/poles.h"
#include "taut/bounds/supporting_plane.h"
#include "taut/core/tolerances.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/hull/solve/tolerant_places.h"

namespace taut {
namespace {

/// Halvings of the angle between two directions until they are next to each other.
constexpr int bracket_halvings = std::numeric_limits<double>::digits;
/// Every so often the angle is halved, whatever the contacts' planes tell.
constexpr int secant_steps = 2;
/// How often Newton's method begins anew with contacts that have left their elements.
constexpr int element_limit = 6;
/// How far parameters may leave [0, 1] by rounding.
constexpr double parameter_rounding = 1e-9;
/// How far from a side a contact may be that the direction does not tell from one on the side:
/// where x . n departs with the third power, its slope with the second is rounding up to there.
constexpr double side_reach = 1e-5;
/// Turn, in radians, into a contact's own region.
constexpr double beside_turn = 1e-6;
/// How far from a contact another one is like it, as a share of the way to the other contact.
constexpr double like_share = 0.3;
/// How much wider than the way between two rulings a bracket between them may be, at most.
constexpr double widest_bracket = 8;
/// Halvings of such a bracket that has others than these contacts in it.
constexpr int narrow_halvings = 16;

/// Ways that are not divided: of what is not rounded; and as a share of how far places may be from
/// each other that rounding makes one. (Between the two nothing is lower by more than the square of
/// it, of what makes them one.)
constexpr double least_exact_way = 1e-6;
constexpr double one_place = 0.01;

/// Depths, in units of the resolution, by a patch's own normals, up to which it touches: rounding
/// turns normals at the sides of small patches so far that this is more than one (four were met);
/// where patches rise from the hull they are hundreds.
constexpr double touching_depths = 16;

bool is_in_element(const Contact& c) {
  const auto within = [](double t) {
    return t >= -parameter_rounding && t <= 1 + parameter_rounding;
  };
  return within(c.u) && within(c.v);
}

/// The contact is on no border of its element.
bool is_off_borders(const Contact& c) {
  const auto within = [](double t) { return t > 0 && t < 1; };
  return c.kind == SourceKind::face && within(c.u) && within(c.v);
}

/// It is nearer to either of two rulings than these are to each other.
bool is_between(const Ruling& from, const Ruling& to, const Ruling& r) {
  const auto square = [](const Ruling& a, const Ruling& b) {
    const auto part = [](const dvec3& x) { return glm::dot(x, x); };
    return part(a.n - b.n) + part(a.point[0] - b.point[0]) + part(a.point[1] - b.point[1]);
  };
  return std::max(square(from, r), square(r, to)) < square(from, to);
}

double place_resolution_of(const Scene& scene, const DirectionMap& map) {
  const double share = is_rounded(scene, map.resolution) ? coarsest_resolution : resolution_floor;
  return std::min(map.resolution, scene.frame().length_to_frame(share * scene.diagonal()));
}

/// A resolution that is asked for does not tell how far places that are one are from each other.
double place_extent_of(const Scene& scene, const DirectionMap& map) {
  const double coarsest = scene.frame().length_to_frame(coarsest_resolution * scene.diagonal());
  return is_rounded(scene, map.resolution) && map.resolution <= coarsest ? map.contact_extent() : 0;
}

/// The point of a round shape that supports in a direction.
dvec3 top_of(const MapCell::Round& round, const dvec3& n) {
  const dvec3 x = round.root * n;
  return round.center + round.root * x / glm::length(x);
}

/// Where the great arc between two directions passes the plane in which both points are as high;
/// in the middle, where it does not.
dvec3 exchange(const SupportingContact& a, const SupportingContact& b) {
  const dvec3 middle = unit(a.n + b.n);
  const dvec3 d = a.x - b.x;
  const double before = glm::dot(a.n, d);
  const double after = glm::dot(b.n, d);
  if (!(before > 0 && after < 0)) return middle;
  return unit(before * b.n - after * a.n);
}

}  // namespace

RulingSearch::RulingSearch(const ContactSystem& system, SupportQuery& query,
                           const DirectionMap& map)
    : system_(system),
      geometry_(system.geometry()),
      query_(query),
      map_(map),
      place_resolution_(place_resolution_of(geometry_.scene(), map)),
      place_extent_(place_extent_of(geometry_.scene(), map)) {}

double RulingSearch::least_way() const {
  return std::max(least_exact_way, one_place * place_extent_);
}

SupportingContact RulingSearch::supporting(const dvec3& n, const Contact& hint) const {
  const Support s = query_(n, hint);
  const Contact c = uncovered(at_rest(geometry_, s.contact, n), n);
  return {n, c, geometry_.point(c)};
}

Contact RulingSearch::uncovered(const Contact& c, const dvec3& n) const {
  const Contact own = geometry_.first(c);
  const auto is_covered = [&](const Contact& edge) {
    return std::any_of(map_.covered_edges.begin(), map_.covered_edges.end(),
                       [&](const Contact& covered) { return same_element(covered, edge); });
  };
  if (own.kind != SourceKind::edge || !is_covered(own)) return own;
  std::optional<Contact> best;
  for (const ContactGeometry::PieceSide& side : geometry_.ruled_sides(own)) {
    Contact across = on_side(own, side);
    double& t = along_v(side.side) ? across.u : across.v;
    t = 1 - t;
    const Contact end = geometry_.first(geometry_.canonical(across));
    if (is_covered(end)) continue;
    if (!best || glm::dot(geometry_.point(end) - geometry_.point(*best), n) > 0) best = end;
  }
  return best.value_or(own);
}

ClimbedContact RulingSearch::uncovered_climb(const Contact& c, const dvec3& n) const {
  const ClimbedContact there = climb(geometry_, c, n);
  const Contact at = geometry_.first(there.contact);
  const Contact own = uncovered(at, n);
  if (same_element(own, at)) return {at, there.x, there.h};
  const dvec3 x = geometry_.point(own);
  return {own, x, glm::dot(x, n)};
}

SupportingContact RulingSearch::climbed_from(const SupportingContact& s, const dvec3& n) const {
  const ClimbedContact c = uncovered_climb(s.contact, n);
  return {n, c.contact, c.x};
}

double RulingSearch::depth(const Ruling& ruling) const {
  const double h = query_(ruling.n, ruling.contact[0]).h;
  return h - std::min(glm::dot(ruling.point[0], ruling.n), glm::dot(ruling.point[1], ruling.n));
}

bool RulingSearch::touches(const Contact& c) const {
  const dvec3 normal = unit_normal(geometry_, c);
  const dvec3 x = geometry_.point(c);
  const double depth = touching_depths * map_.resolution;
  for (const dvec3& n : {normal, -normal}) {
    if (is_supporting(geometry_, query_, n, glm::dot(x, n), c, depth)) return true;
  }
  return false;
}

std::optional<Ruling> RulingSearch::polished(const dvec3& n, const std::array<Contact, 2>& contacts,
                                             const dvec3& across, double depth_limit) const {
  CommonSupport start;
  start.n = n;
  for (const Contact& c : contacts) start.add(geometry_, c);
  LinearEquation equation;
  equation.n = unit(across);
  for (int k = 0; k < element_limit; ++k) {
    CommonSupport s = start;
    const bool solved = system_.solve(s, [&](const CommonSupport& now) {
      equation.residual = glm::dot(equation.n, now.n);
      return equation;
    });
    if (!solved) return std::nullopt;
    bool moved = false;
    for (std::size_t i = 0; i < 2; ++i) {
      const bool inside = is_in_element(s.contact[i]);
      const bool kept = s.kept[i] != CommonSupport::free;
      if (inside && (kept || s.contact[i].kind == SourceKind::face)) continue;
      // It has run over into another element, or others rise beside where it ends: by heights that
      // are lost in rounding where it is not told so.
      const std::optional<Contact> there = climbed(geometry_, clamped(s.contact[i]), s.n);
      const bool same = there && (same_element(*there, start.contact[i]) ||
                                  rises_little(s.n, clamped(s.contact[i]), *there));
      if (inside && (same || !there)) continue;
      if (same || (!there && s.contact[i].kind != SourceKind::face)) return std::nullopt;
      moved = true;
      if (there) {
        s.contact[i] = geometry_.first(*there);
        continue;
      }
      return std::nullopt;
    }
    if (!moved) {
      for (Contact& c : s.contact) c = clamped(c);
      s.evaluate(geometry_);
      keep_on_sides(s, equation);
      const Ruling found = s.ruling();
      if (glm::length(s.d()) <= same_contact || depth(found) > depth_limit) return std::nullopt;
      return found;
    }
    s.evaluate(geometry_);
    start = s;
  }
  return std::nullopt;
}

/// What ends beside ruled patches that are bent supports there, though others rise by as little as
/// these may.
bool RulingSearch::rises_little(const dvec3& n, const Contact& from, const Contact& to) const {
  if (map_.bent == 0 || from.kind == SourceKind::face) return false;
  return glm::dot(geometry_.point(to) - geometry_.point(from), n) <= map_.bent;
}

/// The nearest place nearby, if any, on an edge beside which a ruled patch is bent, of the
/// contact's patch or of those next to it, where that touches: what curves beyond it does not tell
/// where it supports.
std::optional<Contact> RulingSearch::on_bent(const Contact& c) const {
  if (map_.bent == 0) return std::nullopt;
  const dvec3 x = geometry_.point(c);
  // Where curvature begins at the border, heights depart with the third power.
  double nearest = std::cbrt(map_.resolution);
  std::optional<Contact> found;
  std::vector<Contact> places = {c};
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Contact own = places[k];
    for (const ContactExit& exit : exits(geometry_, own)) {
      const Contact on = at_exit(own, exit);
      const double off = glm::distance(geometry_.point(on), x);
      if (off > nearest) continue;
      const std::optional<Contact> over = beyond(geometry_, on, exit);
      if (k == 0 && over && over->kind == SourceKind::face) places.push_back(*over);
      const Contact edge = geometry_.first(geometry_.canonical(on));
      if (!geometry_.is_beside_bent(edge) || !touches(on)) continue;
      nearest = off;
      found = edge;
    }
  }
  return found;
}

/// Of a contact that has left an edge by one of its ends: the end of the edge that goes on there
/// most nearly straight, of those beside ruled patches that are bent.
std::optional<Contact> RulingSearch::beyond_end(const Contact& c) const {
  const Contact end = clamped(c);
  const ContactExit exit{ContactExit::Kind::end, end.u > 0.5 ? 1 : 0};
  const std::optional<Contact> over = beyond(geometry_, at_exit(end, exit), exit);
  if (!over || geometry_.is_beside_bent(*over)) return over;
  if (over->kind != SourceKind::vertex) return std::nullopt;
  const dvec3 way = (exit.index == 1 ? 1.0 : -1.0) * geometry_.jet(end).dx[0];
  std::optional<Contact> best;
  double straightest = 0;
  for (const ContactGeometry::PieceEnd& next : geometry_.ends(*over)) {
    const Contact at = geometry_.first(piece_end(*over, next));
    if (same_element(at, end) || !geometry_.is_beside_bent(at)) continue;
    const double along = glm::dot(unit(tangent_from(geometry_, *over, next)), unit(way));
    if (along <= straightest) continue;
    straightest = along;
    best = at;
  }
  return best;
}

/// Contacts next to edges beside which ruled patches are bent are on these, as far as others are
/// no higher than such patches may be.
bool RulingSearch::keep_on_bent(CommonSupport& s, LinearEquation equation) const {
  if (map_.bent == 0) return false;
  CommonSupport kept = s;
  bool any = false;
  for (std::size_t i = 0; i < 2; ++i) {
    if (s.contact[i].kind != SourceKind::face) continue;
    const std::optional<Contact> edge = on_bent(s.contact[i]);
    if (edge) kept.contact[i] = *edge;
    any = any || edge;
  }
  for (int k = 0; k < element_limit && any; ++k) {
    kept.evaluate(geometry_);
    const bool solved = system_.solve(kept, [&](const CommonSupport& now) {
      equation.residual = glm::dot(equation.n, now.n);
      return equation;
    });
    if (!solved) return false;
    bool moved = false;
    for (Contact& c : kept.contact) {
      if (is_in_element(c)) continue;
      if (c.kind != SourceKind::edge) return false;
      const std::optional<Contact> next = beyond_end(c);
      if (!next) return false;
      c = *next;
      moved = true;
    }
    if (moved) continue;
    for (Contact& c : kept.contact) c = clamped(c);
    kept.evaluate(geometry_);
    if (depth(kept.ruling()) > map_.bent) return false;
    s = kept;
    return true;
  }
  return false;
}

/// A contact next to a side, that supports on it, is there: beyond it a plane or a ruled surface
/// goes on, and the direction does not tell the two places apart.
void RulingSearch::keep_on_sides(CommonSupport& s, LinearEquation equation) const {
  if (keep_on_bent(s, equation)) return;
  CommonSupport kept = s;
  for (std::size_t i = 0; i < 2; ++i) {
    if (s.contact[i].kind != SourceKind::face) continue;
    kept.contact[i] = moved_to_border(geometry_, s.contact[i], side_reach);
    kept.kept[i] = kept_parameter(kept.contact[i], kept.contact[i]);
  }
  if (kept.kept == s.kept) return;
  kept.evaluate(geometry_);
  const bool solved = system_.solve(kept, [&](const CommonSupport& now) {
    equation.residual = glm::dot(equation.n, now.n);
    return equation;
  });
  if (!solved || !std::all_of(kept.contact.begin(), kept.contact.begin() + 2, is_in_element))
    return;
  for (std::size_t i = 0; i < 2; ++i) s.contact[i] = clamped(kept.contact[i]);
  s.n = kept.n;
  s.evaluate(geometry_);
}

Ruling RulingSearch::settled(Ruling ruling) const {
  const dvec3 d = ruling.point[0] - ruling.point[1];
  const dvec3 right = unit(d - glm::dot(d, ruling.n) * ruling.n);
  for (const std::size_t i : {0u, 1u}) {
    const Contact own = geometry_.first(snapped(geometry_, ruling.contact[i], parameter_rounding));
    if (is_off_borders(own)) continue;
    if (geometry_.is_beside_bent(own)) {
      ruling.contact[i] = own;
      ruling.point[i] = geometry_.point(own);
      continue;
    }
    if (own.kind == SourceKind::vertex) {
      // It stays there along the curve, be its own region an edge's or not.
      const dvec3 ahead = beside_turn * glm::cross(ruling.n, right);
      if (same_element(uncovered_climb(own, unit(ruling.n + ahead)).contact, own) &&
          same_element(uncovered_climb(own, unit(ruling.n - ahead)).contact, own)) {
        ruling.contact[i] = own;
        continue;
      }
    }
    const dvec3 beside = unit(ruling.n + (i == 0 ? beside_turn : -beside_turn) * right);
    const Contact there = uncovered_climb(own, beside).contact;
    // At a vertex another edge's contact may have ended, but for a height that is lost in rounding.
    const Contact at =
        own.kind == SourceKind::vertex ? uncovered_climb(there, ruling.n).contact : own;
    if (const auto expressed = expressed_in(geometry_, at, there)) {
      ruling.contact[i] = *expressed;
      ruling.point[i] = geometry_.point(*expressed);
    }
  }
  return ruling;
}

Ruling RulingSearch::bracketed(SupportingContact right, SupportingContact left, const Which& which,
                               const dvec3& apart) const {
  const dvec3 across = glm::cross(right.n, left.n);
  for (int k = 0; k < bracket_halvings * secant_steps; ++k) {
    const bool halves = k % (secant_steps + 1) == secant_steps;
    const dvec3 n = halves ? unit(right.n + left.n) : exchange(right, left);
    if (const auto found = polished(n, {right.contact, left.contact}, across, touching())) {
      const double way = glm::dot(right.n, left.n);
      const bool is_between =
          glm::dot(found->n, right.n) >= way && glm::dot(found->n, left.n) >= way;
      if (is_between && is_right(*found, which, apart)) return settled(*found);
    }
    if (n == right.n || n == left.n) {
      if (halves) break;
      continue;
    }
    // What supports on either side goes on there as one of those that support: where others, or
    // copies, are as high.
    const SupportingContact top = supporting(n, right.contact);
    const std::array<SupportingContact, 2> own = {climbed_from(right, n), climbed_from(left, n)};
    const std::size_t higher = glm::dot(own[0].x, n) >= glm::dot(own[1].x, n) ? 0 : 1;
    const Likeness like = which(top);
    // It may have climbed over to where the other one comes from, which is lower by now.
    const double h = glm::dot(top.x, n);
    const bool has_left = like.is_like && like.side != int(higher) &&
                          glm::dot(own[1 - higher].x, n) < h - geometry_.tie() &&
                          glm::distance(own[higher].x, top.x) <= map_.contact_extent();
    const bool go_on = !has_left && glm::dot(own[higher].x, n) >= h - geometry_.tie() &&
                       glm::distance(own[0].x, own[1].x) > map_.contact_extent();
    const bool tells = !go_on && like.side != Likeness::unknown;
    const std::size_t side = tells ? std::size_t(like.side) : higher;
    // What is like neither is above both by no more than the resolution; and of what is moved by
    // little either may be told as what supports.
    const bool is_told = apart != dvec3(0.0) && glm::dot(own[side].x, n) >= h - geometry_.tie();
    (side == 0 ? right : left) = !go_on && !is_told && like.is_like ? top : own[side];
  }
  const dvec3 n = unit(right.n + left.n);
  if (const auto found = polished(n, {right.contact, left.contact}, across, map_.resolution)) {
    return *found;
  }
  return {n, {right.contact, left.contact}, {right.x, left.x}};
}

/// Contacts that have left their elements may have come upon others.
bool RulingSearch::is_right(const Ruling& found, const Which& which, const dvec3& apart) {
  if (apart != dvec3(0.0)) return glm::dot(found.point[0] - found.point[1], apart) > 0;
  return which({found.n, found.contact[0], found.point[0]}).side == 0 &&
         which({found.n, found.contact[1], found.point[1]}).side == 1;
}

/// Beyond a narrow region of either contact others support: from a contact that is like the one
/// towards those, to one that is like the other.
std::array<SupportingContact, 2> RulingSearch::narrowed(const SupportingContact& right,
                                                        const SupportingContact& left,
                                                        const Which& which) const {
  std::array<SupportingContact, 2> own = {right, left};
  std::array<bool, 2> is_like = {which(right).is_like, which(left).is_like};
  for (int k = 0; k < narrow_halvings && is_like[0] != is_like[1]; ++k) {
    const SupportingContact middle = supporting(unit(own[0].n + own[1].n), own[0].contact);
    const Likeness like = which(middle);
    const std::size_t unlike = is_like[0] ? 1 : 0;
    const std::size_t side = like.is_like ? std::size_t(like.side) : unlike;
    own[side] = middle;
    is_like[side] = like.is_like;
  }
  if (is_like[0] && is_like[1]) return own;
  return {right, left};
}

Ruling RulingSearch::at(const MapCrossing& crossing) const {
  const MapCell& cell = map_.cells[std::size_t(crossing.cell)];
  const auto& [first, second] = crossing.contact;
  const Which which = [&, from = first, to = second](const SupportingContact& s) {
    const int contact = int(cell.told_contact_of(s.n, s.x));
    // Of contacts in line those on the way before the first are to its side.
    const bool is_third = cell.kind == MapCellKind::node && contact != from && contact != to;
    if (is_third) return Likeness{Likeness::unknown, false};
    const int side = (contact - from) * (to - from) <= 0 ? 0 : 1;
    const Box& box = cell.contacts[std::size_t(contact)];
    return Likeness{side, distance(box, s.x) <= map_.contact_extent()};
  };
  const SupportingContact right = supporting(unit(crossing.ends[0]), {});
  const SupportingContact left = supporting(unit(crossing.ends[1]), right.contact);
  dvec3 apart(0.0);
  const auto at = [&](int contact) { return cell.translates[std::size_t(contact)]; };
  if (!cell.translates.empty() && at(first).of == at(second).of) {
    apart = at(first).by - at(second).by;
  } else if (!cell.rounds.empty()) {
    const dvec3 n = unit(crossing.ends[0] + crossing.ends[1]);
    const dvec3 way =
        top_of(cell.rounds[std::size_t(first)], n) - top_of(cell.rounds[std::size_t(second)], n);
    if (glm::length(way) <= map_.contact_extent()) apart = way;
  }
  return bracketed(right, left, which, apart);
}

std::optional<Ruling> RulingSearch::between(const Ruling& from, const Ruling& to) const {
  const dvec3 n = unit(from.n + to.n);
  const std::array<dvec3, 2> x = {0.5 * (from.point[0] + to.point[0]),
                                  0.5 * (from.point[1] + to.point[1])};
  const dvec3 d = x[0] - x[1];
  const dvec3 right = unit(d - glm::dot(d, n) * n);
  const dvec3 across = glm::cross(n, right);
  std::array<Contact, 2> contacts;
  for (std::size_t i = 0; i < 2; ++i) {
    contacts[i] = uncovered_climb(from.contact[i], n).contact;
  }
  const auto found = polished(n, contacts, across, touching());
  if (found && is_between(from, to, *found)) return settled(*found);
  const Which which = [&](const SupportingContact& s) {
    const int side = glm::distance(s.x, x[0]) <= glm::distance(s.x, x[1]) ? 0 : 1;
    const double gap = glm::distance(s.x, x[std::size_t(side)]);
    return Likeness{side, gap <= like_share * glm::distance(x[0], x[1])};
  };
  const double way = glm::distance(from.n, to.n);
  for (double width = 1; width <= widest_bracket; width *= 2) {
    const SupportingContact a = supporting(unit(n + width * way * right), from.contact[0]);
    const SupportingContact b = supporting(unit(n - width * way * right), from.contact[1]);
    if (which(a).side != 0 || which(b).side != 1) continue;
    const auto [right_one, left_one] = narrowed(a, b, which);
    const bool is_narrow = glm::distance(x[0], x[1]) <= map_.contact_extent();
    return bracketed(right_one, left_one, which, is_narrow ? x[0] - x[1] : dvec3(0.0));
  }
  return found;
}

}  // namespace taut
