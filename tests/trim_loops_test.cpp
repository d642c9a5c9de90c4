#include "taut/hull/stitch/trim_loops.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "models.h"
#include "solved_scene.h"
#include "taut/bounds/poles.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

struct Trimmed : SolvedScene {
  using SolvedScene::SolvedScene;

  Contact at(const TrimRegion& r, const dvec2& uv) const {
    return {r.instance, SourceKind::face, r.patch, uv.x, uv.y};
  }
  dvec2 end(const TrimStretch& s, bool last) const {
    if (s.arc < 0) {
      const double t = last ? s.to : s.from;
      const double fixed = s.side == Side::u1 || s.side == Side::v1 ? 1 : 0;
      return s.side == Side::u0 || s.side == Side::u1 ? dvec2(fixed, t) : dvec2(t, fixed);
    }
    const std::vector<Ruling>& rulings =
        graph.arcs[std::size_t(s.arc)].pieces[std::size_t(s.piece)].rulings;
    const Ruling& r = last != s.reversed ? rulings.back() : rulings.front();
    const Contact& c = r.contact[std::size_t(s.contact)];
    return {c.u, c.v};
  }

  /// Every stretch begins where the one before it ends.
  void expect_closed_loops() const {
    for (const TrimRegion& r : regions) {
      for (const auto& loop : r.loops) {
        for (std::size_t k = 0; k < loop.size(); ++k) {
          EXPECT_LT(glm::distance(end(loop[k], true), end(loop[(k + 1) % loop.size()], false)),
                    1e-9);
        }
      }
    }
  }

  /// To the left of the middle of every trace, seen from outside, the patch supports the model; to
  /// the right it does not.
  int expect_left_of_traces() {
    int traces = 0;
    for (const TrimRegion& r : regions) {
      for (const auto& loop : r.loops) {
        for (const TrimStretch& s : loop) {
          if (s.arc < 0) continue;
          const auto& rulings = graph.arcs[std::size_t(s.arc)].pieces[std::size_t(s.piece)].rulings;
          if (rulings.size() < 3) continue;
          const std::size_t k = rulings.size() / 2;
          const auto place = [&](std::size_t i) {
            const Contact& c = rulings[i].contact[std::size_t(s.contact)];
            return dvec2(c.u, c.v);
          };
          dvec2 along = place(k + (k + 1 < rulings.size() ? 1 : 0)) - place(k - 1);
          if (s.reversed) along = -along;
          const dvec2 left = glm::normalize(dvec2(-along.y, along.x)) * double(r.sign);
          for (const double side : {1.0, -1.0}) {
            const Contact c = at(r, place(k) + side * 0.01 * left);
            if (c.u < 0 || c.u > 1 || c.v < 0 || c.v > 1) continue;
            const dvec3 n = double(r.sign) * unit_normal(geometry, c);
            const bool supports = query(n).h <= glm::dot(geometry.point(c), n) + 1e-12;
            EXPECT_EQ(supports, side > 0);
          }
          ++traces;
        }
      }
    }
    return traces;
  }
};

TEST(TrimRegions, WholePatches) {
  // A sphere's eight, each bounded by all of its border, with the outward side told.
  const Trimmed ball(sphere(1));
  EXPECT_TRUE(ball.unresolved.empty());
  ASSERT_EQ(ball.regions.size(), 8U);
  ball.expect_closed_loops();
  for (const TrimRegion& r : ball.regions) {
    ASSERT_EQ(r.loops.size(), 1U);
    EXPECT_EQ(r.loops[0].size(), 4U);
    const Contact middle = ball.at(r, {0.5, 0.5});
    EXPECT_GT(r.sign * glm::dot(unit_normal(ball.geometry, middle), ball.geometry.point(middle)),
              0);
  }
  // Of a ball inside another nothing is left.
  EXPECT_EQ(Trimmed(sphere(1) + shifted(sphere(0.4), {0.1, 0.2, 0.3})).regions.size(), 8U);
}

TEST(TrimRegions, OfTwoSpheres) {
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    Trimmed balls(mapped(sphere(1), turn) +
                  mapped(sphere(0.5), skew_rotation() * turn, {0.2, 0.4, 3}));
    EXPECT_TRUE(balls.unresolved.empty());
    balls.expect_closed_loops();
    EXPECT_GE(balls.expect_left_of_traces(), 8);
    for (const TrimRegion& r : balls.regions) EXPECT_GE(r.loops.size(), 1U);
  }
}

