#pragma once

#include <functional>

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/solve/separating_graph.h"

namespace taut {

/// Makes places on edges and seams one that are no farther from each other than `distance`: those
/// in which pieces of arcs begin and end, corners of facets and ends of their curved sides. Ends of
/// edges' pieces and of sides, too, are such places, and contacts so near to them are on them.
/// (Contacts move along their elements, across the normal: their heights change by the square of
/// the distance.) Ends of curved sides, along which rounding leaves planes nearly level, are one
/// with places up to `level_distance` from them, if none is nearer, and so are places beside ruled
/// patches that are bent, where the patch that ends there touches: what lies between is then part
/// of the region or not. Where lines bend so much that heights change by more than `depth` places
/// are one up to that distance only. In the scene's frame.
void unite_edge_places(const ContactGeometry& geometry, SeparatingGraph& graph, double depth,
                       double distance, double level_distance,
                       const std::function<bool(const Contact&)>& touches);

}  // namespace taut
