#pragma once

#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/decide/direction_map.h"
#include "taut/hull/result/hull_boundary.h"
#include "taut/hull/result/sample.h"

namespace taut {

/// Where a boundary is not what the map of its model's directions tells.
struct MapDifferences {
  std::vector<Unresolved> spots;
  /// What supports there, for a search that begins with it.
  std::vector<Sample> samples;
};

/// Compares a boundary with the map cell by cell, as far as the map is decided:
/// - what supports in the middle of a cell lies on a face, or some place of the boundary comes
///   within the resolution of its plane;
/// - where two contacts exchange, a scroll runs between them, or a facet holds both;
/// - where all that touches lies in one plane, a facet or a ruling does, or a patch touches it;
/// and both contacts of a ruling lie in its plane, which supports in the middle of a curve's
/// pieces.
///
/// The map is certain to within its resolution, and so is what is told, but for what polygons
/// through the rulings of arcs and the outlines of regions leave open.
/// @pre both are of the query's scene @throws Cancelled
MapDifferences map_differences(const ContactGeometry& geometry, SupportQuery& query,
                               const DirectionMap& map, const HullBoundary& boundary);

}  // namespace taut
