#include "taut/hull/trace/pole_passage.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "taut/bounds/contact_climb.h"
#include "taut/bounds/contact_exits.h"
#include "taut/bounds/contact_forms.h"
#include "taut/bounds/poles.h"
#include "taut/core/tolerances.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/contact/exit_margins.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/hull/contact/level_sides.h"
#include "taut/hull/contact/local_curvature.h"
#include "taut/hull/trace/plane_corners.h"

namespace taut {
namespace {

/// Turns of n that are tried as the first step away from where contacts are singular: so many, each
/// less than the one before by the factor. In one of them both contacts are
/// in the elements next to theirs, be these as small as cages' patches about extraordinary
/// vertices.
constexpr double turn_factor = 0.6;
constexpr int turn_count = 30;
/// Lengths that are tried as the first step beyond ends that both contacts reach together: the
/// longest, and so many in all, each shorter by the factor.
constexpr double longest_way = 0.05;
constexpr int way_count = 12;
/// The way to one side is so much of that to another, at most, that the contact goes to the corner;
/// and where the patch is flat in the corner, which curves may reach along a side.
constexpr double corner_share = 1.1;
constexpr double flat_corner_share = 3;
/// A corner in which the patch is plane is reached in a step so many times as long: beside it
/// Newton's method finds nothing that is farther away than a share of the way there.
constexpr double plane_corner_reach = 16;
/// The least cosine of the way to such a corner with the contact's, which arrives in it straight.
constexpr double plane_corner_cosine = 0.9;
/// Newton steps of a contact along a side, on which it has its place but for their square.
constexpr int most_slides = 6;
/// Ends of elements that a contact passes in a corner, at most.
constexpr int most_ends = 3;
/// Shares of such a turn by which n is tilted towards a contact, to tell it from others: with the
/// first of them contacts are then climbed to, with all they are tried as they are.
constexpr std::array<double, 4> tilts = {0.1, 1e-3, 1e-5, 1e-7};
/// Share of such a turn by which n is tilted either way to find where the support jumps from the
/// one contact to the other, and halvings of what is between.
constexpr double jump_tilt = 0.5;
constexpr int jump_halvings = 40;
/// Contacts no farther from where they were than this share of the distance between the two have
/// come from there.
constexpr double near_share = 0.25;

bool is_corner(const Contact& c) { return (c.u == 0 || c.u == 1) && (c.v == 0 || c.v == 1); }

bool is_inside(const Contact& c) { return c.u >= 0 && c.u <= 1 && c.v >= 0 && c.v <= 1; }

/// The cubic with these values and slopes at 0 and 1, at s.
double cubic(double value0, double slope0, double value1, double slope1, double s) {
  const double r = 1 - s;
  return r * r * ((1 + 2 * s) * value0 + s * slope0) + s * s * ((1 + 2 * r) * value1 - r * slope1);
}

}  // namespace

Contact at_pole(Contact c, Side side) {
  (along_v(side) ? c.u : c.v) = at_upper_end(side) ? 1 : 0;
  return c;
}

std::optional<Contact> at_pole_of(const ContactGeometry& geometry, const Contact& c,
                                  const dvec3& x) {
  if (c.kind != SourceKind::face) return std::nullopt;
  for (const Side side : all_sides) {
    const Contact there = at_pole(c, side);
    if (is_pole(geometry, c, side) && glm::distance(geometry.point(there), x) < join_distance) {
      return there;
    }
  }
  return std::nullopt;
}

std::optional<Contact> in_element(const ContactGeometry& geometry, const Contact& c,
                                  const Contact& other) {
  if (!pole_side(geometry, c)) return expressed_in(geometry, c, other);
  return at_pole_of(geometry, other, geometry.point(c));
}

bool PolePassage::reach(int contact, Side side, double length) {
  const auto i = std::size_t(contact);
  const std::size_t other = 1 - i;
  CommonSupport pole = point_.at;
  pole.contact[i] = at_pole(point_.at.contact[i], side);
  pole.n = aligned(unit_normal(geometry_, pole.contact[i]), point_.at.n);
  const std::optional<Contact> c = climbed(geometry_, point_.at.contact[other], pole.n);
  if (!c || !same_element(*c, point_.at.contact[other])) return false;
  pole.contact[other] = *c;
  // At another pole its parameter along the side is as it was, not where the climb came from.
  if (const std::optional<Side> at = pole_side(geometry_, *c)) {
    pole.contact[other] = at_pole(point_.at.contact[other], *at);
  }
  pole.evaluate(geometry_);
  const double ahead = point_.length_to(pole);
  if (std::abs(glm::dot(pole.d(), pole.n)) > geometry_.tie() || ahead < 0 || ahead > 2 * length ||
      point_.query()(pole.n, pole.contact[i]).h >
          glm::dot(pole.jet[i].x, pole.n) + geometry_.tie()) {
    return false;
  }
  point_.at = pole;
  return true;
}

bool PolePassage::is_singular(int contact) const {
  const auto i = std::size_t(contact);
  return pole_side(geometry_, point_.at.contact[i]) ||
         is_flat(point_.at.jet[i], point_.at.n, least_curvature);
}

std::optional<Ruling> PolePassage::leave(double largest) {
  return leave(largest, [&](double step) {
    std::optional<Ruling> first = leave(step, tilts.front(), true);
    for (std::size_t t = 0; !first && t < tilts.size(); ++t) first = leave(step, tilts[t], false);
    return first;
  });
}

std::optional<Ruling> PolePassage::leave_chord() {
  return leave(longest_turn, [&](double step) { return leave_to(at_jump(step), step); });
}

/// The first that succeeds of turns of several sizes, the largest first.
std::optional<Ruling> PolePassage::leave(
    double largest, const std::function<std::optional<Ruling>(double)>& by_step) {
  const CurveTangent came = point_.tangent;
  double step = largest;
  for (int k = 0; k < turn_count; ++k, step *= turn_factor) {
    if (const std::optional<Ruling> first = by_step(step)) return first;
  }
  point_.tangent = came;
  return std::nullopt;
}

std::optional<Ruling> PolePassage::leave(double step, double tilt, bool climbs) {
  return leave_to(stepped_aside(step, tilt, climbs), step);
}

/// To a support of contacts about these, in a direction turned by the step along the curve. Where
/// there is none the point stays, without a tangent.
std::optional<Ruling> PolePassage::leave_to(const std::optional<CommonSupport>& about,
                                            double step) {
  const CommonSupport start = point_.at;
  const std::optional<CommonSupport> beside = about ? corrected_aside(*about, step) : std::nullopt;
  if (!beside) return std::nullopt;
  point_.at = *beside;
  point_.tangent = CurveTangent();
  CommonSupport first = start;
  bool leads = point_.settle();
  for (std::size_t i = 0; i < 2 && leads; ++i) {
    const std::optional<Contact> c = in_element(geometry_, start.contact[i], point_.at.contact[i]);
    leads = c.has_value();
    if (c) first.contact[i] = *c;
  }
  if (!leads) {
    point_.at = start;
    return std::nullopt;
  }
  first.evaluate(geometry_);
  return first.ruling();
}

/// The contact of the branch that contact i moves on in a direction beside: what supports where the
/// direction is tilted into its region, if that is near; else where a climb leads. If it does not
/// climb to n, as it is in the direction tilted so, off the place where the element is flat.
std::optional<Contact> PolePassage::aside(int i, double tilt, const dvec3& n, bool climbs) const {
  const Contact& own = point_.at.contact[std::size_t(i)];
  const dvec3 inward = (i == 0 ? 1.0 : -1.0) * unit(point_.at.d());
  const dvec3 turned = glm::normalize(n + tilt * inward);
  const Support top = point_.query()(turned, own);
  if (glm::distance(top.point, point_.at.jet[std::size_t(i)].x) <
      near_share * glm::length(point_.at.d())) {
    const Contact rest = at_rest(geometry_, top.contact, turned);
    if (!climbs) return rest;
    if (const std::optional<Contact> c = climbed(geometry_, rest, n)) return c;
  }
  return pole_side(geometry_, own) ? beside_pole(geometry_, own, n) : climbed(geometry_, own, n);
}

/// The direction in which curves leave.
dvec3 PolePassage::turn_ahead() const { return unit(glm::cross(point_.at.n, point_.at.d())); }

/// The two contacts' branches where n has turned by a step along the curve.
std::optional<CommonSupport> PolePassage::stepped_aside(double step, double tilt,
                                                        bool climbs) const {
  CommonSupport next = point_.at;
  next.n = glm::normalize(point_.at.n + step * turn_ahead());
  for (std::size_t i = 0; i < 2; ++i) {
    const std::optional<Contact> c = aside(int(i), tilt * step, next.n, climbs);
    if (!c) return std::nullopt;
    next.contact[i] = *c;
  }
  next.evaluate(geometry_);
  return next;
}

/// What supports on either side of where, n having turned by a step along the curve and tilting
/// from the one contact to the other, the support jumps; if that is from the one to the other.
std::optional<CommonSupport> PolePassage::at_jump(double step) const {
  const dvec3 d = point_.at.d();
  const dvec3 ahead = point_.at.n + step * turn_ahead();
  double low = -jump_tilt * step;
  double high = -low;
  CommonSupport next = point_.at;
  std::array<dvec3, 2> x = {point_.at.jet[0].x, point_.at.jet[1].x};
  for (int k = 0; k < jump_halvings; ++k) {
    const double tilt = 0.5 * (low + high);
    next.n = glm::normalize(ahead + tilt * unit(d));
    const Support top = point_.query()(next.n, next.contact[0]);
    const bool is_first =
        glm::dot(2.0 * top.point - point_.at.jet[0].x - point_.at.jet[1].x, d) > 0;
    const std::size_t i = is_first ? 0 : 1;
    (is_first ? high : low) = tilt;
    next.contact[i] = at_rest(geometry_, top.contact, next.n);
    x[i] = geometry_.point(next.contact[i]);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (glm::distance(x[i], point_.at.jet[i].x) > near_share * glm::length(d)) return std::nullopt;
  }
  next.evaluate(geometry_);
  return next;
}

/// The common support of two contacts' branches, where n has turned by a step along the curve.
std::optional<CommonSupport> PolePassage::corrected_aside(CommonSupport next, double step) const {
  const dvec3 along = turn_ahead();
  const auto corrected = [&] {
    return system_.solve(next, [&](const CommonSupport& now) {
      LinearEquation e;
      e.residual = glm::dot(now.n - point_.at.n, along) - step;
      e.n = along;
      return e;
    });
  };
  // Twice, since near a pole parameters are less exact than points.
  if (!corrected() || !corrected()) return std::nullopt;
  bool moved = false;
  for (std::size_t i = 0; i < 2; ++i) {
    Contact& own = next.contact[i];
    const Contact inside{own.instance, own.kind, own.element, std::clamp(own.u, 0.0, 1.0),
                         std::clamp(own.v, 0.0, 1.0)};
    if (inside.u == own.u && inside.v == own.v) continue;
    // Beyond the border of its element.
    const std::optional<Contact> c = climbed(geometry_, inside, next.n);
    if (!c) return std::nullopt;
    own = *c;
    moved = true;
  }
  next.evaluate(geometry_);
  if ((moved && !corrected()) || point_.query()(next.n, next.contact[0]).h >
                                     glm::dot(next.jet[0].x, next.n) + geometry_.tie()) {
    return std::nullopt;
  }
  return next;
}

/// The straight side of the landmark that the two contacts are nearest to, arriving across it.
std::optional<std::size_t> PolePassage::nearest_side(const FacetContacts& facet) const {
  std::optional<std::size_t> best;
  double least = 0;
  const std::size_t count = facet.points.size();
  for (std::size_t k = 0; k < count; ++k) {
    if (facet.is_curved(k)) continue;
    const double off = glm::distance(facet.points[k], point_.at.jet[1].x) +
                       glm::distance(facet.points[(k + 1) % count], point_.at.jet[0].x);
    if (best && off >= least) continue;
    best = k;
    least = off;
  }
  return best;
}

std::optional<Ruling> PolePassage::arrival(const Landmark& landmark, double length) const {
  if (glm::distance(landmark.n, point_.at.n) > 1.5 * length) return std::nullopt;
  const FacetContacts& facet = landmark.facet;
  const std::optional<std::size_t> side = nearest_side(facet);
  if (!side) return std::nullopt;
  CommonSupport end = point_.at;
  end.n = landmark.n;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t corner = (*side + 1 - i) % facet.points.size();
    std::optional<Contact> there =
        in_element(geometry_, facet.contacts[corner], point_.at.contact[i]);
    if (!there) there = climbed(geometry_, point_.at.contact[i], landmark.n);
    if (!there || !same_element(*there, point_.at.contact[i]) ||
        glm::distance(geometry_.point(*there), facet.points[corner]) > same_contact) {
      return std::nullopt;
    }
    end.contact[i] = *there;
  }
  end.evaluate(geometry_);
  const double ahead = point_.length_to(end);
  if (ahead <= margin_slack || ahead > length + margin_slack ||
      point_.distance_to(end) > (1 + correction_limit) * ahead) {
    return std::nullopt;
  }
  return end.ruling();
}

