#include "taut/hull/arc_tracer.h"

#include <algorithm>
#include <cmath>

#include "taut/core/tolerances.h"
#include "taut/hull/contact_bends.h"
#include "taut/hull/contact_exits.h"
#include "taut/hull/facet_contacts.h"
#include "taut/hull/free_ends.h"
#include "taut/hull/rulings_between.h"

namespace taut {
namespace {

/// Lengths are in (n, x_0, x_1), in the scene's frame, whose size is about one.
constexpr double first_step = 0.02;
constexpr double longest_step = 0.12;
constexpr double shortest_step = 1e-11;
/// Steps longer than this are halved where a border is crossed in a place that is not found; what a
/// shorter one crosses is rounding.
constexpr double border_step = 1e-7;
/// A step is halved where the tangent turns by more than the one cosine tells, and the next one
/// grows where it turns by less than the other.
constexpr double turn_limit = 0.97;
constexpr double turn_small = 0.995;
constexpr double growth = 1.6;
/// A plane may lie behind the last ruling by this much: a third contact that surpasses the two by
/// less than geometry_.tie() went unseen.
constexpr double plane_slack = 1e-6;
/// How far the corrector may move the prediction, as a share of the step.
constexpr double correction_limit = 0.15;
/// Margins below this are crossed; or below what the rounding of coordinates does to them, but for
/// places where that is more than a limit, or many times the rounding: beside poles.
constexpr double margin_slack = 1e-12;
constexpr double margin_slack_limit = 1e-9;
constexpr double margin_noise_limit = 300;
/// Turns of n that are tried as the first step away from where contacts are singular.
constexpr std::array<double, 3> leaving_steps = {1e-3, 1e-4, 1e-5};
/// Share of such a turn by which contacts are told apart.
constexpr double share_inward = 0.1;
/// Normal curvature, in the scene's frame, below which a contact is taken for flat.
constexpr double least_curvature = 1e-8;
/// A contact that is no farther from a border, and moves to or from it no faster, moves along it.
constexpr double border_slack = 1e-9;
/// Pieces shorter than this are none.
constexpr double shortest_piece = 1e-7;
/// How far contacts may leave their elements by rounding; or by that of coordinates, of a ruling
/// and of its neighbours.
constexpr double parameter_slack = 1e-9;
constexpr int step_limit = 4000;
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
/// Where rulings are looked for between the last one and a free end.
constexpr std::array<double, 5> merging_shares = {0.1, 0.3, 0.5, 0.7, 0.9};
/// Steps below this share of the distance between two contacts are stuck.
constexpr double stuck_share = 0.01;
/// Contacts nearer than this that do not merge are lost.
constexpr double least_distance = 2e-4;
/// The same of two that are about a pole: no farther from it than so many times their distance.
constexpr double least_distance_at_pole = 1e-6;
constexpr double about_pole = 8;
/// Changes of elements without progress after which the curve is lost.
constexpr int idle_limit = 12;

dvec2 parameters(const Contact& c) { return {c.u, c.v}; }

struct Event {
  double length = 0;  ///< along the step's tangent
  int contact = 0;
  ContactExit exit;
  CommonSupport support;
  double after = 0;  ///< the margin at the step's end, negative
};

class Trace {
 public:
  Trace(const ContactSystem& system, SupportQuery& query, const CommonSupport& start,
        std::span<const Landmark> landmarks)
      : system_(system),
        geometry_(system.geometry()),
        query_(query),
        landmarks_(landmarks),
        at_(start) {}

  TracedArc run(const Progress& progress, bool aside);

 private:
  enum class Pace { on, ended };

  /// A corrected step of this length along the tangent.
  std::optional<CommonSupport> stepped(double length) const;
  CommonSupport predicted(double length) const;
  double length_to(const CommonSupport& s) const {
    return length_along(s.n, s.jet[0].x, s.jet[1].x);
  }
  double length_along(const dvec3& n, const dvec3& x0, const dvec3& x1) const {
    return glm::dot(n - at_.n, tangent_.n) + glm::dot(x0 - at_.jet[0].x, tangent_.x[0]) +
           glm::dot(x1 - at_.jet[1].x, tangent_.x[1]);
  }
  double distance_to(const CommonSupport& s) const {
    return std::sqrt(square(s.n - at_.n) + square(s.jet[0].x - at_.jet[0].x) +
                     square(s.jet[1].x - at_.jet[1].x));
  }
  static double square(const dvec3& x) { return glm::dot(x, x); }

  std::optional<Event> first_event(const CommonSupport& next, double length, bool& known) const;
  std::optional<Event> solved_event(const CommonSupport& next, double share, int contact,
                                    const ContactExit& exit) const;
  double margin(const CommonSupport& s, int contact, const ContactExit& exit) const {
    return exit_margin(geometry_, s, contact, exit).residual;
  }
  Event event_here(int contact, const ContactExit& exit) const;
  bool precedes(const Event& a, const Event& b) const;
  double slack(int contact, const ContactExit& exit) const;
  double border_distance() const { return std::max(parameter_slack, 2 * geometry_.rounding()); }
  /// A contact that the step takes across a pole, or -1, and the side.
  std::pair<int, Side> pole_crossed(const CommonSupport& next) const;
  bool pass_pole(int contact, Side side, double length);
  bool is_singular(int contact) const;
  bool leave();
  bool leave(double step);
  std::optional<CommonSupport> stepped_aside(double step);
  std::optional<Contact> aside(int i, double step, const dvec3& n);
  std::optional<std::size_t> nearest_side(const FacetContacts& facet) const;
  bool arrives(const Landmark& landmark, double length);
  bool is_closing(const CommonSupport& next, double length) const;
  void close();
  std::optional<FreeEnd> exact_end(const Ruling& near);
  bool is_ahead(const FreeEnd& end, double length) const;
  struct Approach;
  Approach approach() const;
  std::optional<FreeEnd> end_ahead(const Approach& a);
  std::optional<Event> event_before(const FreeEnd& end);
  CommonSupport near_end(const FreeEnd& end, double length) const;
  bool end_beyond(const FreeEnd& end);
  bool solve_event(Event& event, double length);
  bool supports(const CommonSupport& s);
  void put_on_border(Event& event) const;
  void find_exits();
  bool merge_at_pole();
  bool runs_into(const dvec3& pole);
  bool is_about_pole() const;
  bool crosses();
  bool merge();
  bool ends_merged();
  bool is_followed(Ruling from, const Ruling& to);
  std::optional<Pace> near_merging();
  Pace surpassed(const CommonSupport& next, const Contact& winner);
  Pace exchange(const Event& event);
  Pace advance();
  bool settle();
  void begin_piece();
  bool is_sound() const;
  void push(const CommonSupport& s) { arc_.pieces.back().rulings.push_back(s.ruling()); }

