#pragma once

#include "taut/verify/coverage.h"
#include "taut/verify/hull_faults.h"
#include "taut/verify/verify.h"

namespace taut {

/// Checks patches at points of their sources' parameters, on grids, at random and beside all
/// outlines. Inside of a region a point supports in the direction of the normal; of those outside
/// of all, and not near any, none does where the surface is strictly convex; but for patches that
/// miss being ruled by no more than the resolution, of which the ends of their lines are as high.
///
/// Returns the largest support gap of a point of a region, beyond the largest bound that faces
/// beside it state, as a fraction of the scene's diagonal.
/// Points that support but are left out, places in more than one region and regions on the wrong
/// side of their outlines are faults ("regions").
double check_patches(const DocumentGeometry& geometry, const DocumentOutlines& outlines,
                     const Coverage& coverage, const Scene& scene, double resolution,
                     const VerifyOptions& options, HullFaults& faults);

}  // namespace taut
