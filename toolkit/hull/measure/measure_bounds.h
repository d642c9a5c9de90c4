#pragma once

#include "taut/hull/measure/boundary_measures.h"

namespace taut {

/// How far places of a boundary that state that they are `tolerant` may be below the supporting
/// planes, in its frame: by the tie, below which nothing is stated, all may.
double place_depth(const HullBoundary& boundary, double tolerant);

/// What measures of a boundary are made of, in the scene's frame.
struct MeasuredLengths {
  double volume = 0;
  double area = 0;
  double mean_width = 0;
  /// Integral over the faces of how far the true hull may be from them.
  double layer = 0;
  /// Distance of the farthest point of the hull from the centroid, at most.
  double radius = 0;
  double diagonal = 0;
  /// The largest moment of inertia about an axis of the frame.
  double inertia = 0;
};

/// Bounds for what places may be below the supporting planes (HullFace::tolerant) and what the hull
/// may reach beyond all of them (HullBoundary::gap); relative errors of the integrals themselves
/// come on top. @pre the volume is positive
MeasureBounds measure_bounds(const HullBoundary& boundary, const MeasuredLengths& lengths);

}  // namespace taut
