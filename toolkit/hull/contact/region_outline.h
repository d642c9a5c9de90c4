#pragma once

#include <vector>

#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// How far outlines, as polygons through rulings, mostly run from the curves at most, in
/// parameters; it is no bound: between two rulings that are far apart it may be more.
inline constexpr double outline_slack = 0.05;

/// The loops of a region in (u, v), as polygons through the rulings of arcs.
using RegionOutline = std::vector<std::vector<dvec2>>;
RegionOutline outline_of(const HullBoundary& boundary, const PatchRegion& region);

/// Distance from the outline, negative outside.
double depth_in(const RegionOutline& outline, const dvec2& uv);

}  // namespace taut
