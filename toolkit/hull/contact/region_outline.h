#pragma once

#include <vector>

#include "taut/hull/contact/contact_system.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// How long an outline's sides are at most, in parameters, but for straight ones: how far it is
/// off its curves, rather.
inline constexpr double outline_slack = 0.05;

/// The loops of a region in (u, v), as polygons through rulings of arcs: those that are stored,
/// and between two of them that are far apart others.
using RegionOutline = std::vector<std::vector<dvec2>>;
RegionOutline outline_of(const ContactSystem& system, const HullBoundary& boundary,
                         const PatchRegion& region);

/// Distance from the outline, negative outside.
double depth_in(const RegionOutline& outline, const dvec2& uv);

}  // namespace taut
