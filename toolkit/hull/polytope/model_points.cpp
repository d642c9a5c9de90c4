#include "taut/hull/polytope/model_points.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Sizes at which no product of three coordinates leaves the range of doubles.
constexpr int safe_exponent = 200;

double scale_for(double largest) {
  int exponent = 0;
  std::frexp(largest, &exponent);
  if (largest == 0 || std::abs(exponent) <= safe_exponent) return 1;
  return std::ldexp(1.0, std::min(-exponent, 1023));
}

double reach_of(const dvec3& largest) { return largest.x + largest.y + largest.z; }

}  // namespace

ModelPoints::ModelPoints(const Model& model) : model_(model) {
  int count = 0;
  for (const Instance& instance : model.instances()) {
    first_.push_back(count);
    count += part_of(instance).point_count();
  }
  const Box box = model.control_box();
  const dvec3 largest = glm::max(glm::abs(box.lower), glm::abs(box.upper));
  scale_ = scale_for(std::max({largest.x, largest.y, largest.z}));
  if (!place()) {
    product_scale_ = scale_;
    scale_ = 1;
    place();
  }
  reach_ = reach_of(scale_ * largest);
  diagonal_ = taut::diagonal({scale_ * box.lower, scale_ * box.upper});
  for (const Instance& instance : model.instances()) {
    if (instance.pose.at_rest()) continue;
    // What cancels in the sums has been rounded all the same.
    const Box& own = part_of(instance).control_box();
    if (own.empty()) continue;
    const double reach = reach_of(scale_ * glm::max(glm::abs(own.lower), glm::abs(own.upper))) +
                         reach_of(scale_ * glm::abs(instance.pose.translation));
    placement_bound_ = std::max(placement_bound_, coordinate_rounding * reach);
  }
}

bool ModelPoints::place() {
  if (scale_ == 1 && model_.instances().size() == 1 && model_.instances().front().pose.at_rest()) {
    points_ = part_of(model_.instances().front()).vertices();
    return true;
  }
  bool exact = true;
  moved_.clear();
  for (const Instance& instance : model_.instances()) {
    const bool moves = !instance.pose.at_rest();
    for (const dvec3& x : part_of(instance).vertices()) {
      const dvec3 p = moves ? instance.pose(x) : x;
      moved_.push_back(scale_ * p);
      exact = exact && moved_.back() / scale_ == p;
    }
  }
  points_ = moved_;
  return exact;
}

dvec3 ModelPoints::model_point(int point) const {
  const Source place = place_of(point);
  const Instance& instance = model_.instances()[std::size_t(place.instance)];
  const dvec3& x = part_of(instance).vertices()[std::size_t(place.index)];
  return instance.pose.at_rest() ? x : instance.pose(x);
}

Source ModelPoints::place_of(int point) const {
  const auto next = std::upper_bound(first_.begin(), first_.end(), point);
  const auto instance = std::size_t(next - first_.begin()) - 1;
  return {SourceKind::vertex, int(instance), point - first_[instance]};
}

}  // namespace taut
