#include "taut/hull/solve/edge_places.h"

#include <gtest/gtest.h>

#include <cmath>

#include "freeform.h"
#include "judge/sweeps.h"
#include "models.h"
#include "taut/bounds/contact_exits.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// An arc along a curve from one of its parameters to another.
SeparatingArc along_curve(const ContactGeometry& geometry, double from, double to) {
  const auto ruling = [&](double t) {
    const Contact c = {0, SourceKind::edge, 0, t, 0};
    const Contact apex = {0, SourceKind::vertex, 0, 0, 0};
    return Ruling{{0, 0, 1}, {c, apex}, {geometry.point(c), geometry.point(apex)}};
  };
  SeparatingArc arc;
  arc.pieces.push_back({{ruling(from), ruling(0.5 * (from + to)), ruling(to)}});
  return arc;
}

bool everywhere(const Contact&) { return true; }

TEST(EdgePlaces, AreOneWithinADistance) {
  const Scene scene = make_scene({{}, {twisted_cubic()}, {{0, 0, 5}}});
  const ContactGeometry geometry(scene);
  SeparatingGraph graph;
  graph.arcs.push_back(along_curve(geometry, 1e-9, 0.3));
  graph.arcs.push_back(along_curve(geometry, 0.3 + 1e-9, 0.6));
  graph.arcs.push_back(along_curve(geometry, 0.6 + 1e-3, 1 - 1e-9));
  unite_edge_places(geometry, graph, 1e-8, 1e-7, 0, everywhere);
  const auto end = [&](std::size_t arc, bool last) {
    const std::vector<Ruling>& rulings = graph.arcs[arc].pieces.front().rulings;
    return (last ? rulings.back() : rulings.front()).contact[0].u;
  };
  EXPECT_EQ(end(0, false), 0);
  EXPECT_EQ(end(0, true), end(1, false));
  EXPECT_NE(end(1, true), end(2, false));
  EXPECT_EQ(end(2, true), 1);
  // Rulings inside of a piece, and points of what has moved.
  EXPECT_EQ(graph.arcs[0].pieces.front().rulings[1].contact[0].u, 0.5 * (1e-9 + 0.3));
  const Ruling& first = graph.arcs[1].pieces.front().rulings.front();
  EXPECT_EQ(first.point[0], geometry.point(first.contact[0]));
}

/// Both ends of an edge that is shorter than the distance stay where they are, and what lies
/// between goes to the nearer one: a contact does not leap over the edge.
TEST(EdgePlaces, EndsOfAShortEdgeStayApart) {
  const Scene scene = make_scene({{}, {twisted_cubic()}, {{0, 0, 5}}});
  const ContactGeometry geometry(scene);
  SeparatingGraph graph;
  graph.arcs.push_back(along_curve(geometry, 0, 0.2));
  graph.arcs.push_back(along_curve(geometry, 0.8, 1));
  unite_edge_places(geometry, graph, 10, 10, 0, everywhere);
  const auto ends = [&](std::size_t arc) {
    const std::vector<Ruling>& rulings = graph.arcs[arc].pieces.front().rulings;
    return std::array{rulings.front().contact[0].u, rulings.back().contact[0].u};
  };
  EXPECT_EQ(ends(0), (std::array{0.0, 0.0}));
  EXPECT_EQ(ends(1), (std::array{1.0, 1.0}));
}

/// A curve that turns back just before its end: what supports where it turns is higher than that.
TEST(EdgePlaces, WhereALineTurnsBesideItsEndAreNotThere) {
  const double turn = 1 - 3e-4;
  const NurbsCurve hook = {
      2, {0, 0, 0, 1, 1, 1}, {{0, 0, 0, 1}, {turn, 0, 5e-8, 1}, {2 * turn - 1, 0, 1e-7, 1}}};
  const Scene scene = make_scene({{}, {hook}, {{0, 0, 1}}});
  const ContactGeometry geometry(scene);
  SeparatingGraph graph;
  graph.arcs.push_back(along_curve(geometry, 0.1, turn));
  std::vector<Ruling>& rulings = graph.arcs.front().pieces.front().rulings;
  for (Ruling& r : rulings) r.n = {1, 0, 0};
  unite_edge_places(geometry, graph, 1e-8, 1e-7, 1e-4, everywhere);
  EXPECT_EQ(rulings.back().contact[0].u, turn);
  // Where heights are not known to so little it may be.
  unite_edge_places(geometry, graph, 1e-7, 1e-7, 1e-4, everywhere);
  EXPECT_EQ(rulings.back().contact[0].u, 1);
}

