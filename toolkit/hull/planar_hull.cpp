#include "taut/hull/planar_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "taut/hull/planar_arcs.h"

namespace taut {
namespace {

constexpr int first_directions = 192;
constexpr int most_rounds = 4;
constexpr int deepest_split = 64;
/// Elements as near to each other share a corner.
constexpr double same_corner = 1e-10;
/// Corners as near to a line are on it.
constexpr double line_width = 1e-12;
/// A smooth joint is known only to about the root of the slack from the heights of both curves.
constexpr double joint_reach = 1e-3;

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }
dvec2 direction(double angle) { return {std::cos(angle), std::sin(angle)}; }
/// Of a side that leads from a to b counter-clockwise.
dvec2 outward(const dvec2& a, const dvec2& b) {
  const dvec2 d = b - a;
  return dvec2(d.y, -d.x) / glm::length(d);
}

/// Where the outline touches the supporting line of a direction.
struct Touch {
  double angle = 0;
  ArcPoint at;
  bool jump = false;  ///< a straight side, or a joint, leads here from the touch before
};

/// Sweeps the supporting line around all, and finds where it goes from one element to another.
class Sweep {
 public:
  Sweep(const PlanarArcs& arcs, std::vector<double> angles)
      : arcs_(arcs), angles_(std::move(angles)) {}

  /// Counter-clockwise; the last one is the first one again.
  std::vector<Touch> touches() {
    std::vector<Touch> starts = start();
    touches_ = {starts.front()};
    for (std::size_t k = 1; k < starts.size(); ++k) between(starts[k - 1], starts[k], 0);
    return std::move(touches_);
  }

 private:
  std::vector<Touch> start() const {
    std::vector<Touch> result;
    result.reserve(angles_.size() + 1);
    int preferred = -1;
    for (const double angle : angles_) {
      result.push_back({angle, arcs_.support(direction(angle), preferred)});
      preferred = result.back().at.arc;
    }
    result.push_back(result.front());
    result.back().angle += 2 * std::numbers::pi;
    return result;
  }

  /// Appends what follows on a, up to b.
  void between(const Touch& a, const Touch& b, int depth) {
    if (depth > deepest_split) {
      touches_.push_back(b);
      touches_.back().jump = true;
    } else if (!is_run(a, b)) {
      cross_over(a, b, depth);
    } else if (const std::optional<Touch> higher = breaks_out(a, b)) {
      between(a, *higher, depth + 1);
      between(*higher, b, depth + 1);
    } else {
      touches_.push_back(b);
    }
  }

  /// The outline goes on along the same curve, or stays in the same point.
  bool is_run(const Touch& a, const Touch& b) const {
    const ConvexArc& from = arcs_[a.at.arc];
    const ConvexArc& to = arcs_[b.at.arc];
    if (a.at.arc == b.at.arc && a.at.t == b.at.t) return true;
    if (from.curve < 0 || from.curve != to.curve || from.t0 == from.t1) return false;
    if (is_same_place(a.at, b.at)) return true;
    const int sense = b.at.t > a.at.t ? 1 : -1;
    double turn = 0;
    const int first = std::min(a.at.arc, b.at.arc);
    const int last = std::max(a.at.arc, b.at.arc);
    for (int k = first; k <= last; ++k) {
      if (arcs_[k].sense == -sense) return false;
      // A cusp between two arcs.
      if (k > first && glm::dot(arcs_[k - 1].last, arcs_[k].first) <= 0) return false;
      if (k > first && k < last) turn += arcs_[k].turn;
    }
    // A spiral may come back to the same direction.
    constexpr double slack = 0.01;
    return turn <= b.angle - a.angle + slack;
  }

  /// On the same curve, but for the rounding of the parameter.
  static bool is_same_place(const ArcPoint& p, const ArcPoint& q) {
    constexpr double parameter_noise = 1e-5;
    return std::abs(p.t - q.t) < parameter_noise && glm::distance(p.x, q.x) < same_corner;
  }

  /// Where another element is farther out than a run in a direction between those of its ends.
  std::optional<Touch> breaks_out(const Touch& a, const Touch& b) const {
    // The supporting lines of the ends leave no room for more.
    constexpr double shortest = 1e-9;
    if (glm::distance(a.at.x, b.at.x) < shortest) return std::nullopt;
    const dvec2 n = outward(a.at.x, b.at.x);
    const double height = std::max(glm::dot(n, a.at.x), glm::dot(n, b.at.x)) + support_slack;
    const auto [first, last] = std::minmax(a.at.arc, b.at.arc);
    for (const int arc : arcs_.beyond(n, height)) {
      if (arc >= first && arc <= last) continue;
      const double angle = farthest_out(a, b, arc);
      const dvec2 m = direction(angle);
      const double gain = glm::dot(m, arcs_.support(arc, m).x) -
                          glm::dot(m, arcs_.support(a.at.arc, b.at.arc, m).x);
      if (gain > support_slack) return Touch{angle, arcs_.support(m, -1)};
    }
    return std::nullopt;
  }

