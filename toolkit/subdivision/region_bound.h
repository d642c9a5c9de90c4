#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "taut/subdivision/cage_level.h"

namespace taut {

/// What stands for the cells of a region, and their limit surface itself, are no farther than this
/// from the convex hull of points that are on both; if it is more than `enough`, something between,
/// unless the least that can be said is asked for. Such points are those known, and those of the
/// region's creases, which are the sides of the caps beside them but for what is added.
///
/// Both are within the convex hulls of their control points. Those on a crease, farther out than it
/// by its own curvature, do not count: a patch is within the convex hull of its side along the
/// crease and its other control points. Of the limit surface this is asked of the patches of the
/// levels below, down to where what is left of the region is small; so is it for the least that can
/// be said of regions without sharp sides.
/// @pre no cell has more than four sides
double region_bound(const CageLevel& level, std::span<const std::size_t> region,
                    const std::vector<CellPatch>& patches, std::vector<dvec3> known, double enough,
                    bool least = false);

/// Places in the patch's net of the control points of a side, from a corner to the next.
std::vector<std::size_t> side_points(const CellPatch& patch, std::size_t side);

}  // namespace taut
