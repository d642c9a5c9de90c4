#include "taut/hull/precise_hull.h"

#include <array>
#include <cstdio>
#include <string>

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

bool wants_more(const HullBoundary& boundary) {
  return !boundary.exhausted && boundary.unresolved.size() <= few_unresolved;
}

/// What keeps a solved boundary from being what it promises, empty if nothing does.
std::string broken_promise(const HullBoundary& boundary, const Resolution& resolution) {
  std::array<char, 256> text{};
  if (!boundary.unresolved.empty()) {
    const auto& [n, reason] = boundary.unresolved.front();
    std::snprintf(text.data(), text.size(),
                  "no exact boundary was found: %s at the normal %g %g %g", reason, n.x, n.y, n.z);
    return text.data();
  }
  const double depth = boundary.frame.length_to_model(deepest_tolerant(boundary));
  if (!(depth > resolution.rho)) return {};
  std::snprintf(text.data(), text.size(),
                "faces of the exact boundary are known to %.3g only, not to the resolution %.3g",
                depth, resolution.rho);
  return text.data();
}

/// The hull with a boundary that was solved; or with its mesh's faces as the boundary, where that
/// is not closed or would be farther off than these.
Hull solved_hull(const Scene& scene, const ContactGeometry& geometry, HullBoundary boundary,
                 const HullOptions& options) {
  auto own = std::make_shared<HullBoundary>(std::move(boundary));
  std::vector<Sample> uncovered;
  Hull hull;
  std::string failure;
  try {
    hull = boundary_mesh(scene, geometry, own, options, &uncovered);
  } catch (const HullNotConverged& stopped) {
    hull = *stopped.best;
    failure = stopped.what();
  }
  for (const Sample& s : uncovered) {
    own->unresolved.push_back({s.n, "a support point lies on no face that was found"});
  }
  const std::string broken = broken_promise(*own, hull.resolution);
  if (broken.empty() && failure.empty()) return hull;
  if (broken.empty()) throw HullNotConverged(failure, std::move(hull));
  const double depth = own->frame.length_to_model(deepest_tolerant(*own));
  if (own->unresolved.empty() && depth <= hull.distance_bound) {
    throw HullNotConverged(broken, std::move(hull));
  }
  Hull facetted = facetted_hull(scene, options);
  facetted.statistics += hull.statistics;
  throw HullNotConverged(broken + "; its faces are those of the mesh", std::move(facetted));
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
      if (options.curves == CurveMethod::solving) {
        Hull hull = solved_hull(scene, geometry, std::move(*boundary), options);
        hull.statistics += statistics;
        return hull;
      }
      Hull hull = boundary_mesh(scene, geometry, boundary, options, &uncovered_samples);
      if (!uncovered_samples.empty() && round < uncovered_rounds && wants_more(*boundary)) {
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
      best.statistics += statistics;
      throw HullNotConverged(failure.what(), std::move(best));
    }
  }
}

}  // namespace taut
