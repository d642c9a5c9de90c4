#include "taut/hull/planar/planar_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace taut {
namespace {

constexpr int deepest_split = 64;

class Sweep {
 public:
  Sweep(const PlanarArcs& arcs, const std::vector<double>& angles) : arcs_(arcs), angles_(angles) {}

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
      result.push_back({angle, arcs_.support(direction_at(angle), preferred)});
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
    const double height = std::max(glm::dot(n, a.at.x), glm::dot(n, b.at.x)) + planar_slack;
    const auto [first, last] = std::minmax(a.at.arc, b.at.arc);
    for (const int arc : arcs_.beyond(n, height)) {
      if (arc >= first && arc <= last) continue;
      const double angle = farthest_out(a, b, arc);
      const dvec2 m = direction_at(angle);
      const double gain = glm::dot(m, arcs_.support(arc, m).x) -
                          glm::dot(m, arcs_.support(a.at.arc, b.at.arc, m).x);
      if (gain > planar_slack) return Touch{angle, arcs_.support(m, -1)};
    }
    return std::nullopt;
  }

  /// The direction between a and b in which an arc is farthest above the run, or least below.
  double farthest_out(const Touch& a, const Touch& b, int arc) const {
    // The slope of a support function is the touch's coordinate along the supporting line.
    const auto slope = [&](double angle) {
      const dvec2 n = direction_at(angle);
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
    const dvec2 n = direction_at(angle);
    const Touch p = {angle, hollow ? a.at : arcs_.support(a.at.arc, n)};
    const Touch q = {angle, hollow ? b.at : arcs_.support(b.at.arc, n), true};
    const ArcPoint all = arcs_.support(n, a.at.arc);
    const double height = std::max(glm::dot(n, p.at.x), glm::dot(n, q.at.x));
    if (glm::dot(n, all.x) > height + planar_slack && angle > a.angle && angle < b.angle) {
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
    const dvec2 start = direction_at(a.angle);
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
      const dvec2 n = direction_at(angle);
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
  const std::vector<double>& angles_;
  std::vector<Touch> touches_;
};

}  // namespace

std::vector<Touch> swept_touches(const PlanarArcs& arcs, const std::vector<double>& angles) {
  return Sweep(arcs, angles).touches();
}

}  // namespace taut
