#pragma once

#include <vector>

#include "taut/hull/decide/direction_map.h"

namespace taut {

/// A curve of directions in which two contacts support at once.
struct MapArc {
  std::vector<int> cells;  ///< that it passes through
  /// The nodes in which it ends; none if it is closed.
  std::vector<int> nodes;
};

/// Directions that are not told apart, with what leaves them.
struct MapNode {
  std::vector<int> cells;
  int arcs = 0;           ///< that end there
  bool is_facet = false;  ///< one of its cells holds the normal of a plane with all that touches
};

/// Regions, arcs and nodes of a direction map.
struct MapTopology {
  int regions = 0;
  std::vector<MapArc> arcs;
  std::vector<MapNode> nodes;
};

/// Puts the cells of a map together. Where two contacts that one cell tells apart are one to that
/// beside it, within the resolution, an arc ends in a node of its own; of what lies between two
/// such ends and is nowhere deeper than the resolution there is no arc. What a side between two
/// cells shows is told from its ends: two arcs that both cross one side, and that no cell tells,
/// are missed.
/// @pre the map is of the geometry @throws Cancelled
MapTopology map_topology(const ContactGeometry& geometry, const DirectionMap& map,
                         const std::stop_token& stop = {});

}  // namespace taut
