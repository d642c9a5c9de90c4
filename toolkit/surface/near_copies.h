#pragma once

#include "taut/surface/model.h"

namespace taut {

/// How far copies of patches miss each other by: the largest distance between control points of two
/// that have the same degrees and weights, of those that are nowhere more than `limit` apart, in
/// model units; 0 if there are none. Parts with cages are left out.
double copies_apart(const Model& model, double limit);

}  // namespace taut
