#include "taut/hull/model_points.h"

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

}  // namespace

ModelPoints::ModelPoints(const Model& model) : model_(model) {
  const Box box = model.control_box();
  dvec3 reach = glm::max(glm::abs(box.lower), glm::abs(box.upper));
  scale_ = scale_for(std::max({reach.x, reach.y, reach.z}));
  reach *= scale_;
  reach_ = reach.x + reach.y + reach.z;
  diagonal_ = taut::diagonal({scale_ * box.lower, scale_ * box.upper});
  int count = 0;
  for (const Instance& instance : model.instances()) {
    first_.push_back(count);
    count += part_of(instance).point_count();
  }
  if (scale_ == 1 && model.instances().size() == 1 && model.instances().front().pose.at_rest()) {
    points_ = part_of(model.instances().front()).vertices();
    return;
  }
  moved_.reserve(std::size_t(count));
  for (const Instance& instance : model.instances()) {
    const bool moves = !instance.pose.at_rest();
    any_moved_ = any_moved_ || moves;
    for (const dvec3& x : part_of(instance).vertices()) {
      moved_.push_back(scale_ * (moves ? instance.pose(x) : x));
    }
  }
  points_ = moved_;
}

double ModelPoints::placement_bound() const {
  return any_moved_ ? coordinate_rounding * reach_ : 0;
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
