#pragma once

#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/gauss_map.h"
#include "taut/hull/cull/culling.h"
#include "taut/hull/decide/direction_map.h"
#include "taut/hull/result/hull_boundary.h"
#include "taut/hull/result/hull_options.h"
#include "taut/hull/result/hull_statistics.h"
#include "taut/hull/result/sample.h"

namespace taut {

/// What a scene's exact boundary begins with: the scene sampled and culled over the Gauss map. Adds
/// what it took to the statistics.
/// @pre the map is the scene's @throws Cancelled
Culling culling_of(const Scene& scene, const GaussMap& map, const HullOptions& options,
                   HullStatistics& statistics);

/// Elements that miss each other by no more, in the scene's frame, are told as one.
double same_elements_of(const Scene& scene, const HullOptions& options);

/// The map of a scene's directions, at the resolution that the options or the model ask for. Where
/// contacts all but tie it costs more than models do to decide it, and it is left undecided. Adds
/// what it took to the statistics.
/// @throws Cancelled
DirectionMap directions_of(const ContactGeometry& geometry, const HullOptions& options,
                           HullStatistics& statistics);

/// The exact boundary of a scene's convex hull: its separating curves traced, stitched. Adds what
/// it took to the statistics.
///
/// Every ruling and facet supports the model to within support_tie (1e-12) of the scene's size,
/// more where coordinates are rounded to more (ContactGeometry::tie), by a support query each; so
/// do the rulings of length zero in free ends, but where these are of no generic kind and
/// extrapolated: there to within the third power of merge_distance (6e-8). Curves are sought
/// between what culling samples and `more` samples, and where the map of directions tells more
/// (map_differences) there, too; in mixed cells where the map does not decide. What could not be
/// resolved, or differs from the map still, is listed (HullBoundary::unresolved); a boundary
/// without any is closed. Same result for any number of threads.
///
/// With CurveMethod::solving the curves come from the map alone, and arcs, scrolls and facets that
/// do not support as exactly say by how much they do not (ArcPiece::tolerant, HullFace::tolerant);
/// patches, by a grid of places. Where no closed boundary to within the resolution is found so,
/// maps at finer ones are asked, down to a 64th.
/// @pre the culling and the map are of the geometry's scene, which spans space (tolerances.h says
/// what is flat)
/// @throws Cancelled
HullBoundary exact_boundary(const ContactGeometry& geometry, const Culling& culling,
                            const DirectionMap& directions, const HullOptions& options,
                            HullStatistics& statistics, const std::vector<Sample>& more = {});
/// The boundary from the beginning: culling and the map of directions first. @pre the map is the
/// scene's, which spans space
HullBoundary exact_boundary(const Scene& scene, const GaussMap& map, const HullOptions& options,
                            HullStatistics& statistics);

}  // namespace taut
