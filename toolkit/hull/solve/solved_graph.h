#pragma once

#include "taut/bounds/support_query.h"
#include "taut/core/progress.h"
#include "taut/hull/decide/direction_map.h"
#include "taut/hull/solve/separating_graph.h"

namespace taut {

/// Beyond so many units of the resolution places on edges stay apart, whatever rounding does.
inline constexpr double most_place_depths = 8;

/// The separating curves of a scene's support function, from its map of directions: where the map
/// tells that arcs pass from cell to cell their rulings are found by bracketed Newton's method, and
/// others between; where arcs meet, their common plane; where one ends, its free end. Places on
/// edges that are no farther from each other than `place_depths` units of the resolution are one.
/// Reports the step "trace".
/// @pre the map is of the geometry @throws Cancelled
SeparatingGraph solved_graph(const ContactGeometry& geometry, SupportQuery& query,
                             const DirectionMap& map, const Progress& progress = {},
                             double place_depths = most_place_depths);

}  // namespace taut
