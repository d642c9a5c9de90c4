#pragma once

#include <algorithm>

#include "taut/core/geometry.h"

namespace taut {

/// The least and the largest of Bernstein coefficients, between which all values are; of none,
/// upside down.
struct CoefficientRange {
  double lower = infinity;
  double upper = -infinity;
  void include(double x) {
    lower = std::min(lower, x);
    upper = std::max(upper, x);
  }
  bool has_zero(double noise) const { return lower <= noise && upper >= -noise; }
};

}  // namespace taut
