#include "taut/hull/solve/arc_solver.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "taut/bounds/contact_climb.h"
#include "taut/bounds/contact_exits.h"
#include "taut/bounds/contact_forms.h"
#include "taut/bounds/poles.h"
#include "taut/hull/contact/exit_margins.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/hull/contact/rulings_between.h"
#include "taut/hull/solve/arc_pieces.h"
#include "taut/hull/solve/contact_way.h"
#include "taut/hull/solve/merged_ends.h"
#include "taut/hull/solve/pole_passage.h"

namespace taut {
namespace {

/// Halvings of the way between two rulings, after which they are next to each other.
constexpr int division_limit = 40;
/// Divisions of one way, after which its parts are taken as they are.
constexpr int most_divisions = 100;
/// How many times longer than a straight way one through a dent may be.
constexpr double longest_detour = 2;
/// Share of the way between two rulings by which the one in the middle may be off theirs.
constexpr double middle_share = 0.05;
/// Largest turn between neighbours, in radians.
constexpr double largest_turn = 0.4;
/// Parts of the way between rulings between which none is found, at whose ends it is looked at.
constexpr int places_on_the_way = 8;
/// Shares of a way at which an interpolated ruling is compared with the exact one: midway between
/// an end and the first exact ruling that the interpolation is made of (RulingsBetween).
constexpr std::array<double, 2> beside_ends = {0.125, 0.875};
/// Times by which a parameter's speed may change between two rulings that are seen to be neighbours
/// in the middle alone; where it changes by more, shares of the way at which it is seen, and how
/// far parameters may be from the interpolated ones there: so that Newton's method surely leads
/// from the one to the other, along circles of a quarter turn.
constexpr double most_stretched = 4;
constexpr std::array<double, 3> on_the_way = {0.125, 0.5, 0.875};
constexpr double parameter_reach = 0.1;
/// How far from a border, in units of the resolution, what is tolerant may be told to be on it.
constexpr double border_depths = 4;
/// Rates at which a contact moves over an exit, as shares of those at which it moves, that are
/// rounding where it runs along it.
constexpr double along_border = 1e-9;
/// How far before the way or beyond it a change may be by rounding, as a share; beside the
/// resolution.
constexpr double way_slack = 1e-9;
/// How far, as a share, the place may be beyond it at which an arc comes to the element of the next
/// ruling: where it turns sharply there.
constexpr double turn_share = 0.02;

double gap(const Ruling& a, const Ruling& b) {
  const auto square = [](const dvec3& x) { return glm::dot(x, x); };
  return std::sqrt(square(a.n - b.n) + square(a.point[0] - b.point[0]) +
                   square(a.point[1] - b.point[1]));
}

/// How far along the way from one ruling to another a third one is, as a share.
double share_of_way(const Ruling& from, const Ruling& to, const Ruling& r) {
  const auto along = [&](const Ruling& x) {
    return glm::dot(x.n - from.n, to.n - from.n) +
           glm::dot(x.point[0] - from.point[0], to.point[0] - from.point[0]) +
           glm::dot(x.point[1] - from.point[1], to.point[1] - from.point[1]);
  };
  const double whole = along(to);
  return whole > 0 ? along(r) / whole : 0;
}

Ruling middle_of(const Ruling& a, const Ruling& b) {
  Ruling r = a;
  r.n = 0.5 * (a.n + b.n);
  for (std::size_t i = 0; i < 2; ++i) r.point[i] = 0.5 * (a.point[i] + b.point[i]);
  return r;
}

bool are_vertices(const Ruling& r) {
  return r.contact[0].kind == SourceKind::vertex && r.contact[1].kind == SourceKind::vertex;
}

}  // namespace

ArcSolver::ArcSolver(const RulingSearch& search, const Ruling& first)
    : search_(search), geometry_(search.geometry()), pieces_({ArcPiece{{first}}}) {}

void ArcSolver::go_on(const Ruling& to) {
  divisions_ = passed_ = 0;
  go_on(to, 0);
}

void ArcSolver::end_in_one_contact() {
  Ruling end = last();
  const std::size_t own = end.contact[1].kind > end.contact[0].kind ? 1 : 0;
  end.contact[1 - own] = end.contact[own];
  end.point[1 - own] = end.point[own];
  if (const auto on = expressed_in(geometry_, end.contact[own], last().contact[1 - own])) {
    end.contact[1 - own] = *on;
  }
  jump(end);
}

void ArcSolver::go_on(const Ruling& to, int depth) {
  if (depth == division_limit || passed_ > most_passed) return jump(to);
  if (!same_elements(last(), to)) {
    const Ruling own = told_as_last(to);
    if (!same_elements(own, to)) return go_on(own, depth + 1);
    const double tie = geometry_.tie(), resolution = search_.map().resolution;
    if (stays(to, tie) || step_over(to, tie) || stays(to, resolution)) {
      ++passed_;
      return go_on(to, depth);
    }
    return divide(to, depth);
  }
  if (is_smooth(to)) return append(to);
  divide(to, depth);
}

/// With contacts told as ones of the elements that they are in by now, as far as they are no
/// farther from the borders of these, and slopes there amount to no more, than the resolution: what
/// is tolerant and runs along a border is not told now as one side's and now as the other's.
Ruling ArcSolver::told_as_last(Ruling to) const {
  const bool is_exact = search_.depth(to) <= geometry_.tie();
  const double distance = is_exact ? 0 : border_depths * search_.map().resolution;
  for (std::size_t i = 0; i < 2; ++i) {
    if (geometry_.is_beside_bent(to.contact[i])) continue;
    const Contact border = moved_to_border(geometry_, to.contact[i], distance);
    const auto own = expressed_in(geometry_, border, last().contact[i]);
    if (!own || own->kind == SourceKind::vertex) continue;
    // What leaves an edge leaves it, unless it stays where that meets the next one.
    const bool stays = own->kind == SourceKind::edge && own->u == last().contact[i].u;
    if (is_exact && to.contact[i].kind != SourceKind::face && !stays) continue;
    const ContactJet j = geometry_.jet(*own);
    const auto is_level = [&](const dvec3& dx) {
      return std::abs(glm::dot(dx, to.n)) <= search_.map().contact_extent() * glm::length(dx);
    };
    if (!std::all_of(j.dx.begin(), j.dx.begin() + j.dimension, is_level)) continue;
    to.contact[i] = *own;
    to.point[i] = j.x;
  }
  return to;
}

/// A contact that is in one place, within a distance, but told as one of another element, is so
/// from here on.
bool ArcSolver::stays(const Ruling& to, double distance) {
  Ruling after = last();
  for (std::size_t i = 0; i < 2; ++i) {
    const bool in_face =
        after.contact[i].kind == SourceKind::face || to.contact[i].kind == SourceKind::face;
    if (in_face || same_element(after.contact[i], to.contact[i]) ||
        glm::distance(after.point[i], to.point[i]) > distance) {
      continue;
    }
    after.contact[i] = to.contact[i];
    after.point[i] = to.point[i];
  }
  if (same_elements(after, last())) return false;
  pieces_.push_back({{after}});
  return true;
}

/// A contact that is no farther than so much from the border of its patch to that of the next
/// ruling's passes it on the straight way there, if that is no deeper than the resolution.
bool ArcSolver::is_beyond(const Ruling& to, double distance) {
  Ruling before = last();
  Ruling after = before;
  for (std::size_t i = 0; i < 2; ++i) {
    const Contact& own = last().contact[i];
    const dvec3& x = last().point[i];
    if (own.kind != SourceKind::face || same_element(own, to.contact[i])) continue;
    for (const ContactExit& exit : exits(geometry_, own)) {
      if (exit.kind != ContactExit::Kind::side) continue;
      const Contact beside = at_exit(own, exit);
      if (glm::distance(geometry_.point(beside), x) > distance) continue;
      const Contact on = passed_on_side(geometry_, beside, Side(exit.index), x, to.point[i]);
      const std::optional<Contact> over = beyond(geometry_, on, exit);
      if (!over || !same_element(*over, to.contact[i])) continue;
      before.contact[i] = on;
      after.contact[i] = *over;
      before.point[i] = after.point[i] = geometry_.point(on);
      break;
    }
  }
  if (same_elements(after, last()) || search_.depth(before) > search_.map().resolution) {
    return false;
  }
  append(before);
  pieces_.push_back({{after}});
  return true;
}

/// The piece goes on smoothly to the ruling; tells how deep it is on the way.
bool ArcSolver::is_smooth(const Ruling& to) {
  const double way = gap(last(), to);
  if (glm::distance(last().n, to.n) > largest_turn) return false;
  if (way <= same_contact || are_vertices(to)) return true;
  const RulingsBetween between(search_.system(), last(), to);
  if (between.empty()) return true;
  const double s = between.at_share(0.5);
  const std::optional<MovingRuling> exact =
      between.leaves_pole() ? std::optional(between.interpolated(s)) : between(s);
  if (!exact) return false;
  const Ruling middle = inside(exact->at.ruling());
  if (between.lies_flat() && !is_interpolated(between)) return false;
  if (passes_pole(to) && !is_well_told(between)) return false;
  if (gap(middle, middle_of(last(), to)) > middle_share * way) return false;
  const double depth = search_.depth(middle);
  if (depth > search_.map().resolution) return false;
  if (depth > geometry_.tie()) pieces_.back().tolerant = std::max(pieces_.back().tolerant, depth);
  return true;
}

/// On the way a contact comes so near to a pole that its parameter about it is far from linear.
bool ArcSolver::passes_pole(const Ruling& to) const {
  for (const std::size_t i : {0u, 1u}) {
    const ContactJet a = geometry_.jet(last().contact[i]);
    const ContactJet b = geometry_.jet(to.contact[i]);
    for (int k = 0; a.dimension == 2 && k < 2; ++k) {
      const double before = glm::length(a.dx[std::size_t(k)]);
      const double after = glm::length(b.dx[std::size_t(k)]);
      if (std::max(before, after) > most_stretched * std::min(before, after)) return true;
    }
  }
  return false;
}

/// All along the parameters of contacts are near the interpolated ones.
bool ArcSolver::is_well_told(const RulingsBetween& between) const {
  return std::all_of(on_the_way.begin(), on_the_way.end(), [&](double s) {
    const std::optional<MovingRuling> exact = between(s);
    const MovingRuling start = between.interpolated(s);
    for (std::size_t i = 0; exact && i < 2; ++i) {
      const Contact& c = exact->at.contact[i];
      if (glm::distance(parameters(c), parameters(start.at.contact[i])) > parameter_reach)
        return false;
    }
    return exact.has_value();
  });
}

/// Beside a flat end the interpolated ruling is what is integrated: whether it is exact is seen
/// near the ends, where it is the farthest from those that it is made of.
bool ArcSolver::is_interpolated(const RulingsBetween& between) const {
  return std::all_of(beside_ends.begin(), beside_ends.end(), [&](double s) {
    const std::optional<MovingRuling> exact = between(s);
    return !exact ||
           gap(exact->at.ruling(), between.interpolated(s).at.ruling()) <= geometry_.tie();
  });
}

/// With contacts that have left their elements on their borders.
Ruling ArcSolver::inside(Ruling r) const {
  for (std::size_t i = 0; i < 2; ++i) {
    r.contact[i] = clamped(r.contact[i]);
    r.point[i] = geometry_.point(r.contact[i]);
  }
  return r;
}

void ArcSolver::divide(const Ruling& to, int depth) {
  ++divisions_;
  ++all_divisions_;
  const double way = gap(last(), to);
  if (!(way > search_.least_way())) return jump(to);
  const std::optional<Ruling> middle = search_.between(last(), to);
  if (!middle || divisions_ > most_divisions || gap(last(), *middle) >= way ||
      gap(*middle, to) >= way) {
    return jump(to);
  }
  go_on(*middle, depth + 1);
  go_on(to, depth + 1);
}

/// The two are neighbours for all that is known. Where contacts pass a dent that is no deeper than
/// the resolution their planes touch the model on the way, though they do not support.
void ArcSolver::jump(const Ruling& to) {
  const double resolution = search_.map().resolution;
  while (!same_elements(last(), to) && passed_ <= most_passed &&
         (is_beyond(to, border_depths * resolution) || step_over(to, resolution))) {
    ++passed_;
  }
  if (same_elements(last(), to) && is_smooth(to)) return append(to);
  const auto way = [&](std::size_t i) {
    return ContactWay(geometry_, last().contact[i], to.contact[i], last().n,
                      search_.map().resolution);
  };
  const ContactWays ways = {way(0), way(1)};
  const double depth = std::max(depth_on_the_way(to, ways), geometry_.tie());
  const std::size_t first = pieces_.size() - 1;
  leap(to, ways);
  for (std::size_t k = first; k < pieces_.size(); ++k) {
    pieces_[k].tolerant = std::max(pieces_[k].tolerant, depth);
  }
}

/// How far the contacts are below supporting planes on their ways: straight where these are not
/// known.
double ArcSolver::depth_on_the_way(const Ruling& to, const ContactWays& ways) const {
  const Ruling& from = last();
  double deepest = 0;
  for (int k = 1; k < places_on_the_way; ++k) {
    const double share = double(k) / places_on_the_way;
    Ruling r = from;
    r.n = unit(glm::mix(from.n, to.n, share));
    for (std::size_t i = 0; i < 2; ++i) {
      r.contact[i] = ways[i].at(share);
      r.point[i] = ways[i].is_known() ? geometry_.point(r.contact[i])
                                      : glm::mix(from.point[i], to.point[i], share);
    }
    deepest = std::max(deepest, search_.depth(r));
  }
  return deepest;
}

/// Both contacts go their ways, and n turns with them, over the borders between their elements.
void ArcSolver::leap(const Ruling& to, const ContactWays& ways) {
  if (same_elements(last(), to)) return append(to);
  const Ruling from = last();
  std::array<std::size_t, 2> passed = {0, 0};
  const auto share = [&](std::size_t i) { return ways[i].share(passed[i]); };
  while (std::min(share(0), share(1)) <= 1) {
    const std::size_t i = share(0) <= share(1) ? 0 : 1;
    const double t = share(i);
    Ruling before = to;
    before.n = unit(glm::mix(from.n, to.n, t));
    before.contact[i] = ways[i].borders()[passed[i]][0];
    before.contact[1 - i] = ways[1 - i].at(t, passed[1 - i]);
    for (const std::size_t k : {0u, 1u}) before.point[k] = geometry_.point(before.contact[k]);
    append(before);
    Ruling after = before;
    after.contact[i] = ways[i].borders()[passed[i]][1];
    after.point[i] = geometry_.point(after.contact[i]);
    pieces_.push_back({{after}});
    ++passed[i];
  }
  if (!same_elements(last(), to)) {
    pieces_.push_back({{to}});
  } else if (gap(last(), to) > 0) {
    append(to);
  }
}

/// Goes on to the first change of elements on the way that is no deeper than so much.
bool ArcSolver::step_over(const Ruling& to, double depth) {
  std::optional<Change> first;
  bool leads_there = false;
  for (std::size_t i = 0; i < 2; ++i) {
    if (same_element(last().contact[i], to.contact[i])) continue;
    for (const ContactExit& exit : exits(geometry_, last().contact[i])) {
      const std::optional<Change> found = change(to, i, exit, depth);
      if (!found) continue;
      const bool arrives = same_element(found->after.contact[i], to.contact[i]);
      if (first && (arrives == leads_there ? found->way >= first->way : leads_there)) continue;
      first = found;
      leads_there = arrives;
    }
  }
  if (!first) return false;
  go_on(first->before, division_limit / 2);
  pieces_.push_back({{first->after}});
  return true;
}

/// On the way to a ruling the contact moves over the exit.
bool ArcSolver::leaves(const CommonSupport& s, const Ruling& to, std::size_t i,
                       const ContactExit& exit) const {
  const std::optional<CurveTangent> tangent = search_.system().tangent(s);
  if (!tangent) return false;
  const Ruling& from = last();
  const double sense = glm::dot(tangent->n, to.n - from.n) +
                       glm::dot(tangent->x[0], to.point[0] - from.point[0]) +
                       glm::dot(tangent->x[1], to.point[1] - from.point[1]);
  const LinearEquation margin = exit_margin(geometry_, s, int(i), exit);
  double rate = glm::dot(margin.n, tangent->n);
  for (const std::size_t k : {0u, 1u}) rate += glm::dot(margin.parameter[k], tangent->parameter[k]);
  const double along = glm::length(tangent->n) + glm::length(tangent->parameter[i]);
  return sense * rate < -std::abs(sense) * along * along_border;
}

/// The ruling with which contact i stands at the exit. Before an end in which contacts merge the
/// system is nearly singular: from where they are when they approach each other evenly.
bool ArcSolver::solve_change(CommonSupport& s, const Ruling& to, std::size_t i,
                             const ContactExit& exit) const {
  const ContactSystem& system = search_.system();
  const auto margin = [&](const CommonSupport& now) {
    return exit_margin(geometry_, now, int(i), exit);
  };
  if (to.point[0] != to.point[1]) return system.solve(s, margin);
  if (exit.kind == ContactExit::Kind::side) {
    s.contact[i] =
        passed_on_side(geometry_, s.contact[i], Side(exit.index), last().point[i], to.point[i]);
    s.evaluate(geometry_);
  }
  const double before = glm::distance(last().point[i], s.jet[i].x);
  const double after = glm::distance(to.point[i], s.jet[i].x);
  if (!(before + after > 0)) return false;
  const double left = after / (before + after);
  // n is a function of the square of their distance where they run on one surface or curve.
  const bool is_smooth = continues(geometry_, last().contact[0], last().contact[1]);
  s.n = unit(glm::mix(to.n, last().n, is_smooth ? left * left : left));
  Contact& other = s.contact[1 - i];
  if (same_element(other, to.contact[1 - i])) {
    other.u = glm::mix(to.contact[1 - i].u, other.u, left);
    other.v = glm::mix(to.contact[1 - i].v, other.v, left);
  }
  s.evaluate(geometry_);
  const double expected = left * glm::distance(last().point[0], last().point[1]);
  if (is_smooth && expected < shortest_solved) return true;
  if (!system.settle(s, margin)) return false;
  const double length = glm::length(s.d());
  return 0.5 * expected < length && length < 2 * expected;
}

std::optional<ArcSolver::Change> ArcSolver::change(const Ruling& to, std::size_t i,
                                                   const ContactExit& exit, double depth) const {
  CommonSupport s(geometry_, last());
  s.contact[i] = at_exit(s.contact[i], exit);
  s.evaluate(geometry_);
  if (pole_side(geometry_, s.contact[i])) {
    // In one direction alone, whatever the parameters there.
    s.n = unit_normal(geometry_, s.contact[i]);
    if (glm::dot(s.n, last().n) < 0) s.n = -s.n;
    const Contact other = climb(geometry_, s.contact[1 - i], s.n).contact;
    const auto own = in_element(geometry_, other, last().contact[1 - i]);
    if (!own) return std::nullopt;
    s.contact[1 - i] = *own;
  } else if (!solve_change(s, to, i, exit)) {
    return std::nullopt;
  }
  for (Contact& c : s.contact) {
    if (glm::distance(parameters(c), parameters(clamped(c))) > way_slack) return std::nullopt;
    c = clamped(c);
  }
  s.contact[i] = at_exit(s.contact[i], exit);
  s.evaluate(geometry_);
  Change found{s.ruling(), s.ruling(), 0};
  found.way = share_of_way(last(), to, found.before);
  const bool at_pole = pole_side(geometry_, s.contact[i]).has_value();
  // A pole is on all patches about it.
  std::optional<Contact> next = at_pole ? pole_in(geometry_, s.contact[i], to.contact[i])
                                        : beyond(geometry_, s.contact[i], exit);
  const bool goes_through = at_pole && !pole_side(geometry_, to.contact[i]);
  if (const auto passed = goes_through ? pole_passage(search_.system(), last(), found.before, to, i)
                                       : std::nullopt) {
    found.before.contact[i] = passed->into;
    next = passed->out_of;
  }
  const bool arrives = next && same_element(*next, to.contact[i]);
  const double beyond_ends = arrives ? turn_share : 0;
  const double whole = gap(last(), to);
  const double slack = beyond_ends + way_slack + search_.map().resolution / whole;
  if (!(found.way >= -slack && found.way <= 1 + slack)) return std::nullopt;
  const double detour = depth > geometry_.tie() ? longest_detour : 1 + beyond_ends + way_slack;
  const double farthest = detour * whole + search_.map().resolution;
  if (gap(last(), found.before) > farthest || gap(found.before, to) > farthest) return std::nullopt;
  if (!next || (!arrives && !leaves(s, to, i, exit))) return std::nullopt;
  if (search_.depth(found.before) > depth) return std::nullopt;
  found.after.contact[i] = *next;
  found.after.point[i] = geometry_.point(*next);
  return found;
}

}  // namespace taut
