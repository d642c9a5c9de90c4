#pragma once

#include "taut/bounds/scene.h"
#include "taut/hull/result/hull.h"
#include "taut/hull/result/hull_options.h"

namespace taut {

/// Convex hull of a scene as a polytope of points sampled on the model (method `sampled`).
///
/// The mesh's vertices are support points of the model, rounded to double; the mesh is closed and
/// exactly convex (every orientation predicate holds on the coordinates as stored), has no face of
/// zero area, and its Hausdorff distance from the true hull is at most distance_bound, which is at
/// most the tolerance, rounding apart. Same bits for any number of threads. Safe to call
/// concurrently.
///
/// A scene that reaches no farther than its resolution, or than flat_width and its like
/// (tolerances.h), across a plane or a line is planar, a segment or a point; its corners are
/// support points too, moved into one plane, and a planar outline is convex as seen along the axis
/// that foreshortens it least.
///
/// @throws InvalidInput if the tolerance or the resolution is not valid, HullNotConverged if it is
/// below what double precision can certify for this scene (about 1e-12 of its size) or max_vertices
/// was met, HullLimitExceeded or LimitMet for limits (HullOptions), Cancelled
Hull sampled_hull(const Scene& scene, const HullOptions& options = {});

/// No mesh of a curved scene can be certified to be nearer to its hull than that, in model units,
/// since support queries prove no more. Smaller tolerances are never reached.
double least_tolerance(const Scene& scene);

/// sampled_hull() with the mesh's faces as the boundary (facetted_boundary): the best closed answer
/// where the exact one is not found.
/// @pre the hull is solid @throws as sampled_hull()
Hull facetted_hull(const Scene& scene, const HullOptions& options = {});

}  // namespace taut
