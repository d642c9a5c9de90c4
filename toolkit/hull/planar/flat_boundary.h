#pragma once

#include <optional>

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// What a flat scene reaches across its plane, as heights x . n in the scene's frame.
struct FlatExtent {
  dvec3 n = dvec3(0.0);  ///< unit
  double middle = 0;
  double half_width = 0;  ///< 0: nothing but rounding
};

/// The exact boundary of a planar hull: one facet, seen from along n, whose outline is stretches of
/// the model's edges and segments, and these curves, which have it to the left.
///
/// What keeps the outline from being simpler by no more than `rho`, in the scene's frame, what the
/// scene reaches across its plane included, is left out: corners and bent edges that are as near to
/// a straight side, and dents between pieces of an edge. Corners are contacts where they are, and
/// the facet is tolerant by the scene's width, and by how far its outline is from the
/// hull's.
///
/// Where faces fold over beyond their borders, the outline goes through places of these that are so
/// near to each other that none is beyond it by more than rho.
///
/// None where that takes more than some hundred thousand places, or there is no area.
/// @pre the scene reaches no farther than rho across the plane
std::optional<HullBoundary> flat_boundary(const ContactGeometry& geometry, SupportQuery& query,
                                          const FlatExtent& extent, double rho);

}  // namespace taut