  Pace ended(TracedArc::End end) {
    arc_.end = end;
    return Pace::ended;
  }
  Pace merged() {
    return ended(arc_.contacts.empty() ? TracedArc::End::merged : TracedArc::End::crossed);
  }
  Pace lost(const char* reason) {
    arc_.reason = reason;
    return ended(TracedArc::End::lost);
  }
  /// Halves the step, unless that is of no use any more.
  Pace shorter(const char* reason) {
    step_ *= 0.5;
    return step_ < shortest_step ? lost(reason) : Pace::on;
  }

  const ContactSystem& system_;
  const ContactGeometry& geometry_;
  SupportQuery& query_;
  std::span<const Landmark> landmarks_;
  /// The first ruling inside a piece, at which the curve closes if it does.
  std::optional<CommonSupport> home_;
  std::size_t home_piece_ = 0;
  std::size_t home_ruling_ = 0;
  CommonSupport at_;
  CurveTangent tangent_;
  std::array<std::vector<ContactExit>, 2> exits_;
  double step_ = first_step;
  int idle_ = 0;
  bool lenient_ = false;  ///< borders that this piece crosses in places not found are rounding
  TracedArc arc_;
};

CommonSupport Trace::predicted(double length) const {
  CommonSupport s = at_;
  s.n = glm::normalize(s.n + length * tangent_.n);
  for (std::size_t i = 0; i < 2; ++i) {
    s.contact[i].u += length * tangent_.parameter[i].x;
    s.contact[i].v += length * tangent_.parameter[i].y;
  }
  s.evaluate(geometry_);
  return s;
}

std::optional<CommonSupport> Trace::stepped(double length) const {
  CommonSupport s = predicted(length);
  const bool solved = system_.solve(s, [&](const CommonSupport& now) {
    LinearEquation e;
    e.residual = length_to(now) - length;
    e.n = tangent_.n;
    for (int i = 0; i < 2; ++i) e.add_point(now, i, tangent_.x[std::size_t(i)]);
    return e;
  });
  if (!solved) return std::nullopt;
  return s;
}

/// The event's contacts in their elements, the one at its exit exactly.
void Trace::put_on_border(Event& event) const {
  CommonSupport& s = event.support;
  Contact& own = s.contact[std::size_t(event.contact)];
  own = at_exit(own, event.exit);
  for (std::size_t i = 0; i < 2; ++i) {
    s.contact[i].u = std::clamp(s.contact[i].u, 0.0, 1.0);
    s.contact[i].v = std::clamp(s.contact[i].v, 0.0, 1.0);
  }
  s.evaluate(geometry_);
}

std::optional<Event> Trace::solved_event(const CommonSupport& next, double share, int contact,
                                         const ContactExit& exit) const {
  Event event;
  event.contact = contact;
  event.exit = exit;
  CommonSupport& s = event.support;
  s = at_;
  s.n = glm::normalize((1 - share) * at_.n + share * next.n);
  for (std::size_t i = 0; i < 2; ++i) {
    s.contact[i].u += share * (next.contact[i].u - at_.contact[i].u);
    s.contact[i].v += share * (next.contact[i].v - at_.contact[i].v);
  }
  s.evaluate(geometry_);
  const bool solved = system_.solve(
      s, [&](const CommonSupport& now) { return exit_margin(geometry_, now, contact, exit); });
  if (!solved) return std::nullopt;
  put_on_border(event);
  event.length = length_to(s);
  return event;
}

/// Of exits in one place those at the ends of elements come first: beyond them slopes tell nothing.
/// Of a contact's others the one that it passes farthest.
bool Trace::precedes(const Event& a, const Event& b) const {
  const auto at_end = [](const Event& e) {
    return e.exit.kind == ContactExit::Kind::side || e.exit.kind == ContactExit::Kind::end;
  };
  const bool one_place =
      std::abs(a.length - b.length) <= std::max(slack(a.contact, a.exit), slack(b.contact, b.exit));
  if (!one_place || (a.contact != b.contact && at_end(a) == at_end(b))) return a.length < b.length;
  return at_end(a) != at_end(b) ? at_end(a) : a.after < b.after;
}

/// The exit as one at which the contact stands.
Event Trace::event_here(int contact, const ContactExit& exit) const {
  Event event;
  event.contact = contact;
  event.exit = exit;
  event.support = at_;
  put_on_border(event);
  return event;
}

/// The first margin on the way to `next` that is crossed there. Not `known` if it is not found
/// where.
std::optional<Event> Trace::first_event(const CommonSupport& next, double length,
                                        bool& known) const {
  known = true;
  std::optional<Event> first;
  for (int i = 0; i < 2; ++i) {
    for (const ContactExit& exit : exits_[std::size_t(i)]) {
      const double after = margin(next, i, exit);
      if (after >= -slack(i, exit)) continue;
      const double before = std::max(margin(at_, i, exit), 0.0);
      const double share = before / (before - after);
      std::optional<Event> event = solved_event(next, share, i, exit);
      // At the exit but for rounding, which may put it far behind.
      if (before <= slack(i, exit) && (!event || event->length < -border_step))
        event = event_here(i, exit);
      if (!event || event->length > length + slack(i, exit)) {
        known = false;
        continue;
      }
      event->after = after;
      if (!first || precedes(*event, *first)) first = event;
    }
  }
  return first;
}

/// How far below zero a contact's margin may be for rounding.
double Trace::slack(int contact, const ContactExit& exit) const {
  const double size =
      std::min(1.0, exit_length(geometry_, at_.contact[std::size_t(contact)], exit));
  const double limit = std::max(margin_slack_limit, margin_noise_limit * geometry_.rounding());
  if (geometry_.rounding() >= limit * size) return limit;
  return std::max(margin_slack, geometry_.rounding() / size);
}

std::pair<int, Side> Trace::pole_crossed(const CommonSupport& next) const {
  for (int i = 0; i < 2; ++i) {
    for (const ContactExit& exit : exits_[std::size_t(i)]) {
      if (exit.kind != ContactExit::Kind::side) continue;
      const Side side = all_sides[std::size_t(exit.index)];
      if (is_pole(geometry_, next.contact[std::size_t(i)], side) && margin(next, i, exit) < 0) {
        return {i, side};
      }
    }
  }
  return {-1, Side::u0};
}

/// A contact at the pole of its side, at the same parameter along the side.
Contact at_pole(Contact c, Side side) {
  (along_v(side) ? c.u : c.v) = at_upper_end(side) ? 1 : 0;
  return c;
}

/// Goes to a pole, where the patch's parameters fail, if the curve does so to within
/// geometry_.tie(), and on beyond it.
bool Trace::pass_pole(int contact, Side side, double length) {
  const auto i = std::size_t(contact);
  const std::size_t other = 1 - i;
  CommonSupport pole = at_;
  pole.contact[i] = at_pole(at_.contact[i], side);
  pole.n = unit_normal(geometry_, pole.contact[i]);
  if (glm::dot(pole.n, at_.n) < 0) pole.n = -pole.n;
  const std::optional<Contact> c = climbed(geometry_, at_.contact[other], pole.n);
  if (!c || !same_element(*c, at_.contact[other])) return false;
  pole.contact[other] = *c;
  // At another pole its parameter along the side is as it was, not where the climb came from.
  if (const std::optional<Side> at = pole_side(geometry_, *c)) {
    pole.contact[other] = at_pole(at_.contact[other], *at);
  }
  pole.evaluate(geometry_);
  const double ahead = length_to(pole);
  if (std::abs(glm::dot(pole.d(), pole.n)) > geometry_.tie() || ahead < 0 || ahead > 2 * length ||
      query_(pole.n, pole.contact[i]).h > glm::dot(pole.jet[i].x, pole.n) + geometry_.tie()) {
    return false;
  }
  at_ = pole;
  push(at_);
  return leave();
}

/// The contact at the pole that its patch has at x, at the same parameter along the side; none if
/// it has none there.
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

/// The point of a contact as one of the element of `other`; a pole's at the parameter of `other`
/// along its side.
std::optional<Contact> in_element(const ContactGeometry& geometry, const Contact& c,
                                  const Contact& other) {
  if (!pole_side(geometry, c)) return expressed_in(geometry, c, other);
  return at_pole_of(geometry, other, geometry.point(c));
}

/// Whether a contact may move without the direction, or its parameters fail: at a pole, and where
/// its element is flat along some direction. The tangent does not tell how it goes on.
bool Trace::is_singular(int contact) const {
  const auto i = std::size_t(contact);
  return pole_side(geometry_, at_.contact[i]) || is_flat(at_.jet[i], at_.n, least_curvature);
}

/// The first step away from a common support of which contacts are singular, in a piece of its own.
bool Trace::leave() {
  const CommonSupport start = at_;
  for (const double step : leaving_steps) {
    at_ = start;
    if (leave(step)) return true;
  }
  at_ = start;
  return false;
}

bool Trace::leave(double step) {
  const CommonSupport start = at_;
  const std::optional<CommonSupport> beside = stepped_aside(step);
  if (!beside) return false;
  at_ = *beside;
  tangent_ = CurveTangent();
  if (!settle()) return false;
  const CommonSupport next = at_;
  at_ = start;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::optional<Contact> c = in_element(geometry_, start.contact[i], next.contact[i]);
    if (!c) return false;
    at_.contact[i] = *c;
  }
  at_.evaluate(geometry_);
  begin_piece();
  at_ = next;
  push(at_);
  return true;
}

/// The contact of the branch that contact i moves on in a direction beside: what supports where the
/// direction turns a little into its region, if that is near; else where a climb leads.
std::optional<Contact> Trace::aside(int i, double step, const dvec3& n) {
  const Contact& own = at_.contact[std::size_t(i)];
  const dvec3 inward = (i == 0 ? 1.0 : -1.0) * unit(at_.d());
  const dvec3 tilted = glm::normalize(n + share_inward * step * inward);
  const Support top = query_(tilted, own);
  if (glm::distance(top.point, at_.jet[std::size_t(i)].x) < 0.25 * glm::length(at_.d())) {
    const std::optional<Contact> c = climbed(geometry_, at_rest(geometry_, top.contact, tilted), n);
    if (c) return c;
  }
  return pole_side(geometry_, own) ? beside_pole(geometry_, own, n) : climbed(geometry_, own, n);
}

/// The common support of the two contacts' branches where n has turned by a step along the curve.
std::optional<CommonSupport> Trace::stepped_aside(double step) {
  const dvec3 along = unit(glm::cross(at_.n, at_.d()));
  CommonSupport next = at_;
  next.n = glm::normalize(at_.n + step * along);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::optional<Contact> c = aside(int(i), step, next.n);
    if (!c) return std::nullopt;
    next.contact[i] = *c;
  }
  next.evaluate(geometry_);
  const auto corrected = [&] {
    return system_.solve(next, [&](const CommonSupport& now) {
      LinearEquation e;
      e.residual = glm::dot(now.n - at_.n, along) - step;
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
  if ((moved && !corrected()) ||
      query_(next.n, next.contact[0]).h > glm::dot(next.jet[0].x, next.n) + geometry_.tie()) {
    return std::nullopt;
  }
  return next;
}

/// The straight side of the landmark that the two contacts are nearest to, arriving across it.
std::optional<std::size_t> Trace::nearest_side(const FacetContacts& facet) const {
  std::optional<std::size_t> best;
  double least = 0;
  const std::size_t count = facet.points.size();
  for (std::size_t k = 0; k < count; ++k) {
    if (facet.is_curved(k)) continue;
    const double off = glm::distance(facet.points[k], at_.jet[1].x) +
                       glm::distance(facet.points[(k + 1) % count], at_.jet[0].x);
    if (best && off >= least) continue;
    best = k;
    least = off;
  }
  return best;
}

/// Ends the arc in a landmark that lies within the step.
bool Trace::arrives(const Landmark& landmark, double length) {
  if (glm::distance(landmark.n, at_.n) > 1.5 * length) return false;
  const FacetContacts& facet = landmark.facet;
  const std::optional<std::size_t> side = nearest_side(facet);
  if (!side) return false;
  CommonSupport end = at_;
  end.n = landmark.n;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t corner = (*side + 1 - i) % facet.points.size();
    std::optional<Contact> there = in_element(geometry_, facet.contacts[corner], at_.contact[i]);
    if (!there) there = climbed(geometry_, at_.contact[i], landmark.n);
    if (!there || !same_element(*there, at_.contact[i]) ||
        glm::distance(geometry_.point(*there), facet.points[corner]) > same_contact) {
      return false;
    }
    end.contact[i] = *there;
  }
  end.evaluate(geometry_);
  const double ahead = length_to(end);
  if (ahead <= margin_slack || ahead > length + margin_slack ||
      distance_to(end) > (1 + correction_limit) * ahead) {
    return false;
  }
  push(end);
  arc_.n = landmark.n;
  arc_.contacts = facet.contacts;
  return true;
}

bool Trace::is_closing(const CommonSupport& next, double length) const {
  if (!home_ || !same_element(home_->contact[0], at_.contact[0]) ||
      !same_element(home_->contact[1], at_.contact[1])) {
    return false;
  }
  const double ahead = length_to(*home_);
  if (ahead <= margin_slack || ahead > length_to(next) + margin_slack) return false;
  if (distance_to(*home_) > 1.5 * length) return false;
  const std::optional<CommonSupport> there = stepped(ahead);
  return there && glm::distance(there->n, home_->n) < same_contact &&
         glm::distance(there->jet[0].x, home_->jet[0].x) < same_contact &&
         glm::distance(there->jet[1].x, home_->jet[1].x) < same_contact;
}

/// Ends the arc at home, and drops what led there from the start.
void Trace::close() {
  push(*home_);
  auto& first = arc_.pieces[home_piece_].rulings;
  first.erase(first.begin(), first.begin() + std::ptrdiff_t(home_ruling_));
  arc_.pieces.erase(arc_.pieces.begin(), arc_.pieces.begin() + std::ptrdiff_t(home_piece_));
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
  return glm::dot(normal, near) < 0 ? -normal : normal;
}

/// Ends the arc where its contacts, of two surfaces or curves, meet in a common point.
bool Trace::crosses() {
  const std::optional<CommonSupport> end = system_.crossing(at_);
  if (!end || distance_to(*end) > 4 * glm::length(at_.d())) return false;
  for (std::size_t i = 0; i < 2; ++i) {
    const Contact& c = end->contact[i];
    if (std::min({c.u, 1 - c.u, c.v, 1 - c.v}) < -border_distance()) return false;
  }
  if (query_(end->n, end->contact[0]).h > glm::dot(end->jet[0].x, end->n) + geometry_.tie()) {
    return false;
  }
  push(*end);
  Ruling& last = arc_.pieces.back().rulings.back();
  for (Contact& c : last.contact) {
    c.u = std::clamp(c.u, 0.0, 1.0);
    c.v = std::clamp(c.v, 0.0, 1.0);
  }
  last.point[1] = last.point[0];
  arc_.n = end->n;
  arc_.contacts.assign(last.contact.begin(), last.contact.end());
  return true;
}

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

/// The free end near the ruling that supports the model.
std::optional<FreeEnd> Trace::exact_end(const Ruling& near) {
  const std::optional<FreeEnd> kind = kind_of_end(geometry_, near);
  const std::optional<FreeEnd> end = kind ? polished(geometry_, *kind) : std::nullopt;
  if (!end) return std::nullopt;
  const double height = glm::dot(geometry_.point(end->contact), end->n);
  return query_(end->n, near.contact[0]).h <= height + geometry_.tie() ? end : std::nullopt;
}

/// Ends the arc where both contacts run straight into one pole. Curvatures differ along the ways
/// out of it: its surface, to second order homogeneous about it, may touch a plane twice however
/// near to it.
bool Trace::merge_at_pole() {
  if (at_.contact[0].kind != SourceKind::face) return false;
  for (const Side side : all_sides) {
    if (is_pole(geometry_, at_.contact[0], side) &&
        runs_into(geometry_.point(at_pole(at_.contact[0], side)))) {
      return true;
    }
  }
  return false;
}

/// Whether both contacts are near to one pole. The surface about it is homogeneous to second order,
/// and the contacts as far from each other as from the pole: they can be told apart down to where
/// heights are rounding.
bool Trace::is_about_pole() const {
  const Contact& c = at_.contact[0];
  if (c.kind != SourceKind::face) return false;
  return std::any_of(all_sides.begin(), all_sides.end(), [&](Side side) {
    if (!is_pole(geometry_, c, side)) return false;
    const dvec3 x = geometry_.point(at_pole(c, side));
    return std::max(glm::distance(at_.jet[0].x, x), glm::distance(at_.jet[1].x, x)) <
           about_pole * glm::length(at_.d());
  });
}

/// Ends the arc in the pole at x, if both contacts run there. On straight ways: their distance need
/// not be linear, being small where the curvatures hardly differ.
bool Trace::runs_into(const dvec3& x) {
  double approach = 0;
  double speed = 0;
  double reach = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    approach += glm::dot(x - at_.jet[i].x, tangent_.x[i]);
    speed += square(tangent_.x[i]);
    reach = std::max(reach, pole_share * glm::distance(at_.jet[i].x, x));
  }
  if (approach <= 0 || reach > pole_share * pole_reach) return false;
  const double ahead = approach / speed;
  Ruling end = at_.ruling();
  for (std::size_t i = 0; i < 2; ++i) {
    Contact& c = end.contact[i];
    c.u = std::clamp(c.u + ahead * tangent_.parameter[i].x, 0.0, 1.0);
    c.v = std::clamp(c.v + ahead * tangent_.parameter[i].y, 0.0, 1.0);
    const std::optional<Contact> pole = at_pole_of(geometry_, c, x);
    if (!pole || glm::distance(at_.jet[i].x + ahead * tangent_.x[i], x) > reach) return false;
    c = *pole;
  }
  if (end.contact[0].instance != end.contact[1].instance) return false;
  end.n = unit_normal(geometry_, end.contact[0]);
  if (glm::dot(end.n, at_.n) < 0) end.n = -end.n;
  if (glm::distance(end.n, at_.n + ahead * tangent_.n) > reach ||
      query_(end.n, end.contact[0]).h > glm::dot(x, end.n) + geometry_.tie()) {
    return false;
  }
  end.point = {x, x};
  arc_.pieces.back().rulings.push_back(end);
  return true;
}

/// Whether the contacts run into the free end, within this length.
bool Trace::is_ahead(const FreeEnd& end, double length) const {
  const dvec3 x = geometry_.point(end.contact);
  return length_along(end.n, x, x) > 0 && glm::distance(x, at_.jet[0].x) < length;
}

/// Where two contacts merge that approach each other, to first order.
struct Trace::Approach {
  Ruling end;
  double length = 0;    ///< of the ruling
  double rate = 0;      ///< of the length, along the tangent
  bool smooth = false;  ///< they run on one smooth curve or surface
  bool one_element = false;

