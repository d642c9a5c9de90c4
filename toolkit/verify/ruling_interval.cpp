#include "taut/verify/ruling_interval.h"

#include <algorithm>
#include <cmath>

namespace taut {

RulingState operator+(const RulingState& a, const RulingState& b) {
  return {a.n + b.n, {a.t[0] + b.t[0], a.t[1] + b.t[1]}};
}

RulingState operator-(const RulingState& a, const RulingState& b) {
  return {a.n - b.n, {a.t[0] - b.t[0], a.t[1] - b.t[1]}};
}

RulingState operator*(double factor, const RulingState& a) {
  return {factor * a.n, {factor * a.t[0], factor * a.t[1]}};
}

double dot(const RulingState& a, const RulingState& b) {
  return glm::dot(a.n, b.n) + glm::dot(a.t[0], b.t[0]) + glm::dot(a.t[1], b.t[1]);
}

double length(const RulingState& a) { return std::sqrt(dot(a, a)); }

void RulingPanel::add(double s, const RulingState& state) {
  nodes_.push_back(s);
  states_.push_back(state);
}

/// Lagrange's form and its derivative.
std::array<RulingState, 2> RulingPanel::through(std::size_t stride, double s) const {
  RulingState value, slope;
  for (std::size_t i = 0; i < nodes_.size(); i += stride) {
    double weight = 1;
    double weight_slope = 0;
    for (std::size_t j = 0; j < nodes_.size(); j += stride) {
      if (j == i) continue;
      const double step = 1 / (nodes_[i] - nodes_[j]);
      weight_slope = (weight_slope * (s - nodes_[j]) + weight) * step;
      weight *= (s - nodes_[j]) * step;
    }
    value = value + weight * states_[i];
    slope = slope + weight_slope * states_[i];
  }
  return {value, slope};
}

std::array<RulingState, 2> RulingInterval::at(double s, Fit fit) const {
  const auto panel = std::find_if(panels.begin(), panels.end() - 1,
                                  [&](const RulingPanel& p) { return s <= p.to; });
  return panel->at(s, fit);
}

}  // namespace taut
