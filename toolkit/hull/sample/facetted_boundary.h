#pragma once

#include "taut/bounds/support_query.h"
#include "taut/hull/result/hull_boundary.h"
#include "taut/hull/sample/sampled_polytope.h"

namespace taut {

/// A polytope of samples as a boundary: its facets, each with how far it is below the supporting
/// plane (HullFace::tolerant), and straight curves between them; coplanar ones are one. Closed, and
/// as near to the exact one as the polytope is. Faces are in the order of those of the polytope's
/// mesh. @throws Cancelled
HullBoundary facetted_boundary(const Scene& scene, SupportQuery& query,
                               const SampledPolytope& polytope, const Progress& progress = {});

}  // namespace taut
