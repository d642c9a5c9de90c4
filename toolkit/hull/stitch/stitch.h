#pragma once

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/support_query.h"
#include "taut/core/progress.h"
#include "taut/hull/result/hull_boundary.h"
#include "taut/hull/solve/separating_graph.h"

namespace taut {

/// Joins the separating curves of a scene to the boundary of its convex hull: trimmed patches,
/// scrolls and facets with the curves between them. What does not fit is told in
/// HullBoundary::unresolved, after what the graph has there; a boundary without any is closed:
/// every curve has two faces, and its Euler characteristic is that of the sphere. What lies below
/// supporting planes by no more than the graph's depth and rounding may be on the hull.
/// Reports the step "stitch".
HullBoundary stitch(const ContactGeometry& geometry, SupportQuery& query, SeparatingGraph graph,
                    const Progress& progress = {});

}  // namespace taut
