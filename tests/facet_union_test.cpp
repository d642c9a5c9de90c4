#include "taut/hull/solve/facet_union.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace taut {
namespace {

constexpr double tie = 1e-12;

/// A facet in the plane z = 0 from whose sides the arcs with these numbers leave.
FacetNode facet(const std::vector<dvec3>& points, const std::vector<int>& arcs) {
  FacetNode node;
  node.n = dvec3(0, 0, 1);
  node.points = points;
  for (std::size_t k = 0; k < points.size(); ++k) {
    node.contacts.push_back({0, SourceKind::vertex, int(k), 0, 0});
    node.slots.push_back({arcs[k], 0});
  }
  return node;
}

/// From the facet across the side from a to b, to a free end.
SeparatingArc arc(const dvec3& a, const dvec3& b, const dvec3& to_n) {
  const Contact first{0, SourceKind::vertex, 0, 0, 0}, second{0, SourceKind::vertex, 1, 0, 0};
  SeparatingArc result;
  result.pieces.push_back(
      {{{dvec3(0, 0, 1), {first, second}, {a, b}}, {to_n, {first, second}, {a, b}}}});
  result.facet = {0, -1};
  return result;
}

/// The rulings of the arcs that leave across a facet's sides begin in the corners of these.
void expect_aligned(const SeparatingGraph& graph, const FacetNode& node) {
  for (std::size_t k = 0; k < node.slots.size(); ++k) {
    const FacetNode::Slot& slot = node.slots[k];
    const std::vector<ArcPiece>& pieces = graph.arcs[std::size_t(slot.arc)].pieces;
    const Ruling& r = slot.end == 0 ? pieces.front().rulings.front() : pieces.back().rulings.back();
    const std::size_t own = slot.end == 0 ? 0 : 1;
    EXPECT_EQ(r.point[own], node.points[k]);
    EXPECT_EQ(r.point[1 - own], node.points[(k + 1) % node.points.size()]);
  }
}

/// A triangle with a spur, which begins with any of its corners.
TEST(FacetUnion, SidesThatLeadOutAndBackAreFolded) {
  const std::vector<dvec3> corners = {{0, 0, 0}, {-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (std::size_t first = 0; first < corners.size(); ++first) {
    SCOPED_TRACE(first);
    std::vector<dvec3> points = corners;
    std::rotate(points.begin(), points.begin() + std::ptrdiff_t(first), points.end());
    SeparatingGraph graph;
    graph.nodes.push_back(facet(points, {0, 1, 2, 3, 4}));
    for (std::size_t k = 0; k < points.size(); ++k) {
      graph.arcs.push_back(
          arc(points[k], points[(k + 1) % points.size()], dvec3(1e-3 * double(k + 1), 0, 1)));
    }
    unite_facets(graph, tie);
    ASSERT_EQ(graph.nodes.size(), 1U);
    ASSERT_EQ(graph.nodes[0].points.size(), 3U);
    ASSERT_EQ(graph.arcs.size(), 4U);
    expect_aligned(graph, graph.nodes[0]);
    const auto goes_on = [](const SeparatingArc& a) { return a.facet[0] < 0 && a.facet[1] < 0; };
    EXPECT_EQ(std::count_if(graph.arcs.begin(), graph.arcs.end(), goes_on), 1);
  }
}

TEST(FacetUnion, OfSidesThatAllLeadOutAndBackNothingIsLeft) {
  const std::vector<dvec3> points = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {1, 0, 0}};
  SeparatingGraph graph;
  graph.nodes.push_back(facet(points, {0, 1, 2, 3}));
  for (std::size_t k = 0; k < 4; ++k) {
    graph.arcs.push_back(arc(points[k], points[(k + 1) % 4], dvec3(1e-3 * double(k + 1), 0, 1)));
  }
  unite_facets(graph, tie);
  EXPECT_TRUE(graph.nodes.empty());
  EXPECT_EQ(graph.arcs.size(), 2U);
}

/// Two triangles of a square with an arc between them along which the plane stands still, or turns.
TEST(FacetUnion, OfTwoInOnePlane) {
  const std::vector<dvec3> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (const bool turns : {false, true}) {
    SeparatingGraph graph;
    graph.nodes.push_back(facet({square[0], square[1], square[2]}, {0, 1, 4}));
    graph.nodes.push_back(facet({square[2], square[3], square[0]}, {2, 3, 4}));
    graph.nodes[1].slots[2].end = 1;
    for (std::size_t k = 0; k < 4; ++k) {
      graph.arcs.push_back(arc(square[k], square[(k + 1) % 4], dvec3(1e-3, 0, 1)));
      graph.arcs.back().facet[0] = k < 2 ? 0 : 1;
    }
    graph.arcs.push_back(arc(square[2], square[0], turns ? dvec3(1e-3, 0, 1) : dvec3(0, 0, 1)));
    graph.arcs.back().facet[1] = 1;
    unite_facets(graph, tie);
    ASSERT_EQ(graph.nodes.size(), turns ? 2U : 1U);
    ASSERT_EQ(graph.arcs.size(), turns ? 5U : 4U);
    EXPECT_EQ(graph.nodes[0].points.size(), turns ? 3U : 4U);
    expect_aligned(graph, graph.nodes[0]);
    for (const SeparatingArc& own : graph.arcs) EXPECT_LT(own.facet[0], int(graph.nodes.size()));
  }
}

}  // namespace
}  // namespace taut