/// The end of a facet's curved side is one with a place farther away, but not if it has one where
/// it is.
TEST(EdgePlaces, EndsOfCurvedSidesReachFarOnlyWhereTheyAreAlone) {
  const Scene scene = make_scene({{}, {twisted_cubic()}, {{0, 0, 5}}});
  const ContactGeometry geometry(scene);
  const auto united = [&](const std::vector<double>& places, double side_end) {
    SeparatingGraph graph;
    for (const double t : places) graph.arcs.push_back(along_curve(geometry, t, 0.9));
    FacetNode facet;
    facet.sides = {EdgeStretch{0, 0, side_end, 0.8}};
    graph.nodes.push_back(facet);
    unite_edge_places(geometry, graph, 1e-8, 1e-7, 1e-4, everywhere);
    return graph;
  };
  const auto begin = [](const SeparatingGraph& graph, std::size_t arc) {
    return graph.arcs[arc].pieces.front().rulings.front().contact[0].u;
  };
  const SeparatingGraph far = united({0.3}, 0.3 + 1e-5);
  EXPECT_EQ(far.nodes.front().sides.front().from, begin(far, 0));
  const SeparatingGraph two = united({0.3, 0.3 + 1e-5}, 0.3 + 1e-5 - 1e-9);
  EXPECT_EQ(two.nodes.front().sides.front().from, begin(two, 1));
  EXPECT_NE(begin(two, 0), begin(two, 1));
}

/// Where a curved side goes on from one piece of an edge to the next it has no end.
TEST(EdgePlaces, CurvedSidesDoNotEndWhereTheyGoOn) {
  const Scene scene = make_scene({{}, {circle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, {{0, 0, 5}}});
  const ContactGeometry geometry(scene);
  const auto united = [&](double side_begin) {
    SeparatingGraph graph;
    graph.arcs.push_back(along_curve(geometry, 0.2, 1 - 1e-5));
    FacetNode facet;
    const EdgePiece& first = geometry.piece({0, SourceKind::edge, 0, 1, 0});
    facet.sides = {EdgeStretch{0, 0, 0.1, 1},
                   EdgeStretch{0, first.end_neighbor[1], side_begin, 0.9}};
    graph.nodes.push_back(facet);
    unite_edge_places(geometry, graph, 1e-8, 1e-7, 1e-4, everywhere);
    return graph.arcs.front().pieces.front().rulings.back().contact[0].u;
  };
  EXPECT_EQ(united(0), 1 - 1e-5);
  EXPECT_EQ(united(0.5), 1);
}

/// Places beside edges at which rounded walls end are on these, unless their patches rise from the
/// hull there.
TEST(EdgePlaces, BesideBentWallsAreOnTheirEdgesWhereThesePatchesTouch) {
  Random random(1);
  Natural box;
  box.shape = with_higher_degrees(filleted_box(3, 2, 1, 0.25));
  const Scene scene = make_scene(placed(box, Variant::float32, random).shape);
  const ContactGeometry geometry(scene, {}, tie_share * 1e-7);
  ASSERT_GT(geometry.bent(), 0);
  const std::vector<Patch>& patches = scene.model().parts().front().patches();
  int moved = 0;
  for (int p = 0; p < int(patches.size()); ++p) {
    for (const Side side : all_sides) {
      const int piece = patches[std::size_t(p)].borders[std::size_t(side)].piece;
      if (piece < 0 || !geometry.is_beside_bent(geometry.first({0, SourceKind::edge, piece, 0, 0})))
        continue;
      for (const bool touches : {false, true}) {
        Contact c = on_side(0, p, side, 0.4);
        double& across = along_v(side) ? c.u : c.v;
        across = at_upper_end(side) ? 1 - 1e-4 : 1e-4;
        const double beside = across;
        SeparatingGraph graph;
        SeparatingArc arc;
        const Ruling r{{0, 0, 1}, {c, c}, {geometry.point(c), geometry.point(c)}};
        arc.pieces.push_back({{r, r}});
        graph.arcs.push_back(arc);
        unite_edge_places(geometry, graph, 1e-4, 1e-9, 1e-2,
                          [&](const Contact&) { return touches; });
        const Contact& there = graph.arcs.front().pieces.front().rulings.front().contact[0];
        const double at = along_v(side) ? there.u : there.v;
        EXPECT_EQ(at, touches ? std::round(beside) : beside);
        ++moved;
      }
    }
  }
  EXPECT_GT(moved, 0);
}

}  // namespace
}  // namespace taut
