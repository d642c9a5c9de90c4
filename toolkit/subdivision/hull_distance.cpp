#include "taut/subdivision/hull_distance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

Eigen::Vector3d vector(const dvec3& p) { return {p.x, p.y, p.z}; }

/// The corral of Wolfe's algorithm: points with their barycentric weights.
struct Corral {
  std::vector<dvec3> points;
  std::vector<double> weights;

  dvec3 sum() const {
    dvec3 x(0.0);
    for (std::size_t i = 0; i < points.size(); ++i) x += weights[i] * points[i];
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
    const Eigen::VectorXd solution = differences.colPivHouseholderQr().solve(-vector(points[0]));
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

}  // namespace

double distance_from_hull_bound(const dvec3& p, const PointTree& points, double enough) {
  constexpr int step_limit = 64;
  const dvec3 nearest = points.nearest(p);
  Corral corral{{nearest - p}, {1.0}};
  dvec3 x = corral.sum();
  const auto rounding_of = [&](const dvec3& q) {
    return 16 * rounding_unit * (glm::length(p) + glm::length(q));
  };
  double rounding = rounding_of(nearest);
  double best = glm::length(x);
  for (int step = 0; step < step_limit && best > 0 && best + rounding > enough; ++step) {
    const dvec3 lowest = points.lowest(x);
    const dvec3 q = lowest - p;
    if (glm::dot(q, x) >= glm::dot(x, x) * (1 - 64 * rounding_unit)) break;
    rounding = std::max(rounding, rounding_of(lowest));
    corral.points.push_back(q);
    corral.weights.push_back(0);
    while (corral.points.size() > 1 && corral.step_towards(corral.affine_minimizer())) {
    }
    if (corral.points.size() == 1) corral.weights[0] = 1;
    x = corral.sum();
    if (!(glm::length(x) < best)) break;
    best = glm::length(x);
  }
  return best + rounding;
}

}  // namespace taut
