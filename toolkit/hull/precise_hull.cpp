#include "taut/hull/precise_hull.h"

#include <utility>

#include "taut/core/stopwatch.h"
#include "taut/hull/boundary_mesh.h"
#include "taut/hull/culling.h"
#include "taut/hull/sampled_start.h"
#include "taut/hull/stitch.h"

namespace taut {
namespace {

/// The seconds since the last call, or the construction.
class Lap {
 public:
  double seconds() {
    const double now = watch_.seconds();
    return now - std::exchange(last_, now);
  }

 private:
  Stopwatch watch_;
  double last_ = 0;
};

}  // namespace

HullBoundary exact_boundary(const Scene& scene, const GaussMap& map, const HullOptions& options,
                            HullStatistics& statistics) {
  Lap lap;
  options.progress.update("cull", 0);
  const Culling culling =
      cull(scene, map, {.threads = options.threads, .progress = options.progress});
  statistics.cells = culling.visited();
  statistics.cells_kept = culling.mixed();
  statistics.seconds_cull += lap.seconds();

  options.progress.update("trace", 0);
  const ContactGeometry geometry(scene);
  SupportQuery query(scene);
  SeparatingGraph graph =
      trace_separating_curves(geometry, query, culling.samples, culling.cells, options.progress);
  statistics.newton_iterations += graph.newton_iterations;
  statistics.seconds_trace += lap.seconds();

  options.progress.update("stitch", 0);
  HullBoundary boundary = stitch(geometry, query, std::move(graph), culling.cells);
  statistics.seconds_stitch += lap.seconds();
  statistics.support_queries += culling.support_queries + query.queries();
  statistics.newton_iterations += query.newton_iterations();
  return boundary;
}

Hull precise_hull(const Scene& scene, const HullOptions& options) {
  tolerance_for(options, scene.diagonal());  // what is wrong with it is told at once
  SupportQuery query(scene);
  if (sampled_start(scene, query).span.dimension < 3) return sampled_hull(scene, options);

  HullStatistics statistics;
  Lap lap;
  const GaussMap map(scene, {.threads = options.threads, .progress = options.progress});
  statistics.seconds_gauss_map = lap.seconds();
  auto boundary =
      std::make_shared<const HullBoundary>(exact_boundary(scene, map, options, statistics));
  const auto add_to = [&](Hull& hull) {
    HullStatistics& s = hull.statistics;
    s.support_queries += statistics.support_queries + query.queries();
    s.newton_iterations += statistics.newton_iterations + query.newton_iterations();
    s.cells = statistics.cells;
    s.cells_kept = statistics.cells_kept;
    s.seconds_gauss_map = statistics.seconds_gauss_map;
    s.seconds_cull = statistics.seconds_cull;
    s.seconds_trace = statistics.seconds_trace;
    s.seconds_stitch = statistics.seconds_stitch;
  };
  try {
    Hull hull = boundary_mesh(scene, ContactGeometry(scene), std::move(boundary), options);
    add_to(hull);
    return hull;
  } catch (const HullNotConverged& failure) {
    Hull best = *failure.best;
    add_to(best);
    throw HullNotConverged(failure.what(), std::move(best));
  }
}

}  // namespace taut
