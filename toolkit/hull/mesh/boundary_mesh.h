#pragma once

#include <memory>
#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/result/hull.h"
#include "taut/hull/result/hull_options.h"
#include "taut/hull/result/sample.h"

namespace taut {

/// The solid hull with this boundary, and the boundary's mesh within the tolerance: the convex hull
/// of points on the boundary's curves and of support points, with its certificate.
///
/// Rulings are edges of the mesh. Its faces are labelled by the boundary: one belongs to the hull
/// face in whose closure all its corners lie, among several to a facet, else to a scroll that it
/// crosses, else to a patch. Where a curve of the boundary is so near to another that the mesh does
/// not tell them apart, there may be none: then to that in which most corners lie, or where its
/// edges bridge a gap to a scroll on or beside both sides of which its corners lie. Where
/// the boundary is not complete, a face without any is labelled as by sampled_hull(), its hull face
/// numbered after those of the boundary.
///
/// Support points that lie on no face of the boundary, and to whose height none of it reaches
/// within the resolution, are added to `uncovered_samples`: what the boundary lacks.
/// @pre the boundary is the scene's, in its frame; the options have no limits but those of their
/// progress (within_limits), which are lifted where one is met while the mesh is refined
/// @throws as sampled_hull()
Hull boundary_mesh(const Scene& scene, const ContactGeometry& geometry,
                   std::shared_ptr<const HullBoundary> boundary, const HullOptions& options = {},
                   std::vector<Sample>* uncovered_samples = nullptr);

}  // namespace taut
