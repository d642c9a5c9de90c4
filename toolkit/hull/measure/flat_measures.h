#pragma once

#include "taut/hull/measure/boundary_measures.h"

namespace taut {

/// Measures of a planar hull, in model units: the area of one side, its centroid, and as mean width
/// a quarter of its perimeter. Volume and inertia are zero.
/// @pre boundary.dimension == 2
BoundaryMeasures flat_measures(const ContactGeometry& geometry, const HullBoundary& boundary);

}  // namespace taut
