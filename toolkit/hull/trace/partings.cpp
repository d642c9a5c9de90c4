#include "taut/hull/trace/partings.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "taut/bounds/contact_climb.h"
#include "taut/bounds/contact_exits.h"
#include "taut/bounds/contact_forms.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/trace/level_way.h"
#include "taut/surface/flatness.h"

namespace taut {
namespace {

/// Share of its motion by which a contact may miss the first order of it.
constexpr double first_order = 0.2;
constexpr int parting_newton_limit = 60;
/// Values of two contacts that differ by so little are equal.
constexpr double parting_tie = 1e-15;

/// From a vertex or the end of a piece, straight pieces of edges lead one after the other to the
/// point. In a direction across them all of them support: no climb leads from one end to the other.
bool leads_straight(const ContactGeometry& geometry, const Contact& from, const dvec3& x) {
  std::vector<Contact> starts;
  if (from.kind == SourceKind::edge && (from.u == 0 || from.u == 1)) starts.push_back(from);
  for (const ContactExit& exit : exits(geometry, from)) {
    const Contact at = at_exit(from, exit);
    if (exit.kind == ContactExit::Kind::face || at.u != from.u) continue;
    const std::optional<Contact> next = beyond(geometry, from, exit);
    if (next && next->kind == SourceKind::edge) starts.push_back(*next);
  }
  return std::any_of(starts.begin(), starts.end(), [&](const Contact& start) {
    return found_on_edge(geometry, start, [&](const Contact& begin, const Contact& end) {
      if (!is_straight(geometry.curve(begin))) return EdgeVisit::lost;
      const double way = glm::distance(geometry.point(end), x);
      return way < branch_distance(geometry) ? EdgeVisit::found : EdgeVisit::on;
    });
  });
}

}  // namespace

double branch_distance(const ContactGeometry& geometry) {
  return std::max(same_branch_distance, std::sqrt(geometry.tie()));
}

SupportSample seen(const ContactGeometry& geometry, SupportQuery& query, const dvec3& n,
                   const Contact& hint) {
  const Support s = query(n, hint);
  const Contact c = at_rest(geometry, s.contact, n);
  return {n, c, geometry.point(c)};
}

bool is_near(const ContactGeometry& geometry, const SupportSample& from, const SupportSample& to) {
  const ContactJet j = geometry.jet(from.contact);
  const std::optional<dvec2> rate = parameter_rate(j, from.n, to.n - from.n);
  if (!rate) return false;
  const dvec3 motion = rate->x * j.dx[0] + rate->y * j.dx[1];
  return glm::distance(to.x - from.x, motion) < first_order * glm::distance(to.x, from.x);
}

bool same_branch(const ContactGeometry& geometry, const SupportSample& a, const SupportSample& b) {
  const double same = branch_distance(geometry);
  if (glm::distance(a.x, b.x) < same) return true;
  const auto leads = [&](const SupportSample& from, const SupportSample& to) {
    if (is_near(geometry, from, to)) return true;
    const std::optional<Contact> c = climbed(geometry, from.contact, to.n);
    if (!c) return false;
    const dvec3 x = geometry.point(*c);
    if (glm::distance(x, to.x) < same) return true;
    if (std::abs(glm::dot(to.x - x, to.n)) > geometry.tie()) return false;
    if (leads_straight(geometry, *c, to.x)) return true;
    // It was seen beside the top, by less than a tie tells: where an edge begins without a bend.
    const std::optional<Contact> top = climbed(geometry, to.contact, to.n);
    return top && glm::distance(geometry.point(*top), x) < same;
  };
  return leads(a, b) && leads(b, a);
}

/// Newton's method on the difference of the two values, the slope of which is the contacts'
/// difference, within the bracket that their signs make.
std::optional<CommonSupport> parting(const ContactGeometry& geometry, const SupportSample& a,
                                     const SupportSample& b) {
  CommonSupport s;
  s.add(geometry, a.contact);
  s.add(geometry, b.contact);
  double lower = 0;
  double upper = 1;
  double t = 0.5;
  for (int k = 0; k < parting_newton_limit; ++k) {
    const dvec3 mixed = (1 - t) * a.n + t * b.n;
    s.n = glm::normalize(mixed);
    // From where they were seen, lest they stay with a branch that an earlier step led to.
    const std::optional<Contact> of_a = climbed(geometry, a.contact, s.n);
    const std::optional<Contact> of_b = climbed(geometry, b.contact, s.n);
    if (!of_a || !of_b) return std::nullopt;
    s.contact[0] = *of_a;
    s.contact[1] = *of_b;
    s.evaluate(geometry);
    if (glm::length(s.d()) < branch_distance(geometry)) return std::nullopt;
    const double value = glm::dot(s.d(), s.n);
    if (std::abs(value) < parting_tie) {
      if (level_way(geometry, *of_a, *of_b, s.n)) return std::nullopt;
      return s;
    }
    (value > 0 ? lower : upper) = t;
    const double slope = glm::dot(s.d(), b.n - a.n) / glm::length(mixed);
    const double next = t - value / slope;
    t = next > lower && next < upper ? next : 0.5 * (lower + upper);
    if (upper - lower < parting_tie) {
      if (!(std::abs(value) < geometry.tie())) return std::nullopt;
      if (level_way(geometry, *of_a, *of_b, s.n)) return std::nullopt;
      return s;
    }
  }
  return std::nullopt;
}

}  // namespace taut
