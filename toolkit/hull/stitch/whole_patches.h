#pragma once

#include <vector>

#include "taut/bounds/support_query.h"
#include "taut/hull/stitch/trim_loops.h"

namespace taut {

/// Adds the patches that lie on the hull as a whole to the regions that separating curves bound:
/// what these regions go on into, over smooth joins, and over edges and at vertices beyond which
/// nothing else lies. So of surfaces that coincide it is one that is taken. Where there are no
/// curves a support query tells where to begin. A patch is none if its middle is below the
/// supporting plane there by more than rounding and the graph's depth, or if it is in the plane of
/// a facet to within as much: it is part of that. Where one is flat or developable, that is added
/// to `unresolved`; a saddle, as of a dent less deep than that, is as deep as it is.
void add_whole_patches(const ContactGeometry& geometry, SupportQuery& query,
                       const SeparatingGraph& graph, std::vector<TrimRegion>& regions,
                       std::vector<Unresolved>& unresolved);

}  // namespace taut
