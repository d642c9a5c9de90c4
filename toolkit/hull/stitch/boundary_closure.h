#pragma once

#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// Adds to HullBoundary::unresolved what keeps the boundary from being closed: every curve without
/// two faces, facets that are segments or whose corners run the wrong way around and, where nothing
/// else is unresolved, a face whose curves do not close up, faces that do not hang together, or an
/// Euler characteristic other than the sphere's. Ends of curves nearer than `distance` are one.
void check_closure(HullBoundary& boundary, double distance);

}  // namespace taut
