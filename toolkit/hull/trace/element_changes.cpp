#include "taut/hull/trace/element_changes.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/poles.h"

namespace taut {
namespace {

/// Margins below margin_slack are crossed; or below what the rounding of coordinates does to them,
/// but for places where that is more than a limit, or many times the rounding: beside poles.
constexpr double margin_slack_limit = 1e-9;
constexpr double margin_noise_limit = 300;
/// Sine below which an edge leaves a vertex in line with another vertex.
constexpr double leaving_sine = 1e-9;
/// How far behind a step's start rounding may put an exit at which it begins.
constexpr double behind_limit = 1e-7;

}  // namespace

void put_on_border(const ContactGeometry& geometry, ElementChange& event) {
  CommonSupport& s = event.support;
  Contact& own = s.contact[std::size_t(event.contact)];
  own = at_exit(own, event.exit);
  for (std::size_t i = 0; i < 2; ++i) {
    s.contact[i].u = std::clamp(s.contact[i].u, 0.0, 1.0);
    s.contact[i].v = std::clamp(s.contact[i].v, 0.0, 1.0);
  }
  s.evaluate(geometry);
}

void ElementChanges::begin() {
  for (int i = 0; i < 2; ++i) {
    std::vector<ContactExit>& own = exits_[std::size_t(i)];
    own = exits(geometry_, point_.at.contact[std::size_t(i)]);
    std::erase_if(own, [&](const ContactExit& exit) { return stays_level(i, exit); });
  }
}

/// Two vertices are the contacts, and the exit's edge goes straight on from the segment between
/// them: its margin is zero all along the curve.
bool ElementChanges::stays_level(int contact, const ContactExit& exit) const {
  const CommonSupport& s = point_.at;
  if (exit.kind != ContactExit::Kind::edge || s.contact[0].kind != SourceKind::vertex ||
      s.contact[1].kind != SourceKind::vertex) {
    return false;
  }
  const dvec3 away = exit_margin(geometry_, s, contact, exit).n;
  return glm::length(glm::cross(away, unit(s.d()))) < leaving_sine;
}

std::optional<ElementChange> ElementChanges::solved(const CommonSupport& next, double share,
                                                    int contact, const ContactExit& exit) const {
  ElementChange event;
  event.contact = contact;
  event.exit = exit;
  CommonSupport& s = event.support;
  s = point_.at;
  s.n = glm::normalize((1 - share) * point_.at.n + share * next.n);
  for (std::size_t i = 0; i < 2; ++i) {
    s.contact[i].u += share * (next.contact[i].u - point_.at.contact[i].u);
    s.contact[i].v += share * (next.contact[i].v - point_.at.contact[i].v);
  }
  s.evaluate(geometry_);
  const bool solved = system_.solve(
      s, [&](const CommonSupport& now) { return exit_margin(geometry_, now, contact, exit); });
  if (!solved) return std::nullopt;
  put_on_border(geometry_, event);
  event.length = point_.length_to(s);
  return event;
}

/// Of exits in one place those at the ends of elements come first: beyond them slopes tell nothing.
/// Of a contact's others the one that it passes farthest.
bool ElementChanges::precedes(const ElementChange& a, const ElementChange& b) const {
  const auto at_end = [](const ElementChange& e) {
    return e.exit.kind == ContactExit::Kind::side || e.exit.kind == ContactExit::Kind::end;
  };
  const bool one_place =
      std::abs(a.length - b.length) <= std::max(slack(a.contact, a.exit), slack(b.contact, b.exit));
  if (!one_place || (a.contact != b.contact && at_end(a) == at_end(b))) return a.length < b.length;
  return at_end(a) != at_end(b) ? at_end(a) : a.after < b.after;
}

/// The exit as one at which the contact stands.
ElementChange ElementChanges::change_here(int contact, const ContactExit& exit) const {
  ElementChange event;
  event.contact = contact;
  event.exit = exit;
  event.support = point_.at;
  put_on_border(geometry_, event);
  return event;
}

std::optional<ElementChange> ElementChanges::first(const CommonSupport& next, double length,
                                                   bool& known) const {
  known = true;
  std::optional<ElementChange> first;
  for (int i = 0; i < 2; ++i) {
    for (const ContactExit& exit : exits_[std::size_t(i)]) {
      const double after = margin(next, i, exit);
      if (after >= -slack(i, exit)) continue;
      const double before = std::max(margin(point_.at, i, exit), 0.0);
      const double share = before / (before - after);
      std::optional<ElementChange> event = solved(next, share, i, exit);
      // At the exit but for rounding, which may put it far behind.
      if (before <= slack(i, exit) && (!event || event->length < -behind_limit))
        event = change_here(i, exit);
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

/// How far below zero a contact's margin may be for rounding, or for running along a join.
double ElementChanges::slack(int contact, const ContactExit& exit) const {
  const double size =
      std::min(1.0, exit_length(geometry_, point_.at.contact[std::size_t(contact)], exit));
  const double limit = std::max(margin_slack_limit, margin_noise_limit * geometry_.rounding());
  const double least =
      exit.kind == ContactExit::Kind::side
          ? std::max(margin_slack,
                     point_.join_distance(std::size_t(contact), all_sides[std::size_t(exit.index)]))
          : margin_slack;
  if (geometry_.rounding() >= limit * size) return std::max(limit, least);
  return std::max(least, geometry_.rounding() / size);
}

std::pair<int, Side> ElementChanges::pole_crossed(const CommonSupport& next) const {
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

}  // namespace taut
