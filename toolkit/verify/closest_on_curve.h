#pragma once

#include <algorithm>
#include <limits>

#include "taut/verify/document_geometry.h"

namespace taut {

/// A curve's parameter with the distance of its point from another one.
struct ClosestOnCurve {
  double s = 0;
  double distance = std::numeric_limits<double>::infinity();
};

/// The point of a curve over [from, to] (or [to, from]) that is nearest to p, by Newton's method
/// from the nearest of some samples, with steps halved that lead away. `jet(s)` is a SourceJet
/// whose first parameter is the curve's.
template <class Jet>
ClosestOnCurve closest_on_curve(const dvec3& p, double from, double to, const Jet& jet) {
  constexpr int samples = 16;
  constexpr int steps = 30;
  constexpr int halvings = 8;
  ClosestOnCurve best;
  const auto consider = [&](double s) {
    const double distance = glm::distance(jet(s).x, p);
    if (distance < best.distance) best = {s, distance};
  };
  for (int i = 0; i <= samples; ++i) consider(from + (to - from) * i / samples);
  for (int i = 0; i < steps; ++i) {
    const SourceJet j = jet(best.s);
    const dvec3 off = j.x - p;
    const double square = glm::dot(j.dx[0], j.dx[0]);
    const double second = square + glm::dot(off, j.dxx);
    // Where the curve bends towards p as if it were straight.
    double step = glm::dot(off, j.dx[0]) / (second > 0 ? second : square);
    const double before = best.distance;
    for (int k = 0; k < halvings && !(best.distance < before); ++k, step *= 0.5) {
      consider(std::clamp(best.s - step, std::min(from, to), std::max(from, to)));
    }
    if (!(best.distance < before)) break;
  }
  return best;
}

}  // namespace taut
