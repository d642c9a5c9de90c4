#pragma once

#include "taut/bounds/scene.h"
#include "taut/hull/result/hull.h"
#include "taut/hull/result/hull_options.h"

namespace taut {

/// Convex hull of a model: polyhedral_hull() where it is made of points and polygons alone,
/// precise_hull() otherwise. A model without geometry has the empty hull.
/// @throws as these do
Hull convex_hull(const Model& model, const HullOptions& options = {});
/// Convex hull of the model of a scene that is there already.
Hull convex_hull(const Scene& scene, const HullOptions& options = {});

}  // namespace taut
