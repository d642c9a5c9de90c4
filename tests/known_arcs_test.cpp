#include "taut/hull/solve/known_arcs.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "cages.h"
#include "taut/hull/exact_boundary.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: cages

Ruling ruling_with(double x) {
  Ruling r;
  r.n = {0, 0, 1};
  r.point = {dvec3(x, 0, 0), dvec3(x, 1, 0)};
  return r;
}

/// Arcs from node to node, with rulings at these places.
KnownArcs arcs(const std::vector<std::array<int, 2>>& nodes,
               const std::vector<std::vector<double>>& places, int count) {
  KnownArcs known;
  known.graph.nodes.resize(std::size_t(count));
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    MapGraph::Arc arc;
    arc.node = nodes[k];
    known.graph.arcs.push_back(arc);
    known.rulings.emplace_back();
    for (const double x : places[k]) known.rulings.back().push_back(ruling_with(x));
    for (const int end : {0, 1}) {
      known.graph.nodes[std::size_t(nodes[k][std::size_t(end)])].ends.push_back({int(k), end});
    }
  }
  return known;
}

std::vector<double> known_places(const std::vector<Ruling>& rulings) {
  std::vector<double> places;
  places.reserve(rulings.size());
  for (const Ruling& r : rulings) places.push_back(r.point[0].x);
  return places;
}

/// Whichever way the two run, they are one from the end of the first to that of the second.
TEST(KnownArcs, AreJoinedWhereNothingEnds) {
  for (const bool first_turned : {false, true}) {
    for (const bool second_turned : {false, true}) {
      const auto way = [](bool turned, int from, int to) {
        return turned ? std::array{to, from} : std::array{from, to};
      };
      const auto line = [](bool turned, double from, double to) {
        return turned ? std::vector{to, from} : std::vector{from, to};
      };
      KnownArcs known = arcs({way(first_turned, 0, 1), way(second_turned, 1, 2)},
                             {line(first_turned, 0, 1), line(second_turned, 2, 3)}, 3);
      join_arcs(known, 1);
      EXPECT_TRUE(known.graph.nodes[1].ends.empty());
      EXPECT_TRUE(known.rulings[1].empty());
      EXPECT_EQ(known.graph.arcs[0].node, (std::array{0, 2}));
      EXPECT_EQ(known_places(known.rulings[0]), std::vector<double>({0, 1, 2, 3}));
      // Rulings that are passed the other way have their contacts exchanged.
      EXPECT_EQ(known.rulings[0][0].point[0].y, first_turned ? 1 : 0);
      EXPECT_EQ(known.rulings[0][2].point[0].y, second_turned ? 1 : 0);
      ASSERT_EQ(known.graph.nodes[2].ends.size(), 1U);
      EXPECT_EQ(known.graph.nodes[2].ends[0].arc, 0);
      EXPECT_EQ(known.graph.nodes[2].ends[0].end, 1);
      EXPECT_EQ(known.graph.nodes[0].ends[0].end, 0);
    }
  }
}

TEST(KnownArcs, ThatLeadBackToWhereNothingEndsAreClosed) {
  KnownArcs known = arcs({{0, 0}}, {{0, 1, 2}}, 1);
  join_arcs(known, 0);
  EXPECT_TRUE(known.graph.arcs[0].is_closed());
  EXPECT_EQ(known_places(known.rulings[0]), std::vector<double>({0, 1, 2}));
}

/// One of the edges of a box with 3 x 3 quads a side is sharp. Beside its ends the flat middles of
/// the sides touch planes along lines, in which four contacts are told apart, and nodes in line are
/// within the resolution of a side's plane: each side is one node. Arcs of neighbours in line are
/// nearer to each other than cells are wide, and none goes over to the other.
TEST(KnownArcs, OfABoxWithASharpEdgeLeadFromSideToSide) {
  ControlCage cage = box_cage({3});
  make_sharp(cage, [](const dvec3& x) { return x.x == 1 && x.z == 1; });
  const Scene scene(cage_model(cage));
  const ContactGeometry geometry(scene, {}, same_elements_of(scene, {}));
  DirectionMapOptions options;
  options.resolution = scene.frame().length_to_frame(resolution_floor * scene.diagonal());
  options.candidate_limit = 20'000'000;
  const DirectionMap map = direction_map(geometry, options);
  SupportQuery query(scene);
  query.leave_out(map.covered);
  const ContactSystem system(geometry);
  const KnownArcs known = known_arcs(RulingSearch(system, query, map));
  const std::vector<MapGraph::Node>& nodes = known.graph.nodes;
  EXPECT_EQ(
      std::count_if(nodes.begin(), nodes.end(), [](const auto& n) { return !n.ends.empty(); }), 6);
  EXPECT_EQ(known.graph.arcs.size(), 14U);
  for (const std::vector<Ruling>& rulings : known.rulings) {
    for (std::size_t k = 1; k < rulings.size(); ++k) {
      for (const std::size_t i : {0u, 1u}) {
        EXPECT_LT(glm::distance(rulings[k - 1].point[i], rulings[k].point[i]), 0.4);
      }
    }
  }
}

}  // namespace
}  // namespace taut
