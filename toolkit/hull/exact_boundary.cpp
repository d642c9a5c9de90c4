#include "taut/hull/exact_boundary.h"

#include <cmath>
#include <utility>

#include "taut/core/stopwatch.h"
#include "taut/hull/stitch/stitch.h"

namespace taut {

Culling culling_of(const Scene& scene, const GaussMap& map, const HullOptions& options,
                   HullStatistics& statistics) {
  Stopwatch watch;
  options.progress.update("cull", 0);
  Culling culling = cull(scene, map,
                         {.levels = culling_levels(scene.patch_count()),
                          .threads = options.threads,
                          .progress = options.progress});
  const auto finest = double(culling.levels.empty() ? 0 : culling.levels.size() - 1);
  statistics.cells = std::lround(scene.patch_count() * std::exp2(2 * finest));
  statistics.cells_kept = std::lround(double(statistics.cells) * (1 - culling.removed_share()));
  statistics.support_queries += culling.support_queries;
  statistics.seconds_cull += watch.lap();
  return culling;
}

HullBoundary exact_boundary(const ContactGeometry& geometry, const Culling& culling,
                            const HullOptions& options, HullStatistics& statistics,
                            const std::vector<Sample>& more) {
  Stopwatch watch;
  options.progress.update("trace", 0);
  std::vector<Sample> samples = culling.samples;
  samples.insert(samples.end(), more.begin(), more.end());
  SupportQuery query(geometry.scene(), options.progress.stop);
  SeparatingGraph graph =
      trace_separating_curves(geometry, query, samples, culling.cells, options.progress);
  statistics.support_queries += graph.support_queries;
  statistics.newton_iterations += graph.newton_iterations;
  statistics.cells_searched = graph.cells_searched;
  statistics.seconds_trace += watch.lap();

  options.progress.update("stitch", 0);
  HullBoundary boundary = stitch(geometry, query, std::move(graph), culling.cells);
  statistics.seconds_stitch += watch.lap();
  statistics.support_queries += query.queries();
  statistics.newton_iterations += query.newton_iterations();
  return boundary;
}

HullBoundary exact_boundary(const Scene& scene, const GaussMap& map, const HullOptions& options,
                            HullStatistics& statistics) {
  const Culling culling = culling_of(scene, map, options, statistics);
  const ContactGeometry geometry(scene, options.progress.stop);
  return exact_boundary(geometry, culling, options, statistics);
}

}  // namespace taut