  /// f(0) = f - linear() f' for a function f of the length.
  double linear() const { return length / rate; }
};

/// As functions of their distance, the contacts' parameters and n are smooth at a free end. Where
/// both run on one smooth curve or surface, n and, if they are in one element, the parameters' mean
/// are smooth functions of its square.
Trace::Approach Trace::approach() const {
  Approach a;
  a.end = at_.ruling();
  const std::array<Contact, 2> c = a.end.contact;
  a.length = glm::length(at_.d());
  a.rate = glm::dot(tangent_.x[0] - tangent_.x[1], at_.d()) / a.length;
  a.smooth = continues(geometry_, c[0], c[1]);
  a.one_element = same_element(c[0], c[1]);
  // f(0) = f - length f' / 2 for a function of the square.
  const double squared = 0.5 * a.linear();
  a.end.n = at_.n - (a.smooth ? squared : a.linear()) * tangent_.n;
  const dvec2 mean = 0.5 * (parameters(c[0]) + parameters(c[1])) -
                     0.5 * squared * (tangent_.parameter[0] + tangent_.parameter[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    const dvec2 own = parameters(c[i]) - a.linear() * tangent_.parameter[i];
    const dvec2 there = a.one_element ? mean : own;
    a.end.contact[i].u = std::clamp(there.x, 0.0, 1.0);
    a.end.contact[i].v = std::clamp(there.y, 0.0, 1.0);
  }
  move_together(geometry_, a.end.contact[0], a.end.contact[1]);
  return a;
}

/// The free end into which the contacts run.
std::optional<FreeEnd> Trace::end_ahead(const Approach& a) {
  std::optional<FreeEnd> exact = exact_end(a.end);
  if (!exact && a.smooth && !a.one_element) {
    // Where a join makes the end, n is no smooth function of the square.
    Ruling straight = a.end;
    straight.n = at_.n - a.linear() * tangent_.n;
    exact = exact_end(straight);
  }
  if (exact && !is_ahead(*exact, 2 * std::abs(a.linear()))) exact.reset();
  return exact;
}

/// Ends the arc where the contacts merge, if they do.
bool Trace::merge() {
  if (merge_at_pole()) return true;
  Approach a = approach();
  Ruling& end = a.end;
  const double rho = a.length;
  if (!a.smooth &&
      !same_element(geometry_.canonical(end.contact[0]), geometry_.canonical(end.contact[1]))) {
    return crosses();
  }
  if (const std::optional<FreeEnd> exact = end_ahead(a)) {
    if (const std::optional<Ruling> ruling = ruling_at(geometry_, *exact, end)) {
      arc_.pieces.back().rulings.push_back(*ruling);
      return true;
    }
    // A contact changes its element before.
    if (end_beyond(*exact)) return true;
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
  const Support top = query_(end.n, at_.contact[0]);
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
  arc_.pieces.back().rulings.push_back(end);
  return true;
}

/// Rates of an element's parameters along a unit tangent in which it bends least. None where they
/// fail.
std::optional<dvec2> rate_along(const ContactGeometry& geometry, const Contact& c,
                                const dvec3& along) {
  if (c.kind == SourceKind::edge) {
    const dvec3 d = geometry.jet(c).dx[0];
    return dvec2(glm::dot(d, along) / glm::dot(d, d), 0);
  }
  const std::optional<SurfaceBend> b = surface_bend(geometry, c);
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
    if (!leads_over_border(exit)) continue;
    const Contact at = at_exit(c, exit);
    if (at.u != c.u || at.v != c.v) continue;
    const std::optional<Contact> over = beyond(geometry, at, exit);
    if (over && same_element(*over, other)) return exit;
  }
  return std::nullopt;
}

/// The next change of a contact into the element of the free end, over a smooth join. The contacts
/// are about as far from the end as each other, and as the end from the join then.
std::optional<Event> Trace::event_before(const FreeEnd& end) {
  std::optional<Event> event;
  double longest = 0;
  for (int i = 0; i < 2; ++i) {
    const auto k = std::size_t(i);
    const Contact& own = at_.contact[k];
    if (same_element(own, end.contact)) continue;
    const dvec3 apart = at_.jet[k].x - at_.jet[1 - k].x;
    const dvec3 along = glm::dot(apart, end.along) < 0 ? -end.along : end.along;
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
  if (!event || !solve_event(*event, 2 * longest)) return std::nullopt;
  return event;
}

/// Solves for the ruling of about this length with which a contact stands at its exit; from a start
/// near it.
bool Trace::solve_event(Event& event, double length) {
  CommonSupport& s = event.support;
  const bool solved = system_.settle(s, [&](const CommonSupport& now) {
    return exit_margin(geometry_, now, event.contact, event.exit);
  });
  if (!solved) return false;
  put_on_border(event);
  event.length = length_to(s);
  const double apart = glm::length(s.d());
  return event.length > margin_slack && apart > 0.5 * length && apart < 2 * length && supports(s);
}

/// About where the contacts have approached each other to this length, before the free end.
CommonSupport Trace::near_end(const FreeEnd& end, double length) const {
  const double apart = glm::length(at_.d());
  const double rate = glm::dot(tangent_.x[0] - tangent_.x[1], at_.d()) / apart;
  const double share = length / apart;
  CommonSupport s = at_;
  s.n = glm::normalize(end.n + share * share * (at_.n - end.n));
  for (std::size_t i = 0; i < 2; ++i) {
    Contact& c = s.contact[i];
    const dvec2 ahead = (length - apart) / rate * tangent_.parameter[i];
    c.u = std::clamp(c.u + ahead.x, 0.0, 1.0);
    c.v = std::clamp(c.v + ahead.y, 0.0, 1.0);
    if (!same_element(c, end.contact)) continue;
    const dvec3 side = at_.jet[i].x - at_.jet[1 - i].x;
    const std::optional<dvec2> along =
        rate_along(geometry_, end.contact, glm::dot(side, end.along) < 0 ? -end.along : end.along);
    if (!along) continue;
    c.u = std::clamp(end.contact.u + 0.5 * length * along->x, 0.0, 1.0);
    c.v = std::clamp(end.contact.v + 0.5 * length * along->y, 0.0, 1.0);
  }
  return s;
}

/// Goes to a free end in an element into which a contact changes over before; false if that is not
/// found.
bool Trace::end_beyond(const FreeEnd& end) {
  FreeEnd near = end;
  near.contact = snapped(geometry_, end.contact, shortest_piece);
  std::optional<Ruling> last = ruling_at(geometry_, near, at_.ruling());
  for (int k = 0; k < 2 && !last; ++k) {
    const std::optional<Event> event = event_before(end);
    if (!event || !is_followed(at_.ruling(), event->support.ruling())) return false;
    const auto i = std::size_t(event->contact);
    at_ = event->support;
    push(at_);
    const std::optional<Contact> over = expressed_in(geometry_, at_.contact[i], end.contact);
    if (!over) return false;
    at_.contact[i] = *over;
    at_.evaluate(geometry_);
    begin_piece();
    last = ruling_at(geometry_, end, at_.ruling());
  }
  if (last) arc_.pieces.back().rulings.push_back(*last);
  return last.has_value();
}

/// Ends the arc where the contacts merge, if the rulings on the way there are found.
bool Trace::ends_merged() {
  const CommonSupport at = at_;
  const std::size_t pieces = arc_.pieces.size();
  const std::size_t count = arc_.pieces.back().rulings.size();
  if (merge()) {
    const std::vector<Ruling>& rulings = arc_.pieces.back().rulings;
    if (is_followed(rulings[rulings.size() - 2], rulings.back())) return true;
  }
  at_ = at;
  arc_.pieces.resize(pieces);
  arc_.pieces.back().rulings.resize(count);
  arc_.contacts.clear();
  find_exits();
  return false;
}

/// Whether the rulings between two of them are found, in the same elements, and support the model.
bool Trace::is_followed(Ruling from, const Ruling& to) {
  for (std::size_t i = 0; i < 2; ++i) {
    from.contact[i] = turned_to(geometry_, from.contact[i], to.contact[i]);
  }
  const RulingsBetween between(system_, from, to);
  if (between.empty()) return true;
  // As lengths: about a pole parameters are less exact.
  const auto stays = [&](double t, const dvec3& dx) {
    return (std::abs(t - 0.5) - 0.5) * std::min(1.0, glm::length(dx)) <= border_distance();
  };
  const auto supports = [&](double s) {
    const std::optional<MovingRuling> m = between(s);
    if (!m) return false;
    const CommonSupport& at = m->at;
    for (std::size_t i = 0; i < 2; ++i) {
      const Contact& c = at.contact[i];
      if (!stays(c.u, at.jet[i].dx[0]) || !stays(c.v, at.jet[i].dx[1])) return false;
    }
    return query_(at.n, at.contact[0]).h <= glm::dot(at.jet[0].x, at.n) + geometry_.tie();
  };
  if (!between.merges()) return supports(0.5);
  return std::all_of(merging_shares.begin(), merging_shares.end(), supports);
}

/// Where a contact moves along an edge or a seam, it is told as one of that; along another smooth
/// join, as one of the patch into which its region extends. Sets the tangent anew; false if there
/// is none.
bool Trace::settle() {
  const CurveTangent* before = tangent_.n == dvec3(0.0) ? nullptr : &tangent_;
  const std::optional<CurveTangent> t = system_.tangent(at_, before);
  if (!t) return false;
  tangent_ = *t;
  bool changed = false;
  for (std::size_t i = 0; i < 2; ++i) {
    const Contact c = at_.contact[i];
    if (c.kind != SourceKind::face) continue;
    for (const ContactExit& exit : exits(geometry_, c)) {
      const LinearEquation e = exit_margin(geometry_, at_, int(i), exit);
      const double along = glm::dot(e.parameter[i], tangent_.parameter[i]);
      // As lengths: about a pole parameters are less exact.
      const Side side = all_sides[std::size_t(exit.index)];
      const double size = std::min(1.0, glm::length(at_.jet[i].dx[along_v(side) ? 0 : 1]));
      const double slack = std::max(border_slack, geometry_.rounding());
      if (std::max(std::abs(e.residual), std::abs(along)) * size > slack) continue;
      const std::optional<Contact> over = beyond(geometry_, c, exit);
      if (!over || over->kind == SourceKind::vertex) continue;
      if (over->kind == SourceKind::face) {
        // How the contact moves where the direction turns into its own region.
        const dvec3 inward = i == 0 ? at_.d() : -at_.d();
        const std::optional<dvec2> rate = parameter_rate(at_.jet[i], at_.n, inward);
        if (!rate || glm::dot(e.parameter[i], *rate) >= 0) continue;
      }
      at_.contact[i] = *over;
      changed = true;
      break;
    }
  }
  if (!changed) return true;
  at_.evaluate(geometry_);
  const std::optional<CurveTangent> again = system_.tangent(at_, before);
  if (again) tangent_ = *again;
  return again.has_value();
}

void Trace::begin_piece() {
  if (!arc_.pieces.empty() && arc_.pieces.back().rulings.size() < 2) arc_.pieces.pop_back();
  arc_.pieces.emplace_back();
  lenient_ = false;
  push(at_);
  find_exits();
}

void Trace::find_exits() {
  for (std::size_t i = 0; i < 2; ++i) exits_[i] = exits(geometry_, at_.contact[i]);
}

/// The two contacts support the model.
bool Trace::supports(const CommonSupport& s) {
  return query_(s.n, s.contact[0]).h <= glm::dot(s.jet[0].x, s.n) + geometry_.tie();
}

/// All numbers are finite: Newton's method may end in anything on surfaces without tangent planes.
bool Trace::is_sound() const {
  return std::all_of(arc_.pieces.begin(), arc_.pieces.end(), [](const ArcPiece& piece) {
    return std::all_of(piece.rulings.begin(), piece.rulings.end(), [](const Ruling& r) {
      return is_finite(r.n) && is_finite(r.point[0]) && is_finite(r.point[1]);
    });
  });
}

/// Where the step would take the two contacts into each other: shortens it, until they are so near
/// that they merge.
std::optional<Trace::Pace> Trace::near_merging() {
  const double apart = glm::length(at_.d());
  const double rate = glm::dot(tangent_.x[0] - tangent_.x[1], at_.d()) / apart;
  if (rate >= 0 || apart >= -2 * rate * step_) return std::nullopt;
  if (apart >= merging_distance(geometry_)) {
    step_ = -0.5 * apart / rate;
    return std::nullopt;
  }
  if (ends_merged()) return merged();
  const double least = is_about_pole() ? least_distance_at_pole : least_distance;
  if (apart < least) return lost("two contacts approach each other and do not merge");
  // A third contact may yet surpass them.
  step_ = -0.5 * apart / rate;
  return std::nullopt;
}

/// A contact surpasses the two at `next`: ends the arc in the plane of the three.
Trace::Pace Trace::surpassed(const CommonSupport& next, const Contact& winner) {
  std::optional<CommonSupport> plane = common_plane(system_, query_, next, winner);
  if (plane) {
    for (std::size_t i = 0; i < 2; ++i) {
      // In a pole, from where the curve comes.
      Contact& c = plane->contact[i];
      if (pole_side(geometry_, c)) c = in_element(geometry_, c, at_.contact[i]).value_or(c);
    }
    plane->evaluate(geometry_);
  }
  const double there = plane ? length_to(*plane) : 0;
  if (!plane || there < -plane_slack || there > length_to(next) + plane_slack) {
    return shorter("no common plane with a contact that surpasses two");
  }
  if (step_ > border_step && there > plane_slack && !is_followed(at_.ruling(), plane->ruling())) {
    return shorter("the rulings before a common plane are not found");
  }
  std::vector<Ruling>& rulings = arc_.pieces.back().rulings;
  if (there <= 0 && rulings.size() > 1) rulings.pop_back();
  push(*plane);
  arc_.n = plane->n;
  arc_.contacts.assign(plane->contact.begin(), plane->contact.end());
  return ended(TracedArc::End::plane);
}

/// On to the next element, at the exit where the contact stands.
Trace::Pace Trace::exchange(const Event& event) {
  const auto i = std::size_t(event.contact);
  const std::optional<Contact> over = beyond(geometry_, at_.contact[i], event.exit);
  if (!over) return lost("a separating curve has no next element");
  at_.contact[i] = *over;
  at_.evaluate(geometry_);
  if (!settle()) return lost("a separating curve has no tangent");
  begin_piece();
  step_ = std::max(0.5 * step_, shortest_step);
  return Pace::on;
}

Trace::Pace Trace::advance() {
  if (const std::optional<Pace> pace = near_merging()) return *pace;
  for (const Landmark& landmark : landmarks_) {
    if (arrives(landmark, step_)) return ended(TracedArc::End::plane);
  }
  std::optional<CommonSupport> next = stepped(step_);
  const std::optional<CurveTangent> turned =
      next ? system_.tangent(*next, &tangent_) : std::nullopt;
  const double cosine = turned ? glm::dot(turned->n, tangent_.n) +
                                     glm::dot(turned->x[0], tangent_.x[0]) +
                                     glm::dot(turned->x[1], tangent_.x[1])
                               : 0;
  if (cosine < turn_limit || distance_to(*next) > (1 + correction_limit) * step_) {
    // The nearer the contacts are to merging, the worse the system is conditioned.
    const double apart = glm::length(at_.d());
    const bool approach = glm::dot(tangent_.x[0] - tangent_.x[1], at_.d()) < 0;
    if (approach && apart < 2 * merging_distance(geometry_) && step_ < stuck_share * apart &&
        ends_merged()) {
      return merged();
    }
    return shorter("a separating curve cannot be followed");
  }
  if (const auto [contact, side] = pole_crossed(*next); contact >= 0) {
    return pass_pole(contact, side, step_)
               ? Pace::on
               : shorter("a separating curve cannot be followed past a pole");
  }
  bool known = true;
  const std::optional<Event> event = first_event(*next, step_, known);
  if (!known && !lenient_) {
    if (step_ > border_step) {
      return shorter("a separating curve cannot be followed over a border");
    }
    lenient_ = true;
  }
  if (event) next = event->support;
  if (is_closing(*next, step_)) {
    close();
    return ended(TracedArc::End::closed);
  }
  const Support top = query_(next->n, next->contact[0]);
  if (top.h > glm::dot(next->jet[0].x, next->n) + geometry_.tie()) {
    return surpassed(*next, top.contact);
  }
  if (step_ > border_step && !is_followed(at_.ruling(), next->ruling())) {
    return shorter("the rulings between two of a separating curve are not found");
  }
  const bool moved = length_to(*next) > margin_slack;
  idle_ = moved ? 0 : idle_ + 1;
  if (idle_ > idle_limit) return lost("a separating curve stays on a border");
  at_ = *next;
  if (moved) push(at_);
  if (event) return exchange(*event);
  if (moved && !home_) {
    home_ = at_;
    home_piece_ = arc_.pieces.size() - 1;
    home_ruling_ = arc_.pieces.back().rulings.size() - 1;
  }
  tangent_ = *turned;
  step_ = std::min(longest_step, cosine > turn_small ? growth * step_ : step_);
  return Pace::on;
}

TracedArc Trace::run(const Progress& progress, bool aside) {
  if (aside || is_singular(0) || is_singular(1)) {
    if (!leave()) lost("a separating curve cannot be followed from a pole or a flat point");
  } else if (settle()) {
    begin_piece();
  } else {
    lost("a separating curve has no tangent");
  }
  Pace pace = arc_.pieces.empty() ? Pace::ended : Pace::on;
  for (int k = 0; pace != Pace::ended; ++k) {
    if (k % 64 == 0) progress.check();
    pace = k < step_limit ? advance() : lost("a separating curve has no end");
  }
  if (!is_sound()) lost("a separating curve is not finite");
  drop_empty_pieces(geometry_, arc_.pieces);
  return std::move(arc_);
}

/// Puts a ruling in the place of one very near to it, its contacts in their own elements as far as
/// they reach there.
void move_to(const ContactGeometry& geometry, Ruling& ruling, const Ruling& place) {
  ruling.n = place.n;
  ruling.point = place.point;
  for (std::size_t i = 0; i < 2; ++i) {
    const Contact c = snapped(geometry, place.contact[i], shortest_piece);
    if (const auto own = in_element(geometry, c, ruling.contact[i])) ruling.contact[i] = *own;
  }
}

/// Contacts with which pieces begin and end in their normal form: turned to the next ones.
void turn_ends(const ContactGeometry& geometry, std::vector<ArcPiece>& pieces) {
  for (ArcPiece& piece : pieces) {
    std::vector<Ruling>& rulings = piece.rulings;
    if (rulings.size() < 2) continue;
    for (std::size_t i = 0; i < 2; ++i) {
      Contact& first = rulings.front().contact[i];
      Contact& last = rulings.back().contact[i];
      first = turned_to(geometry, first, rulings[1].contact[i]);
      last = turned_to(geometry, last, rulings[rulings.size() - 2].contact[i]);
    }
  }
}

}  // namespace

double merging_distance(const ContactGeometry& geometry) {
  return std::max(merge_distance, 2 * std::pow(geometry.rounding(), 0.25));
}

void drop_empty_pieces(const ContactGeometry& geometry, std::vector<ArcPiece>& pieces) {
  const auto square = [](const dvec3& x) { return glm::dot(x, x); };
  // At its ends, where heights tie over as much.
  const double tied = std::max(shortest_piece, std::sqrt(geometry.rounding()));
  const auto is_empty = [&](std::size_t k) {
    const std::vector<Ruling>& rulings = pieces[k].rulings;
    const double shortest = k == 0 || k + 1 == pieces.size() ? tied : shortest_piece;
    const Ruling& a = rulings.front();
    return std::all_of(rulings.begin(), rulings.end(), [&](const Ruling& b) {
      return square(b.n - a.n) + square(b.point[0] - a.point[0]) + square(b.point[1] - a.point[1]) <
             shortest * shortest;
    });
  };
  for (std::size_t k = pieces.size(); k-- > 0 && pieces.size() > 1;) {
    if (!is_empty(k)) continue;
    // What begins and ends the arc is told by its first ruling and its last.
    if (k == 0) move_to(geometry, pieces[1].rulings.front(), pieces[0].rulings.front());
    if (k + 1 == pieces.size())
      move_to(geometry, pieces[k - 1].rulings.back(), pieces[k].rulings.back());
    if (k > 0 && k + 1 < pieces.size()) {
      // One contact crosses its border here, the other one in the piece's other end.
      move_to(geometry, pieces[k - 1].rulings.back(), pieces[k - 1].rulings.back());
      move_to(geometry, pieces[k + 1].rulings.front(), pieces[k + 1].rulings.front());
    }
    pieces.erase(pieces.begin() + std::ptrdiff_t(k));
  }
  turn_ends(geometry, pieces);
}

TracedArc trace_arc(const ContactSystem& system, SupportQuery& query, const CommonSupport& start,
                    std::span<const Landmark> landmarks, const Progress& progress, bool aside) {
  return Trace(system, query, start, landmarks).run(progress, aside);
}

}  // namespace taut
