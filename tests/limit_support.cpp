#include "limit_support.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace taut_test {

namespace {

using taut::infinity;

/// Faces of a level beyond which refinement gives up.
constexpr std::size_t most_faces = 3000;
/// About a vertex of high valence a level gains little.
constexpr int most_levels = 80;

}  // namespace

LimitSupport::Level::Level(RefinedCage refined) : cage(std::move(refined)) {
  const std::vector<LimitPoint> all = cage.limits();
  std::vector<bool> taken(all.size());
  for (const int f : cage.faces()) {
    const auto corners = cage.level().GetFaceVertices(f);
    for (int k = 0; k < corners.size(); ++k) {
      const auto v = std::size_t(corners[k]);
      if (taken[v]) continue;
      taken[v] = true;
      if (cage.has_limit(corners[k])) limits.push_back(all[v]);
    }
  }
}

LimitSupport::LimitSupport(const ControlCage& cage, int levels)
    : start_(RefinedCage(cage, levels)), simple_(start_.cage.has_simple_edges()) {}

double LimitSupport::highest_limit(const Level& level, const dvec3& n) {
  double most = -infinity;
  for (const LimitPoint& p : level.limits) most = std::max(most, glm::dot(p.x, n));
  return most;
}

/// For each face the highest control point of the faces that touch it.
std::vector<double> LimitSupport::reaches(const Level& level, const dvec3& n) {
  const auto topology = level.cage.level();
  const std::vector<dvec3>& points = level.cage.points();
  std::vector<double> height(points.size());
  for (std::size_t v = 0; v < points.size(); ++v) height[v] = glm::dot(points[v], n);
  std::vector<double> around(points.size(), -infinity);
  for (int f = 0; f < topology.GetNumFaces(); ++f) {
    const auto corners = topology.GetFaceVertices(f);
    double most = -infinity;
    for (int k = 0; k < corners.size(); ++k) most = std::max(most, height[std::size_t(corners[k])]);
    for (int k = 0; k < corners.size(); ++k) {
      double& reach = around[std::size_t(corners[k])];
      reach = std::max(reach, most);
    }
  }
  std::vector<double> result;
  result.reserve(level.cage.faces().size());
  for (const int f : level.cage.faces()) {
    const auto corners = topology.GetFaceVertices(f);
    double most = -infinity;
    for (int k = 0; k < corners.size(); ++k) most = std::max(most, around[std::size_t(corners[k])]);
    result.push_back(most);
  }
  return result;
}

SupportRange LimitSupport::operator()(const dvec3& n, double accuracy) const {
  double lower = -infinity;
  const Level* level = &start_;
  std::optional<Level> local;
  for (int k = 0;; ++k) {
    lower = std::max(lower, highest_limit(*level, n));
    const std::vector<double> reach = reaches(*level, n);
    std::vector<int> higher;
    double upper = lower;
    for (std::size_t i = 0; i < reach.size(); ++i) {
      if (reach[i] <= lower) continue;
      higher.push_back(level->cage.faces()[i]);
      upper = std::max(upper, reach[i]);
    }
    if (!simple_ || upper - lower <= accuracy || k == most_levels || higher.size() > most_faces) {
      return {lower, upper};
    }
    local = Level(level->cage.refined(higher));
    level = &*local;
  }
}

}  // namespace taut_test
