#pragma once

#include <cstddef>
#include <optional>

#include "taut/core/progress.h"
#include "taut/surface/resolution.h"

namespace taut {

/// How a hull is computed and how close it comes.
struct HullOptions {
  /// Largest distance of the mesh from the true hull, in model units. Zero: `relative` counts.
  double tolerance = 0;
  /// That distance as a fraction of the diagonal of the model's box.
  double relative = 1e-4;
  /// What is nearer than this fraction of that diagonal may be taken for one; 0: nothing but what
  /// rounding to doubles does. None: the model tells (Resolution).
  std::optional<double> resolution = std::nullopt;
  /// Threads to use, 0 for all. The result does not depend on it.
  int threads = 0;
  /// Vertices, some thirty to begin with apart, after which refinement gives up (HullNotConverged
  /// is thrown). Each takes about 700 bytes meanwhile.
  int max_vertices = 4'000'000;
  /// A budget: at most so many vertices, four in space and three in a plane at least, and the best
  /// mesh for them. `relative` does not count then, `tolerance` does where it is given:
  /// HullNotConverged tells that the budget does not reach it.
  std::optional<int> vertex_budget = std::nullopt;
  /// Seconds from the call on, and bytes of main memory that the process holds (resident_bytes),
  /// after which the best hull that is there is thrown with HullLimitExceeded, or LimitMet where
  /// there is none as yet. To finish and label it takes some more. None: no limit. Where results
  /// come in time they do not depend on it; those of a limit that is met do.
  std::optional<double> max_seconds = std::nullopt;
  std::optional<std::size_t> max_memory = std::nullopt;  ///< see max_seconds
  Progress progress = {};  ///< told of the share done, and asked to stop
};

/// The tolerance that the options ask for, in model units; positive where the diagonal is, but 0
/// where there is a budget alone.
/// @throws InvalidInput if the tolerance is negative or no number, or the relative one counts and
/// is not positive and finite, or leaves the range of doubles; or the budget is below four
double tolerance_for(const HullOptions& options, double diagonal);

/// The same options, with a progress that stops at the limits they ask for, which begin now, and at
/// those it has (Progress::stop); what is called with them adds none of its own.
/// @throws InvalidInput unless limits are positive and finite
HullOptions within_limits(const HullOptions& options);

/// The resolution that the options ask for, or the model's. @throws InvalidInput if it is asked for
/// and not in [0, 1]
inline Resolution resolution_for(const HullOptions& options, const Model& model, double diagonal) {
  return resolution_of(model, diagonal, options.resolution);
}

}  // namespace taut
