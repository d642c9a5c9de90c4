#include "taut/hull/arc_tracer.h"

#include <algorithm>
#include <cmath>

#include "taut/hull/contact_exits.h"
#include "taut/hull/facet_contacts.h"

namespace taut {
namespace {

/// Lengths are in (n, x_0, x_1), in the scene's frame, whose size is about one.
constexpr double first_step = 0.02;
constexpr double longest_step = 0.12;
constexpr double shortest_step = 1e-11;
/// A step is halved where the tangent turns by more than the one cosine tells, and the next one
/// grows where it turns by less than the other.
constexpr double turn_limit = 0.97;
constexpr double turn_small = 0.995;
constexpr double growth = 1.6;
/// A plane may lie behind the last ruling by this much: a third contact that surpasses the two by
/// less than support_tie went unseen.
constexpr double plane_slack = 1e-6;
/// How far the corrector may move the prediction, as a share of the step.
constexpr double correction_limit = 0.15;
/// Contacts so near to each other that keep approaching merge. The system's smallest singular value
/// falls with the third power of their distance; here rounding moves them by about 1e-8 yet.
constexpr double merge_distance = 4e-3;
/// Margins below this are crossed.
constexpr double margin_slack = 1e-12;
constexpr int step_limit = 20000;
/// Changes of elements without progress after which the curve is lost.
constexpr int idle_limit = 12;

struct Event {
  double length = 0;  ///< along the step's tangent
  int contact = 0;
  ContactExit exit;
  CommonSupport support;
};

class Trace {
 public:
  Trace(const ContactSystem& system, SupportQuery& query, const CommonSupport& start)
      : system_(system), geometry_(system.geometry()), query_(query), start_(start), at_(start) {}

  TracedArc run(const Progress& progress);

 private:
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

  std::optional<Event> first_event(const CommonSupport& next, double length) const;
  std::optional<Event> solved_event(const CommonSupport& next, double share, int contact,
                                    const ContactExit& exit) const;
  double margin(const CommonSupport& s, int contact, const ContactExit& exit) const {
    return exit_margin(geometry_, s, contact, exit).residual;
  }
  bool is_closing(const CommonSupport& next, double length) const;
  bool merge();
  void begin_piece();
  void push(const CommonSupport& s) { arc_.pieces.back().rulings.push_back(s.ruling()); }
  TracedArc lost(const char* reason) {
    arc_.end = TracedArc::End::lost;
    arc_.reason = reason;
    return std::move(arc_);
  }

