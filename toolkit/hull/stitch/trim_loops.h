#pragma once

#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/solve/separating_graph.h"

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

/// The whole border of a patch, with the patch to the left as seen against its normal times the
/// sign.
std::vector<TrimStretch> whole_border(int sign);

/// The regions of Bezier patches that lie on the hull and that contacts of separating curves bound,
/// with the patches' borders. The pieces of the arcs are those that the walk leads along. Reasons
/// why something does not fit are added to `unresolved`. `extent`: regions may be turned over where
/// they are nowhere wider.
std::vector<TrimRegion> trim_regions(const ContactGeometry& geometry, const SeparatingGraph& graph,
                                     std::vector<Unresolved>& unresolved, double extent = 0);

}  // namespace taut
