#include "taut/hull/precise_hull.h"

#include "taut/core/stopwatch.h"
#include "taut/hull/cull/culling.h"
#include "taut/hull/exact_boundary.h"
#include "taut/hull/mesh/boundary_mesh.h"
#include "taut/hull/sample/sampled_hull.h"
#include "taut/hull/sample/sampled_start.h"

namespace taut {
namespace {

/// How often the boundary is sought again with support points that the mesh met on no face of it,
/// unless more spots than so many could not be resolved: such points are then not what it wants.
constexpr int uncovered_rounds = 2;
constexpr std::size_t few_unresolved = 16;

bool wants_more(const HullBoundary& boundary, const HullOptions& options) {
  return options.curves == CurveMethod::tracing && !boundary.exhausted &&
         boundary.unresolved.size() <= few_unresolved;
}

}  // namespace

Hull precise_hull(const Scene& scene, const HullOptions& options) {
  // What is wrong with the options is told at once.
  tolerance_for(options, scene.diagonal());
  const Resolution resolution = resolution_for(options, scene.model(), scene.diagonal());
  SupportQuery query(scene, options.progress.stop);
  if (sampled_start(scene, query).span.dimension < 3) return sampled_hull(scene, options);
  warn_if_capped(resolution, options.progress);

  HullStatistics statistics;
  statistics.support_queries = query.queries();
  statistics.newton_iterations = query.newton_iterations();
  Stopwatch watch;
  const GaussMap map(scene, {.levels = culling_levels(scene.patch_count()),
                             .threads = options.threads,
                             .progress = options.progress});
  statistics.seconds_gauss_map = watch.lap();
  const ContactGeometry geometry(scene, options.progress.stop, same_elements_of(scene, options));
  const Culling culling = culling_of(scene, map, options, statistics);
  const DirectionMap directions = directions_of(geometry, options, statistics);
  std::vector<Sample> found;
  for (int round = 0;; ++round) {
    auto boundary = std::make_shared<HullBoundary>(
        exact_boundary(geometry, culling, directions, options, statistics, found));
    std::vector<Sample> uncovered_samples;
    try {
      Hull hull = boundary_mesh(scene, geometry, boundary, options, &uncovered_samples);
      if (!uncovered_samples.empty() && round < uncovered_rounds &&
          wants_more(*boundary, options)) {
        // The mesh has met faces that were not known: once more, with what it met.
        found.insert(found.end(), uncovered_samples.begin(), uncovered_samples.end());
        statistics += hull.statistics;
        continue;
      }
      // Of a search that was given up the samples tell nothing new.
      if (boundary->exhausted) uncovered_samples.clear();
      for (const Sample& s : uncovered_samples) {
        boundary->unresolved.push_back({s.n, "a support point lies on no face that was found"});
      }
      hull.statistics += statistics;
      return hull;
    } catch (const HullNotConverged& failure) {
      Hull best = *failure.best;
      best.boundary = std::move(boundary);
      best.statistics += statistics;
      throw HullNotConverged(failure.what(), std::move(best));
    }
  }
}

}  // namespace taut
