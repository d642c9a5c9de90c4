#include "taut/hull/planar/outline_chain.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace taut {
namespace {

/// Corners as near to a line are on it.
constexpr double width_of_line = 1e-12;
/// A smooth joint is known only to about the root of the slack from the heights of both curves.
constexpr double joint_reach = 1e-3;

}  // namespace

OutlineChain::OutlineChain(const PlanarArcs& arcs, std::span<const dvec2> points,
                           const std::vector<Touch>& touches)
    : arcs_(arcs), points_(points), points_by_x_(points.size()) {
  std::iota(points_by_x_.begin(), points_by_x_.end(), 0);
  std::stable_sort(points_by_x_.begin(), points_by_x_.end(), [&](int a, int b) {
    return points[std::size_t(a)].x < points[std::size_t(b)].x;
  });
  collect(touches);
  for (std::size_t k = 0; k < chain_.size(); ++k) connect(k);
  for (Stretch& s : chain_) s.corner = has_no_length(s);
  drop_doubles();
}

void OutlineChain::collect(const std::vector<Touch>& touches) {
  // The last touch is the first one again: begin behind a jump.
  const std::size_t count = touches.size() - 1;
  std::size_t first = 0;
  while (first < count && !touches[first].jump) ++first;
  chain_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = (first + i) % count;
    const Touch& touch = touches[k == 0 ? count : k];
    if (i > 0 && !touch.jump) {
      chain_.back().to = touch.at.t;
      chain_.back().end = touch.at.x;
    } else {
      add(touch);
    }
  }
  chain_.back().normal = direction_at(touches[first].angle);
}

void OutlineChain::add(const Touch& touch) {
  // The jump's direction belongs to the stretch before it.
  if (!chain_.empty()) chain_.back().normal = direction_at(touch.angle);
  const ConvexArc& arc = arcs_[touch.at.arc];
  Stretch s;
  s.point = arc.point;
  s.curve = arc.curve;
  s.smooth = arc.t0 < arc.t1;
  s.from = s.to = touch.at.t;
  s.start = s.end = touch.at.x;
  chain_.push_back(s);
}

dvec2 OutlineChain::at(const Stretch& s, double t) const {
  return s.point >= 0 ? points_[std::size_t(s.point)] : planar_jet(arcs_.curve(s.curve), t).c;
}

/// The parameter of the curve's point nearest to x; Newton's method.
double OutlineChain::nearest(const Stretch& s, double t, const dvec2& x) const {
  if (!s.smooth) return t;
  constexpr int steps = 20;
  for (int step = 0; step < steps; ++step) {
    const PlanarJet jet = planar_jet(arcs_.curve(s.curve), t);
    const double speed = glm::dot(jet.ct, jet.ct);
    if (speed == 0) break;
    t = std::clamp(t - glm::dot(jet.c - x, jet.ct) / speed, 0.0, 1.0);
  }
  return t;
}

/// The end of the stretch's curve, where it is near a parameter; a single point is its own end.
std::optional<double> OutlineChain::end_near(const Stretch& s, double t) const {
  if (!s.smooth) return t;
  const double end = t < 0.5 ? 0 : 1;
  if (glm::distance(at(s, end), at(s, t)) > joint_reach) return std::nullopt;
  return end;
}

bool OutlineChain::stays_above(const Stretch& s, double from, double to, const dvec2& n,
                               double height) const {
  if (!s.smooth) return glm::dot(n, at(s, to)) >= height;
  const std::vector<dvec2> polygon = part_polygon(arcs_.curve(s.curve), from, to);
  return std::all_of(polygon.begin(), polygon.end(),
                     [&](const dvec2& p) { return glm::dot(n, p) >= height; });
}

bool OutlineChain::join_at(Stretch& a, Stretch& b, double ta, double tb) const {
  const dvec2 xa = at(a, ta);
  const dvec2 xb = at(b, tb);
  if (glm::distance(xa, xb) > same_corner) return false;
  // A side over a notch or a hollow is no joint.
  const dvec2& n = a.normal;
  const double least = std::max(glm::dot(n, a.end), glm::dot(n, b.start)) - 4 * planar_slack;
  if (!stays_above(a, a.to, ta, n, least) || !stays_above(b, b.from, tb, n, least)) return false;
  a.to = ta;
  a.end = xa;
  b.from = tb;
  b.start = xb;
  return true;
}

