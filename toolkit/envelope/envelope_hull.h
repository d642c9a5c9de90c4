#pragma once

#include "taut/envelope/envelope_images.h"
#include "taut/envelope/envelope_map.h"
#include "taut/hull/convex_hull.h"

namespace taut {

/// Convex hull of a scene as its envelope images show it (method `envelope`): a polytope of the
/// contacts at pixels, at separating curves and at triple points.
///
/// As coarse a grid of pixels as reaches the tolerance is taken; between pixels whose contacts are
/// far apart for their directions, contacts are climbed to. The mesh is one as of sampled_hull(),
/// closed and exactly convex, with the same certificate of its distance from the true hull, which
/// support queries measure and do not improve. A scene that is flat has the hull of sampled_hull().
/// Same bits for any number of threads.
/// @throws InvalidInput if the tolerance is not valid, HullNotConverged if the images are too
/// coarse for it, Cancelled
Hull envelope_hull(const EnvelopeImages& images, const EnvelopeMap& map,
                   const HullOptions& options = {});

}  // namespace taut