  const ContactSystem& system_;
  const ContactGeometry& geometry_;
  SupportQuery& query_;
  CommonSupport start_;
  CommonSupport at_;
  CurveTangent tangent_;
  std::array<std::vector<ContactExit>, 2> exits_;
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
  // On the border exactly.
  Contact& c = s.contact[std::size_t(contact)];
  if (exit.kind == ContactExit::Kind::side) {
    const Side side = all_sides[std::size_t(exit.index)];
    (side == Side::u0 || side == Side::u1 ? c.u : c.v) =
        side == Side::u1 || side == Side::v1 ? 1 : 0;
  } else if (exit.kind == ContactExit::Kind::end) {
    c.u = exit.index;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    s.contact[i].u = std::clamp(s.contact[i].u, 0.0, 1.0);
    s.contact[i].v = std::clamp(s.contact[i].v, 0.0, 1.0);
  }
  s.evaluate(geometry_);
  event.length = length_to(s);
  return event;
}

/// The first margin on the way to `next` that is crossed there.
std::optional<Event> Trace::first_event(const CommonSupport& next, double length) const {
  std::optional<Event> first;
  for (int i = 0; i < 2; ++i) {
    for (const ContactExit& exit : exits_[std::size_t(i)]) {
      const double after = margin(next, i, exit);
      if (after >= -margin_slack) continue;
      const double before = std::max(margin(at_, i, exit), 0.0);
      const double share = before / (before - after);
      const std::optional<Event> event = solved_event(next, share, i, exit);
      if (!event || event->length > length + margin_slack) continue;
      if (!first || event->length < first->length) first = event;
    }
  }
  return first;
}

bool Trace::is_closing(const CommonSupport& next, double length) const {
  const double ahead = length_to(start_);
  if (ahead <= margin_slack || ahead > length_to(next) + margin_slack) return false;
  if (distance_to(start_) > 1.5 * length) return false;
  const std::optional<CommonSupport> there = stepped(ahead);
  return there && glm::distance(there->n, start_.n) < same_contact &&
         glm::distance(there->jet[0].x, start_.jet[0].x) < same_contact &&
         glm::distance(there->jet[1].x, start_.jet[1].x) < same_contact;
}

/// Ends the arc where the contacts merge, if they do: their parameters and n, as functions of the
/// distance rho between them, are smooth there, n and the middle in its square.
bool Trace::merge() {
  const std::vector<Ruling>& rulings = arc_.pieces.back().rulings;
  const Ruling& last = rulings.back();
  const auto length = [](const Ruling& r) { return glm::distance(r.point[0], r.point[1]); };
  const double rho = length(last);
  const auto before = std::find_if(rulings.rbegin(), rulings.rend(),
                                   [&](const Ruling& r) { return length(r) > 1.5 * rho; });
  if (before == rulings.rend()) return false;
  const double other = length(*before);
  const double linear = rho / (other - rho);
  const double squared = rho * rho / (other * other - rho * rho);
  Ruling end = last;
  end.n = last.n + squared * (last.n - before->n);
  const auto same = [](const Contact& a, const Contact& b) {
    return a.instance == b.instance && a.kind == b.kind && a.element == b.element;
  };
  const bool one_element = same(last.contact[0], last.contact[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    Contact& c = end.contact[i];
    const auto extrapolated = [&](double Contact::*t) {
      const auto middle = [&](const Ruling& r) {
        return 0.5 * (r.contact[0].*t + r.contact[1].*t);
      };
      const double value =
          one_element ? middle(last) + squared * (middle(last) - middle(*before))
                      : last.contact[i].*t + linear * (last.contact[i].*t - before->contact[i].*t);
      return std::clamp(value, 0.0, 1.0);
    };
    c.u = extrapolated(&Contact::u);
    c.v = extrapolated(&Contact::v);
  }
  const std::array<ContactJet, 2> jet = {geometry_.jet(end.contact[0]),
                                         geometry_.jet(end.contact[1])};
  if (glm::distance(jet[0].x, jet[1].x) > 0.25 * rho) return false;
  // The direction is that of the higher-dimensional contact's tangents.
  for (const ContactJet& j : jet) {
    if (j.dimension == 1) {
      const dvec3 along = unit(j.dx[0]);
      end.n -= glm::dot(end.n, along) * along;
    }
  }
  for (const ContactJet& j : jet) {
    if (j.dimension != 2) continue;
    const dvec3 normal = unit(glm::cross(j.dx[0], j.dx[1]));
    if (normal == dvec3(0.0)) continue;
    end.n = glm::dot(normal, end.n) < 0 ? -normal : normal;
    break;
  }
  end.n = unit(end.n);
  const std::size_t anchor = jet[0].dimension <= jet[1].dimension ? 0 : 1;
  const dvec3 x = jet[anchor].x;
  const Support top = query_(end.n, last.contact[0]);
  // About a free end heights differ by the fourth power of distances, at a border by the third.
  if (top.h - glm::dot(x, end.n) > rho * rho * rho || glm::distance(top.point, x) > 4 * rho) {
    return false;
  }
  end.point = {x, x};
  arc_.pieces.back().rulings.push_back(end);
  return true;
}

void Trace::begin_piece() {
  if (!arc_.pieces.empty() && arc_.pieces.back().rulings.size() < 2) arc_.pieces.pop_back();
  arc_.pieces.emplace_back();
  push(at_);
  for (std::size_t i = 0; i < 2; ++i) exits_[i] = exits(geometry_, at_.contact[i]);
}

TracedArc Trace::run(const Progress& progress) {
  const std::optional<CurveTangent> first = system_.tangent(at_, nullptr);
  if (!first) return lost("a separating curve has no tangent");
  tangent_ = *first;
  begin_piece();
  double step = first_step;
  int idle = 0;
  for (int k = 0; k < step_limit; ++k) {
    if (k % 64 == 0) progress.check();
    const double apart = glm::length(at_.d());
    const double rate = glm::dot(tangent_.x[0] - tangent_.x[1], at_.d()) / apart;
    if (rate < 0 && apart < -2 * rate * step) {
      if (apart < merge_distance) {
        if (!merge()) return lost("two contacts approach each other and do not merge");
        arc_.end = TracedArc::End::merged;
        return std::move(arc_);
      }
      step = -0.5 * apart / rate;
    }
    std::optional<CommonSupport> next = stepped(step);
    std::optional<CurveTangent> turned;
    if (next) turned = system_.tangent(*next, &tangent_);
    double cosine = 0;
    if (turned) {
      cosine = glm::dot(turned->n, tangent_.n) + glm::dot(turned->x[0], tangent_.x[0]) +
               glm::dot(turned->x[1], tangent_.x[1]);
      const bool corrected_far = distance_to(*next) > (1 + correction_limit) * step;
      if (cosine < turn_limit || corrected_far) turned.reset();
    }
    if (!turned) {
      step *= 0.5;
      if (step < shortest_step) return lost("a separating curve cannot be followed");
      continue;
    }
    const std::optional<Event> event = first_event(*next, step);
    if (event) next = event->support;
    const bool closing = is_closing(*next, step);
    const Support top = query_(next->n, next->contact[0]);
    if (!closing && top.h > glm::dot(next->jet[0].x, next->n) + support_tie) {
      std::optional<CommonSupport> plane = common_plane(system_, query_, *next, top.contact);
      const double there = plane ? length_to(*plane) : 0;
      if (plane && (there < -plane_slack || there > length_to(*next) + plane_slack)) plane.reset();
      if (!plane) {
        step *= 0.5;
        if (step < shortest_step) return lost("no common plane with a contact that surpasses two");
        continue;
      }
      if (there <= 0 && arc_.pieces.back().rulings.size() > 1)
        arc_.pieces.back().rulings.pop_back();
      push(*plane);
      arc_.end = TracedArc::End::plane;
      arc_.plane = *plane;
      return std::move(arc_);
    }
    if (closing) {
      push(start_);
      Ruling& end = arc_.pieces.back().rulings.back();
      const Ruling& own = next->ruling();
      for (std::size_t i = 0; i < 2; ++i) {
        const Contact& c = own.contact[i];
        if (end.contact[i].kind != c.kind || end.contact[i].element != c.element) {
          return lost("a closed separating curve begins on a border");
        }
      }
      arc_.end = TracedArc::End::closed;
      return std::move(arc_);
    }
    const double moved = length_to(*next);
    idle = moved > margin_slack ? 0 : idle + 1;
    if (idle > idle_limit) return lost("a separating curve stays on a border");
    at_ = *next;
    if (moved > margin_slack) push(at_);
    if (event) {
      const auto i = std::size_t(event->contact);
      const std::optional<Contact> over = beyond(geometry_, at_.contact[i], event->exit);
      if (!over) return lost("a separating curve passes through a pole");
      at_.contact[i] = *over;
      at_.evaluate(geometry_);
      begin_piece();
      turned = system_.tangent(at_, &tangent_);
      if (!turned) return lost("a separating curve has no tangent");
      step = std::max(0.5 * step, shortest_step);
    } else {
      if (cosine > turn_small) step *= growth;
      step = std::min(longest_step, step);
    }
    tangent_ = *turned;
  }
  return lost("a separating curve has no end");
}

}  // namespace

TracedArc trace_arc(const ContactSystem& system, SupportQuery& query, const CommonSupport& start,
                    const Progress& progress) {
  return Trace(system, query, start).run(progress);
}

}  // namespace taut
