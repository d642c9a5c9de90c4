#include "taut/envelope/cull/culling.h"

#include <algorithm>
#include <memory>
#include <string>

#include "taut/bounds/scene_content.h"
#include "taut/core/error.h"
#include "taut/core/parallel.h"
#include "taut/core/pool.h"
#include "taut/envelope/cull/concave_surroundings.h"
#include "taut/envelope/cull/patch_culling.h"
#include "taut/envelope/cull/spread_samples.h"

namespace taut {
namespace {

constexpr int level_limit = 20;

/// The finer the patches, the less is to be gained by their cells.
constexpr int default_levels = 3;
constexpr long cells_in_all = 16384;

/// Patches of a task, between these, so that there are many tasks for all threads; each task makes
/// its own queries and caps.
constexpr std::size_t least_patches_per_task = 8;
constexpr std::size_t most_patches_per_task = 256;
constexpr std::size_t tasks = 64;

/// A patch of an instance.
struct CellPlace {
  int instance;
  int root;
};

void append(const CulledPatch& from, Culling& to) {
  to.support_queries += from.queries;
  to.samples.insert(to.samples.end(), from.samples.begin(), from.samples.end());
  to.frame_points.insert(to.frame_points.end(), from.frame_points.begin(), from.frame_points.end());
  to.cells.insert(to.cells.end(), from.cells.begin(), from.cells.end());
  for (std::size_t l = 0; l < from.levels.size(); ++l) {
    CullingLevel& sum = to.levels[l];
    const CullingLevel& more = from.levels[l];
    sum.visited += more.visited;
    sum.off_by_samples += more.off_by_samples;
    sum.off_by_curvature += more.off_by_curvature;
    sum.on += more.on;
    sum.ruled += more.ruled;
    sum.kept += more.kept;
  }
}

void add_shares(std::size_t patches, std::vector<CullingLevel>& levels) {
  double removed = 0;
  double decided = 0;
  double cell = patches > 0 ? 1.0 / double(patches) : 0;
  for (CullingLevel& level : levels) {
    removed += cell * double(level.off_by_samples + level.off_by_curvature);
    decided += cell * double(level.on + level.ruled);
    level.removed_share = removed;
    level.decided_share = removed + decided;
    cell /= 4;
  }
}

}  // namespace

int culling_levels(long patches) {
  int levels = default_levels;
  while (levels > 0 && patches * (1L << (2 * levels)) > cells_in_all) --levels;
  return levels;
}

long Culling::visited() const {
  long sum = 0;
  for (const CullingLevel& level : levels) sum += level.visited;
  return sum;
}

long Culling::mixed() const { return levels.empty() ? 0 : levels.back().kept; }

Culling cull(const Scene& scene, const GaussMap& map, const CullingOptions& options) {
  if (options.levels < 0 || options.levels > level_limit) {
    throw InvalidInput("levels of culling must be 0 .. 20, not " + std::to_string(options.levels));
  }
  options.progress.update("cull", 0);
  Culling result;
  result.levels.resize(std::size_t(options.levels) + 1);
  const SceneContent& content = scene.content();
  std::vector<CellPlace> places;
  for (const int i : content.distinct_instances) {
    const int roots = map.root_count(content.instances[std::size_t(i)].part);
    for (int root = 0; root < roots; ++root) places.push_back({i, root});
  }
  const SpreadSamples spread(scene, places.size(), options);
  result.samples = spread.samples();
  result.frame_points = spread.points();
  result.support_queries = long(spread.samples().size());
  std::vector<CulledPatch> results(places.size());
  Pool<ConcaveSurroundings> surroundings(
      [&] { return std::make_unique<ConcaveSurroundings>(scene, options.progress.stop); });
  const std::size_t patches_per_task =
      std::clamp(places.size() / tasks, least_patches_per_task, most_patches_per_task);
  parallel_for(places.size(), patches_per_task, options.threads,
               [&](std::size_t begin, std::size_t end) {
                 const Pool<ConcaveSurroundings>::Lease lent = surroundings.lease();
                 (*lent).begin_anew();  // whichever tasks had it before
                 CullingTools tools(scene, *lent, options.progress.stop);
                 for (std::size_t k = begin; k < end; ++k) {
                   options.progress.check();
                   results[k] = cull_patch(scene, map, spread, places[k].instance, places[k].root,
                                           options.levels, tools);
                 }
               });
  for (const CulledPatch& patch : results) append(patch, result);
  add_shares(places.size(), result.levels);
  options.progress.update("cull", 1);
  return result;
}

}  // namespace taut
