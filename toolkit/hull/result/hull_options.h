#pragma once

#include "taut/core/progress.h"

namespace taut {

/// How a hull is computed and how close it comes.
struct HullOptions {
  /// Largest distance of the mesh from the true hull, in model units. Zero: `relative` counts.
  double tolerance = 0;
  /// That distance as a fraction of the diagonal of the model's box.
  double relative = 1e-4;
  /// Threads to use, 0 for all. The result does not depend on it.
  int threads = 0;
  /// Vertices, some thirty to begin with apart, after which refinement gives up (HullNotConverged
  /// is thrown). Each takes about 700 bytes meanwhile.
  int max_vertices = 4'000'000;
  Progress progress;
};

/// The tolerance that the options ask for, in model units; positive where the diagonal is.
/// @throws InvalidInput if the tolerance is negative or no number, or the relative one counts and
/// is not positive and finite, or leaves the range of doubles
double tolerance_for(const HullOptions& options, double diagonal);

}  // namespace taut
