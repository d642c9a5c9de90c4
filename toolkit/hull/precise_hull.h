#pragma once

#include "taut/bounds/scene.h"
#include "taut/hull/result/hull.h"
#include "taut/hull/result/hull_options.h"

namespace taut {

/// Convex hull of a scene with its exact boundary (method `precise`): trimmed patches of the model,
/// developable scrolls and flat facets in Hull::boundary, and a mesh of it.
///
/// The mesh is one as of sampled_hull(), with the same certificate, but its vertices lie on the
/// boundary's curves too, and its faces are labelled by the boundary's faces. The hull of a scene
/// that is flat to within its resolution is that of sampled_hull(); that of a plane has its
/// boundary (flat_boundary) where edges and vertices make its outline.
///
/// The boundary is closed always, and faces that are below supporting planes say by how much
/// (HullFace::tolerant). Where none is found that is exact to within the model's resolution, one
/// four or 16 times as coarse is tried unless the options state one: the hull then has that one,
/// and a warning (coarser-resolution) says so. Where none is found at all HullNotConverged says
/// why, and the boundary of the best hull is the one that was found or, if that is not closed or
/// farther off, the faces of the mesh.
///
/// Under limits (HullOptions, Progress::stop) a mesh comes first, for which a quarter of them is
/// kept; where one is met HullLimitExceeded has the nearer of that, with its faces as the boundary,
/// and of what was found until then, if that is closed.
/// @throws as sampled_hull(), HullNotConverged also where the resolution is missed
Hull precise_hull(const Scene& scene, const HullOptions& options = {});

}  // namespace taut
