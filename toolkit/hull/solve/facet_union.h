#pragma once

#include "taut/hull/solve/separating_graph.h"

namespace taut {

/// Makes one facet of each two that lie in one plane with an arc between them along which that
/// plane stands still, as cells tell beside contacts in line; and where sides of a facet lead out
/// and back, lets the arcs that leave across the two go on into each other. Of a facet that
/// has no other sides nothing is left. Heights and places that differ by no more than `tie` are
/// one, in the scene's frame.
void unite_facets(SeparatingGraph& graph, double tie);

}  // namespace taut
