#pragma once

#include <array>
#include <utility>
#include <vector>

#include "taut/bounds/gauss_map.h"
#include "taut/bounds/patch_nets.h"
#include "taut/bounds/reach_test.h"
#include "taut/bounds/support_query.h"
#include "taut/envelope/cull/concave_surroundings.h"
#include "taut/envelope/cull/culling.h"
#include "taut/envelope/cull/spread_samples.h"

namespace taut {

/// What one patch of one instance contributes to a Culling.
struct CulledPatch {
  std::vector<Sample> samples;
  std::vector<dvec3> frame_points;
  std::vector<CulledCell> cells;
  std::vector<CullingLevel> levels;
  long queries = 0;
};

/// What a task culls patches with, one after the other.
struct CullingTools {
  CullingTools(const Scene& scene, ConcaveSurroundings& with, Stop stop = {})
      : query(scene, stop), reach(scene, std::move(stop)), surroundings(with) {}
  /// To be asked before each query; those that are not made count too.
  bool may_ask();

  SupportQuery query;
  ReachTest reach;
  ConcaveSurroundings& surroundings;
  long asked = 0;
  std::vector<std::array<CellNets, 4>> quarters;  // per level
};

/// Decides the cells of one patch of one instance, depth first (cull() says how).
/// `root`: the patch's root in the map. @throws Cancelled
CulledPatch cull_patch(const Scene& scene, const GaussMap& map, const SpreadSamples& spread,
                       int instance, int root, int levels, CullingTools& tools);

}  // namespace taut
