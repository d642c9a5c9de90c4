#pragma once

#include "taut/bounds/scene.h"
#include "taut/hull/result/hull.h"
#include "taut/hull/result/hull_options.h"

namespace taut {

/// Convex hull of a scene with its exact boundary (method `precise`): trimmed patches of the model,
/// developable scrolls and flat facets in Hull::boundary, and a mesh of it.
///
/// The mesh is one as of sampled_hull(), with the same certificate, but its vertices lie on the
/// boundary's curves too, and its faces are labelled by the boundary's faces. What of the boundary
/// could not be resolved is listed there; the mesh is true all the same. A scene that is flat has
/// no boundary: its hull is that of sampled_hull().
/// @throws as sampled_hull()
Hull precise_hull(const Scene& scene, const HullOptions& options = {});

}  // namespace taut