bool OutlineChain::join(Stretch& a, Stretch& b) const {
  if (glm::distance(a.end, b.start) > joint_reach) return false;
  const std::optional<double> ta = end_near(a, a.to);
  const std::optional<double> tb = end_near(b, b.from);
  if (ta && tb && join_at(a, b, *ta, *tb)) return true;
  if (ta && join_at(a, b, *ta, nearest(b, b.from, at(a, *ta)))) return true;
  if (tb && join_at(a, b, nearest(a, a.to, at(b, *tb)), *tb)) return true;
  return join_at(a, b, a.to, b.from);
}

/// The line in direction d through the point at t is a tangent, not held by the curve's end.
bool OutlineChain::is_tangent(const Stretch& s, double t, const dvec2& d) const {
  if (!s.smooth) return false;
  if (t > 0 && t < 1) return true;
  const dvec2 ct = planar_jet(arcs_.curve(s.curve), t).ct;
  constexpr double aligned = 1e-7;
  return std::abs(cross(ct, d)) < aligned * glm::length(ct) * glm::length(d);
}

/// Newton's method for the tangent points of a straight side; keeps what is there where it fails.
void OutlineChain::polish(Stretch& a, Stretch& b) const {
  double ta = a.to;
  double tb = b.from;
  bool free_a = is_tangent(a, ta, b.start - a.end);
  bool free_b = is_tangent(b, tb, b.start - a.end);
  constexpr int steps = 12;
  for (int step = 0; step < steps && (free_a || free_b); ++step) {
    const PlanarJet p = free_a ? planar_jet(arcs_.curve(a.curve), ta) : PlanarJet{a.end, {}, {}};
    const PlanarJet q = free_b ? planar_jet(arcs_.curve(b.curve), tb) : PlanarJet{b.start, {}, {}};
    const dvec2 d = q.c - p.c;
    // Rows: d x p' = 0 and d x q' = 0; an end that is held has a row of the identity.
    const double aa = free_a ? cross(d, p.ctt) : 1;
    const double ab = free_a ? cross(q.ct, p.ct) : 0;
    const double ba = free_b ? -cross(p.ct, q.ct) : 0;
    const double bb = free_b ? cross(d, q.ctt) : 1;
    const double fa = free_a ? cross(d, p.ct) : 0;
    const double fb = free_b ? cross(d, q.ct) : 0;
    const double area = aa * bb - ab * ba;
    const double next_a = ta - (fa * bb - ab * fb) / area;
    const double next_b = tb - (aa * fb - ba * fa) / area;
    constexpr double largest_move = 1e-4;
    const auto near = [](double s, double t) { return std::abs(s - t) < largest_move; };
    if (!near(next_a, a.to) || !near(next_b, b.from)) return;
    ta = std::clamp(next_a, 0.0, 1.0);
    tb = std::clamp(next_b, 0.0, 1.0);
    free_a = free_a && ta == next_a;
    free_b = free_b && tb == next_b;
  }
  a.to = ta;
  b.from = tb;
  a.end = at(a, ta);
  b.start = at(b, tb);
}

/// Makes the straight side, or the joint, behind a stretch exact.
void OutlineChain::connect(std::size_t k) {
  arcs_.check_stop();
  if (chain_.size() < 2 && !chain_[k].smooth) return;
  Stretch& a = chain_[k];
  Stretch& b = chain_[next(k)];
  a.joint = join(a, b);
  if (!a.joint) polish(a, b);
}

bool OutlineChain::has_no_length(const Stretch& s) const {
  if (!s.smooth || s.from == s.to) return true;
  const std::vector<dvec2> polygon = part_polygon(arcs_.curve(s.curve), s.from, s.to);
  return std::all_of(polygon.begin(), polygon.end(),
                     [&](const dvec2& p) { return glm::distance(p, polygon[0]) < same_corner; });
}

/// Drops single corners that are a joint's.
void OutlineChain::drop_doubles() {
  for (std::size_t k = 0; k < chain_.size() && chain_.size() > 1;) {
    Stretch& before = chain_[previous(k)];
    const Stretch& s = chain_[k];
    if (!s.corner || !(before.joint || s.joint)) {
      ++k;
      continue;
    }
    // The side that stays is the one that is not the joint.
    if (before.joint) {
      before.joint = s.joint;
      before.normal = s.normal;
    }
    chain_.erase(chain_.begin() + std::ptrdiff_t(k));
  }
}

