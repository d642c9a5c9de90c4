#include "taut/hull/measure/measure_bounds.h"

#include <algorithm>
#include <numbers>

#include "taut/core/tolerances.h"
#include "taut/hull/measure/facet_integrals.h"

namespace taut {

double MeasureBounds::largest() const {
  return std::max({volume, area, mean_width, centroid, inertia});
}

double place_depth(const HullBoundary& boundary, double tolerant) {
  return std::max(tolerant, tie_share * boundary.gap);
}

/// K is the true hull with the support function h, B the boundary and R what it bounds, d the
/// depths h(n) - x . n of its points x with their normals n, at most D. R lies in K.
MeasureBounds measure_bounds(const HullBoundary& boundary, const MeasuredLengths& lengths) {
  constexpr double pi = std::numbers::pi;
  const double w = lengths.mean_width;
  // A polyhedron is convex, and lacks no more than the gap. Of others, made of pieces that meet
  // within D, normals may turn back and points ripple within D.
  const bool convex = is_polyhedron(boundary);
  const double D = convex ? boundary.gap : std::max(boundary.gap, deepest_tolerant(boundary));
  const double folds = convex ? 1 : 2;

  MeasureBounds bounds;
  // From a point of K outside of R to the nearest one x of B, the way is along a normal of B at x,
  // and so no longer than d. Such points fill the layer, to first order, and no more than what
  // Steiner's formula has for D beyond that.
  const double between = lengths.layer + D * D * (2 * pi * w + 4 * pi / 3 * D);
  bounds.volume = lengths.volume > 0 ? between / lengths.volume : 1;
  // The hull of B and a ball of radius D contain K; Steiner's formula tells that body's area.
  // Ripples t <= D of B have an area of int |grad t|^2 / 2 <= D int |H|, no more than that again.
  bounds.area = folds * 4 * pi * D * (w + D) / lengths.area;
  // Mean width is int h / (2 pi) over all directions, that of B int x . n over its normals, which
  // is less by int d <= 4 pi D, for normals that turn back and forth at most twice that.
  bounds.mean_width = folds * 2 * D / w;
  // What is between has its own centroid no farther off than the radius.
  bounds.centroid = bounds.volume * lengths.radius / lengths.diagonal;
  const double inertia = between * lengths.radius * lengths.radius;
  bounds.inertia = lengths.inertia > 0 ? inertia / lengths.inertia : 1;
  return bounds;
}

}  // namespace taut