/// In one direction the patch has no curvature at its corner.
bool PolePassage::is_flat_corner(const Contact& c) const {
  const dvec3 n = unit_normal(geometry_, c);
  if (n == dvec3(0.0)) return false;
  const ContactJet j = geometry_.jet(c);
  return is_flat(j, n, least_curvature) && !is_flat(j, n, -least_curvature);
}

/// The corner in which its patch is plane for which the contact heads, in reach of a step of this
/// length.
std::optional<Contact> PolePassage::plane_corner_ahead(int i, double length) const {
  const dvec3& from = point_.at.jet[std::size_t(i)].x;
  const dvec3& rate = point_.tangent.x[std::size_t(i)];
  for (const Contact& corner : corners_of(point_.at.contact[std::size_t(i)])) {
    const dvec3 way = geometry_.point(corner) - from;
    const double distance = glm::length(way);
    if (distance == 0 || distance > plane_corner_reach * length ||
        glm::dot(way, rate) < plane_corner_cosine * distance * glm::length(rate)) {
      continue;
    }
    if (is_plane_corner(geometry_, corner)) return corner;
  }
  return std::nullopt;
}

/// The contact where the tangent leads it, within a step of this length, to the end of an edge or
/// to a side of its patch.
std::optional<Contact> PolePassage::end_ahead(int i, double length) const {
  Contact c = point_.at.contact[std::size_t(i)];
  const dvec2 rate = point_.tangent.parameter[std::size_t(i)];
  if (c.kind == SourceKind::edge) {
    // The tangent near such an end tells no more than that it is near by.
    const double end = rate.x > 0 ? 1 : 0;
    if (c.u == end) return std::nullopt;
    c.u = end;
    return c;
  }
  if (c.kind == SourceKind::vertex) {
    // Edges' ends are reached from vertices step by step.
    if (point_.at.contact[std::size_t(1 - i)].kind != SourceKind::face) return std::nullopt;
    return c;
  }
  if (const std::optional<Contact> corner = plane_corner_ahead(i, length)) return corner;
  const dvec2 border(rate.x > 0 ? 1 : 0, rate.y > 0 ? 1 : 0);
  const dvec2 way = (border - parameters(c)) / rate;
  const int across = way.x < way.y ? 0 : 1;
  if (!(way[across] > 0 && way[across] <= length)) return std::nullopt;
  const Contact corner{c.instance, c.kind, c.element, border.x, border.y};
  const double share = is_flat_corner(corner) ? flat_corner_share : corner_share;
  if (way[1 - across] < share * way[across]) return corner;
  const dvec2 there = parameters(c) + way[across] * rate;
  c.u = std::clamp(across == 0 ? border.x : there.x, 0.0, 1.0);
  c.v = std::clamp(across == 1 ? border.y : there.y, 0.0, 1.0);
  return c;
}

