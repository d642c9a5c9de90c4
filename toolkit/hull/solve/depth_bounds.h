#pragma once

#include <algorithm>

namespace taut {

/// What the deepest of some places below supporting planes tells of the others, in the scene's
/// frame.
class DepthBounds {
 public:
  /// How many times deeper it may be beside the deepest place, where it was looked closer: what a
  /// parabola over the last steps tops it by.
  static constexpr double near_places = 1.001;

  /// How often the step to the places next to the deepest one is halved.
  static constexpr int closer_looks = 5;

  /// `tie`: up to which heights tie.
  DepthBounds(double tie, double resolution) : tie_(tie), resolution_(resolution) {}

  double tie() const { return tie_; }
  double resolution() const { return resolution_; }
  /// What is so deep: none, if that is not known from none and contacts are where planes touch.
  double known(double deepest, bool touches = true) const {
    if (deepest <= tie_) return touches ? 0 : tie_;
    return deepest;
  }
  /// Elsewhere it may be deeper, as far as that is within the resolution.
  double elsewhere(double deepest, bool touches = true) const {
    const double own = known(deepest, touches);
    return std::max(near_places * own, std::min(other_places * own, resolution_));
  }

 private:
  /// How many times deeper it may be elsewhere than in the deepest place that was found.
  static constexpr double other_places = 1.25;

  double tie_;
  double resolution_;
};

}  // namespace taut
