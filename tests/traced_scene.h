#pragma once

#include <vector>

#include "models.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/cull/culling.h"
#include "taut/hull/stitch/whole_patches.h"
#include "taut/hull/trace/separating_graph.h"

namespace taut_test {

/// A scene with its separating curves and the regions that they trim.
struct TracedScene {
  taut::Scene scene;
  taut::ContactGeometry geometry;
  taut::SupportQuery query;
  taut::SeparatingGraph graph;
  std::vector<taut::Unresolved> unresolved;
  std::vector<taut::TrimRegion> regions;

  TracedScene(const TracedScene&) = delete;
  explicit TracedScene(const Shape& shape)
      : scene(make_scene(shape)), geometry(scene), query(scene) {
    const taut::GaussMap map(scene, {.threads = 1, .progress = {}});
    const taut::Culling culling = taut::cull(scene, map, {.threads = 1, .progress = {}});
    graph = trace_separating_curves(geometry, query, culling.samples, culling.cells);
    unresolved = graph.unresolved;
    regions = trim_regions(geometry, graph, unresolved);
    add_whole_patches(geometry, query, graph, 0, regions, unresolved);
  }
};

}  // namespace taut_test