  /// The direction between a and b in which an arc is farthest above the run, or least below.
  double farthest_out(const Touch& a, const Touch& b, int arc) const {
    // The slope of a support function is the touch's coordinate along the supporting line.
    const auto slope = [&](double angle) {
      const dvec2 n = direction(angle);
      const dvec2 d = arcs_.support(arc, n).x - arcs_.support(a.at.arc, b.at.arc, n).x;
      return cross(n, d);
    };
    constexpr double flat = 1e-14;
    double lower = a.angle;
    double upper = b.angle;
    if (slope(lower) <= flat) return lower;
    if (slope(upper) >= -flat) return upper;
    while (upper - lower > flat) {
      const double middle = 0.5 * (lower + upper);
      if (middle <= lower || middle >= upper) break;
      (slope(middle) > 0 ? lower : upper) = middle;
    }
    return 0.5 * (lower + upper);
  }

  /// From one arc to another one, or over the hollow side of one.
  void cross_over(const Touch& a, const Touch& b, int depth) {
    const bool hollow = a.at.arc == b.at.arc;
    const double angle = hollow ? chord_angle(a, b) : common_height(a, b);
    const dvec2 n = direction(angle);
    const Touch p = {angle, hollow ? a.at : arcs_.support(a.at.arc, n)};
    const Touch q = {angle, hollow ? b.at : arcs_.support(b.at.arc, n), true};
    const ArcPoint all = arcs_.support(n, a.at.arc);
    const double height = std::max(glm::dot(n, p.at.x), glm::dot(n, q.at.x));
    if (glm::dot(n, all.x) > height + support_slack && angle > a.angle && angle < b.angle) {
      const Touch middle = {angle, all};
      between(a, middle, depth + 1);
      between(middle, b, depth + 1);
      return;
    }
    // Within the interval an arc may have been touched in its other end.
    between(a, p, depth + 1);
    touches_.push_back(q);
    between(q, b, depth + 1);
  }

  /// The direction of the side from a to b.
  static double chord_angle(const Touch& a, const Touch& b) {
    const dvec2 n = outward(a.at.x, b.at.x);
    const dvec2 start = direction(a.angle);
    const double turn = std::atan2(cross(start, n), glm::dot(start, n));
    return std::clamp(a.angle + turn, a.angle, b.angle);
  }

  /// The direction in which the arcs of a and b are equally far. @pre they are the farthest in
  /// those of a and b
  double common_height(const Touch& a, const Touch& b) const {
    double lower = a.angle;
    double upper = b.angle;
    double angle = 0.5 * (lower + upper);
    constexpr int most_steps = 100;
    for (int step = 0; step < most_steps; ++step) {
      const dvec2 n = direction(angle);
      const dvec2 d = arcs_.support(a.at.arc, n).x - arcs_.support(b.at.arc, n).x;
      const double lead = glm::dot(n, d);
      (lead > 0 ? lower : upper) = angle;
      double next = angle - lead / cross(n, d);
      if (!(next > lower && next < upper)) next = 0.5 * (lower + upper);
      const double moved = std::abs(next - angle);
      angle = next;
      if (moved <= 2 * std::numeric_limits<double>::epsilon()) break;
    }
    return angle;
  }

  const PlanarArcs& arcs_;
  std::vector<double> angles_;
  std::vector<Touch> touches_;
};

/// What lies between two jumps: a part of a curve, or a single corner.
struct Stretch {
  int point = -1;
  int curve = -1;
  bool smooth = false;  ///< on a curve that is not straight
  double from = 0;
  double to = 0;
  dvec2 start = dvec2(0);
  dvec2 end = dvec2(0);
  bool corner = false;      ///< of no length
  bool joint = false;       ///< the next stretch begins where this one ends
  dvec2 normal = dvec2(0);  ///< of the side to the next one
};

/// The outline as a closed chain of stretches.
class Chain {
 public:
  Chain(const PlanarArcs& arcs, std::span<const dvec2> points, const std::vector<Touch>& touches)
      : arcs_(arcs), points_(points) {
    collect(touches);
    for (std::size_t k = 0; k < chain_.size(); ++k) connect(k);
    for (Stretch& s : chain_) s.corner = has_no_length(s);
    drop_doubles();
  }

