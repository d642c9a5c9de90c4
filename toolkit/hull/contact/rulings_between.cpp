#include "taut/hull/contact/rulings_between.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/poles.h"
#include "taut/core/tolerances.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/hull/contact/ruling_starts.h"

namespace taut {
namespace {

/// Newton's method may move the interpolated ruling by this share of the chord: more than curves
/// turn between two neighbouring rulings, less than to another solution.
constexpr double correction_share = 0.15;
/// Rulings are no shorter than this share of both their neighbours.
constexpr double least_length = 0.1;
/// What rounding may move contacts by that nearly merge.
constexpr double rounded = 1e-6;
/// Contacts whose distance falls to less than this share between two rulings are about to merge.
constexpr double merging_share = 0.25;
/// Rates per share of the length, relative to the chord, below which the length falls with the
/// square of the way: one half, where others are one.
constexpr double touching_share = 0.6;
/// Of the way to a free end: what is shorter there than this share of it is a poor measure of it.
constexpr double slender_share = 0.1;
/// Chords up to this long may be too short for the rates of exact rulings.
constexpr double longest_noisy = 1e-2;
/// An arc that is so many times its chord is none that was solved.
constexpr double longest_arc = 10;

double squared(const dvec3& x) { return glm::dot(x, x); }

/// A free end: its two points are one, though they may come from two elements.
bool merged(const Ruling& r) { return glm::length(r.point[0] - r.point[1]) <= coordinate_rounding; }

/// So flat is one of the contacts that where it lies is rounding.
bool is_flat(const CommonSupport& s, const ContactGeometry& geometry) {
  const double least = std::sqrt(geometry.rounding());
  return is_flat(s.jet[0], s.n, least) || is_flat(s.jet[1], s.n, least);
}

/// The derivatives in m are not those of a curve that runs about straight between the two; of n,
/// which may stand still, not by more than may be corrected.
bool bends(const Ruling& begin, const Ruling& end, const MovingRuling& m) {
  double chord = squared(end.n - begin.n);
  for (std::size_t i = 0; i < 2; ++i) {
    const dvec2 straight = parameters(end.contact[i]) - parameters(begin.contact[i]);
    const dvec2 bend = m.dp[i] - straight;
    if (!(glm::dot(bend, bend) <= glm::dot(straight, straight))) return true;
    chord += squared(end.point[i] - begin.point[i]);
  }
  const dvec3 turned = end.n - begin.n;
  return squared(m.dn - turned) >
         std::max(squared(turned), correction_share * correction_share * chord);
}

/// Where a surface's parabolic curve touches an edge, the rulings' length falls with the square of
/// the way to the end: by its derivatives in m, with respect to its share, the longer ruling would
/// be half as far from the end as it is.
bool touches(const Ruling& end, const Ruling& longer, const MovingRuling& m) {
  const SourceKind first = longer.contact[0].kind;
  const SourceKind other = longer.contact[1].kind;
  if (std::min(first, other) != SourceKind::face || std::max(first, other) != SourceKind::edge)
    return false;
  double along = glm::dot(longer.n - end.n, m.dn);
  double chord = squared(longer.n - end.n);
  for (std::size_t i = 0; i < 2; ++i) {
    along += glm::dot(longer.point[i] - end.point[i], m.dx[i]);
    chord += squared(longer.point[i] - end.point[i]);
  }
  return along < touching_share * chord && along > (1 - touching_share) * chord;
}

/// Contacts that stay at ends of edges are the highest of these.
bool is_at_tops(const CommonSupport& s) {
  for (std::size_t i = 0; i < std::size_t(s.count); ++i) {
    if (s.kept[i] == CommonSupport::free || s.contact[i].kind != SourceKind::edge) continue;
    const double rise = glm::dot(s.jet[i].dx[0], s.n);
    if (s.contact[i].u > 0.5 ? rise < 0 : rise > 0) return false;
  }
  return true;
}

}  // namespace

void MovingRuling::complete() {
  for (std::size_t i = 0; i < 2; ++i) {
    dx[i] = dp[i].x * at.jet[i].dx[0] + dp[i].y * at.jet[i].dx[1];
  }
  dn -= glm::dot(dn, at.n) * at.n;
}

void MovingRuling::move(const CurveTangent& t, double speed) {
  dn = speed * t.n;
  for (std::size_t i = 0; i < 2; ++i) dp[i] = speed * t.parameter[i];
  complete();
}

void MovingRuling::speed_up(double factor) {
  dn *= factor;
  for (std::size_t i = 0; i < 2; ++i) {
    dp[i] *= factor;
    dx[i] *= factor;
  }
}

RulingsBetween::State RulingsBetween::state(const dvec3& n, const dvec2& p0, const dvec2& p1) {
  return {n.x, n.y, n.z, p0.x, p0.y, p1.x, p1.y};
}

RulingsBetween::State RulingsBetween::place(const MovingRuling& m) {
  return state(m.at.n, parameters(m.at.contact[0]), parameters(m.at.contact[1]));
}

RulingsBetween::State RulingsBetween::rate(const MovingRuling& m) {
  return state(m.dn, m.dp[0], m.dp[1]);
}

bool lies_at_pole(const ContactGeometry& geometry, const Ruling& r) {
  return std::any_of(r.contact.begin(), r.contact.end(),
                     [&](const Contact& c) { return collapsed_side(geometry, c).has_value(); });
}

RulingsBetween::RulingsBetween(const ContactSystem& system, const Ruling& from, const Ruling& to)
    : system_(system),
      from_(from),
      to_(to),
      kept_({kept_parameter(from.contact[0], to.contact[0]),
             kept_parameter(from.contact[1], to.contact[1])}),
      square_(squared(to.n - from.n) + squared(to.point[0] - from.point[0]) +
              squared(to.point[1] - from.point[1])) {
  shorter_ = std::min(glm::distance(from.point[0], from.point[1]),
                      glm::distance(to.point[0], to.point[1]));
  if (empty()) return;
  if (from.n == to.n) {
    for (const double s : {0.0, 1.0}) {
      const Ruling& r = s == 0 ? from : to;
      polynomial_.add(s, state(r.n, parameters(r.contact[0]), parameters(r.contact[1])));
    }
    return;
  }
  touches_ =
      merged(from) != merged(to) && touch(merged(from) ? from : to, merged(from) ? to : from);
  if (touches_) {
    fit();
    refine();
  } else if (merged(from) == merged(to)) {
    nearly_merges_ = nearly_merge();
    const std::array<RulingStart, 2> start = {start_at(system.geometry(), from, to),
                                              start_at(system.geometry(), to, from)};
    for (std::size_t i = 0; i < 2; ++i) {
      straight_[i] = start[i] == RulingStart::straight;
      stands_[i] = start[i] == RulingStart::stands;
    }
    const auto is_flat_far_off = [&](const Ruling& r) {
      return system.geometry().tie() > support_tie &&
             is_flat(CommonSupport(system.geometry(), r), system.geometry());
    };
    const auto lies_flat = [&](const Ruling& r) {
      return begins_on_segment(system.geometry(), r) || is_flat_far_off(r);
    };
    leaves_pole_ = length() <= pole_chord &&
                   (lies_at_pole(system.geometry(), from) || lies_at_pole(system.geometry(), to));
    lies_flat_ = is_straight() || stands_[0] || stands_[1] || lies_flat(from) || lies_flat(to);
    fit();
  } else {
    free_end_ = merged(from) ? 0 : 1;
    fit_free_end(merged(from) ? from : to, merged(from) ? to : from);
  }
}

/// The longer ruling's length falls towards the end with the square of the way, or may: it is much
/// shorter than the way.
bool RulingsBetween::touch(const Ruling& end, const Ruling& longer) {
  MovingRuling m;
  m.at = support(longer);
  length_ = glm::length(m.at.d());
  const bool is_smooth = continues(system_.geometry(), longer.contact[0], longer.contact[1]);
  if (is_smooth && length_ < slender_share * length()) return true;
  return find_slope(m, 1) && touches(end, longer, m);
}

double RulingsBetween::share(double s) const {
  if (straight_[0] && straight_[1]) return s * s * (3 - 2 * s);
  if (straight_[0]) return s * s;
  return straight_[1] ? s * (2 - s) : s;
}

double RulingsBetween::share_slope(double s) const {
  if (straight_[0] && straight_[1]) return 6 * s * (1 - s);
  if (straight_[0]) return 2 * s;
  return straight_[1] ? 2 * (1 - s) : 1;
}

double RulingsBetween::at_share(double share) const {
  const double within = std::clamp(share, 0.0, 1.0);
  if (straight_[0] && straight_[1]) return 0.5 - std::sin(std::asin(1 - 2 * within) / 3);
  if (straight_[0]) return std::sqrt(within);
  return straight_[1] ? 1 - std::sqrt(1 - within) : share;
}

/// The contacts do, along a chord that is little more than their approach.
bool RulingsBetween::nearly_merge() const {
  const double longer = std::max(glm::distance(from_.point[0], from_.point[1]),
                                 glm::distance(to_.point[0], to_.point[1]));
  return !is_distinct(shorter_) && shorter_ < merging_share * longer && square_ < longer * longer &&
         continues(system_.geometry(), from_.contact[0], from_.contact[1]);
}

/// Rounding moves contacts by its own size over the smallest singular value of their system, and
/// their rates by that over it again; between rulings whose own length is no matter Hermite's
/// interpolation misses rates by the cube of the chord at most.
bool RulingsBetween::are_rates_noise() const {
  if (length() > longest_noisy) return false;
  const double least = std::sqrt(system_.geometry().rounding() * square_ * length());
  return system_.uncertainty(support(from_)) > least || system_.uncertainty(support(to_)) > least;
}

/// Between the ends, with their slopes unless these are noise (next to a pole or a free end, say).
void RulingsBetween::fit() {
  double s = 0;
  for (const Ruling* end : {&from_, &to_}) {
    MovingRuling m;
    m.at = support(*end);
    if (straight_[end == &from_ ? 0 : 1]) {
      // n and the parameters are smooth in powers of the share, which begins level.
      polynomial_.add(s, place(m), State{});
    } else if (!merged(*end) && !stands_[end == &from_ ? 0 : 1] && !is_noise(m.at) &&
               find_speed(m) && !bends(from_, to_, m)) {
      m.speed_up(share_slope(s));
      polynomial_.add(s, place(m), rate(m));
    } else {
      polynomial_.add(s, place(m));
    }
    s = 1;
  }
  if (lies_flat_) refine();
}

/// Adds exact rulings in between. Of contacts that merge by touching first those far from the end:
/// near it, contacts in one place would be found from a worse start.
void RulingsBetween::refine() {
  using Shares = std::array<double, 3>;
  const Shares shares = !touches_       ? Shares{0.5, 0.25, 0.75}
                        : merged(from_) ? Shares{0.75, 0.5, 0.25}
                                        : Shares{0.25, 0.5, 0.75};
  for (const double s : shares) {
    MovingRuling m = moving(s, 1);
    if (!solve_share(m, share(s)) || !find_speed(m)) continue;
    m.speed_up(share_slope(s));
    polynomial_.add(s, place(m), rate(m));
  }
}

/// The slope at this end is noise.
bool RulingsBetween::is_noise(const CommonSupport& s) const {
  if (nearly_merges_ && !is_distinct(glm::length(s.d()))) return true;
  return lies_flat_ && is_flat(s, system_.geometry());
}

/// In the share of the longer ruling's length: from the end, the longer ruling and some in between,
/// with slopes.
void RulingsBetween::fit_free_end(const Ruling& end, const Ruling& longer) {
  MovingRuling m;
  m.at = support(longer);
  length_ = glm::length(m.at.d());
  polynomial_.add(0, state(end.n, parameters(end.contact[0]), parameters(end.contact[1])));
  if (!find_slope(m, 1) || bends(end, longer, m)) {
    // Too far from the end, or too close to it for the tangent: straight.
    polynomial_.add(1, place(m));
    return;
  }
  polynomial_.add(1, place(m), rate(m));
  for (const double r : {0.75, 0.5, 0.25}) {
    if (!is_distinct(r * length_)) break;
    MovingRuling next = moving(r, 1);
    if (!solve_length(next, r) || !find_slope(next, r)) break;
    polynomial_.add(r, place(next), rate(next));
  }
}

bool RulingsBetween::solve_share(MovingRuling& m, double s) const {
  const dvec3 dn = (to_.n - from_.n) / square_;
  const auto equation = [&](const CommonSupport& at) {
    LinearEquation e;
    e.n = dn;
    e.residual = glm::dot(at.n - from_.n, dn) - s;
    for (std::size_t i = 0; i < 2; ++i) {
      const dvec3 g = (to_.point[i] - from_.point[i]) / square_;
      e.residual += glm::dot(at.jet[i].x - from_.point[i], g);
      e.add_point(at, int(i), g);
    }
    return e;
  };
  return solve(m, equation);
}

/// The ruling of r times the longer ruling's length.
bool RulingsBetween::solve_length(MovingRuling& m, double r) const {
  const double length = r * length_;
  return solve(m, [&](const CommonSupport& at) { return distance_equation(at, length); });
}

/// Contacts that lie on sides at both ends stay there; or where they do not support there, they are
/// free. At the ends of edges they stay at kinks.
template <class Equation>
bool RulingsBetween::solve(MovingRuling& m, const Equation& equation) const {
  const MovingRuling start = m;
  const auto begin = [&](const std::array<int, CommonSupport::capacity>& kept) {
    m = start;
    m.at.kept = kept;
  };
  const auto solved = [&] { return system_.solve(m.at, equation) && is_near(start, m); };
  const auto& all_free = CommonSupport().kept;
  begin(start.at.kept);
  if (solved() && is_at_tops(m.at)) return true;
  begin(all_free);
  if (start.at.kept != all_free && solved()) return true;
  begin(all_free);
  return system_.settle(m.at, equation) && is_near(start, m);
}

CommonSupport RulingsBetween::support(const Ruling& r) const {
  CommonSupport s(system_.geometry(), r);
  for (std::size_t i = 0; i < 2; ++i) s.kept[i] = kept_[i];
  return s;
}

/// The rounding of the system's answer, a rounding unit over the cube of the length, is less than
/// what a quadratic misses.
bool RulingsBetween::is_distinct(double length) {
  return length * length * length >= std::sqrt(rounding_unit);
}

/// Derivatives with respect to the share of the chord, which its share in the tangent tells.
bool RulingsBetween::find_speed(MovingRuling& m) const {
  const std::optional<CurveTangent> t = system_.tangent(m.at);
  if (!t) return false;
  const double share = glm::dot(to_.n - from_.n, t->n) +
                       glm::dot(to_.point[0] - from_.point[0], t->x[0]) +
                       glm::dot(to_.point[1] - from_.point[1], t->x[1]);
  const double speed = square_ / share;
  if (!(std::abs(speed) < longest_arc * std::sqrt(square_))) return false;
  m.move(*t, speed);
  return true;
}

/// Derivatives with respect to the share r of the length.
bool RulingsBetween::find_slope(MovingRuling& m, double r) const {
  const std::optional<CurveTangent> t = system_.tangent(m.at);
  if (!t) return false;
  m.move(*t, r * length_ * length_ / glm::dot(m.at.d(), t->x[0] - t->x[1]));
  return true;
}

/// Not another solution, like the one with the contacts exchanged.
bool RulingsBetween::is_near(const MovingRuling& start, const MovingRuling& m) const {
  if (merges() && glm::dot(start.at.d(), m.at.d()) <= 0) return false;
  // Any two contacts in one point are a solution.
  const double least = touches_ ? glm::length(start.at.d()) : shorter_;
  if (!merges() && glm::length(m.at.d()) < least_length * least) return false;
  const double limit = std::max(correction_share * correction_share * square_, rounded * rounded);
  return squared(m.at.n - start.at.n) + squared(m.at.jet[0].x - start.at.jet[0].x) +
             squared(m.at.jet[1].x - start.at.jet[1].x) <=
         limit;
}

MovingRuling RulingsBetween::moving(double r, double sense) const {
  const State value = polynomial_.value(r);
  const State slope = polynomial_.slope(r);
  Ruling ruling = from_;
  MovingRuling m;
  const dvec3 n(value[0], value[1], value[2]);
  ruling.n = glm::normalize(n);
  m.dn = sense / glm::length(n) * dvec3(slope[0], slope[1], slope[2]);
  for (std::size_t i = 0; i < 2; ++i) {
    ruling.contact[i].u = value[3 + 2 * i];
    ruling.contact[i].v = value[4 + 2 * i];
    m.dp[i] = sense * dvec2(slope[3 + 2 * i], slope[4 + 2 * i]);
  }
  m.at = support(ruling);
  m.complete();
  return m;
}

MovingRuling RulingsBetween::interpolated(double s) const {
  return free_end_ == 1 ? moving(1 - s, -1) : moving(s, 1);
}

std::optional<MovingRuling> RulingsBetween::operator()(double s) const {
  MovingRuling m = interpolated(s);
  if (free_end_ < 0) {
    if (!solve_share(m, share(s))) return std::nullopt;
    if (find_speed(m)) m.speed_up(share_slope(s));
    return m;
  }
  const double r = free_end_ == 0 ? s : 1 - s;
  if (r == 0) return m;
  if (r < 0 || !solve_length(m, r)) return std::nullopt;
  return m;
}

std::optional<Ruling> ruling_between(const ContactSystem& system, const Ruling& from,
                                     const Ruling& to, double s) {
  if (s == 0) return from;
  if (s == 1) return to;
  const RulingsBetween between(system, from, to);
  if (between.empty()) return from;
  const std::optional<MovingRuling> m = between(s);
  return m ? std::optional(m->at.ruling()) : std::nullopt;
}

}  // namespace taut