/// The place on the side on which the curve crosses it, were the patch to go on beyond as it is:
/// there is a solution there with the direction turning back.
bool PolePassage::cross_side(int i, Contact& c, double length) const {
  if (is_corner(c)) return true;
  const auto k = std::size_t(i);
  const CommonSupport& from = point_.at;
  const std::optional<CommonSupport> to = point_.stepped(length);
  const std::optional<CurveTangent> back = to ? system_.tangent(*to, nullptr) : std::nullopt;
  if (!back) return false;
  const int across = c.u == 0 || c.u == 1 ? 0 : 1;
  const dvec2 p0 = parameters(from.contact[k]);
  const dvec2 p1 = parameters(to->contact[k]);
  const double border = parameters(c)[across];
  const double chord = p1[across] - p0[across];
  const double s = (border - p0[across]) / chord;
  if (!(s > 0 && s < 1)) return false;
  const auto slope = [&](const CurveTangent& t) {
    return chord * t.parameter[k][1 - across] / t.parameter[k][across];
  };
  const double along =
      cubic(p0[1 - across], slope(point_.tangent), p1[1 - across], slope(*back), s);
  if (!(along >= 0 && along <= 1)) return false;
  (across == 0 ? c.v : c.u) = along;
  return true;
}

/// In the direction the contact's element is flat at the end, in the corner or across the side on
/// which it lies.
bool PolePassage::is_flat_end(const Contact& c, const ContactJet& jet, const dvec3& n) const {
  if (c.kind == SourceKind::edge) {
    return ends_straight(geometry_, c) &&
           std::abs(glm::dot(unit(jet.dx[0]), n)) <= geometry_.rounding();
  }
  if (c.kind == SourceKind::vertex || (is_corner(c) && is_flat_corner(c))) return true;
  return std::any_of(all_sides.begin(), all_sides.end(),
                     [&](Side side) { return is_level_across(geometry_, c, side, n); });
}

