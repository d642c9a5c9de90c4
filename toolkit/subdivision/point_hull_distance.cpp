#include "taut/subdivision/point_hull_distance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <utility>
#include <vector>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

Eigen::Vector3d vector(const dvec3& p) { return {p.x, p.y, p.z}; }

/// The corral of Wolfe's algorithm: points with their barycentric weights.
struct Corral {
  dvec3 origin;
  std::vector<dvec3> points;
  std::vector<double> weights;

  /// From the origin to the point of these weights.
  dvec3 sum() const {
    dvec3 x(0.0);
    for (std::size_t i = 0; i < points.size(); ++i) x += weights[i] * (points[i] - origin);
    return x;
  }

  /// Weights of the point of the affine hull that is nearest to the origin. By the differences of
  /// points, not by their products, which would tell distances to the root of rounding only.
  std::vector<double> affine_minimizer() const {
    const auto n = static_cast<Eigen::Index>(points.size()) - 1;
    Eigen::Matrix3Xd differences(3, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      differences.col(i) = vector(points[std::size_t(i) + 1] - points[0]);
    }
    const Eigen::VectorXd solution =
        differences.colPivHouseholderQr().solve(vector(origin - points[0]));
    std::vector<double> result = {1 - solution.sum()};
    result.insert(result.end(), solution.begin(), solution.end());
    return result;
  }

  /// Moves towards the weights until one of them vanishes, and drops its point; false if none does.
  bool step_towards(const std::vector<double>& to) {
    double share = 1;
    for (std::size_t i = 0; i < to.size(); ++i) {
      if (to[i] <= 0) share = std::min(share, weights[i] / (weights[i] - to[i]));
    }
    const bool whole = std::all_of(to.begin(), to.end(), [](double w) { return w > 0; });
    for (std::size_t i = 0; i < to.size(); ++i) weights[i] += share * (to[i] - weights[i]);
    if (whole) return false;
    const auto least = std::min_element(weights.begin(), weights.end());
    points.erase(points.begin() + (least - weights.begin()));
    weights.erase(least);
    return true;
  }
};

/// From the point p + x towards q it is nearer to p, by more than rounding.
bool descends(const dvec3& p, const dvec3& x, const dvec3& q) {
  const double rounding = 16 * rounding_unit * glm::length(x) * glm::distance(p, q);
  return glm::dot(q - p, x) < glm::dot(x, x) - rounding;
}

}  // namespace

double PointHullDistance::bound(const dvec3& p, double enough) {
  constexpr int step_limit = 64;
  constexpr std::size_t most_recent = 24;
  const dvec3 nearest = points_.nearest(p);
  std::vector<dvec3> untried = recent_;  // each once: it may seem to descend by rounding
  std::erase(untried, nearest);
  Corral corral{p, {nearest}, {1.0}};
  dvec3 x = corral.sum();
  const auto rounding_of = [&](const dvec3& q) {
    return 16 * rounding_unit * (glm::length(p) + glm::length(q));
  };
  double rounding = rounding_of(nearest);
  double best = glm::length(x);
  for (int step = 0; step < step_limit && best > 0 && best + rounding > enough; ++step) {
    const auto lowest = std::min_element(
        untried.begin(), untried.end(),
        [&](const dvec3& a, const dvec3& b) { return glm::dot(a, x) < glm::dot(b, x); });
    const bool known = lowest != untried.end() && descends(p, x, *lowest);
    const dvec3 q = known ? *lowest : points_.lowest(x);
    if (!descends(p, x, q)) break;
    if (known) {
      untried.erase(lowest);
    } else {
      std::erase(recent_, q);
      if (recent_.size() == most_recent) recent_.erase(recent_.begin());
      recent_.push_back(q);
    }
    Corral next = corral;
    next.points.push_back(q);
    next.weights.push_back(0);
    while (next.points.size() > 1 && next.step_towards(next.affine_minimizer())) {
    }
    if (next.points.size() == 1) next.weights[0] = 1;
    const dvec3 to = next.sum();
    if (glm::length(to) < best) {
      corral = std::move(next);
      x = to;
      best = glm::length(x);
      rounding = std::max(rounding, rounding_of(q));
    } else if (!known) {
      break;
    }
  }
  return best + rounding;
}

}  // namespace taut
