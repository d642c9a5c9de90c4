#include "taut/hull/decide/graph_edits.h"

#include <gtest/gtest.h>

#include <array>

namespace taut {
namespace {

Box point_box(const dvec3& x) { return {x, x}; }

/// Between two facets two arcs, cut in one spot that the middle cell stands for: along each of them
/// the contacts move by a share of what is between them.
struct CutArcs {
  DirectionMap map;
  MapGraph graph;

  CutArcs(MapCellKind kind, double moved) {
    map.resolution = 1e-8;
    const std::array<dvec3, 3> x = {dvec3(0, 0, 0), dvec3(1, 0, 0), dvec3(2, 0, 0)};
    const dvec3 way(0, moved, 0);
    // Of the arcs 0 and 2 between the first two contacts, of 1 and 3 between the last two.
    for (const int arc : {0, 1, 2, 3}) {
      MapCell cell;
      cell.kind = MapCellKind::arc;
      const std::size_t left = std::size_t(arc % 2);
      const dvec3 off = arc < 2 ? dvec3(0.0) : way;
      cell.contacts = {point_box(x[left] + off), point_box(x[left + 1] + off)};
      map.cells.push_back(cell);
      MapGraph::Arc own;
      own.crossings = {{{}, arc, {1, 0}}};
      own.node = arc < 2 ? std::array{0, 1} : std::array{1, 2};
      graph.arcs.push_back(own);
    }
    MapCell spot;
    spot.kind = kind;
    map.cells.push_back(spot);
    graph.nodes = {{{}, {{1, 0}, {0, 0}}, true},
                   {{4}, {{0, 1}, {1, 1}, {3, 0}, {2, 0}}, false},
                   {{}, {{2, 1}, {3, 1}}, true}};
  }
};

bool never(const MapGraph::Node&) { return false; }

TEST(GraphEdits, ArcsPassSpotsThatAreLeftUndecided) {
  CutArcs cut(MapCellKind::undecided, 0.01);
  remove_arcs(cut.graph, cut.map, {}, never);
  ASSERT_EQ(cut.graph.arcs.size(), 2U);
  EXPECT_EQ(cut.graph.nodes.size(), 2U);
  for (const MapGraph::Arc& arc : cut.graph.arcs) {
    ASSERT_EQ(arc.crossings.size(), 2U);
    // Each goes on between the contacts that it is between.
    EXPECT_EQ(arc.crossings[0].cell % 2, arc.crossings[1].cell % 2);
  }
}

TEST(GraphEdits, ArcsEndInSpotsWhereContactsAreOthers) {
  CutArcs far(MapCellKind::undecided, 0.2);
  remove_arcs(far.graph, far.map, {}, never);
  EXPECT_EQ(far.graph.arcs.size(), 4U);
  // What cells tell apart is near to within the resolution only.
  CutArcs told(MapCellKind::node, 0.01);
  remove_arcs(told.graph, told.map, {}, never);
  EXPECT_EQ(told.graph.arcs.size(), 4U);
}

}  // namespace
}  // namespace taut
