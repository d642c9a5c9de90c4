#include "taut/surface/nearest_parameter.h"

#include <algorithm>
#include <cmath>

#include "taut/core/tolerances.h"

namespace taut {

double nearest_parameter(const BezierCurve& curve, const dvec3& x) {
  const int samples = 4 * curve.degree();
  double t = 0;
  for (int k = 1; k <= samples; ++k) {
    const double s = double(k) / samples;
    if (glm::distance(point(curve, s), x) < glm::distance(point(curve, t), x)) t = s;
  }
  constexpr int step_limit = 20;
  for (int k = 0; k < step_limit; ++k) {
    const CurveJet j = jet(curve, t);
    const double bend = glm::dot(j.ct, j.ct) + glm::dot(j.c - x, j.ctt);
    if (!(bend > 0)) break;
    const double next = std::clamp(t - glm::dot(j.c - x, j.ct) / bend, 0.0, 1.0);
    const bool still = std::abs(next - t) <= rounding_unit;
    t = next;
    if (still) break;
  }
  return t;
}

}  // namespace taut
