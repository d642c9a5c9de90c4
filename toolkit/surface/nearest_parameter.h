#pragma once

#include "taut/surface/bezier.h"

namespace taut {

/// The parameter in [0, 1] of the curve's point that is nearest to x, which lies near the curve: by
/// Newton's method, to rounding, from the nearest of a few samples a degree.
double nearest_parameter(const BezierCurve& curve, const dvec3& x);

}  // namespace taut
