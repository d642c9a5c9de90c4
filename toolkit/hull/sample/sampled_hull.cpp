#include "taut/hull/sample/sampled_hull.h"

#include "taut/core/stopwatch.h"
#include "taut/hull/sample/polytope_mesh.h"
#include "taut/hull/sample/sampled_start.h"

namespace taut {

Hull sampled_hull(const Scene& scene, const HullOptions& options) {
  const double tolerance = tolerance_for(options, scene.diagonal());
  warn_if_capped(resolution_for(options, scene.model(), scene.diagonal()), options.progress);
  const Stopwatch start_time;
  SupportQuery query(scene, options.progress.stop);
  SampledStart start = sampled_start(scene, query);
  if (start.span.dimension < 3) {
    Hull hull = flat_sampled_hull(scene, options, tolerance, std::move(start), query);
    hull.statistics.seconds_sample = start_time.seconds();
    hull.statistics.support_queries += query.queries();
    hull.statistics.newton_iterations += query.newton_iterations();
    return hull;
  }
  SampledPolytope polytope =
      sampled_polytope(scene, options, tolerance, std::move(start.samples), start.points);
  polytope.statistics.support_queries += query.queries();
  polytope.statistics.newton_iterations += query.newton_iterations();
  return polytope_hull(scene, options, polytope);
}

}  // namespace taut
