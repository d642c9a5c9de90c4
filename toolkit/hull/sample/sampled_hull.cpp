#include "taut/hull/sample/sampled_hull.h"

#include <utility>

#include "taut/core/stopwatch.h"
#include "taut/core/tolerances.h"
#include "taut/hull/sample/facetted_boundary.h"
#include "taut/hull/sample/polytope_mesh.h"
#include "taut/hull/sample/sampled_start.h"

namespace taut {
namespace {

/// Within limits; what follows, which finishes it, has none. @pre start.span.dimension == 3
SampledPolytope polytope_from(const Scene& scene, const HullOptions& options, double tolerance,
                              SampledStart start, const SupportQuery& query) {
  if (options.vertex_budget) start = spanning(start, meaningful_width(scene));
  SampledPolytope polytope =
      sampled_polytope(scene, options, tolerance, std::move(start.samples), start.points);
  options.progress.stop.lift_limits();
  polytope.statistics.support_queries += query.queries();
  polytope.statistics.newton_iterations += query.newton_iterations();
  return polytope;
}

}  // namespace

Hull sampled_hull(const Scene& scene, const HullOptions& asked) {
  const HullOptions options = within_limits(asked);
  const double tolerance = tolerance_for(options, scene.diagonal());
  const Resolution resolution = resolution_for(options, scene.model(), scene.diagonal());
  warn_if_capped(resolution, options.progress);
  const Stopwatch start_time;
  SupportQuery query(scene, options.progress.stop);
  SampledStart start = sampled_start(scene, query, scene.frame().length_to_frame(resolution.rho));
  if (start.span.dimension < 3) {
    Hull hull = flat_sampled_hull(scene, options, tolerance, std::move(start), query);
    hull.statistics.seconds_sample = start_time.seconds();
    hull.statistics.support_queries += query.queries();
    hull.statistics.newton_iterations += query.newton_iterations();
    return hull;
  }
  return polytope_hull(scene, options,
                       polytope_from(scene, options, tolerance, std::move(start), query));
}

double least_tolerance(const Scene& scene) {
  return scene.frame().length_to_model(support_slack + gap_rounding);
}

Hull facetted_hull(const Scene& scene, const HullOptions& asked) {
  const HullOptions options = within_limits(asked);
  SupportQuery query(scene, options.progress.stop);
  SampledPolytope polytope = polytope_from(scene, options, tolerance_for(options, scene.diagonal()),
                                           sampled_start(scene, query), query);
  const std::optional<std::string> failure = std::exchange(polytope.failure, std::nullopt);
  const std::optional<std::string> limit = std::exchange(polytope.limit, std::nullopt);
  Hull hull = polytope_hull(scene, options, polytope);
  hull.boundary = std::make_shared<const HullBoundary>(
      facetted_boundary(scene, query, polytope, options.progress));
  for (const auto f : hull.mesh.faces()) {
    hull.mesh.data(f).kind = FaceKind::facet;
    hull.mesh.data(f).hull_face = f.idx();
  }
  for (const auto e : hull.mesh.edges()) hull.mesh.data(e).feature = true;
  throw_if_failed(hull, failure, limit);
  return hull;
}

}  // namespace taut