/// The direction in which both may support: a patch's normal, or across two edges of which one may
/// leave its end along the ruling.
dvec3 PolePassage::common_normal(const CommonSupport& end) const {
  for (std::size_t i = 0; i < 2; ++i) {
    if (end.contact[i].kind != SourceKind::face) continue;
    return unit_normal(geometry_, end.contact[i]);
  }
  const dvec3 first = glm::cross(unit(end.jet[0].dx[0]), end.d());
  const dvec3 second = glm::cross(unit(end.jet[1].dx[0]), end.d());
  return unit(glm::length(first) > glm::length(second) ? first : second);
}

/// The side on which the contact of a face lies, no corner, if the patch is level across it.
std::optional<Side> PolePassage::level_side(const Contact& c) const {
  if (c.kind != SourceKind::face || is_corner(c)) return std::nullopt;
  const dvec3 n = unit_normal(geometry_, c);
  const auto side = std::find_if(all_sides.begin(), all_sides.end(),
                                 [&](Side own) { return is_level_across(geometry_, c, own, n); });
  return side == all_sides.end() ? std::nullopt : std::optional(*side);
}

/// The support of two contacts on sides, `end` near by, of which the one stops to be inside of its
/// patch (swell_end): the other one is highest on its side in the same direction.
std::optional<CommonSupport> PolePassage::at_swell_end(const CommonSupport& end,
                                                       double length) const {
  std::optional<CommonSupport> nearest;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::optional<Side> side = level_side(end.contact[i]);
    if (!side || !level_side(end.contact[1 - i])) return std::nullopt;
    const std::optional<Contact> last = swell_end(geometry_, end.contact[i], *side, point_.at.n);
    if (!last) continue;
    CommonSupport s = end;
    s.contact[i] = *last;
    s.n = aligned(unit_normal(geometry_, *last), point_.at.n);
    Contact& other = s.contact[1 - i];
    for (int k = 0; k < most_slides; ++k) other = highest_along(geometry_, other, s.n);
    s.evaluate(geometry_);
    const double ahead = point_.length_to(s);
    if (!(ahead > margin_slack && ahead <= length)) continue;
    if (!nearest || ahead < point_.length_to(*nearest)) nearest = s;
  }
  return nearest;
}

