#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "taut/core/progress.h"
#include "taut/subdivision/cage_level.h"

namespace taut {

/// What stands for the cells of a region changes the support function of it and of known points by
/// no more than this, which may be anything over `enough` if it is more than that, unless the least
/// that can be said is asked for. Known are points that are on both.
///
/// Both the caps and the limit surface are within the convex hulls of their control points: neither
/// is farther from the convex hull of the known points than those are. Where that is not enough,
/// and there are sharp sides or the least is asked for, they are compared with each other: the one
/// is no farther than its control points from the convex hull of the known points and points of the
/// other. Of the limit surface this is asked of the patches of the levels below, down to where what
/// is left of the region is small. Control points on creases, farther out than these by their own
/// curvature, do not count: creases are the sides of the caps beside them but for what is added,
/// and a patch is within the convex hull of its side along one and its other control points.
/// @pre no cell has more than four sides @throws Cancelled
double region_bound(const CageLevel& level, std::span<const std::size_t> region,
                    const std::vector<CellPatch>& patches, const std::vector<dvec3>& known,
                    double enough, const Progress& progress, bool least = false);

/// Places in the patch's net of the control points of a side, from a corner to the next.
std::vector<std::size_t> side_points(const CellPatch& patch, std::size_t side);

}  // namespace taut
