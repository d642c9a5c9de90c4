#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "taut/verify/document_geometry.h"

namespace taut {

/// A curve's parameter with the distance of its point from another one.
struct ClosestOnCurve {
  double s = 0;
  double distance = std::numeric_limits<double>::infinity();
};

/// Shares of the farthest sample's distance that are none: what is so near is the nearest.
inline constexpr double no_distance = 1e-13;

/// The point of a curve over [from, to] (or [to, from]) that is nearest to p, by Newton's method
/// from the samples that are nearer than those beside them, the nearest first, with steps halved
/// that lead away; from more samples where none leads to p itself, though p is no farther from one
/// than these are from each other. `jet(s)` is a SourceJet whose first parameter is the curve's.
template <class Jet>
ClosestOnCurve closest_on_curve(const dvec3& p, double from, double to, const Jet& jet) {
  constexpr int steps = 30;
  constexpr int halvings = 12;
  const auto at = [&](double s) { return ClosestOnCurve{s, glm::distance(jet(s).x, p)}; };
  const auto nearer = [](const ClosestOnCurve& a, const ClosestOnCurve& b) {
    return a.distance < b.distance;
  };
  const auto approach = [&](ClosestOnCurve own) {
    for (int i = 0; i < steps; ++i) {
      const SourceJet j = jet(own.s);
      const dvec3 off = j.x - p;
      const double square = glm::dot(j.dx[0], j.dx[0]);
      const double second = square + glm::dot(off, j.dxx);
      // Where the curve bends towards p as if it were straight.
      double step = glm::dot(off, j.dx[0]) / (second > 0 ? second : square);
      const double before = own.distance;
      for (int k = 0; k < halvings && !(own.distance < before); ++k, step *= 0.5) {
        const double s = std::clamp(own.s - step, std::min(from, to), std::max(from, to));
        own = std::min(own, at(s), nearer);
      }
      if (!(own.distance < before)) break;
    }
    return own;
  };
  ClosestOnCurve best;
  for (const int parts : {16, 64, 1024}) {
    std::vector<ClosestOnCurve> sample;
    double apart = 0;  // neighbours, at most
    dvec3 last(0.0);
    for (int i = 0; i <= parts; ++i) {
      const double s = from + (to - from) * i / parts;
      const dvec3 x = jet(s).x;
      if (i > 0) apart = std::max(apart, glm::distance(last, x));
      last = x;
      sample.push_back({s, glm::distance(x, p)});
    }
    std::vector<ClosestOnCurve> starts;
    for (std::size_t i = 0; i < sample.size(); ++i) {
      if (i > 0 && nearer(sample[i - 1], sample[i])) continue;
      if (i + 1 < sample.size() && nearer(sample[i + 1], sample[i])) continue;
      starts.push_back(sample[i]);
    }
    std::sort(starts.begin(), starts.end(), nearer);
    const double none =
        no_distance * std::max_element(sample.begin(), sample.end(), nearer)->distance;
    for (const ClosestOnCurve& start : starts) {
      if (start.distance > best.distance + apart) break;
      best = std::min(best, approach(start), nearer);
      if (best.distance <= none) return best;
    }
    if (starts.front().distance > apart) break;
  }
  return best;
}

}  // namespace taut