bool OutlineChain::supports(const dvec2& n, const dvec2& x) const {
  return glm::dot(n, arcs_.support(n, -1).x) <= glm::dot(n, x) + planar_slack;
}

std::vector<dvec2> OutlineChain::failures() const {
  std::vector<dvec2> result;
  if (chain_.size() < 2 && chain_[0].corner) return result;
  const auto check = [&](const dvec2& n, const dvec2& x) {
    if (!supports(n, x)) result.push_back(n);
  };
  for (std::size_t k = 0; k < chain_.size(); ++k) {
    const Stretch& s = chain_[k];
    if (!s.joint) check(outward(s.end, chain_[next(k)].start), s.end);
    if (s.corner) continue;
    constexpr int places = 9;
    for (int i = 1; i < places; ++i) {
      const double t = s.from + (s.to - s.from) * i / places;
      const PlanarJet jet = planar_jet(arcs_.curve(s.curve), t);
      check(outward(dvec2(0), s.to > s.from ? jet.ct : -jet.ct), jet.c);
    }
  }
  return result;
}

/// A stretch with straight sides on both hands lies on the line of its neighbours.
bool OutlineChain::is_between(std::size_t k) const {
  const Stretch& s = chain_[k];
  if (chain_[previous(k)].joint || s.joint) return false;
  const dvec2 a = chain_[previous(k)].end;
  const dvec2 d = chain_[next(k)].start - a;
  const auto on_line = [&](const dvec2& x) {
    const double along = glm::dot(x - a, d);
    return along >= 0 && along <= glm::dot(d, d) &&
           std::abs(cross(d, x - a)) <= width_of_line * glm::length(d);
  };
  if (s.corner) return on_line(s.start);
  const std::vector<dvec2> polygon = part_polygon(arcs_.curve(s.curve), s.from, s.to);
  return std::all_of(polygon.begin(), polygon.end(), on_line);
}

void OutlineChain::drop_collinear() {
  for (std::size_t k = 0; k < chain_.size() && chain_.size() > 2;) {
    if (!is_between(k)) {
      ++k;
      continue;
    }
    chain_.erase(chain_.begin() + std::ptrdiff_t(k));
    k = (k + chain_.size() - 1) % chain_.size();
    polish(chain_[k], chain_[next(k)]);
    k = previous(k);
  }
}

/// The point of the lowest number that is the same corner.
std::optional<int> OutlineChain::point_at(const dvec2& x) const {
  const auto begins_before = [&](int k, double least) { return points_[std::size_t(k)].x < least; };
  auto k = std::lower_bound(points_by_x_.begin(), points_by_x_.end(), x.x - 2 * same_corner,
                            begins_before);
  std::optional<int> lowest;
  for (; k != points_by_x_.end() && points_[std::size_t(*k)].x <= x.x + 2 * same_corner; ++k) {
    const bool same = glm::distance(points_[std::size_t(*k)], x) <= same_corner;
    if (same && (!lowest || *k < *lowest)) lowest = *k;
  }
  return lowest;
}

OutlineSide OutlineChain::corner_of(const Stretch& s, bool end) const {
  arcs_.check_stop();
  OutlineSide side;
  side.point = s.point;
  side.curve = s.curve;
  side.t = end ? s.to : s.from;
  side.x = end ? s.end : s.start;
  if (!s.corner) return side;
  if (const std::optional<int> point = point_at(side.x)) {
    side.point = *point;
    side.curve = -1;
    side.t = 0;
    side.x = points_[std::size_t(*point)];
  }
  return side;
}

std::vector<OutlineSide> OutlineChain::sides() const {
  std::vector<OutlineSide> result;
  result.reserve(2 * chain_.size());
  for (const Stretch& s : chain_) {
    if (!s.corner) {
      result.push_back(corner_of(s, false));
      result.back().along = s.curve;
      result.back().from = s.from;
      result.back().to = s.to;
    }
    if (!s.joint) result.push_back(corner_of(s, true));
  }
  return result;
}

}  // namespace taut
