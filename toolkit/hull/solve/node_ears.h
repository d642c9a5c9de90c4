#pragma once

#include "taut/hull/solve/known_arcs.h"

namespace taut {

/// Parts nodes whose contacts touch no one plane, as where the map is not decided, into nodes of
/// three contacts that do, and what is left: as long as three contacts that follow each other have
/// a plane that supports, they make a node of their own, with an arc between the two.
void cut_ears(const RulingSearch& search, KnownArcs& known);

/// The contacts in which a node's arcs leave it, each to the right of the way out, with directions
/// next to the node, and one in it.
struct NodeCorners {
  std::vector<Contact> contacts;
  std::vector<dvec3> beside;
  dvec3 n = dvec3(0.0);
};
NodeCorners corners_of(const KnownArcs& known, const MapGraph::Node& node, const DirectionMap& map);

}  // namespace taut
