#include "taut/hull/precise_hull.h"

#include <cmath>
#include <utility>

#include "taut/core/stopwatch.h"
#include "taut/hull/boundary_mesh.h"
#include "taut/hull/culling.h"
#include "taut/hull/sampled_start.h"
#include "taut/hull/stitch.h"

namespace taut {
namespace {

/// How often the boundary is sought again with support points that the mesh met on no face of it,
/// unless more spots of it than so many could not be resolved: these are then not what it wants.
constexpr int stray_rounds = 2;
constexpr std::size_t few_unresolved = 16;

bool wants_more(const HullBoundary& boundary) {
  return !boundary.exhausted && boundary.unresolved.size() <= few_unresolved;
}

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
                            HullStatistics& statistics, const std::vector<Sample>& more) {
  Lap lap;
  options.progress.update("cull", 0);
  Culling culling = cull(scene, map,
                         {.levels = culling_levels(scene.model().patch_count()),
                          .threads = options.threads,
                          .progress = options.progress});
  const auto finest = double(culling.levels.empty() ? 0 : culling.levels.size() - 1);
  statistics.cells = std::lround(scene.model().patch_count() * std::exp2(2 * finest));
  statistics.cells_kept = std::lround(double(statistics.cells) * (1 - culling.removed_share()));
  statistics.seconds_cull += lap.seconds();

  options.progress.update("trace", 0);
  culling.samples.insert(culling.samples.end(), more.begin(), more.end());
  const ContactGeometry geometry(scene, options.progress.stop);
  SupportQuery query(scene, options.progress.stop);
  SeparatingGraph graph =
      trace_separating_curves(geometry, query, culling.samples, culling.cells, options.progress);
  statistics.newton_iterations += graph.newton_iterations;
  statistics.cells_searched = graph.cells_searched;
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
  SupportQuery query(scene, options.progress.stop);
  if (sampled_start(scene, query).span.dimension < 3) return sampled_hull(scene, options);

  HullStatistics statistics;
  statistics.support_queries = query.queries();
  statistics.newton_iterations = query.newton_iterations();
  Lap lap;
  const GaussMap map(scene, {.levels = culling_levels(scene.model().patch_count()),
                             .threads = options.threads,
                             .progress = options.progress});
  statistics.seconds_gauss_map = lap.seconds();
  const ContactGeometry geometry(scene, options.progress.stop);
  std::vector<Sample> found;
  for (int round = 0;; ++round) {
    auto boundary =
        std::make_shared<HullBoundary>(exact_boundary(scene, map, options, statistics, found));
    std::vector<Sample> strays;
    try {
      Hull hull = boundary_mesh(scene, geometry, boundary, options, &strays);
      if (!strays.empty() && round < stray_rounds && wants_more(*boundary)) {
        // The mesh has met faces that were not known: once more, with what it met.
        found.insert(found.end(), strays.begin(), strays.end());
        statistics += hull.statistics;
        continue;
      }
      // Of a search that was given up they tell nothing new.
      if (boundary->exhausted) strays.clear();
      for (const Sample& s : strays) {
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
