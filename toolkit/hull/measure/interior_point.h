#pragma once

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// The mean of points on the boundary that span the hull, so a point inside, in the scene's frame;
/// the origin where the boundary is empty.
dvec3 interior_point(const ContactGeometry& geometry, const HullBoundary& boundary);

}  // namespace taut
