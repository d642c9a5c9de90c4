#pragma once

#include <functional>
#include <set>

#include "taut/hull/decide/map_graph.h"

namespace taut {

/// Whether arcs between the same two contacts, more than two, end in a node, as in a crossing, or
/// pass it in pairs: the map does not tell.
using IsCrossing = std::function<bool(const MapGraph::Node&)>;

/// Leaves out arcs, and nodes that are nothing without them; and joins arcs that pass through nodes
/// in which nothing ends: two alone, or each two that follow each other there between the same
/// contacts. (Of three contacts whose support functions have independent gradients, each two
/// exchange along one curve, and these meet in three or pass each other.)
/// @pre the graph is the map's
void remove_arcs(MapGraph& graph, const DirectionMap& map, const std::set<int>& arcs,
                 const IsCrossing& is_crossing);

/// The arcs that end in a node go on into each other: two alone, or as remove_arcs() says.
/// @pre the graph is the map's
bool arcs_pass(MapGraph& graph, const DirectionMap& map, const MapGraph::Node& node);

/// Makes one node of the two that each of the arcs leads between, and leaves the arcs out, those
/// that lead from a node to itself, too.
/// @pre the graph is the map's; none of the arcs is closed
void contract_arcs(MapGraph& graph, const DirectionMap& map, const std::set<int>& arcs,
                   const IsCrossing& is_crossing);

/// Cuts arcs where they pass from cell to cell at places that are none of theirs: each part between
/// two such ends there in nodes of its own. Ends of arcs that are such stay.
void cut_arcs(MapGraph& graph, const std::function<bool(const MapCrossing&)>& is_none);

}  // namespace taut
