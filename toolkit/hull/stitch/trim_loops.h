#pragma once

#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/trace/separating_graph.h"

namespace taut {

/// The region of a contact of an arc, as its border is walked along with the region to the left,
/// seen from outside: contact 1 along the arc, contact 0 against it.
struct HalfArc {
  int arc = -1;
  int contact = 0;
};

/// The half-arc that goes on where this one ends: at a facet that of the next side with the same
/// contact, at a free end the other one of the arc, on a closed arc itself.
HalfArc next_half_arc(const SeparatingGraph& graph, const HalfArc& half);

/// A region of a Bezier patch that lies on the hull, as PatchRegion, but walked along with the
/// region to the left seen from outside: clockwise in (u, v) where sign is negative.
struct TrimRegion {
  int instance = -1;
  int patch = -1;
  int sign = 1;
  std::vector<std::vector<TrimStretch>> loops;
};

/// The regions of all Bezier patches that lie on the hull, bounded by the contacts of separating
/// curves and by the patches' borders. The pieces of the arcs are those that the walk leads along;
/// where it meets no curve, support queries tell whether a patch with cells that may be on the hull
/// lies there as a whole, unless the search for the graph is exhausted: they would cost as much.
/// Reasons why something does not fit are added to `unresolved`.
std::vector<TrimRegion> trim_regions(const ContactGeometry& geometry, SupportQuery& query,
                                     const SeparatingGraph& graph,
                                     const std::vector<CulledCell>& cells,
                                     std::vector<Unresolved>& unresolved);

}  // namespace taut