TEST(TrimRegions, OfDentedBodiesAndTheTeapot) {
  for (const Shape& shape : {blob(2), dented_ellipsoid(), teapot()}) {
    Trimmed trimmed(shape);
    EXPECT_TRUE(trimmed.unresolved.empty());
    trimmed.expect_closed_loops();
    EXPECT_GE(trimmed.expect_left_of_traces(), 4);
  }
}

/// A curve inside of one patch cuts a hole into it, or an island out of it.
TEST(TrimRegions, HolesAndIslands) {
  // A paraboloid over a square, its top at z = -height.
  const auto cap = [](double height) {
    BezierPatch patch{2, 2, {}};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double z = (i == 1 ? 0.0 : -height) + (j == 1 ? 0.0 : -height);
        patch.points.push_back(homogeneous(dvec3(i - 1, j - 1, z)));
      }
    }
    return of_patch(patch);
  };
  Trimmed pierced(cap(1) + Shape{{}, {}, {{0.05, 0.03, -0.95}}});
  int holes = 0;
  for (const TrimRegion& r : pierced.regions) holes += int(r.loops.size()) - 1;
  EXPECT_EQ(holes, 1);
  pierced.expect_closed_loops();
  EXPECT_GE(pierced.expect_left_of_traces(), 1);
  // A large ring about a flat cap leaves its top alone.
  Trimmed island(cap(0.4) + Shape{{}, {circle({0.1, 0.05, -0.5}, {3, 0, 0.1}, {0, 3, 0})}, {}});
  ASSERT_EQ(island.regions.size(), 1U);
  EXPECT_EQ(island.regions[0].loops.size(), 1U);
  for (const TrimStretch& s : island.regions[0].loops[0]) EXPECT_GE(s.arc, 0);
  EXPECT_GE(island.expect_left_of_traces(), 1);
}

TEST(TrimRegions, TellCurvesWithoutLength) {
  Trimmed balls(sphere(1) + shifted(sphere(0.5), {0.2, 0.4, 3}));
  ASSERT_EQ(balls.graph.arcs.size(), 1U);
  SeparatingArc& arc = balls.graph.arcs.front();
  ASSERT_TRUE(arc.closed);
  arc.pieces.resize(1);
  arc.pieces.front().rulings.resize(1);
  std::vector<Unresolved> unresolved;
  trim_regions(balls.geometry, balls.graph, unresolved);
  EXPECT_FALSE(unresolved.empty());
}

TEST(HalfArcs, GoRoundTheirRegions) {
  // Two facets that three arcs join: each half-arc's region is bounded by two of them.
  SeparatingGraph graph;
  graph.arcs.resize(5);
  graph.nodes.resize(2);
  for (int k = 0; k < 3; ++k) graph.arcs[std::size_t(k)].facet = {0, 1};
  graph.nodes[0].slots = {{0, 0}, {1, 0}, {2, 0}};
  graph.nodes[1].slots = {{2, 1}, {1, 1}, {0, 1}};
  graph.arcs[3].closed = true;
  for (int a = 0; a < 3; ++a) {
    for (int contact = 0; contact < 2; ++contact) {
      const HalfArc other = next_half_arc(graph, {a, contact});
      EXPECT_NE(other.arc, a);
      EXPECT_EQ(other.contact, 1 - contact);
      const HalfArc back = next_half_arc(graph, other);
      EXPECT_TRUE(back.arc == a && back.contact == contact);
    }
  }
  // A closed arc follows itself, one with free ends turns back at them.
  EXPECT_TRUE(next_half_arc(graph, {3, 1}).arc == 3 && next_half_arc(graph, {3, 1}).contact == 1);
  EXPECT_TRUE(next_half_arc(graph, {4, 1}).arc == 4 && next_half_arc(graph, {4, 1}).contact == 0);
  // Nothing follows where a facet's side was not met.
  graph.nodes[0].slots[2].arc = -1;
  EXPECT_EQ(next_half_arc(graph, {0, 0}).arc, -1);
}

/// A facet with these sides, across which arcs begin (end 0) or end (end 1).
FacetNode facet_with(const std::vector<FacetNode::Slot>& slots, const std::vector<bool>& curved) {
  FacetNode node;
  node.slots = slots;
  node.points.resize(slots.size());
  node.contacts.resize(slots.size());
  for (std::size_t k = 0; k < curved.size(); ++k) {
    EdgeStretch side;
    if (curved[k]) side = {0, int(k), 0, 1};
    node.sides.push_back(side);
  }
  return node;
}