std::optional<CommonSupport> PolePassage::at_flat_ends(double length) const {
  CommonSupport end = point_.at;
  for (int i = 0; i < 2; ++i) {
    const std::optional<Contact> there = end_ahead(i, length);
    if (!there) return std::nullopt;
    end.contact[std::size_t(i)] = *there;
  }
  end.evaluate(geometry_);
  if (glm::length(end.d()) < join_distance) return std::nullopt;
  if (const std::optional<CommonSupport> last = at_swell_end(end, length)) {
    return is_tangent(*last) ? last : std::nullopt;
  }
  const double ahead = point_.length_to(end);
  const double reach = in_plane_corner(end) ? plane_corner_reach * length : length;
  if (ahead <= margin_slack || ahead > reach) return std::nullopt;
  end.n = aligned(common_normal(end), point_.at.n);
  for (std::size_t i = 0; i < 2; ++i) {
    if (!is_flat_end(end.contact[i], end.jet[i], end.n)) return std::nullopt;
  }
  for (int i = 0; i < 2; ++i) {
    Contact& c = end.contact[std::size_t(i)];
    if (c.kind == SourceKind::face && !cross_side(i, c, 2 * ahead)) return std::nullopt;
  }
  end.evaluate(geometry_);
  return is_tangent(end) ? std::optional(end) : std::nullopt;
}