  /// Normals of sides that do not support all.
  std::vector<dvec2> failures() const;
  /// Leaves corners out that are on a line with their neighbours.
  void drop_collinear();
  std::vector<OutlineSide> sides() const;

 private:
  void collect(const std::vector<Touch>& touches);
  void add(const Touch& touch);
  std::size_t next(std::size_t k) const { return (k + 1) % chain_.size(); }
  std::size_t previous(std::size_t k) const { return (k + chain_.size() - 1) % chain_.size(); }
  void connect(std::size_t k);
  bool join(Stretch& a, Stretch& b) const;
  /// A part of the stretch's curve.
  bool stays_above(const Stretch& s, double from, double to, const dvec2& n, double height) const;
  bool join_at(Stretch& a, Stretch& b, double ta, double tb) const;
  void polish(Stretch& a, Stretch& b) const;
  dvec2 at(const Stretch& s, double t) const;
  double nearest(const Stretch& s, double t, const dvec2& x) const;
  std::optional<double> end_near(const Stretch& s, double t) const;
  bool is_tangent(const Stretch& s, double t, const dvec2& d) const;
  bool has_no_length(const Stretch& s) const;
  void drop_doubles();
  bool is_between(std::size_t k) const;
  bool supports(const dvec2& n, const dvec2& x) const;
  OutlineSide corner_of(const Stretch& s, bool end) const;

