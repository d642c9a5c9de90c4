#pragma once

#include <algorithm>
#include <limits>

#include "taut/io/document_geometry.h"

namespace taut {

/// The distance of p from a surface over [0, 1]^2, by Newton's method from the nearest of some
/// samples. `jet(t)` is the surface's SourceJet.
template <class Jet>
double distance_to_surface(const dvec3& p, const Jet& jet) {
  constexpr int samples = 8;
  constexpr int steps = 16;
  dvec2 t(0.0);
  double best = std::numeric_limits<double>::infinity();
  const auto consider = [&](const dvec2& at) {
    const double distance = glm::distance(jet(at).x, p);
    if (!(distance < best)) return;
    best = distance;
    t = at;
  };
  for (int i = 0; i <= samples; ++i) {
    for (int k = 0; k <= samples; ++k) consider(dvec2(i, k) / double(samples));
  }
  dvec2 now = t;
  for (int i = 0; i < steps; ++i) {
    const SourceJet j = jet(now);
    const dvec3 off = j.x - p;
    // Gauss and Newton's: the distances that matter are zero, where the second derivatives count
    // for nothing.
    const double E = glm::dot(j.dx[0], j.dx[0]);
    const double F = glm::dot(j.dx[0], j.dx[1]);
    const double G = glm::dot(j.dx[1], j.dx[1]);
    const dvec2 slope(glm::dot(off, j.dx[0]), glm::dot(off, j.dx[1]));
    const double determinant = E * G - F * F;
    if (!(determinant > 0)) break;
    const dvec2 step(G * slope.x - F * slope.y, E * slope.y - F * slope.x);
    now = glm::clamp(now - step / determinant, dvec2(0.0), dvec2(1.0));
    consider(now);
  }
  return best;
}

}  // namespace taut
