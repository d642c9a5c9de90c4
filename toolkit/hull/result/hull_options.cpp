#include "taut/hull/result/hull_options.h"

#include <cmath>

#include "taut/core/error.h"

namespace taut {

double tolerance_for(const HullOptions& options, double diagonal) {
  constexpr int fewest = 4;
  if (options.vertex_budget && *options.vertex_budget < fewest) {
    throw InvalidInput("the budget of vertices must be four or more");
  }
  // Asked in forms that NaN fails.
  if (!(options.tolerance >= 0)) {
    throw InvalidInput("the tolerance must be positive");
  }
  if (options.tolerance > 0) return options.tolerance;
  if (options.vertex_budget) return 0;
  if (!(options.relative > 0 && std::isfinite(options.relative))) {
    throw InvalidInput("the relative tolerance must be positive");
  }
  const double tolerance = options.relative * diagonal;
  if (diagonal > 0 && !(tolerance > 0 && std::isfinite(tolerance))) {
    throw InvalidInput("the relative tolerance times the diagonal leaves the range of doubles");
  }
  return tolerance;
}

HullOptions within_limits(const HullOptions& options) {
  HullOptions own = options;
  if (options.max_seconds || options.max_memory || options.progress.stop.has_limits()) {
    own.progress.stop = options.progress.stop.within(options.max_seconds, options.max_memory);
  }
  own.max_seconds.reset();
  own.max_memory.reset();
  return own;
}

}  // namespace taut
