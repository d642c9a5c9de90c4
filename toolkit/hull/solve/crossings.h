#pragma once

#include <optional>
#include <vector>

#include "taut/hull/solve/known_arcs.h"
#include "taut/hull/solve/ruling_search.h"
#include "taut/hull/solve/separating_graph.h"

namespace taut {

/// Where surfaces between which rulings lie touch each other, next to these, to within the
/// resolution; empty if that is not one point for all of them.
std::vector<Ruling> touching_beside(const RulingSearch& search, const std::vector<Ruling>& beside);

/// Nodes in which arcs end since two surfaces touch each other in one point of the hull, as tori
/// about one centre do: the arcs between the two that end there are joined in one node, wherever
/// cells beside the point end them.
void join_crossings(const RulingSearch& search, KnownArcs& known);

/// Such a node as one of the graph, a facet that is a point (FacetNode::is_crossing). None if it is
/// none.
std::optional<FacetNode> crossing_of(const RulingSearch& search, const KnownArcs& known,
                                     const MapGraph::Node& node);

}  // namespace taut
