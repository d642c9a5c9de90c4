#pragma once

#include <set>

#include "taut/hull/decide/map_graph.h"

namespace taut {

/// Leaves out arcs, and nodes that are nothing without them; and joins arcs that pass through nodes
/// in which nothing ends: two alone, or each two that follow each other there between the same
/// contacts. (Of three contacts whose support functions have independent gradients, each two
/// exchange along one curve, and these meet in three or pass each other.)
/// @pre the graph is the map's
void remove_arcs(MapGraph& graph, const DirectionMap& map, const std::set<int>& arcs);

/// The arcs that end in a node go on into each other: two alone, or as remove_arcs() says.
/// @pre the graph is the map's
bool arcs_pass(MapGraph& graph, const DirectionMap& map, const MapGraph::Node& node);

/// Makes one node of the two that each of the arcs leads between, and leaves the arcs out, those
/// that lead from a node to itself, too.
/// @pre the graph is the map's; none of the arcs is closed
void contract_arcs(MapGraph& graph, const DirectionMap& map, const std::set<int>& arcs);

}  // namespace taut
