#pragma once

#include "taut/envelope/envelope_images.h"
#include "taut/envelope/envelope_map.h"
#include "taut/hull/sample/sampled_hull.h"

namespace taut {

/// Convex hull of a scene as its envelope images show it (method `envelope`): a polytope of the
/// contacts at some pixels and at triple points, grown by those that the images show in the
/// directions of its facets until the tolerance is reached.
///
/// The mesh is one as of sampled_hull(), closed and exactly convex, with the same certificate of
/// its distance from the true hull; support queries measure the distance and choose no point. A
/// scene that is flat has the hull of sampled_hull(). Same bits for any number of threads.
/// @throws InvalidInput if the tolerance or the resolution is not valid, HullNotConverged if the
/// images do not show enough for the tolerance (features between pixels), or max_vertices was met,
/// HullLimitExceeded or LimitMet for limits (HullOptions), Cancelled
Hull envelope_hull(const EnvelopeImages& images, const EnvelopeMap& map,
                   const HullOptions& options = {});

}  // namespace taut
