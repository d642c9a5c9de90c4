#pragma once

#include "taut/bounds/support_query.h"
#include "taut/core/progress.h"
#include "taut/hull/decide/direction_map.h"
#include "taut/hull/solve/separating_graph.h"

namespace taut {

/// The separating curves of a scene's support function, from its map of directions: where the map
/// tells that arcs pass from cell to cell their rulings are found by bracketed Newton's method, and
/// others between; where arcs meet, their common plane; where one ends, its free end.
/// @pre the map is of the geometry @throws Cancelled
SeparatingGraph solved_graph(const ContactGeometry& geometry, SupportQuery& query,
                             const DirectionMap& map, const Progress& progress = {});

}  // namespace taut
