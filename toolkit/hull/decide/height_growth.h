#pragma once

#include <algorithm>

#include "taut/hull/decide/cell_view.h"

namespace taut {

/// Of homogeneous points and vectors from them: the heights surely grow along all the vectors, for
/// points between the points.
class HeightGrowth {
 public:
  /// Along vectors of length one by more than `tilt`. The view must outlive it.
  explicit HeightGrowth(const CellView& view, double tilt = 0) : view_(view), tilt_(tilt) {
    lower_.fill(infinity);
    upper_.fill(-infinity);
  }
  void include(const dvec4& point) {
    const Corners y = heights(point, view_.q(), view_.corners());
    for (std::size_t c = 0; c < 4; ++c) {
      lower_[c] = std::min(lower_[c], y[c] / point.w);
      upper_[c] = std::max(upper_[c], y[c] / point.w);
    }
  }
  bool along(const dvec4& vector) const {
    const Corners y = heights(vector, view_.q(), view_.corners());
    const double least = view_.noise() + (tilt_ > 0 ? tilt_ * glm::length(dvec3(vector)) : 0);
    for (std::size_t c = 0; c < 4; ++c) {
      if (!(y[c] - (vector.w > 0 ? upper_[c] : lower_[c]) * vector.w > least)) return false;
    }
    return true;
  }

 private:
  const CellView& view_;
  double tilt_;
  Corners lower_, upper_;
};

}  // namespace taut
