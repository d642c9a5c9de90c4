#pragma once

#include "taut/hull/result/hull.h"
#include "taut/hull/result/hull_options.h"
#include "taut/surface/model.h"

namespace taut {

/// Convex hull of points and polygons: its vertices are points of the input as they stand.
///
/// Exact up to the rounding that the input's coordinates carry: of points that stick out less than
/// coordinate_rounding (tolerances.h), in directions in which coordinates have such digits
/// (rounding_width), and no farther than spurious_share of the diagonal, only
/// enough are kept that no others reach farther than that above any facet, and distance_bound says
/// how far that is; points_left_out tells how many are not. A turned cube of points so has twelve
/// triangles or six squares and a turned polygon is planar, whatever rounding did to them. Where
/// nothing of the kind is there, always where the points are as close as their rounding, where a
/// vertex has too many neighbours for the search (ten thousand and more), and where the options ask
/// for the resolution 0, the hull is exact. It is exactly convex and has no face of zero area in
/// any case. The tolerance does not matter.
///
/// Duplicates, points within and empty parts change nothing. Same bits for any number of threads.
/// Faces carry as source the first polygon that lies in them and touches a corner of their hull
/// face.
/// @pre model.polyhedral() @throws InvalidInput if the tolerance or the resolution is not valid,
/// LimitMet for limits (HullOptions), since before the end there is no hull; Cancelled
Hull polyhedral_hull(const Model& model, const HullOptions& options = {});

}  // namespace taut
