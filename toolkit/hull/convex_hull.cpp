#include "taut/hull/convex_hull.h"

#include <algorithm>
#include <cmath>

#include "taut/core/error.h"

namespace taut {

Hull convex_hull(const Model& model, const HullOptions& options) {
  if (model.empty()) {
    tolerance_for(options, 0);
    return {};
  }
  if (model.polyhedral()) return polyhedral_hull(model, options);
  const Scene scene(model, {options.threads, options.progress});
  return precise_hull(scene, options);
}

Hull convex_hull(const Scene& scene, const HullOptions& options) {
  return scene.model().polyhedral() ? polyhedral_hull(scene.model(), options)
                                    : precise_hull(scene, options);
}

HullStatistics& HullStatistics::operator+=(const HullStatistics& other) {
  support_queries += other.support_queries;
  newton_iterations += other.newton_iterations;
  cells = std::max(cells, other.cells);
  cells_kept = std::max(cells_kept, other.cells_kept);
  cells_searched = std::max(cells_searched, other.cells_searched);
  seconds_gauss_map += other.seconds_gauss_map;
  seconds_sample += other.seconds_sample;
  seconds_cull += other.seconds_cull;
  seconds_trace += other.seconds_trace;
  seconds_stitch += other.seconds_stitch;
  seconds_mesh += other.seconds_mesh;
  return *this;
}

double tolerance_for(const HullOptions& options, double diagonal) {
  // Asked in forms that NaN fails.
  if (!(options.tolerance >= 0)) {
    throw InvalidInput("the tolerance must be positive");
  }
  if (options.tolerance > 0) return options.tolerance;
  if (!(options.relative > 0 && std::isfinite(options.relative))) {
    throw InvalidInput("the relative tolerance must be positive");
  }
  const double tolerance = options.relative * diagonal;
  if (diagonal > 0 && !(tolerance > 0 && std::isfinite(tolerance))) {
    throw InvalidInput("the relative tolerance times the diagonal leaves the range of doubles");
  }
  return tolerance;
}

}  // namespace taut
