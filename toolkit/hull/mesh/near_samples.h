#pragma once

#include <vector>

#include "taut/hull/mesh/boundary_samples.h"

namespace taut {

/// The samples without those to which one before is as near as `clear` says of each. Where that is
/// `width` the two are in one place, and the first gets the other's faces and chords. Lengths are
/// in model units; `center` is in the middle of the samples, about.
/// @pre samples at the ends of chords are clear by `width`
BoundarySamples without_near_ones(const BoundarySamples& all, const std::vector<double>& clear,
                                  double width, const dvec3& center);

}  // namespace taut
