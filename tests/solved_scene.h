#pragma once

#include <vector>

#include "models.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/exact_boundary.h"
#include "taut/hull/solve/solved_graph.h"
#include "taut/hull/stitch/whole_patches.h"

namespace taut_test {

/// A scene with its separating curves and the regions that they trim.
struct SolvedScene {
  taut::Scene scene;
  taut::ContactGeometry geometry;
  taut::SupportQuery query;
  taut::SeparatingGraph graph;
  std::vector<taut::Unresolved> unresolved;
  std::vector<taut::TrimRegion> regions;

  SolvedScene(const SolvedScene&) = delete;
  explicit SolvedScene(const Shape& shape)
      : scene(make_scene(shape)), geometry(scene), query(scene) {
    taut::HullStatistics statistics;
    const taut::DirectionMap map = directions_of(geometry, {}, statistics);
    graph = solved_graph(geometry, query, map, {});
    unresolved = graph.unresolved;
    regions = trim_regions(geometry, graph, unresolved);
    add_whole_patches(geometry, query, graph, regions, unresolved);
  }
};

}  // namespace taut_test
