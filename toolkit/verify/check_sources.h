#pragma once

#include "taut/hull/result/hull_document.h"
#include "taut/verify/hull_faults.h"

namespace taut {

/// Compares a document's sources with those of the model that have their ids, and its diagonal with
/// the scene's. False if they are not of the same kinds, degrees and domains, so that contacts
/// cannot be taken from the one to the other. `off_model` is raised to the largest distance of a
/// control point, and difference of the diagonals, as a fraction of the scene's diagonal; weights
/// count by their relative difference.
bool check_sources(const HullDocument& hull, const Scene& scene, HullFaults& faults,
                   double& off_model);

}  // namespace taut