  const PlanarArcs& arcs_;
  std::span<const dvec2> points_;
  std::vector<Stretch> chain_;
};

void Chain::collect(const std::vector<Touch>& touches) {
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
  chain_.back().normal = direction(touches[first].angle);
}

void Chain::add(const Touch& touch) {
  // The jump's direction belongs to the stretch before it.
  if (!chain_.empty()) chain_.back().normal = direction(touch.angle);
  const ConvexArc& arc = arcs_[touch.at.arc];
  Stretch s;
  s.point = arc.point;
  s.curve = arc.curve;
  s.smooth = arc.t0 < arc.t1;
  s.from = s.to = touch.at.t;
  s.start = s.end = touch.at.x;
  chain_.push_back(s);
}

dvec2 Chain::at(const Stretch& s, double t) const {
  return s.point >= 0 ? points_[std::size_t(s.point)] : planar_jet(arcs_.curve(s.curve), t).c;
}

/// The parameter of the curve's point nearest to x; Newton's method.
double Chain::nearest(const Stretch& s, double t, const dvec2& x) const {
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
std::optional<double> Chain::end_near(const Stretch& s, double t) const {
  if (!s.smooth) return t;
  const double end = t < 0.5 ? 0 : 1;
  if (glm::distance(at(s, end), at(s, t)) > joint_reach) return std::nullopt;
  return end;
}

bool Chain::stays_above(const Stretch& s, double from, double to, const dvec2& n,
                        double height) const {
  if (!s.smooth) return glm::dot(n, at(s, to)) >= height;
  const std::vector<dvec2> polygon = part_polygon(arcs_.curve(s.curve), from, to);
  return std::all_of(polygon.begin(), polygon.end(),
                     [&](const dvec2& p) { return glm::dot(n, p) >= height; });
}

bool Chain::join_at(Stretch& a, Stretch& b, double ta, double tb) const {
  const dvec2 xa = at(a, ta);
  const dvec2 xb = at(b, tb);
  if (glm::distance(xa, xb) > same_corner) return false;
  // A side over a notch or a hollow is no joint.
  const dvec2& n = a.normal;
  const double least = std::max(glm::dot(n, a.end), glm::dot(n, b.start)) - 4 * support_slack;
  if (!stays_above(a, a.to, ta, n, least) || !stays_above(b, b.from, tb, n, least)) return false;
  a.to = ta;
  a.end = xa;
  b.from = tb;
  b.start = xb;
  return true;
}

bool Chain::join(Stretch& a, Stretch& b) const {
  if (glm::distance(a.end, b.start) > joint_reach) return false;
  const std::optional<double> ta = end_near(a, a.to);
  const std::optional<double> tb = end_near(b, b.from);
  if (ta && tb && join_at(a, b, *ta, *tb)) return true;
  if (ta && join_at(a, b, *ta, nearest(b, b.from, at(a, *ta)))) return true;
  if (tb && join_at(a, b, nearest(a, a.to, at(b, *tb)), *tb)) return true;
  return join_at(a, b, a.to, b.from);
}

/// The line in direction d through the point at t is a tangent, not held by the curve's end.
bool Chain::is_tangent(const Stretch& s, double t, const dvec2& d) const {
  if (!s.smooth) return false;
  if (t > 0 && t < 1) return true;
  const dvec2 ct = planar_jet(arcs_.curve(s.curve), t).ct;
  constexpr double aligned = 1e-7;
  return std::abs(cross(ct, d)) < aligned * glm::length(ct) * glm::length(d);
}

/// Newton's method for the tangent points of a straight side; keeps what is there where it fails.
void Chain::polish(Stretch& a, Stretch& b) const {
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
void Chain::connect(std::size_t k) {
  if (chain_.size() < 2 && !chain_[k].smooth) return;
  Stretch& a = chain_[k];
  Stretch& b = chain_[next(k)];
  a.joint = join(a, b);
  if (!a.joint) polish(a, b);
}

bool Chain::has_no_length(const Stretch& s) const {
  if (!s.smooth || s.from == s.to) return true;
  const std::vector<dvec2> polygon = part_polygon(arcs_.curve(s.curve), s.from, s.to);
  return std::all_of(polygon.begin(), polygon.end(),
                     [&](const dvec2& p) { return glm::distance(p, polygon[0]) < same_corner; });
}

/// Drops single corners that are a joint's.
void Chain::drop_doubles() {
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

bool Chain::supports(const dvec2& n, const dvec2& x) const {
  return glm::dot(n, arcs_.support(n, -1).x) <= glm::dot(n, x) + support_slack;
}

std::vector<dvec2> Chain::failures() const {
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
bool Chain::is_between(std::size_t k) const {
  const Stretch& s = chain_[k];
  if (chain_[previous(k)].joint || s.joint) return false;
  const dvec2 a = chain_[previous(k)].end;
  const dvec2 d = chain_[next(k)].start - a;
  const auto on_line = [&](const dvec2& x) {
    const double along = glm::dot(x - a, d);
    return along >= 0 && along <= glm::dot(d, d) &&
           std::abs(cross(d, x - a)) <= line_width * glm::length(d);
  };
  if (s.corner) return on_line(s.start);
  const std::vector<dvec2> polygon = part_polygon(arcs_.curve(s.curve), s.from, s.to);
  return std::all_of(polygon.begin(), polygon.end(), on_line);
}

void Chain::drop_collinear() {
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

OutlineSide Chain::corner_of(const Stretch& s, bool end) const {
  OutlineSide side;
  side.point = s.point;
  side.curve = s.curve;
  side.t = end ? s.to : s.from;
  side.x = end ? s.end : s.start;
  if (s.corner) {
    const auto same = [&](const dvec2& p) { return glm::distance(p, side.x) <= same_corner; };
    const auto point = std::find_if(points_.begin(), points_.end(), same);
    if (point != points_.end()) {
      side.point = int(point - points_.begin());
      side.curve = -1;
      side.t = 0;
      side.x = *point;
    }
  }
  return side;
}

std::vector<OutlineSide> Chain::sides() const {
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

/// Irregular, so that symmetric models have no ties there.
std::vector<double> regular_angles(int count) {
  constexpr double offset = 0.3711;
  std::vector<double> angles;
  angles.reserve(std::size_t(count));
  for (int k = 0; k < count; ++k) angles.push_back(2 * std::numbers::pi * (k + offset) / count);
  return angles;
}

void leave_out_inside(PlanarArcs& arcs) {
  constexpr int corners = 32;
  std::vector<dvec2> polygon;
  polygon.reserve(corners);
  int preferred = -1;
  for (const double angle : regular_angles(corners)) {
    const ArcPoint p = arcs.support(direction(angle), preferred);
    preferred = p.arc;
    if (polygon.empty() || p.x != polygon.back()) polygon.push_back(p.x);
  }
  while (polygon.size() > 1 && polygon.back() == polygon.front()) polygon.pop_back();
  arcs.leave_out_inside(polygon);
}

}  // namespace

PlanarHull planar_hull(std::span<const dvec2> points, std::span<const std::vector<dvec3>> curves) {
  PlanarArcs arcs(points, curves);
  PlanarHull hull;
  if (arcs.empty()) return hull;
  leave_out_inside(arcs);
  std::vector<double> more;
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<double> angles = regular_angles(first_directions << round);
    angles.insert(angles.end(), more.begin(), more.end());
    std::sort(angles.begin(), angles.end());
    Chain chain(arcs, points, Sweep(arcs, std::move(angles)).touches());
    const std::vector<dvec2> failures = chain.failures();
    chain.drop_collinear();
    hull.sides = chain.sides();
    hull.verified = failures.empty();
    if (hull.verified) break;
    for (const dvec2& n : failures) {
      const double angle = std::atan2(n.y, n.x);
      more.push_back(angle < 0 ? angle + 2 * std::numbers::pi : angle);
    }
  }
  return hull;
}

}  // namespace taut