bool is(const HalfArc& half, int arc, int contact) {
  return half.arc == arc && half.contact == contact;
}

TEST(HalfArcs, PassCurvedSides) {
  // Sides, counter-clockwise: straight, two curved ones, straight, curved.
  SeparatingGraph graph;
  graph.arcs.resize(2);
  graph.nodes = {facet_with({{0, 0}, {}, {}, {1, 1}, {}}, {false, true, true, false, true})};
  graph.arcs[0].facet = {0, -1};
  graph.arcs[1].facet = {-1, 0};
  // Contact 0 of arc 0 is walked against it, to the facet; it goes on with the side before.
  EXPECT_TRUE(is(next_half_arc(graph, {0, 0}), 1, 0));
  EXPECT_TRUE(is(next_half_arc(graph, {1, 1}), 0, 1));
  // Their other ends are free.
  EXPECT_TRUE(is(next_half_arc(graph, {0, 1}), 0, 0));
  EXPECT_TRUE(is(next_half_arc(graph, {1, 0}), 1, 1));
  // One straight side: its arc follows itself around the facet.
  SeparatingGraph half_disc;
  half_disc.arcs.resize(1);
  half_disc.arcs[0].facet = {0, -1};
  half_disc.nodes = {facet_with({{}, {0, 0}, {}}, {true, false, true})};
  EXPECT_TRUE(is(next_half_arc(half_disc, {0, 0}), 0, 1));
}

TEST(HalfArcs, AtCrossings) {
  // Two contacts that change places: four curves end in one point, in order about it.
  SeparatingGraph graph;
  graph.arcs.resize(4);
  FacetNode node;
  node.contacts.resize(4);
  node.points.resize(4);
  node.is_crossing = true;
  node.slots = {{0, 0}, {1, 1}, {2, 0}, {3, 1}};
  graph.nodes = {node};
  for (const int k : {0, 2}) graph.arcs[std::size_t(k)].facet = {0, -1};
  for (const int k : {1, 3}) graph.arcs[std::size_t(k)].facet = {-1, 0};
  EXPECT_TRUE(is(next_half_arc(graph, {0, 0}), 3, 0));
  EXPECT_TRUE(is(next_half_arc(graph, {3, 1}), 2, 1));
  EXPECT_TRUE(is(next_half_arc(graph, {2, 0}), 1, 0));
  EXPECT_TRUE(is(next_half_arc(graph, {1, 1}), 0, 1));
}

/// In a graph that was solved half-arcs are permuted, in cycles along which the contact at the end
/// of one is that at the beginning of the next, facets' curved sides apart.
void expect_cycles(const Shape& shape, int half_arcs, int cycles) {
  const Trimmed trimmed(shape);
  EXPECT_TRUE(trimmed.unresolved.empty());
  const SeparatingGraph& graph = trimmed.graph;
  std::map<std::pair<int, int>, int> entered;
  int found = 0;
  for (int a = 0; a < int(graph.arcs.size()); ++a) {
    for (const int contact : {0, 1}) {
      if (entered[{a, contact}] > 0) continue;
      ++found;
      HalfArc half{a, contact};
      for (int k = 0; k < 1000; ++k) {
        half = next_half_arc(graph, half);
        ASSERT_GE(half.arc, 0);
        ++entered[{half.arc, half.contact}];
        if (is(half, a, contact)) break;
      }
      EXPECT_TRUE(is(half, a, contact));
    }
  }
  for (const auto& each : entered) EXPECT_EQ(each.second, 1);
  EXPECT_EQ(int(entered.size()), half_arcs);
  EXPECT_EQ(found, cycles);
}

TEST(HalfArcs, OfTracedGraphs) {
  const Shape ring{{}, {circle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, {}};
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    expect_cycles(mapped(two_spheres(1, 0.5, 3), turn), 2, 2);
    // Four scrolls that end in two crossings: each circle has two regions.
    expect_cycles(mapped(perpendicular_circles(), turn), 8, 4);
    expect_cycles(
        mapped(torus(1, 0.25) + mapped(torus(1, 0.25), {1, 0, 0, 0, 0, -1, 0, 1, 0}), turn), 8, 4);
    // A disc, a point in its plane and one below: three regions, that of the disc with two arcs to
    // the one point and one to the other, and one between the points.
    expect_cycles(mapped(ring + Shape{{}, {}, {{3, 0, 0}, {0.5, 0, -2}}}, turn), 8, 3);
  }
}

}  // namespace
}  // namespace taut