bool PolePassage::in_plane_corner(const CommonSupport& s) const {
  return std::any_of(s.contact.begin(), s.contact.begin() + 2, [&](const Contact& c) {
    return c.kind == SourceKind::face && is_corner(c) && is_plane_corner(geometry_, c);
  });
}

/// The plane holds both contacts, supports, and the rulings that lead there are found.
bool PolePassage::is_tangent(const CommonSupport& end) const {
  return std::abs(glm::dot(end.d(), end.n)) <= geometry_.tie() && point_.supports(end) &&
         point_.is_followed(point_.at.ruling(), end.ruling());
}

/// The point of a contact at ends of its element beyond those for which it heads; a vertex itself.
std::optional<Contact> PolePassage::over_ends(int i) const {
  const auto k = std::size_t(i);
  CommonSupport s = point_.at;
  if (s.contact[k].kind == SourceKind::vertex) return s.contact[k];
  bool is_over = false;
  for (int step = 0; step < most_ends; ++step) {
    const Contact c = s.contact[k];
    const dvec2 rate = parameter_change(s.jet[k], point_.tangent.x[k]);
    const std::vector<ContactExit> all = exits(geometry_, c);
    const auto exit = std::find_if(all.begin(), all.end(), [&](const ContactExit& e) {
      return leads_over_border(e) && stands_at(c, e) &&
             glm::dot(exit_margin(geometry_, s, i, e).parameter[k], rate) < 0;
    });
    if (exit == all.end()) return is_over ? std::optional(c) : std::nullopt;
    const std::optional<Contact> over = beyond(geometry_, c, *exit);
    if (!over || over->kind != c.kind) return std::nullopt;
    s.contact[k] = *over;
    s.evaluate(geometry_);
    is_over = true;
  }
  return std::nullopt;
}

std::optional<Ruling> PolePassage::go_on() {
  const CommonSupport end = point_.at;
  const CurveTangent came = point_.tangent;
  for (int i = 0; i < 2; ++i) {
    const std::optional<Contact> over = over_ends(i);
    if (!over) {
      point_.at = end;
      return std::nullopt;
    }
    point_.at.contact[std::size_t(i)] = *over;
  }
  point_.at.evaluate(geometry_);
  const CommonSupport start = point_.at;
  // In the elements, and n stands still.
  CurveTangent ahead;
  double square = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const ContactJet& j = start.jet[i];
    const dvec2 p = parameter_change(j, came.x[i]);
    ahead.parameter[i] = p;
    ahead.x[i] = p.x * j.dx[0] + p.y * j.dx[1];
    square += glm::dot(ahead.x[i], ahead.x[i]);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    ahead.parameter[i] /= std::sqrt(square);
    ahead.x[i] /= std::sqrt(square);
  }
  double length = longest_way;
  for (int k = 0; k < way_count; ++k, length *= turn_factor) {
    point_.at = start;
    point_.tangent = ahead;
    const std::optional<CommonSupport> next = point_.stepped(length);
    if (!next || !is_inside(next->contact[0]) || !is_inside(next->contact[1]) ||
        !point_.supports(*next) || point_.distance_to(*next) > (1 + correction_limit) * length) {
      continue;
    }
    point_.at = *next;
    if (point_.settle()) return start.ruling();
  }
  point_.at = end;
  point_.tangent = came;
  return std::nullopt;
}

}  // namespace taut
