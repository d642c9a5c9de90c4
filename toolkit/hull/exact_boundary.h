#pragma once

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/decide/direction_map.h"
#include "taut/hull/result/hull_boundary.h"
#include "taut/hull/result/hull_options.h"
#include "taut/hull/result/hull_statistics.h"

namespace taut {

/// Elements that miss each other by no more, in the scene's frame, are told as one.
double same_elements_of(const Scene& scene, const HullOptions& options);

/// The map of a scene's directions, at the resolution that the options or the model ask for. Where
/// contacts all but tie it costs more than models do to decide it, and it is left undecided. Adds
/// what it took to the statistics.
/// @throws Cancelled
DirectionMap directions_of(const ContactGeometry& geometry, const HullOptions& options,
                           HullStatistics& statistics);

/// Where a map that is left undecided does not do, whether one that takes ten times as long is
/// asked.
enum class MapEffort { usual, thorough };

/// The exact boundary of a scene's convex hull: its separating curves, solved from the map of
/// directions, stitched. Adds what it took to the statistics.
///
/// Every ruling and facet supports the model to within support_tie (1e-12) of the scene's size,
/// more where coordinates are rounded to more (ContactGeometry::tie), by a support query each, or
/// says by how much it does not (ArcPiece::tolerant, HullFace::tolerant); patches, by a grid of
/// places. What could not be resolved is listed (HullBoundary::unresolved); a boundary without any
/// is closed. Where no closed boundary to within the resolution is found, a map is decided to the
/// end that was not, as far as the effort goes, or maps at finer ones are asked, down to a 64th.
/// Same result for any number of threads.
/// @pre the map is of the geometry's scene, which spans space (tolerances.h says what is flat)
/// @throws Cancelled
HullBoundary exact_boundary(const ContactGeometry& geometry, const DirectionMap& directions,
                            const HullOptions& options, HullStatistics& statistics,
                            MapEffort effort = MapEffort::thorough);
/// The same from the beginning, the map of directions first. @pre the scene spans space
HullBoundary exact_boundary(const Scene& scene, const HullOptions& options,
                            HullStatistics& statistics);

}  // namespace taut
